#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss::testing {

inline const GpsTime kStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

/// Every error off, clocks and Earth rotation on.
inline GnssConfig errors_off() {
  GnssConfig c;
  c.mode.name = "single_uncorrected";
  c.ionosphere.name = c.troposphere.name = c.ephemeris_error.name = "none";
  c.propagation.paths.name = c.reception.multipath_rule.name = "none";
  c.tracking.thermal_noise_scale = 0.0;
  c.mask_deg = 5.0;
  return c;
}

/// Errors on, open sky.
inline GnssConfig open_sky(const std::string& mode) {
  GnssConfig c;
  c.mode.name = mode;
  c.propagation.paths.name = c.reception.multipath_rule.name = "none";
  return c;
}

/// A sensor of pseudoranges in a street, and its antenna at rest.
class PseudorangeSensorTest : public ::testing::Test {
 protected:
  std::unique_ptr<GnssSensor> make(const GnssConfig& config, std::uint64_t seed = 1, GpsTime start = kStart) {
    auto sensor = make_gnss_sensor(config, seed, start, start + 480.0, *scene);
    EXPECT_TRUE(sensor.ok()) << sensor.error().str();
    return *std::move(sensor);
  }
  std::string error_of(const GnssConfig& config) {
    const auto sensor = make_gnss_sensor(config, 1, kStart, kStart + 480.0, *scene);
    return sensor.ok() ? "no error" : sensor.error().str();
  }
  GnssOutput measure(GnssSensor& sensor, std::int64_t index, GpsTime start = kStart) {
    return sensor.measure(index, start + 0.5 * static_cast<double>(index), antenna_W, still, scene::SceneAt(*scene));
  }
  Eigen::Vector3d truth_E() const { return scene->frame().to_E(antenna_W); }

  // A street canyon: walls 12 m to the west and 9 m to the east, open to north and south.
  std::unique_ptr<scene::Scene> scene =
      WallScene().box({-60, -300, 0}, {-12, 300, 30}).box({9, -300, 0}, {60, 300, 18}, "glass").build();
  Eigen::Vector3d antenna_W{0, 0, 2}, still = Eigen::Vector3d::Zero();
};

}  // namespace canyon::gnss::testing
