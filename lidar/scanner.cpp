#include "lidar/scanner.h"

#include <algorithm>
#include <cmath>

#include "core/config_text.h"
#include "core/units.h"
#include "lidar/scanner_models.h"

namespace canyon::lidar {
namespace {

struct Row {
  const char* name;
  std::unique_ptr<Scanner> (*make)(const LidarConfig&, const BeamTable&, std::uint64_t seed);
  const char* doc;
};

constexpr Row kModels[] = {
    {"single_ray", &make_single_ray,
     "one infinitely thin ray per firing, Gaussian range noise, Lambertian reflectivity"},
};

Error config_error(const char* key, std::string what, std::string expected) {
  return Error{"", 0, std::string("lidar.") + key, std::move(what), std::move(expected)};
}

Status validate(const LidarConfig& c, const BeamTable& table) {
  if (!(c.min_range_m < c.max_range_m)) {
    return config_error("min_range_m", number_text(c.min_range_m),
                        "less than max_range_m, " + number_text(c.max_range_m));
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

void visit(FieldVisitor& f, LidarConfig& c) {
  f.file("beams", c.beams, ".csv", "beam table: the name of a built-in one (vlp16, grid16) or the path of a .csv file");
  std::vector<std::string> models;
  for (const Row& row : kModels) models.emplace_back(row.name);
  f.choice("model", c.model, models, "how a beam meets the scene");
  f.number("rate_hz", c.rate_hz, {0.1, 100}, "revolutions per second");
  f.integer("azimuth_steps", c.azimuth_steps, {1, 100000}, "firings of every laser per revolution");
  f.vector3("mount_m", c.mount_m, {-100, 100}, "position of the sensor in the body: forward, left, up");
  f.vector3("mount_yaw_pitch_roll_deg", c.mount_yaw_pitch_roll_deg, {-360, 360},
            "orientation of the sensor in the body");
  f.number("min_range_m", c.min_range_m, {0, 1e4}, "shorter measured ranges are not reported");
  f.number("max_range_m", c.max_range_m, {0, 1e4}, "longer measured ranges are not reported");
  f.number("range_noise_m", c.range_noise_m, {0, 10}, "1-sigma of the range noise, independent per ray");
  f.number("range_quantum_m", c.range_quantum_m, {0, 1}, "step of the reported range; 0 = continuous");
  f.flag("blinded", c.blinded, "the sensor returns nothing (coupling studies)");
}

Pose sensor_in_body(const LidarConfig& config) {
  const Eigen::Vector3d angles = config.mount_yaw_pitch_roll_deg * kDegree;
  return {rotation_from({.yaw_rad = angles[0], .pitch_rad = angles[1], .roll_rad = angles[2]}), config.mount_m};
}

Result<std::unique_ptr<Scanner>> make_scanner(const LidarConfig& config, std::uint64_t seed) {
  CANYON_TRY(const BeamTable table, load_beam_table(config.beams));
  CANYON_TRY_STATUS(validate(config, table));
  for (const Row& row : kModels) {
    if (config.model == row.name) return row.make(config, table, seed);
  }
  std::string known;
  for (const Row& row : kModels) known += (known.empty() ? "" : ", ") + std::string(row.name);
  return config_error("model", "unknown model \"" + config.model + '"', "one of " + known);
}

}  // namespace canyon::lidar
