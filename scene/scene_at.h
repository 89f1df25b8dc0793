#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include <Eigen/Core>

#include "scene/scene.h"

namespace canyon::scene {

struct Ray {
  Eigen::Vector3f origin;     ///< in W
  Eigen::Vector3f direction;  ///< unit
  float max_m = std::numeric_limits<float>::infinity();
};

/// What a ray met. `triangle` == kMiss: nothing.
struct Hit {
  static constexpr std::uint32_t kMiss = 0xffffffffu;
  float range_m = 0;
  std::uint32_t triangle = kMiss;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< geometric, unit, facing the ray's origin
  bool hit() const { return triangle != kMiss; }
};

struct NearestSurface {
  double distance_m = std::numeric_limits<double>::infinity();
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();
  std::uint32_t triangle = Hit::kMiss;
};

/// The scene at one time as sensors receive it; one per run (moving instances will live here). Cheap to make.
/// All queries are const and thread-safe. Counts its rays, for cost reports.
class SceneAt {
 public:
  explicit SceneAt(const Scene& scene);

  const Scene& scene() const { return *scene_; }

  Hit trace(const Ray& ray) const;
  /// Many rays at once; neighbouring rays should be neighbours in direction. hits.size() == rays.size().
  void trace(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// True if anything lies on the open segment between a and b (both ends kept clear by 1 mm).
  bool blocked(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W) const;
  /// True if anything lies on the ray from p towards the unit direction, up to max_m, except trees when `ignore_foliage`.
  bool blocked_towards(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m = 1e5,
                       bool ignore_foliage = true) const;
  /// Length of the way through tree crowns along the ray, m.
  double foliage_m(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m = 1e5) const;

  /// Nearest point of any surface within max_m of p (static scene; used by the scorer).
  NearestSurface nearest(const Eigen::Vector3d& p_W, double max_m) const;

 private:
  const Scene* scene_;
};

}  // namespace canyon::scene
