#include "canyon/lidar/receiver/crosstalk.h"

#include "canyon/lidar/lidar_config.h"

namespace canyon::lidar {

void visit(FieldVisitor& f, CrosstalkConfig& c) {
  f.number("crosstalk", c.probability, {0, 1}, "probability that another sensor's pulse is among a shot's echoes");
}

Crosstalk::Crosstalk(const LidarConfig& config, std::uint64_t seed)
    : probability_(config.crosstalk.probability),
      min_m_(config.report.min_range_m),
      max_m_(config.report.max_range_m),
      signal_(config.signal),
      stream_(seed, "lidar.crosstalk") {}

void Crosstalk::apply(const Volley& volley, Echoes& echoes) const {
  if (probability_ <= 0) return;
  for (std::size_t shot = 0; shot < volley.shots(); ++shot) {
    const auto laser = static_cast<std::uint32_t>(Volley::laser_of(shot));
    const std::uint64_t draw = volley.draw_of(shot);
    const bool fired = volley.rays[shot / Volley::kLanes].max_m[shot % Volley::kLanes] >= 0;
    if (!fired || stream_.uniform(laser, draw, 0) >= probability_) continue;
    const double range_m = stream_.uniform(min_m_, max_m_, laser, draw, 1);
    const double signal = stream_.uniform(1.0, 10.0, laser, draw, 2);
    echoes.insert(shot, {{static_cast<float>(range_m), 1.0f, kNoMaterial, kNoObject},
                         static_cast<float>(signal / signal_gain(signal_, range_m))});
  }
}

}  // namespace canyon::lidar
