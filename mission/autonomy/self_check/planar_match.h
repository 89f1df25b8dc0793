#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/mission/autonomy/known_vehicle.h"

namespace canyon::mission {

/// A place on the level plane, in the frame that has B's origin and heading.
using PlanarPoints = std::vector<Eigen::Vector2d>;

/// What stands about a vehicle in one scan: returns between `low_m` and `high_m` over its ground plane and at most
/// `reach_m` away, one of each square of 0.2 m. `X_WL` and `X_WB` as believed.
struct StandingRule {
  double low_m = 0.7, high_m = 3.0;
  double reach_m = 28.0;
};
PlanarPoints standing_points(const LidarScan& scan, const Pose& X_WL, const Pose& X_WB, const StandingRule& rule);

/// How a body has moved on the plane: its pose now in the frame it had then, and the covariance of x, y (along and left
/// of the frame then) and yaw.
struct PlanarMotion {
  PlanPose pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
};

/// The surfaces that a scan showed, as one straight piece in each square metre (the normal distributions of Biber and
/// Strasser 2003, of which only the narrow direction is used: along a wall a scan does not say how far one has gone).
class WallPieces {
 public:
  explicit WallPieces(const PlanarPoints& points);

  /// The most probable motion by these surfaces and what was known before, given what the body sees now. Where the
  /// surfaces say nothing it is what was known before, with that covariance.
  PlanarMotion match(const PlanarPoints& now, const PlanarMotion& before) const;
  int count() const { return count_; }

 private:
  static constexpr int kSide = 64;  // cells of 1 m, the frame's origin in the middle
  struct Piece {
    Eigen::Vector2d middle{0, 0}, normal{0, 0};
    double variance_m2 = 0.0;  ///< across; 0: no piece
  };
  static int cell(const Eigen::Vector2d& p);

  std::vector<Piece> pieces_;
  int count_ = 0;
};

}  // namespace canyon::mission
