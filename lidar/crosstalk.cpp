#include "lidar/crosstalk.h"

#include <utility>

#include "lidar/detector.h"

namespace canyon::lidar {

void Crosstalk::apply(const Volley& volley, EchoList& list) const {
  if (config_.crosstalk <= 0) return;
  thread_local EchoList out;
  out.clear(volley.shots());
  for (std::size_t shot = 0; shot < volley.shots(); ++shot) {
    Echo pulse;
    const auto laser = static_cast<std::uint32_t>(Volley::laser_of(shot));
    const std::uint64_t draw = volley.draw_of(shot);
    const bool fired = volley.rays[shot / Volley::kLanes].max_m[shot % Volley::kLanes] >= 0;
    if (fired && stream_.uniform(laser, draw, 0) < config_.crosstalk) {
      const double range_m = stream_.uniform(config_.min_range_m, config_.max_range_m, laser, draw, 1);
      const double signal = stream_.uniform(1.0, 10.0, laser, draw, 2);
      pulse = {.range_m = static_cast<float>(range_m),
               .reflectivity = static_cast<float>(signal / signal_gain(config_, range_m)),
               .cos_incidence = 1.0f};
    }
    for (std::uint32_t e = list.first[shot]; e < list.first[shot + 1]; ++e) {
      const Echo& echo = list.echoes[e];
      if (pulse.range_m > 0 && pulse.range_m < echo.range_m) out.echoes.push_back(std::exchange(pulse, Echo{}));
      out.echoes.push_back(echo);
    }
    if (pulse.range_m > 0) out.echoes.push_back(pulse);
    out.end_shot();
  }
  std::swap(list, out);
}

}  // namespace canyon::lidar
