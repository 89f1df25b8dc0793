#pragma once

#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/fusion/smoothing/smoother.h"
#include "canyon/fusion/strapdown.h"

/// A drive of which the filter's model is exactly true: the twin of the recorded runs.
namespace canyon::fusion {

struct DriveSetup {
  double seconds = 60.0, rate_hz = 50.0;
  double fix_sigma_m = 0.5;
  double outage_from_s = 20.0, outage_to_s = 40.0;        ///< without fixes
  double noise_scale = 1.0;                               ///< of everything that is uncertain
  double outlier_share = 0.0, outlier_m = 0.0;            ///< of fixes that are off by so much, in any direction
  const char* keys = "states = [\"biases\", \"gains\"]";  ///< of [fusion]
};

struct Drive {
  FilterConfig config;
  ImuNoise noise;
  LocalFrame frame;
  Eigen::Vector3d lever_U_B, lever_A_B;
  GpsTime start;
  Pose X_WB;  ///< the start as the filter is told it, wrong by its own uncertainty
  Eigen::Vector3d v_WB_W;
  std::vector<ImuSample> imu;
  std::vector<GnssFix> fixes;
  std::vector<bool> outlier;    ///< of each fix
  std::vector<NavState> truth;  ///< at the start, and after each sample

  SmootherInput input() const;
};

/// Scale factors that are constant, biases that wander (Gauss-Markov), white noise; a start drawn from the filter's own
/// uncertainty. Truth is what the strapdown row of the filter makes of the true increments.
Drive simulated_drive(std::uint64_t seed, const DriveSetup& setup);

/// Error [theta, p, v] of a state, truth minus estimate.
Eigen::Matrix<double, 9, 1> error_of(const NavState& truth, const NavState& estimate);

/// What a row of smoothers() with these keys makes of a drive.
Smoothed smoothed_by(const char* smoother, const Drive& drive, const std::string& keys = "");

}  // namespace canyon::fusion
