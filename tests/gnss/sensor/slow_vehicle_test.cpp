// Range errors from epoch to epoch of a vehicle that creeps through a street with all that a street does to signals.
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/tests/gnss/sensor/gnss_keys.h"
#include "canyon/tests/gnss/sensor/pseudorange_sensor_fixture.h"

namespace canyon::gnss {
namespace {

constexpr double kLoop_hz = 0.25, kRate_hz = 10.0, kSpeed_m_s = 0.1;

/// Multipath of each satellite at each epoch, while it is tracked.
using Errors = std::map<SatelliteId, std::map<std::int64_t, double>>;

class SlowVehicle : public testing::PseudorangeSensorTest {
 protected:
  /// With the channel of the fidelities high and modern.
  Errors drive(bool memory) {
    GnssConfig config;
    const std::string keys =
        "paths = \"specular2\"\nreflection_borders = true\ndiffraction = \"wedge\"\nscatter = \"directive\"\n"
        "clutter = \"street\"\nmultipath_rule = \"correlator\"\nrate_hz = 10\ncode_loop_hz = 0.25\n";
    testing::set_keys(config, keys + "code_loop_memory = " + (memory ? "true" : "false"));
    const auto sensor = make(config);
    Errors errors;
    const Eigen::Vector3d v(0.0, kSpeed_m_s, 0.0);
    for (std::int64_t k = 0; k < 400; ++k) {
      const double t_s = static_cast<double>(k) / kRate_hz;
      const GnssOutput out = sensor->measure(k, testing::kStart + t_s, antenna_W + t_s * v, v, scene::SceneAt(*scene));
      for (const auto& s : out.truth.satellites)
        if (s.tracked) errors[s.sv][k] = s.multipath_m;
    }
    return errors;
  }
};

// A loop of first order that has been given what it would settle at, epoch by epoch: to roundings. So no error moves by
// more than 1 - exp(-4 B dt) of what it still has to, 9.5 % here, where without it half a chip can go at once.
TEST_F(SlowVehicle, NoRangeErrorMovesFasterThanItsCodeLoop) {
  const Errors settled = drive(false), followed = drive(true);
  const double share = 1.0 - std::exp(-4.0 * kLoop_hz / kRate_hz);
  double most_m = 0.0, most_without_m = 0.0;
  int compared = 0;
  for (const auto& [sv, errors] : followed) {
    for (const auto& [k, error_m] : errors) {
      const auto before = errors.find(k - 1);
      const double settles_m = settled.at(sv).at(k);
      if (before == errors.end()) {
        EXPECT_EQ(error_m, settles_m) << sv.str() << " " << k;
        continue;
      }
      EXPECT_NEAR(error_m, before->second + share * (settles_m - before->second), 1e-12) << sv.str() << " " << k;
      most_m = std::max(most_m, std::abs(error_m - before->second));
      most_without_m = std::max(most_without_m, std::abs(settles_m - settled.at(sv).at(k - 1)));
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LT(most_m, 0.5 * most_without_m);
  std::printf("0.1 s and 1 cm apart: at most %.2f m, without the loop %.2f m\n", most_m, most_without_m);
}

}  // namespace
}  // namespace canyon::gnss
