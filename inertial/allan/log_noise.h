#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/inertial/allan/deviation.h"
#include "canyon/inertial/allan/noise_fit.h"
#include "canyon/inertial/imu_log.h"

namespace canyon::inertial {

struct LogNoiseOptions {
  int per_octave = 4;  ///< points of the curves to an octave of the averaging time
  double confidence = 0.95;
  std::vector<std::string> processes;  ///< that the fit may use; all if empty; an Error where there can be no fit
};

/// The noise of one channel of a resting unit.
struct ChannelNoise {
  int channel = 0;                     ///< 0..5, as in ImuLog
  std::vector<DeviationPoint> points;  ///< overlapping Allan deviation
  std::optional<NoiseFit> fit;         ///< none in a build that cannot fit (can_fit_noise)
};

/// Overlapping Allan deviation of every channel of a log, and the processes fitted to it. The times of the log give its
/// segments and mean interval (sampling_of).
Result<std::vector<ChannelNoise>> log_noise(const ImuLog& log, const Sampling& sampling,
                                            const LogNoiseOptions& options);

}  // namespace canyon::inertial
