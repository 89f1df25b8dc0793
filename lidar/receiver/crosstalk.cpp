#include "canyon/lidar/receiver/crosstalk.h"

#include "canyon/lidar/receiver/detector.h"

namespace canyon::lidar {

void Crosstalk::apply(const Volley& volley, Echoes& echoes) const {
  if (config_.crosstalk <= 0) return;
  for (std::size_t shot = 0; shot < volley.shots(); ++shot) {
    const auto laser = static_cast<std::uint32_t>(Volley::laser_of(shot));
    const std::uint64_t draw = volley.draw_of(shot);
    const bool fired = volley.rays[shot / Volley::kLanes].max_m[shot % Volley::kLanes] >= 0;
    if (!fired || stream_.uniform(laser, draw, 0) >= config_.crosstalk) continue;
    const double range_m = stream_.uniform(config_.min_range_m, config_.max_range_m, laser, draw, 1);
    const double signal = stream_.uniform(1.0, 10.0, laser, draw, 2);
    echoes.insert(shot, {{static_cast<float>(range_m), 1.0f, kNoMaterial, kNoObject},
                         static_cast<float>(signal / signal_gain(config_, range_m))});
  }
}

}  // namespace canyon::lidar
