#pragma once

#include <Eigen/Core>

#include "canyon/fusion/smoothing/graph/graph_layout.h"
#include "canyon/fusion/smoothing/graph/preintegration.h"

namespace canyon::fusion {

/// Rows of a factor: residual, in units of its 1-sigma, and its derivatives by what it stands between.
struct FactorRows {
  Eigen::VectorXd residual;
  Eigen::MatrixXd by_first, by_second, by_constants;
};

/// Two nodes and what the IMU measured between them.
///
/// Inertial axes that coincide with E's at the first node carry the motion: there U moves with u = v + w_IE x p, and
/// what it does is gravitation G (gravity without the centrifugal part) and specific force alone. E turns under them by
/// w_IE dt, exactly, so that Earth rate, Coriolis and centrifugal terms are in it whole. G is taken as linear in time
/// between its values at the two nodes, as which it enters velocity by dt (G_i + G_j) / 2 and position by dt^2 (G_i / 3
/// + G_j / 6). What that leaves out is the gravity gradient (3e-6 1/s^2) times the way off the chord: 2.6e-7 a dt^3 m/s
/// of velocity for an acceleration a, below 1e-6 m/s for 3 m/s^2 over a second.
///
/// The residual is that of [theta at the second node, p, v in U's axes at the first, wandering values], with E+ =
/// Exp(w_IE dt):
///   Log(dR' R_i' E+ R_j)
///   R_i' (E+ p_j - p_i - u_i dt - dt^2 (G_i / 3 + G_j / 6)) - dp
///   R_i' (E+ (v_j + w x p_j) - u_i - dt (G_i + G_j) / 2) - dv
///   c_j - kept c_i
class ImuFactor {
 public:
  /// `gradient_at_E`: where the gravity gradient is taken, within some tens of kilometres.
  ImuFactor(const GraphLayout& layout, const PreintegratedImu& imu, const Eigen::Vector3d& gradient_at_E);

  double dt_s() const { return imu_.dt_s; }
  const PreintegratedImu& imu() const { return imu_; }
  /// Where the second node is, as the first and the IMU have it; its time too.
  GraphNode predict(const GraphLayout& layout, const GraphNode& first, const Eigen::VectorXd& constants) const;
  FactorRows rows(const GraphLayout& layout, const GraphNode& first, const GraphNode& second,
                  const Eigen::VectorXd& constants, bool derivatives) const;

 private:
  PreintegratedImu imu_;
  Eigen::MatrixXd whiten_;  // lower triangle
  Eigen::Matrix3d gravitation_gradient_;
  Eigen::Matrix3d turn_less_one_;  // E+ - 1
};

/// The inverse of the lower Cholesky factor of a covariance. Where rounding leaves it indefinite, or noise is zero,
/// each variance counts as known to 1e-12 of itself and no better than `floor` (1-sigma) beside.
Eigen::MatrixXd whitening(const Eigen::MatrixXd& covariance, double floor = 0.0);

}  // namespace canyon::fusion
