#pragma once

#include <string>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/inertial/allan/log_noise.h"
#include "canyon/inertial/allan/motion_check.h"

namespace canyon::inertial {

struct LogAnalysisOptions {
  LogNoiseOptions noise;
  std::vector<std::string> kinds;  ///< of deviation_kinds(), beside the overlapping one
};

/// All that a resting unit's log says of its noise.
struct LogAnalysis {
  ImuLog log;
  LogAnalysisOptions options;
  Sampling sampling;
  MotionFound motion;  ///< where it does not rest
  std::vector<ChannelNoise> channels;
  std::vector<std::vector<std::vector<DeviationPoint>>> more;  ///< [channel][kind]

  double duration_s() const { return log.t_s.back() - log.t_s.front() + sampling.interval_s; }
};
Result<LogAnalysis> analyse_log(ImuLog log, const LogAnalysisOptions& options);

/// Every point of every curve with its interval, and of the overlapping one what the fitted processes give there,
/// where there is a fit.
std::string deviations_csv(const LogAnalysis& analysis);

/// "rad/s" or "m/s^2": of channel 0..5.
const char* channel_unit(int channel);

}  // namespace canyon::inertial
