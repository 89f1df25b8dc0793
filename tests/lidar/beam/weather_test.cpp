// The air between sensor and surfaces.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/lidar/beam/weather.h"
#include "canyon/tests/lidar/beam/screens.h"

namespace canyon::lidar {
namespace {

using testing::add_material;
using testing::add_screen;
using testing::ideal_lidar;
using testing::level_laser;
using testing::scan_of;

/// N(D) = 8000 exp(-4.1 R^-0.21 D) per m^3 and mm (Marshall and Palmer 1948), each drop taking twice its cross-section.
TEST(Weather, MarshallPalmerRainIsTheIntegralOverItsDrops) {
  for (const double rate : {1.0, 10.0, 50.0}) {
    double extinction = 0;
    constexpr int kSteps = 40000;
    for (int i = 0; i < kSteps; ++i) {
      const double d_mm = (i + 0.5) * 40.0 / kSteps;
      const double drops = 8000.0 * std::exp(-4.1 * std::pow(rate, -0.21) * d_mm) * 40.0 / kSteps;
      extinction += drops * 2.0 * 0.25 * kPi * d_mm * d_mm * 1e-6;
    }
    // The coefficient is printed as 3.6e-4; the integral gives 3.65e-4.
    EXPECT_NEAR(rain_laws()[0].make(rate, 905) / extinction, 1.0, 0.015) << rate;
    EXPECT_DOUBLE_EQ(rain_laws()[0].make(rate, 905), 3.6e-4 * std::pow(rate, 0.63));
  }
  EXPECT_GT(rain_laws()[2].make(10, 905), 20 * rain_laws()[0].make(10, 905))
      << "the strong empirical form goes by its own name";
}

TEST(Weather, LawsAtValuesComputedByHand) {
  // 3.912 / 1000 m * (905 / 550)^-0.585 and, of thick fog, no wavelength at all.
  EXPECT_NEAR(fog_laws()[0].make(1000, 905), 3.912e-3 * std::pow(905.0 / 550.0, -0.585), 1e-12);
  EXPECT_DOUBLE_EQ(fog_laws()[1].make(200, 905), 3.912 / 200);
  EXPECT_DOUBLE_EQ(fog_laws()[1].make(200, 1550), 3.912 / 200);
  // 3.878 dB/km for 1 mm/h of wet snow at 905 nm: 8.93e-4 per metre.
  EXPECT_NEAR(snow_laws()[0].make(1, 905), (1.023e-4 * 905 + 3.7855466) / 4342.944819, 1e-12);
  EXPECT_NEAR(dust_extinction_1_m(1000), 52.0 / 4342.944819, 1e-9);
}

TEST(Weather, RainDimsAnEchoByItsExtinction) {
  scene::SceneParts parts = testing::empty_parts();
  add_material(parts, "grey", 0.5);
  add_screen(parts, 60.0, 1.0, "grey");
  LidarConfig config = level_laser();
  const LidarOutput dry = scan_of(parts, config);
  config.weather.rain_mm_h = 25;
  config.weather.false_returns = false;
  const LidarOutput wet = scan_of(parts, config);
  ASSERT_EQ(dry.truth.size(), wet.truth.size());
  ASSERT_GT(dry.truth.size(), 10u);
  for (std::size_t i = 0; i < dry.truth.size(); ++i) {
    const double alpha = 3.6e-4 * std::pow(25, 0.63);
    EXPECT_NEAR(wet.scan.points[i].intensity / dry.scan.points[i].intensity,
                std::exp(-2 * alpha * dry.truth[i].range_m), 1e-6);
  }
}

/// 1 - prod(1 - exp(-1 / m_k)) over cells of a pulse's length, m_k = pi a / 18.8 sr * pulse * 10 (50 / max(r, 5))^2
/// exp(-2 a r) at each cell's middle; and of those that answer, the signal over m is 1 / m plus an exponential.
TEST(Weather, FalseReturnsFollowTheirLaw) {
  LidarConfig config = ideal_lidar();
  config.weather.fog_visibility_m = 60;
  config.report.max_range_m = 60;
  const double a = fog_laws()[0].make(60, 905);
  const auto mean = [&](double r) {
    const double ratio = 50.0 / std::max(r, 5.0);
    return kPi * a / 18.8 * 0.75 * 10 * ratio * ratio * std::exp(-2 * a * r);
  };
  const Weather weather(config, 1);
  double silent = 1;
  for (int k = 0; k < 40; ++k) {
    silent *= 1 - std::exp(-1 / mean(0.9 + 0.75 * (k + 0.5)));
    EXPECT_NEAR(weather.false_return_probability(0.9 + 0.75 * (k + 1)), 1 - silent, 1e-9) << k;
  }
  config.detector.name = "ideal";
  const LidarOutput out = scan_of(testing::empty_parts(), config);
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    if (out.scan.points[i].intensity >= 1) continue;  // clipped
    const double r = out.truth[i].range_m, ratio = 50.0 / std::max(r, 5.0);
    const double signal = out.scan.points[i].intensity * 10 * ratio * ratio;
    sum += (signal - 1) / mean(r), ++n;
  }
  ASSERT_GT(n, 5000);
  EXPECT_NEAR(sum / n, 1, 4.5 / std::sqrt(n) + 1e-3) << "exponential: mean and standard deviation 1";
}

TEST(Weather, ThickFogAnswersAsOftenAsItsProbabilitySays) {
  LidarConfig config = ideal_lidar();
  config.weather.fog_visibility_m = 60;
  config.report.max_range_m = 60;
  scene::SceneParts parts = testing::empty_parts();
  const LidarOutput out = scan_of(parts, config);  // nothing but fog
  const Weather weather(config, 1);
  const double n = 28800;
  for (const double range_m : {5.0, 10.0, 20.0, 60.0}) {
    const auto nearer = static_cast<double>(
        std::count_if(out.truth.begin(), out.truth.end(), [&](const auto& t) { return t.range_m < range_m; }));
    const double p = weather.false_return_probability(range_m);
    EXPECT_NEAR(nearer / n, p, 4.5 * std::sqrt(p * (1 - p) / n) + 1e-6) << range_m;
  }
  EXPECT_GT(weather.false_return_probability(60), 0.5) << "a wall of fog";
  EXPECT_EQ(out.truth.front().material, kNoMaterial);
  EXPECT_EQ(out.truth.front().object, kNoObject);
  config.weather.fog_visibility_m = 0;
  config.weather.rain_mm_h = 10;
  EXPECT_LT(Weather(config, 1).false_return_probability(60), 0.05) << "rain answers seldom";
}

}  // namespace
}  // namespace canyon::lidar
