#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/imu_noise.h"
#include "canyon/core/messages.h"
#include "canyon/fusion/error_propagation.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/fix_response.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// What one update did; for consistency statistics.
struct UpdateReport {
  GpsTime t;
  bool accepted = false;
  double nis = 0.0;                                      ///< normalized innovation squared
  int dimension = 0;                                     ///< 0: there was no fix, or nothing to correct by it
  Eigen::Vector3d innovation = Eigen::Vector3d::Zero();  ///< m, in E
};

/// 15-state error-state Kalman filter, loosely coupled: strapdown in E with Earth rate and gravity, error state
/// [dtheta, dp, dv, b_g, b_a]; attitude error is a right perturbation R_EB = R_hat Exp(dtheta); dp, dv in E, of the
/// IMU. Joseph-form updates; the covariance is kept symmetric and positive definite. Never sees a simulator.
///
/// Where the IMU's noise names scale factors or misalignments, the 18 gain errors of the two triads are estimated
/// beside the 15 (fusion/error_propagation.h): in a 90 degree turn 500 ppm and 1 mrad make larger errors of heading and
/// tilt than the noise does, and a filter that does not know of them is too confident (measured: heading NEES 104
/// instead of 1).
class ErrorStateFilter {
 public:
  static constexpr int kStates = ErrorIndex::kNavigation;
  using StateVector = Eigen::Matrix<double, kStates, 1>;
  using StateMatrix = Eigen::Matrix<double, kStates, kStates>;

  /// `lever_U_B` position of the IMU, `lever_A_B` of the antenna, both in B from B's origin, m.
  ErrorStateFilter(const FilterConfig& config, const ImuNoise& noise, const LocalFrame& frame,
                   const Eigen::Vector3d& lever_U_B, const Eigen::Vector3d& lever_A_B);

  /// Starts at a pose of B in W and a velocity in W (body not turning), with zero biases and the configured
  /// uncertainty.
  void initialize(GpsTime t, const Pose& X_WB, const Eigen::Vector3d& v_WB_W);

  /// Moves state and covariance over one IMU interval. Samples must follow one another without gap or overlap.
  /// A sample that is not finite, or not contiguous, is refused with a ProgramError that names the IMU.
  void predict(const ImuSample& imu);

  /// Corrects with a position of the antenna. A fix with status kNone changes nothing (dimension 0); so does one that
  /// the gate refuses (accepted false). The fix may be up to 0.1 s away from the last IMU sample: the antenna is then
  /// carried there with the estimated velocity. A fix that is not finite, or whose covariance is not positive definite,
  /// is refused with a ProgramError that names the receiver. Where the antenna is known so well already that rounding
  /// leaves no definite innovation covariance, the fix counts as known to that rounding only. Where the position is not
  /// known to 1000 km (1-sigma), after hours without a fix, the fix does not correct it but takes its place (accepted,
  /// dimension 0), the velocity counts as unknown, and attitude and calibration stay.
  UpdateReport update(const GnssFix& fix);

  /// From now on tells how the estimate depends on the fixes; null: nobody. It must outlive this.
  void watch(FixResponse* response) { response_ = response; }
  /// d (B's origin, in E) / d [theta, p, v], as AntennaPosition::H.
  Eigen::Matrix<double, 3, 9> body_jacobian() const;

  NavEstimate estimate() const;
  /// Of the 15 states, in the order of the class comment; SI.
  StateMatrix covariance() const;
  /// State of the IMU frame in E and the present calibration, for consistency checks.
  const NavState& nav_state() const { return state_; }
  const Calibration& calibration() const { return calibration_; }

 private:
  void restart(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& R, const Eigen::Matrix3d& H_theta);
  void inject(const Eigen::Matrix<double, ErrorIndex::kAll, 1>& error);

  FilterConfig config_;
  ErrorProcesses processes_;
  LocalFrame frame_;
  Eigen::Vector3d lever_U_B_, lever_A_B_;
  std::unique_ptr<Strapdown> strapdown_;

  NavState state_;
  Calibration calibration_;
  Eigen::Vector3d w_EU_U_ = Eigen::Vector3d::Zero();  ///< last angular rate, for lever arms
  Eigen::Matrix3d gravity_gradient_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gravity_gradient_at_E_ = Eigen::Vector3d::Zero();
  ErrorMatrix P_ = ErrorMatrix::Zero();
  FixResponse* response_ = nullptr;
};

}  // namespace canyon::fusion
