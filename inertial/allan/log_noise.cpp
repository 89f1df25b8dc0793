#include "canyon/inertial/allan/log_noise.h"

namespace canyon::inertial {

Result<std::vector<ChannelNoise>> log_noise(const ImuLog& log, const Sampling& sampling,
                                            const LogNoiseOptions& options) {
  const auto factors = averaging_factors(static_cast<std::int64_t>(log.size()), options.per_octave);
  std::vector<ChannelNoise> out;
  for (int c = 0; c < 6; ++c) {
    const std::vector<double>& rate = log.channels[static_cast<std::size_t>(c)];
    if (rate.empty()) continue;
    ChannelNoise noise;
    noise.channel = c;
    noise.points = deviation("overlapping", rate, sampling, factors, options.confidence);
    if (can_fit_noise() || !options.processes.empty()) {
      CANYON_TRY(noise.fit, fit_noise(noise.points, options.per_octave, options.processes));
    }
    out.push_back(std::move(noise));
  }
  return out;
}

}  // namespace canyon::inertial
