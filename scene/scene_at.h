#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/scene/scene.h"
#include "canyon/scene/tracing/instances.h"
#include "canyon/scene/tracing/ray_packet.h"

namespace canyon::scene {

struct Ray {
  Eigen::Vector3d origin;     ///< in W
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

/// The scene at one time as sensors receive it; one per run. Cheap to make and to copy; a copy keeps the instances it
/// was made with. All queries are const and thread-safe. Ray origins, directions and points must be finite. Scenes
/// wider than 2 km are traced in tiles, each about a center of its own, so that rays are as exact everywhere as near
/// W's origin (scene/tracing/tiled_tracer.h).
///
/// Moving things have an acceleration structure of their own over their shapes', made anew at each step; the static
/// scene's is never touched, and a scene without moving things pays nothing for them. Triangles from
/// scene().mesh().triangles.size() on, and objects from scene().objects().size() on, are of moving things: surface()
/// and object() know both.
class SceneAt {
 public:
  explicit SceneAt(const Scene& scene) : scene_(&scene) {}

  const Scene& scene() const { return *scene_; }

  /// Puts the moving things where they are now; their shapes' materials must be the scene's. Not while other threads
  /// trace.
  void set_instances(std::vector<Instance> instances);
  /// Moving object k is scene().objects().size() + k.
  const std::vector<Instance>& instances() const;

  /// What a ray met: index of its material, of its object, and whether it is a moving thing.
  struct Surface {
    std::uint16_t material = 0;
    std::uint32_t object = 0;
    bool moving = false;
  };
  Surface surface(std::uint32_t triangle) const {
    const Mesh& mesh = scene_->mesh();
    if (triangle < mesh.triangles.size()) return {mesh.material[triangle], mesh.object[triangle], false};
    return moving_surface(triangle);
  }
  const SceneObject& object(std::uint32_t index) const;

  Hit trace(const Ray& ray) const;
  /// Many rays at once, on the calling thread. hits.size() == rays.size(). Rays go in packets of 16 neighbours: three
  /// times faster than single rays when these are neighbours in direction (all azimuths of one beam, then the next
  /// beam). Every hit is the same as that of trace(ray), except that a ray exactly through an edge may report either
  /// neighbour.
  void trace(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// The same for rays that are already packed, their origins relative to `origin_W`; nothing but range, incidence and
  /// triangle comes back. Fast and exact where origin_W is the packet_origin() of the sensor's place.
  void trace(std::span<const RayPacket> rays, std::span<HitPacket> hits,
             const Eigen::Vector3d& origin_W = Eigen::Vector3d::Zero()) const;
  /// What the origins of packets should be relative to near p: W's origin, or the center of the tile there.
  Eigen::Vector3d packet_origin(const Eigen::Vector3d& p_W) const;
  /// True if anything, trees included, lies on the open segment between a and b (both ends kept clear by 1 mm).
  bool blocked(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W) const;
  /// True if anything lies on the ray from p (kept clear by 1 mm) towards the unit direction, up to max_m, except trees
  /// (trunk and crown: every triangle of an ObjectKind::kTree) when `ignore_foliage`.
  bool blocked_towards(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m = 1e5,
                       bool ignore_foliage = true) const;
  /// Length of the way through tree crowns along the ray, m, as if all were of the reference leaf density: the chords
  /// through all Foliage ellipsoids times density / reference, summed (where crowns overlap, both count). The direction
  /// must be a unit vector.
  double foliage_m(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m = 1e5) const;
  /// The chords themselves, by crown; replaces what is in `out`.
  void crown_passages(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m,
                      std::vector<CrownPassage>& out) const;

  /// Nearest point of any static surface, trees and terrain included, within max_m of p, in double precision (used by
  /// the scorer). `triangle` is kMiss if there is none; of equally near triangles the one with the lowest
  /// index.
  NearestSurface nearest(const Eigen::Vector3d& p_W, double max_m) const;

 private:
  Surface moving_surface(std::uint32_t triangle) const;

  const Scene* scene_;
  std::shared_ptr<const InstanceSet> instances_;  ///< null: nothing moves
  std::vector<SceneObject> moving_objects_;
};

}  // namespace canyon::scene
