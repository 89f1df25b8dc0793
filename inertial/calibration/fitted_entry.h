#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "inertial/allan/log_noise.h"
#include "inertial/calibration/triad_calibration.h"

namespace canyon::inertial {

/// What fits have found of a unit.
struct FittedUnit {
  std::string name, log;  ///< name of the entry; name of the log, for the sources
  double duration_s = 0.0, rate_hz = 0.0;
  std::vector<ChannelNoise> noise;  ///< of a resting log: six channels, or those of the accelerometer alone
  int per_octave = 4;               ///< points of its curves
  /// Bias found beside it, rad/s and m/s^2; from the resting log's means if nothing better is known.
  std::array<double, 2> bias{};
  std::array<std::string, 2> bias_source{};
  std::array<std::optional<TriadCalibration>, 2> calibration{};  ///< gyroscope, accelerometer
};

/// The unit as a catalogue entry, TOML: what `[imu] sensor` and `--sensor` take. A triad has one figure for its three
/// axes, so the processes are fitted anew to the root mean square of their curves, which has their degrees of freedom
/// together. Every figure has its source; what the log does not determine is zero and says so. An Error if this build
/// has no Ceres.
Result<std::string> catalogue_toml(const FittedUnit& unit);

/// The magnitude of a resting log's mean rate; and how far its mean specific force is from gravity, which is the part
/// of the bias along the vertical.
double resting_rate(const ImuLog& log);
double resting_force_error(const ImuLog& log, double gravity_m_s2);

}  // namespace canyon::inertial
