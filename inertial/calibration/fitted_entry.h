#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "canyon/inertial/allan/log_noise.h"
#include "canyon/inertial/calibration/triad_calibration.h"

namespace canyon::inertial {

/// What fits have found of a unit.
struct FittedUnit {
  std::string name, log;  ///< name of the entry; name of the log, for the sources
  double duration_s = 0.0, rate_hz = 0.0;
  std::vector<ChannelNoise> noise;  ///< at rest, or of what a calibration leaves: six channels, or the accelerometer's
  int per_octave = 4;               ///< points of its curves
  /// Gyroscope, accelerometer: biases in rad/s and m/s^2, and how they were found.
  std::array<double, 2> bias{};
  std::array<std::string, 2> bias_source{};
  /// Scale factors and misalignments, where they were looked for, and how.
  std::array<std::optional<TriadCalibration>, 2> calibration{};
  std::array<std::string, 2> calibration_source{};
};

/// Takes over a calibration: its gains, and its bias as root mean square of the axes.
void take_calibration(FittedUnit& unit, std::size_t triad, const TriadCalibration& found, const std::string& source);

/// The processes of one triad (0 gyroscope, 1 accelerometer), fitted to the root mean square of its axes' curves, which
/// has their degrees of freedom together. An Error if this build has no Ceres.
Result<NoiseFit> fit_triad(const FittedUnit& unit, std::size_t triad);

/// The unit as a catalogue entry, TOML: what `[imu] sensor` and `--sensor` take. A triad has one figure for its three
/// axes, and it is a 1-sigma: the root mean square of the biases, scale factors and misalignments that were found. The
/// processes are those of fit_triad. Every figure has its source; what the log does not determine is zero and says so.
/// An Error if this build has no Ceres.
Result<std::string> catalogue_toml(const FittedUnit& unit);

/// The magnitude of a resting log's mean rate; and how far its mean specific force is from gravity, which is the part
/// of the bias along the vertical.
double resting_rate(const ImuLog& log);
double resting_force_error(const ImuLog& log, double gravity_m_s2);

}  // namespace canyon::inertial
