#pragma once

#include <memory>
#include <optional>
#include <span>

#include "scene/ray_packet.h"
#include "scene/scene.h"
#include "scene/scene_at.h"

namespace canyon::scene {

/// What a ray may meet, as bits.
enum TraceMask : std::uint32_t { kTraceTerrain = 1, kTraceSolid = 2, kTraceTree = 4, kTraceAll = 7 };

/// Ray tracing and nearest-surface queries over a static mesh. All that Canyon knows of Embree is in embree_tracer.cpp.
///
/// The ray tracer finds the triangle in single precision (watertight); the range is then computed in double precision
/// from the ray and that triangle, so that it is the same on every CPU and for single rays and packets alike.
/// Embree advises to flush denormal numbers to zero; that mode is not set, since it belongs to the calling thread and
/// would change the arithmetic of everything else there.
class Tracer {
 public:
  explicit Tracer(const SceneParts& parts);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  /// As SceneAt's; origins, directions and points must be finite.
  Hit trace(const Ray& ray) const;
  void trace(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// Returns how many rays were traced.
  std::int64_t trace(std::span<const RayPacket> rays, std::span<HitPacket> hits) const;
  /// Anything of `mask` at ranges (min_m, max_m)?
  bool occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float min_m, float max_m,
                std::uint32_t mask) const;
  NearestSurface nearest(const Eigen::Vector3d& p_W, double max_m) const;
  /// Highest terrain triangle at (x, y), or Hit::kMiss.
  std::uint32_t terrain_triangle(double x, double y) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace canyon::scene
