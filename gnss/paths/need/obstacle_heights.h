#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "canyon/core/motion/route_segment.h"
#include "canyon/scene/city/traffic.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {

/// How high the scene reaches, what moves in it wherever it may come, by squares of the ground: an upper bound of the
/// horizon of any place in it, made without a ray. Trees are left out, as they do not block (SceneAt::blocked_towards).
class ObstacleHeights {
 public:
  /// `moving`: where things may stand that move.
  explicit ObstacleHeights(const scene::Scene& scene, const std::vector<scene::SweptRoom>& moving = {});

  /// No part of the static scene stands higher than this above W's horizontal, seen from any point that lies
  /// `above_m` or more over the segment's lower end and not below the ground; pi / 2 where nothing can be said: a
  /// solid within the segment that reaches above it, no ground within kNear_m of it, or a place beside the scene.
  ///
  /// Solids, and terrain beyond kNear_m: atan(height above the lowest point / least horizontal distance). Terrain
  /// within kNear_m: its steepest slope there, since ground that nowhere rises faster than that does not rise faster
  /// from under the antenna on either.
  double horizon_rad(const RouteSegment& segment, double above_m, double beside_m) const;

  static constexpr double kNear_m = 30.0;

 private:
  struct Square {
    float terrain_top_m = -1e30F, solid_top_m = -1e30F;
    float slope = 0.0F;  ///< steepest of the terrain's triangles that touch it, rise over run
    bool terrain() const { return terrain_top_m > -1e29F; }
  };
  void add(const scene::SweptRoom& room);
  template <class Visit>
  void each_square(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Visit& visit);

  double cell_m_ = 4.0;
  Eigen::AlignedBox2d ground_;  ///< of the static scene; squares beyond it hold what moves there
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  int columns_ = 0, rows_ = 0;
  std::vector<Square> squares_;
};

}  // namespace canyon::gnss
