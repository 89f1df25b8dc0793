#include "scene/scene_at.h"

#include "scene/tracer.h"

namespace canyon::scene {
namespace {

constexpr float kClearance_m = 1e-3f;

}  // namespace

Hit SceneAt::trace(const Ray& ray) const {
  traced_rays_.add(1);
  return scene_->tracer_->trace(ray);
}

void SceneAt::trace(std::span<const Ray> rays, std::span<Hit> hits) const {
  traced_rays_.add(static_cast<std::int64_t>(rays.size()));
  scene_->tracer_->trace(rays, hits);
}

void SceneAt::trace(std::span<const RayPacket> rays, std::span<HitPacket> hits) const {
  traced_rays_.add(scene_->tracer_->trace(rays, hits));
}

bool SceneAt::blocked(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W) const {
  const Eigen::Vector3d way = b_W - a_W;
  const double length_m = way.norm();
  if (length_m <= 2.0 * kClearance_m) return false;
  occlusion_rays_.add(1);
  return scene_->tracer_->occluded(a_W.cast<float>(), (way / length_m).cast<float>(), kClearance_m,
                                   static_cast<float>(length_m - kClearance_m), kTraceAll);
}

bool SceneAt::blocked_towards(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m,
                              bool ignore_foliage) const {
  if (max_m <= kClearance_m) return false;
  occlusion_rays_.add(1);
  return scene_->tracer_->occluded(p_W.cast<float>(), direction_W.cast<float>(), kClearance_m,
                                   static_cast<float>(max_m), ignore_foliage ? kTraceTerrain | kTraceSolid : kTraceAll);
}

double SceneAt::foliage_m(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m) const {
  return scene_->crowns_.chords_m(p_W, direction_W, max_m);
}

NearestSurface SceneAt::nearest(const Eigen::Vector3d& p_W, double max_m) const {
  nearest_queries_.add(1);
  return scene_->tracer_->nearest(p_W, max_m);
}

TraceCounters SceneAt::counters() const {
  return {traced_rays_.n.load(std::memory_order_relaxed), occlusion_rays_.n.load(std::memory_order_relaxed),
          nearest_queries_.n.load(std::memory_order_relaxed)};
}

}  // namespace canyon::scene
