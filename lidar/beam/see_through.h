#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "canyon/core/model_table.h"
#include "canyon/core/random/random.h"
#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/surfaces.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {

/// What light goes on behind: `[lidar] see_through`.
struct Transparent {
  bool panes = false, leaves = false;
  bool operator==(const Transparent&) const = default;
};
ModelTable<Transparent> see_through_rows();

/// One ray of a packet whose origins are relative to origin_W.
inline scene::Ray ray_of(const scene::RayPacket& p, std::size_t lane, const Eigen::Vector3d& origin_W) {
  return {origin_W + Eigen::Vector3d(p.origin_x[lane], p.origin_y[lane], p.origin_z[lane]),
          {p.direction_x[lane], p.direction_y[lane], p.direction_z[lane]},
          p.max_m[lane]};
}

/// Follows a ray behind what it met first.
///
/// Panes: a surface that lets the share t of the light through gives its own echo, and what lies behind it is seen
/// through it twice: t^2. Every triangle of such a material is a pane (lidar/beam/pane.h).
///
/// Leaves: a crown is a volume of leaves turned every way, of one-sided area `leaf_density` per volume, of which a beam
/// meets half (Ross 1981): the way to the first leaf is exponential with rate density / 2, and a chord d stays clear
/// with probability exp(-density d / 2). A thin ray is stopped by the leaf it meets, whose tilt is drawn with the
/// probability that it is met at it, 2 cos. The leaves that a scene's mesh shows in the place of a crown (triangles of
/// trees and of the material "foliage" whose middle lies in one) are then left out; other leaves stop light as ever.
///
/// Stream "lidar.leaves", entity = laser, index = firing cycle, n = 32 * sub-ray + 2 * crown along the ray: how far,
/// + 1: tilt. Const and thread-safe.
class SeeThrough {
 public:
  SeeThrough(Transparent through, std::uint64_t seed);

  bool any() const { return panes_ || leaves_; }
  bool leaves() const { return leaves_; }

  /// One ray in W, and which of the laser's it is.
  struct Shot {
    scene::Ray ray;
    std::uint32_t laser = 0;
    std::uint64_t draw = 0;
    std::uint32_t sub_ray = 0;
  };
  /// Replaces `out` by the ray's echoes, nearest first. In the lane of `first` is what the ray met first.
  void follow(const Shot& shot, const scene::HitPacket& first, std::size_t lane, const scene::SceneAt& scene,
              const Surfaces& surfaces, std::vector<Echo>& out) const;

 private:
  bool panes_ = false, leaves_ = false;
  RandomStream stream_;
};

}  // namespace canyon::lidar
