#pragma once

#include <array>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/verdict/run_evidence.h"
#include "canyon/study/fuse/inputs.h"
#include "canyon/study/fuse/outages.h"

namespace canyon::study {

/// How far an estimate is from the reference at an instant, estimate minus truth, and the filter's own 1-sigma. NaN
/// where the reference says nothing.
struct FuseError {
  GpsTime t;
  Eigen::Vector3d attitude_rad, attitude_sigma_rad;  ///< about x (roll), y (pitch), z (yaw) of the true body
  Eigen::Vector3d position_enu_m, position_sigma_m;
  Eigen::Vector3d velocity_enu_m_s, velocity_sigma_m_s;
  double nees = kNaN;   ///< of all that the reference knows, per state
  bool counts = false;  ///< after the time that is skipped
};

/// From the IMU to the point that the reference is of, in B.
Eigen::Vector3d truth_arm(const FuseTruth& truth, const Eigen::Vector3d& lever_U_B, const Eigen::Vector3d& lever_A_B);

/// An estimate of the IMU, its angular rate against E and its covariance as of fusion::SmoothedState.
struct EstimatedMotion {
  fusion::NavState nav;
  Eigen::Vector3d rate_U;
  Eigen::Matrix<double, 9, 9> covariance;
};
/// Against the reference at the same instant; `counts` is left to the caller, who gets the covariances too.
FuseError fuse_error(const FuseTruth& truth, const Eigen::Vector3d& arm_U, const EstimatedMotion& estimate,
                     const fusion::NavState& at, fusion::NavigationError* detail = nullptr);

/// Compares a filter with a reference while it runs.
class Scorer {
 public:
  /// `truth` must outlive it, as `evidence`, which gets the errors that count.
  Scorer(const FuseTruth& truth, const Eigen::Vector3d& lever_U_B, const Eigen::Vector3d& lever_A_B, GpsTime count_from,
         fusion::RunEvidence& evidence);

  /// Between two states of one prediction: reference instants after `before` and before `after`.
  void passed(const fusion::NavState& before, const fusion::NavState& after, const fusion::ErrorStateFilter& filter,
              const Eigen::Vector3d& rate_U, Outages& outages);
  /// At a state that everything of its time has corrected. States are stamped by the clock of the reference.
  void settled(const fusion::NavState& now, const fusion::ErrorStateFilter& filter, const Eigen::Vector3d& rate_U,
               Outages& outages);

  const std::vector<FuseError>& errors() const { return errors_; }

 private:
  void add(const fusion::NavState& estimate, const fusion::NavState& truth, const fusion::ErrorStateFilter& filter,
           const Eigen::Vector3d& rate_U, Outages& outages);

  const FuseTruth& truth_;
  Eigen::Vector3d arm_U_;  ///< from the IMU to the reference's point
  GpsTime count_from_;
  std::size_t next_ = 0;
  std::vector<FuseError> errors_;
  fusion::RunEvidence& evidence_;
};

/// Root mean squares and consistency over the errors that count; NaN where there are none.
struct FuseScore {
  std::size_t instants = 0;
  GpsTime first, last;
  double rms_3d_m = kNaN, final_error_m = kNaN, final_horizontal_m = kNaN, nees_mean = kNaN;
  Eigen::Vector3d position_rms_m, velocity_rms_m_s, attitude_rms_rad;
  /// Means of (error / sigma)^2, and root mean squares of sigma.
  Eigen::Vector3d position_ratio, velocity_ratio, attitude_ratio;
  Eigen::Vector3d position_sigma_m, velocity_sigma_m_s, attitude_sigma_rad;
};
FuseScore fuse_score(const std::vector<FuseError>& errors);

}  // namespace canyon::study
