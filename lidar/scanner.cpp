#include "canyon/lidar/scanner.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/config/text.h"
#include "canyon/core/units.h"
#include "canyon/lidar/volley_scanner.h"

namespace canyon::lidar {
namespace {

Error config_error(const char* keys, std::string what, std::string expected) {
  return Error{"", 0, keys, std::move(what), std::move(expected)};
}

Status validate(const LidarConfig& c, const BeamTable& table) {
  if (!(c.report.min_range_m < c.report.max_range_m)) {
    return config_error(
        "lidar.min_range_m, lidar.max_range_m",
        "ranges from " + number_text(c.report.min_range_m) + " to " + number_text(c.report.max_range_m) + " m",
        "lidar.min_range_m below lidar.max_range_m");
  }
  if (((c.ego.max_m - c.ego.min_m).array() < 0).any()) {
    return config_error("lidar.ego_min_m, lidar.ego_max_m", "the highest corner lies lower than the lowest",
                        "lidar.ego_max_m of lidar.ego_min_m or more along each axis");
  }
  const bool inside = ((c.mount_m - c.ego.min_m).array() > 0).all() && ((c.ego.max_m - c.mount_m).array() > 0).all();
  if (inside) {
    return config_error("lidar.ego_min_m, lidar.ego_max_m, lidar.mount_m",
                        "the sensor itself is in the box that hides its own vehicle",
                        "a box from lidar.ego_min_m to lidar.ego_max_m that leaves out lidar.mount_m");
  }
  if (table.rosette && c.azimuth_steps != 0) {
    return config_error("lidar.azimuth_steps", std::to_string(c.azimuth_steps),
                        "0 (" + table.name + " has a path of its own, at its own rate)");
  }
  if (c.azimuth_steps == 0) {
    if (table.cycle_s > 0) return Ok{};
    return config_error("lidar.azimuth_steps", "0",
                        "the number of firings per revolution (" + table.name + " has no shortest firing cycle)");
  }
  const double firing_s = 1.0 / (c.rate_hz * static_cast<double>(c.azimuth_steps));
  const double needed_s = std::max(table.cycle_s, table.last_firing_s());
  if (firing_s < needed_s) {
    const auto most = static_cast<std::int64_t>(std::floor(1.0 / (c.rate_hz * needed_s)));
    return config_error("lidar.azimuth_steps, lidar.rate_hz",
                        std::to_string(c.azimuth_steps) + " firings a revolution at " + number_text(c.rate_hz) + " Hz",
                        "lidar.azimuth_steps of at most " + std::to_string(most) +
                            " at lidar.rate_hz = " + number_text(c.rate_hz) + " (" + table.name + " needs " +
                            number_text(std::round(needed_s * 1e9) / 1e3) + " us per firing)");
  }
  return Ok{};
}

}  // namespace

Pose sensor_in_body(const LidarConfig& config) {
  const Eigen::Vector3d angles = config.mount_yaw_pitch_roll_deg * kDegree;
  return {rotation_from({.yaw_rad = angles[0], .pitch_rad = angles[1], .roll_rad = angles[2]}), config.mount_m};
}

bool follows_shots_alone(const LidarConfig& c) {
  const WeatherConfig& w = c.weather;
  const bool clear_air =
      w.rain_mm_h <= 0.0 && w.fog_visibility_m <= 0.0 && w.snow_mm_h <= 0.0 && w.dust_visibility_m <= 0.0;
  return c.model.name == "single_ray" && (c.detector.name == "ideal" || c.detector.name == "radiometric") &&
         c.see_through == Transparent{} && clear_air && c.crosstalk.probability <= 0.0 && c.azimuth_steps != 0 &&
         c.latency_s == 0.0;
}

Result<std::unique_ptr<Scanner>> make_scanner(const LidarConfig& config, std::uint64_t seed) {
  CANYON_TRY(BeamTable table, load_beam_table(config.beams));
  CANYON_TRY_STATUS(validate(config, table));
  CANYON_TRY(auto model, config.model.make("lidar.model", config, seed));
  CANYON_TRY(auto detector, config.detector.make("lidar.detector", config, seed));
  return make_volley_scanner(config, std::move(table), std::move(model), std::move(detector), seed);
}

}  // namespace canyon::lidar
