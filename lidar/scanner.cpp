#include "canyon/lidar/scanner.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/config/text.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/echo_model.h"
#include "canyon/lidar/beam/see_through.h"
#include "canyon/lidar/receiver/detector.h"
#include "canyon/lidar/receiver/return_choice.h"
#include "canyon/lidar/volley_scanner.h"

namespace canyon::lidar {
namespace {

Error config_error(const char* key, std::string what, std::string expected) {
  return Error{"", 0, std::string("lidar.") + key, std::move(what), std::move(expected)};
}

/// The row that a key names.
template <class Row>
Result<const Row*> row_of(const std::vector<Row>& rows, const char* key, const std::string& name) {
  std::string known;
  for (const Row& row : rows) {
    if (name == row.name) return &row;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  std::string what = "unknown ";
  what.append(key).append(" \"").append(name).append("\"");
  return config_error(key, std::move(what), "one of " + known);
}

Status validate(const LidarConfig& c, const BeamTable& table) {
  if (!(c.min_range_m < c.max_range_m)) {
    return config_error("min_range_m", number_text(c.min_range_m),
                        "less than max_range_m, " + number_text(c.max_range_m));
  }
  if (((c.ego_max_m - c.ego_min_m).array() < 0).any()) {
    return config_error("ego_max_m", "a corner lower than ego_min_m", "ego_min_m or more along each axis");
  }
  const bool inside = ((c.mount_m - c.ego_min_m).array() > 0).all() && ((c.ego_max_m - c.mount_m).array() > 0).all();
  if (inside) {
    return config_error("ego_min_m", "the sensor itself is in the box that hides its own vehicle",
                        "a box that leaves out mount_m");
  }
  if (table.rosette && c.azimuth_steps != 0) {
    return config_error("azimuth_steps", std::to_string(c.azimuth_steps),
                        "0 (" + table.name + " has a path of its own, at its own rate)");
  }
  if (c.azimuth_steps == 0) {
    if (table.cycle_s > 0) return Ok{};
    return config_error("azimuth_steps", "0",
                        "the number of firings per revolution (" + table.name + " has no shortest firing cycle)");
  }
  const double firing_s = 1.0 / (c.rate_hz * static_cast<double>(c.azimuth_steps));
  const double needed_s = std::max(table.cycle_s, table.last_firing_s());
  if (firing_s < needed_s) {
    const auto most = static_cast<std::int64_t>(std::floor(1.0 / (c.rate_hz * needed_s)));
    return config_error("azimuth_steps", std::to_string(c.azimuth_steps),
                        "at most " + std::to_string(most) + " at " + number_text(c.rate_hz) + " Hz (" + table.name +
                            " needs " + number_text(std::round(needed_s * 1e9) / 1e3) + " us per firing)");
  }
  return Ok{};
}

}  // namespace

Pose sensor_in_body(const LidarConfig& config) {
  const Eigen::Vector3d angles = config.mount_yaw_pitch_roll_deg * kDegree;
  return {rotation_from({.yaw_rad = angles[0], .pitch_rad = angles[1], .roll_rad = angles[2]}), config.mount_m};
}

Result<std::unique_ptr<Scanner>> make_scanner(const LidarConfig& config, std::uint64_t seed) {
  CANYON_TRY(BeamTable table, load_beam_table(config.beams));
  CANYON_TRY_STATUS(validate(config, table));
  CANYON_TRY(const EchoModelRow* model, row_of(echo_models(), "model", config.model));
  CANYON_TRY(const DetectorRow* detector, row_of(detectors(), "detector", config.detector));
  CANYON_TRY(const ReturnModeRow* returns, row_of(return_modes(), "returns", config.returns));
  CANYON_TRY_STATUS(row_of(see_through_rows(), "see_through", config.see_through));
  return make_volley_scanner(config, std::move(table), model->make(config, seed), detector->make(config, seed),
                             returns->mode, seed);
}

}  // namespace canyon::lidar
