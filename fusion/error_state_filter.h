#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/imu_noise.h"
#include "canyon/core/messages.h"
#include "canyon/fusion/acceptance/acceptance.h"
#include "canyon/fusion/error_state.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/fix_response.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/fusion/propagation/error_propagation.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// What one measurement did; for consistency statistics.
struct UpdateReport {
  const char* measurement = "";  ///< row of measurement_models()
  GpsTime t;
  bool accepted = false;
  double nis = 0.0;                                      ///< normalized innovation squared, of the noise as stated
  int dimension = 0;                                     ///< 0: there was no fix, or nothing to correct by it
  Eigen::Vector3d innovation = Eigen::Vector3d::Zero();  ///< as many elements as dimension; of a fix m, in E
};

/// Error-state Kalman filter, loosely coupled: strapdown in E with Earth rate and gravity, error state [dtheta, dp, dv]
/// and the blocks of `states` (fusion/states/) behind it; attitude error is a right perturbation R_EB = R_hat
/// Exp(dtheta); dp, dv in E, of the IMU. It is corrected by the rows of `measurements` that the configuration names
/// (fusion/measurements/), as far as those of `acceptance` let them. Joseph-form updates; the covariance is kept
/// symmetric and positive definite. Never sees a simulator.
class ErrorStateFilter {
 public:
  /// `lever_U_B` position of the IMU, `lever_A_B` of the antenna, both in B from B's origin, m.
  ErrorStateFilter(const FilterConfig& config, const ImuNoise& noise, const LocalFrame& frame,
                   const Eigen::Vector3d& lever_U_B, const Eigen::Vector3d& lever_A_B);

  /// Starts at a pose of B in W and a velocity in W (body not turning), with zero biases and the configured
  /// uncertainty.
  void initialize(GpsTime t, const Pose& X_WB, const Eigen::Vector3d& v_WB_W);

  /// Moves state and covariance over one IMU interval. Samples must follow one another without gap or overlap.
  /// A sample that is not finite, or not contiguous, is refused with a ProgramError that names the IMU.
  void predict(const ImuSample& imu);

  /// Corrects with what the fix says of the antenna, and tells of its position. A fix with status kNone changes nothing
  /// (dimension 0); so does one that is not accepted. The fix may be up to 0.1 s away from the last IMU sample: the
  /// antenna is then carried there with the estimated velocity. A fix that is not finite, or whose covariance is not
  /// positive definite, is refused with a ProgramError that names the receiver. Where the antenna is known so well
  /// already that rounding leaves no definite innovation covariance, the fix counts as known to that rounding only.
  /// Where the position is not known to 1000 km (1-sigma), after hours without a fix, the fix does not correct it but
  /// takes its place (accepted, dimension 0), the velocity counts as unknown, and attitude and calibration stay.
  UpdateReport update(const GnssFix& fix);
  /// Corrects with any other message, as far as a measurement takes it.
  void update(const AidingMessage& message);
  /// What all measurements but the position of a fix have done in and since the last predict().
  const std::vector<UpdateReport>& reports() const { return reports_; }

  /// From now on tells how the estimate depends on the fixes; null: nobody. It must outlive this.
  void watch(FixResponse* response);
  /// d (B's origin, in E) / d [theta, p, v], m per rad, 1, s.
  Eigen::Matrix<double, 3, 9> body_jacobian() const;

  NavEstimate estimate() const;
  /// Pose of B in W as the last predict() left it, before the measurements in it corrected anything.
  Pose predicted_pose() const { return body_pose(predicted_R_EU_, predicted_p_EU_E_); }
  /// Of all states, in the order of the class comment; SI.
  Eigen::MatrixXd covariance() const;
  /// State of the IMU frame in E and the present calibration, for consistency checks.
  const NavState& nav_state() const { return state_.nav; }
  Calibration calibration() const { return state_.calibration(); }
  /// Where the states of a block begin; -1 if it is not carried.
  int offset(std::string_view block) const { return state_.offset(block); }

 private:
  struct Aid {
    const char* name;
    std::unique_ptr<MeasurementModel> model;
    std::unique_ptr<Acceptance> acceptance;
  };

  FilterView view() const;
  Pose body_pose(const Eigen::Quaterniond& R_EU, const Eigen::Vector3d& p_EU_E) const;
  void restart(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& R, const Eigen::Matrix3d& H_theta);
  UpdateReport correct(Aid& aid, Measurement& m);
  void inject(const Eigen::VectorXd& error);

  FilterConfig config_;
  LocalFrame frame_;
  Eigen::Vector3d lever_U_B_, lever_A_B_;
  std::unique_ptr<Strapdown> strapdown_;

  ErrorState state_;
  ErrorPropagation propagation_;
  std::vector<Aid> aids_;
  std::vector<UpdateReport> reports_;
  Eigen::Vector3d w_EU_U_ = Eigen::Vector3d::Zero();  ///< last angular rate, for lever arms
  Eigen::Quaterniond predicted_R_EU_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d predicted_p_EU_E_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d f_U_ = Eigen::Vector3d::Zero();  ///< last specific force
  Eigen::Matrix3d gravity_gradient_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gravity_gradient_at_E_ = Eigen::Vector3d::Zero();
  ErrorMatrix P_;
  FixResponse* response_ = nullptr;
};

}  // namespace canyon::fusion
