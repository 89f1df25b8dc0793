#include "canyon/inertial/allan/log_analysis.h"

#include <cstdio>

namespace canyon::inertial {

Result<LogAnalysis> analyse_log(ImuLog log, const LogAnalysisOptions& options) {
  LogAnalysis a;
  a.log = std::move(log);
  a.options = options;
  a.sampling = sampling_of(a.log.t_s);
  a.motion = find_motion(a.log);
  CANYON_TRY(a.channels, log_noise(a.log, a.sampling, options.noise));
  const auto factors = averaging_factors(static_cast<std::int64_t>(a.log.size()), options.noise.per_octave);
  for (const ChannelNoise& c : a.channels) {
    a.more.emplace_back();
    for (const std::string& kind : options.kinds)
      a.more.back().push_back(deviation(kind, a.log.channels[static_cast<std::size_t>(c.channel)], a.sampling, factors,
                                        options.noise.confidence));
  }
  return a;
}

std::string deviations_csv(const LogAnalysis& a) {
  std::string out = "axis,kind,tau_s,samples,deviation,low,high,degrees_of_freedom,fit,unit\n";
  char line[240];
  const auto add = [&](const ChannelNoise& c, const std::string& kind, const DeviationPoint& p, bool fitted) {
    std::snprintf(line, sizeof line, "%s,%s,%.9g,%lld,%.9g,%.9g,%.9g,%.4g,", kChannelNames[c.channel], kind.c_str(),
                  p.tau_s, static_cast<long long>(p.m), p.deviation, p.low, p.high, p.edf);
    out += line;
    if (fitted && c.fit) {
      std::snprintf(line, sizeof line, "%.9g", c.fit->deviation_at(p.tau_s));
      out += line;
    }
    out += std::string(",") + channel_unit(c.channel) + "\n";
  };
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    for (const DeviationPoint& p : a.channels[i].points) add(a.channels[i], "overlapping", p, true);
    for (std::size_t k = 0; k < a.options.kinds.size(); ++k)
      for (const DeviationPoint& p : a.more[i][k]) add(a.channels[i], a.options.kinds[k], p, false);
  }
  return out;
}

const char* channel_unit(int channel) {
  return channel < 3 ? "rad/s" : "m/s^2";
}

}  // namespace canyon::inertial
