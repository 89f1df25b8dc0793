#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/truth.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/mission/autonomy/autonomy.h"

namespace canyon::mission {

/// One row per [run] epoch_rate_hz.
struct NavRow {
  GpsTime t;
  Pose X_WB_true;
  double true_speed_m_s = 0.0;
  NavEstimate estimate;
  DriveCommand command;
  int waypoint = 0;  ///< 1-based number of the waypoint the autonomy heads for
  AutonomyState state = AutonomyState::kBlind;
  bool phantom = false;  ///< it finds no way where the true body would have one ([success] phantom_free_m)
  /// As of fusion::ErrorStateFilter::body_covariance(); where it is to be recorded.
  std::optional<Eigen::Matrix<double, 9, 9>> covariance = {};
};

/// One row per due GNSS epoch.
struct GnssRow {
  GnssFix fix;
  GnssTruth truth;
  std::vector<double> cn0_dbhz;  ///< by satellite of the truth record; NaN where not tracked
  Eigen::Vector3d p_A_W_true = Eigen::Vector3d::Zero();
  bool has_satellites = false;  ///< does the sensor know any; their counts and DOP jumps are else undefined
  GnssEpoch epoch;              ///< where the filter measures with ranges
  bool withheld = false;
  double range_gain = kNaN;  ///< as of gnss::GnssOutput
  fusion::UpdateReport update;
};

/// One row per keyframe.
struct KeyframeRow {
  GpsTime t;
  std::size_t points = 0;
  Pose X_WL_true, X_WL_prior, X_WL_registered;
  std::optional<lidar::RegistrationStatus> status;  ///< none: not registered
  int iterations = 0;
  double rms_m = kNaN;
  double overlap = kNaN;  ///< share of the points that were matched
  /// Directions that the surfaces leave open, as of lidar::RegistrationResult, of xi in L; none: it is not known.
  std::optional<std::vector<Vector6d>> open;
  std::optional<lidar::RegistrationStatus> map_status;   ///< onto the prior map; none: there is no such map
  Matrix6d prior_covariance = Matrix6d::Constant(kNaN);  ///< of X_WL_prior
  Matrix6d covariance = Matrix6d::Constant(kNaN);        ///< of X_WL_registered
  std::optional<RelativePose> placed;  ///< L in L at the keyframe before, as the map took it; none: not registered
  std::optional<RelativePose> alone;   ///< the same by the alignment alone; none: it did not converge
  Pose X_LL_true;                      ///< the same as it was
};

/// What a keyframe was made of, as the mapper was given it; holds while it is handed on.
struct KeyframeInput {
  const LidarScan& deskewed;  ///< in L at its stamp
  const NavEstimate& estimate;
  const RelativePose& motion;  ///< of B since the keyframe before, by prediction alone
  Pose X_WB_true;
  double distance_m = 0.0;  ///< truly driven by then
};

}  // namespace canyon::mission
