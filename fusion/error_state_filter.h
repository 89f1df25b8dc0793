#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/imu_noise.h"
#include "canyon/core/messages.h"
#include "canyon/fusion/acceptance/acceptance.h"
#include "canyon/fusion/copied.h"
#include "canyon/fusion/error_state.h"
#include "canyon/fusion/estimators/estimator.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/filter_observer.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/fusion/measurements/pose_residual.h"
#include "canyon/fusion/propagation/error_propagation.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// What one measurement did; for consistency statistics.
struct UpdateReport {
  const char* measurement = "";  ///< row of measurement_models()
  GpsTime t;
  bool accepted = false;
  double nis = 0.0;   ///< normalized innovation squared, of the noise as stated
  int dimension = 0;  ///< 0: there was no fix, or nothing to correct by it
  /// As many elements as dimension; of a fix m, in E.
  Vector6d innovation = Vector6d::Zero();
  /// The innovation in units of its own covariance, S = L L': L^-1 innovation, whose elements are independent and unit
  /// normal if the filter is right.
  Vector6d normalized = Vector6d::Zero();
};

/// Error-state Kalman filter, loosely coupled: strapdown in E with Earth rate and gravity, error state [dtheta, dp, dv]
/// and the blocks of `states` (fusion/states/) behind it; attitude error is a right perturbation R_EB = R_hat
/// Exp(dtheta); dp, dv in E, of the IMU. It is corrected by the rows of `measurements` that the configuration names
/// (fusion/measurements/), as far as those of `acceptance` let them; `estimator` keeps the covariance, symmetric and
/// positive definite. A copy goes on by itself. Never sees a simulator.
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
  /// Corrects with any other message, as far as a measurement takes it; what holds the last IMU sample's time.
  void update(const AidingMessage& message);
  /// From now on the block clone, where it is carried, holds the present pose, with its errors.
  void take_clone();
  /// Makes attitude, position and velocity so much less sure on each axis (1-sigma, in U and E): after a gap.
  void loosen(double theta_rad, double p_m, double v_m_s);
  /// What all measurements but the position of a fix have done in and since the last predict().
  const std::vector<UpdateReport>& reports() const { return reports_; }

  /// From now on its integrator leaves these out (fusion/strapdown/strapdown_omissions.h); throws as it does. The
  /// covariance keeps them, so that gains depend on them through the estimate alone.
  void leave_out(const StrapdownOmissions& omissions) { strapdown_->leave_out(omissions); }

  /// From now on tells this of all that it does; null: nobody. It must outlive this. Call after initialize().
  void watch(FilterObserver* observer);
  /// d (B's origin, in E) / d [theta, p, v], m per rad, 1, s.
  Eigen::Matrix<double, 3, 9> body_jacobian() const;

  NavEstimate estimate() const;
  /// Pose of B in W as the last predict() left it, before the measurements in it corrected anything.
  Pose predicted_pose() const { return pose_of(predicted_R_EU_, predicted_p_EU_E_); }
  /// Pose of B in E, and how it depends on the errors.
  BodyPose body_pose() const { return canyon::fusion::body_pose(view()); }
  /// Of all states, in the order of the class comment; SI.
  Eigen::MatrixXd covariance() const;
  /// Of [xi of X_WB, velocity of B in W] as estimate() has them, with what the two have in common.
  Eigen::Matrix<double, 9, 9> body_covariance() const;
  /// State of the IMU frame in E and the present calibration, for consistency checks.
  const NavState& nav_state() const { return state_.nav; }
  Calibration calibration() const { return state_.calibration(); }
  /// Angular rate of the IMU against E as the last sample had it, rad/s.
  const Eigen::Vector3d& angular_rate() const { return w_EU_U_; }
  const ErrorState& state() const { return state_; }
  /// Where the states of a block begin; -1 if it is not carried.
  int offset(std::string_view block) const { return state_.offset(block); }
  /// Estimate of one of a block's states, counted from the first of all.
  double value(int state) const { return state_.values(state, 1)[0]; }

 private:
  struct Aid {
    const char* name;
    Held<MeasurementModel> model;
    Held<Acceptance> acceptance;
  };
  /// Who watches one filter does not watch its copies.
  struct Watcher {
    Watcher() = default;
    Watcher(const Watcher&) {}
    Watcher& operator=(const Watcher&) { return *this; }
    FilterObserver* observer = nullptr;
  };

  FilterView view() const;
  const ErrorMatrix& P() const { return estimator_->covariance(); }
  Pose pose_of(const Eigen::Quaterniond& R_EU, const Eigen::Vector3d& p_EU_E) const;
  void restart(const Measurement& fix);
  /// Covariance of the attitude at the start, in the IMU's axes.
  Eigen::Matrix3d first_attitude(const Eigen::Matrix3d& R_WU) const;
  /// A filter that is lost has been led astray, and taught wrongly: its blocks begin anew, of its attitude it becomes
  /// less sure by what was unknown at the start, and of its velocity by this 1-sigma per axis.
  void doubt(double v_m_s);
  void renew(std::span<const Renewal> states);
  UpdateReport correct(Aid& aid, Measurement& m);
  /// Of a measurement with `motion`, whose innovation has this NIS.
  PlaceBeside place_beside(const Measurement& m, double nis) const;

  FilterConfig config_;
  LocalFrame frame_;
  Eigen::Vector3d lever_U_B_, lever_A_B_;
  Held<Strapdown> strapdown_;

  ErrorState state_;
  ErrorPropagation propagation_;
  Held<Estimator> estimator_;
  std::vector<Aid> aids_;
  std::vector<UpdateReport> reports_;
  Eigen::Vector3d w_EU_U_ = Eigen::Vector3d::Zero();  ///< last angular rate, for lever arms
  Eigen::Quaterniond predicted_R_EU_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d predicted_p_EU_E_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d f_U_ = Eigen::Vector3d::Zero();  ///< last specific force
  Eigen::Matrix3d gravity_gradient_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gravity_gradient_at_E_ = Eigen::Vector3d::Zero();
  Watcher watcher_;
};

}  // namespace canyon::fusion
