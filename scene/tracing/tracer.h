#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/tracing/ray_packet.h"

namespace canyon::scene {

/// What a ray may meet, as bits.
enum TraceMask : std::uint32_t { kTraceTerrain = 1, kTraceSolid = 2, kTraceTree = 4, kTraceAll = 7 };

/// The part of a ray that is traced, and how far along it the tracer sets off, so that its coordinates stay small.
struct RaySpan {
  double from_m = 0.0;
  double to_m = std::numeric_limits<double>::infinity();
  double start_m = 0.0;  ///< <= from_m
};

/// Ray tracing and nearest-surface queries over some triangles of a static mesh. All that Canyon knows of Embree is in
/// embree_*.cpp.
///
/// It works in W moved to a center of whole metres, by which no vertex is rounded: there single precision is finest.
///
/// The ray tracer finds the triangle in single precision (watertight); the range is then computed in double precision
/// from the ray and that triangle, so that it is the same on every CPU and for single rays and packets alike.
/// Embree advises to flush denormal numbers to zero; that mode is not set, since it belongs to the calling thread and
/// would change the arithmetic of everything else there.
class Tracer {
 public:
  Tracer(const SceneParts& parts, std::span<const std::uint32_t> triangles, const Eigen::Vector3d& center_W);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  /// As SceneAt's; origins, directions and points must be finite. Of the ray only the span is looked at.
  Hit trace(const Ray& ray, const RaySpan& span) const;
  void trace(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// Origins of packets are relative to the center.
  void trace(std::span<const RayPacket> rays, std::span<HitPacket> hits) const;
  /// Anything of `mask` on the span?
  bool occluded(const Eigen::Vector3d& origin_W, const Eigen::Vector3f& direction, const RaySpan& span,
                std::uint32_t mask) const;
  NearestSurface nearest(const Eigen::Vector3d& p_W, double max_m) const;
  /// Highest terrain triangle at (x, y), or Hit::kMiss.
  std::uint32_t terrain_triangle(double x, double y) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace canyon::scene
