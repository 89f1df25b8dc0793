#include "canyon/scene/scene_at.h"

#include "canyon/core/check.h"
#include "canyon/scene/tracing/tiled_tracer.h"

namespace canyon::scene {
namespace {

constexpr float kClearance_m = 1e-3f;

}  // namespace

void SceneAt::set_instances(std::vector<Instance> instances) {
  moving_objects_.clear();
  for (const Instance& i : instances) {
    CANYON_CHECK(i.shape != nullptr, "instance ", i.name, " has no shape");
    for (const std::uint16_t m : i.shape->mesh().material)
      CANYON_CHECK(m < scene_->materials().size(), "instance ", i.name, " material ", m);
    moving_objects_.push_back({i.name, i.shape->kind()});
  }
  instances_ = nullptr;
  if (instances.empty()) return;
  const Eigen::Vector3d center_W = packet_origin(instances.front().X_WS.p);
  instances_ = std::make_shared<const InstanceSet>(std::move(instances), center_W);
  ++scene_->instance_sets_;
}

const std::vector<Instance>& SceneAt::instances() const {
  static const std::vector<Instance> kNone;
  return instances_ ? instances_->instances() : kNone;
}

SceneAt::Surface SceneAt::moving_surface(std::uint32_t triangle) const {
  const std::size_t first = scene_->mesh().triangles.size();
  CANYON_CHECK(instances_ != nullptr, "triangle ", triangle, " of ", first);
  const InstanceSet::Member member = instances_->member(triangle - static_cast<std::uint32_t>(first));
  return {instances_->instances()[member.instance].shape->mesh().material[member.triangle],
          static_cast<std::uint32_t>(scene_->objects().size()) + member.instance, true};
}

const SceneObject& SceneAt::object(std::uint32_t index) const {
  const auto& fixed = scene_->objects();
  CANYON_CHECK(index < fixed.size() + moving_objects_.size(), "object ", index);
  return index < fixed.size() ? fixed[index] : moving_objects_[index - fixed.size()];
}

Hit SceneAt::trace(const Ray& ray) const {
  Hit hit = scene_->tracer_->trace(ray);
  if (instances_) instances_->trace(ray, static_cast<std::uint32_t>(scene_->mesh().triangles.size()), hit);
  return hit;
}

void SceneAt::trace(std::span<const Ray> rays, std::span<Hit> hits) const {
  scene_->tracer_->trace(rays, hits);
  if (instances_) instances_->trace(rays, static_cast<std::uint32_t>(scene_->mesh().triangles.size()), hits);
}

void SceneAt::trace(std::span<const RayPacket> rays, std::span<HitPacket> hits, const Eigen::Vector3d& origin_W) const {
  scene_->tracer_->trace(rays, hits, origin_W);
  if (instances_) instances_->trace(rays, origin_W, static_cast<std::uint32_t>(scene_->mesh().triangles.size()), hits);
}

Eigen::Vector3d SceneAt::packet_origin(const Eigen::Vector3d& p_W) const {
  return scene_->tracer_->center(p_W);
}

bool SceneAt::blocked(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W) const {
  const Eigen::Vector3d way = b_W - a_W;
  const double length_m = way.norm();
  if (length_m <= 2.0 * kClearance_m) return false;
  const Eigen::Vector3f direction = (way / length_m).cast<float>();
  const auto max_m = static_cast<float>(length_m - kClearance_m);
  return scene_->tracer_->occluded(a_W, direction, kClearance_m, max_m, kTraceAll) ||
         (instances_ && instances_->occluded(a_W, direction, kClearance_m, max_m));
}

bool SceneAt::blocked_towards(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m,
                              bool ignore_foliage) const {
  if (max_m <= kClearance_m) return false;
  const Eigen::Vector3f direction = direction_W.cast<float>();
  const auto end_m = static_cast<float>(max_m);
  const std::uint32_t mask = ignore_foliage ? kTraceTerrain | kTraceSolid : kTraceAll;
  return scene_->tracer_->occluded(p_W, direction, kClearance_m, end_m, mask) ||
         (instances_ && instances_->occluded(p_W, direction, kClearance_m, end_m));
}

double SceneAt::foliage_m(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m) const {
  return scene_->crowns_.chords_m(p_W, direction_W, max_m);
}

void SceneAt::crown_passages(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m,
                             std::vector<CrownPassage>& out) const {
  scene_->crowns_.passages(p_W, direction_W, max_m, out);
}

NearestSurface SceneAt::nearest(const Eigen::Vector3d& p_W, double max_m) const {
  return scene_->tracer_->nearest(p_W, max_m);
}

}  // namespace canyon::scene
