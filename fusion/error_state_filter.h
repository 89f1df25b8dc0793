#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/config.h"
#include "core/imu_noise.h"
#include "core/local_frame.h"
#include "core/messages.h"

namespace canyon::fusion {

/// [fusion] of a mission file.
struct FilterConfig {
  double initial_attitude_sigma_deg_roll_pitch = 0.1;
  double initial_attitude_sigma_deg_heading = 1.0;
  double initial_position_sigma_m = 0.5;
  double initial_velocity_sigma_m_s = 0.05;
  double gate_sigma = 0.0;        ///< innovation gate on NIS as a one-dimensional equivalent; 0 = accept every fix
  double fix_sigma_floor_m = 0.0; ///< lower bound on a fix's 1-sigma per axis
};
void visit(FieldVisitor& f, FilterConfig& c);

/// What one update did; for consistency statistics.
struct UpdateReport {
  GpsTime t;
  bool accepted = false;
  double nis = 0.0;  ///< normalized innovation squared
  int dimension = 0;
  Eigen::Vector3d innovation = Eigen::Vector3d::Zero();  ///< m, in E
};

/// 15-state error-state Kalman filter, loosely coupled: strapdown in E with Earth rate and gravity, error state
/// [dtheta, dp, dv, b_g, b_a]; attitude error is a right perturbation R_EB = R_hat Exp(dtheta); dp, dv in E.
/// Joseph-form updates; the covariance is kept symmetric and positive definite. Never sees a simulator.
class ErrorStateFilter {
 public:
  static constexpr int kStates = 15;
  using StateVector = Eigen::Matrix<double, kStates, 1>;
  using StateMatrix = Eigen::Matrix<double, kStates, kStates>;

  /// `lever_U_B` position of the IMU, `lever_A_B` of the antenna, both in B from B's origin, m.
  ErrorStateFilter(const FilterConfig& config, const ImuNoise& noise, const LocalFrame& frame, const Eigen::Vector3d& lever_U_B,
                   const Eigen::Vector3d& lever_A_B);

  /// Starts at a pose of B in W and a velocity in W.
  void initialize(GpsTime t, const Pose& X_WB, const Eigen::Vector3d& v_WB_W);
  void predict(const ImuSample& imu);
  UpdateReport update(const GnssFix& fix);

  NavEstimate estimate() const;
  const StateMatrix& covariance() const { return P_; }

 private:
  FilterConfig config_;
  ImuNoise noise_;
  LocalFrame frame_;
  Eigen::Vector3d lever_U_B_, lever_A_B_;
  GpsTime t_;
  Eigen::Quaterniond R_EU_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_EU_E_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_EU_E_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero(), accel_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_EU_U_ = Eigen::Vector3d::Zero();  ///< last angular rate, for lever arms
  StateMatrix P_ = StateMatrix::Identity();
};

}  // namespace canyon::fusion
