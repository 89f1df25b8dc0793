// What surfaces send back and the receiver makes of it, against closed forms.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/lidar/beam/surfaces.h"
#include "canyon/tests/lidar/beam/screens.h"

namespace canyon::lidar {
namespace {

using testing::add_material;
using testing::add_screen;
using testing::level_laser;
using testing::position;
using testing::scan_of;
using testing::set_keys;
using testing::yaw_deg;

constexpr double kThresholdSnr = 6.0;  // the default

/// A screen of 10 % at the range where it is at the threshold, and at others: the share detected is Phi(snr (s - 1)).
TEST(Radiometric, DetectionFollowsTheRadarEquation) {
  for (const double ratio : {0.85, 0.95, 1.0, 1.1}) {
    const double range_m = 50.0 * ratio, signal = 1.0 / (ratio * ratio);
    scene::SceneParts parts = testing::empty_parts();
    add_material(parts, "ten percent", 0.1);
    add_screen(parts, range_m, 2.0, "ten percent");
    LidarConfig config = level_laser();
    config.detector.name = "radiometric";
    config.azimuth_steps = 36000;  // a narrow fan: the screen's middle is square to it
    std::size_t fired = 0, detected = 0;
    for (std::int64_t index = 0; index < 10; ++index) {
      const LidarOutput ideal = [&] {
        LidarConfig all = config;
        all.detector.name = "ideal";
        return scan_of(parts, all, Pose{}, index);
      }();
      const LidarOutput out = scan_of(parts, config, Pose{}, index);
      const auto middle = [](const LidarPoint& p) { return std::abs(yaw_deg(p)) < 1.0; };
      fired += static_cast<std::size_t>(std::count_if(ideal.scan.points.begin(), ideal.scan.points.end(), middle));
      detected += static_cast<std::size_t>(std::count_if(out.scan.points.begin(), out.scan.points.end(), middle));
    }
    ASSERT_GE(fired, 1900u);
    const auto n = static_cast<double>(fired);
    const double expected = 0.5 * std::erfc(-kThresholdSnr * (signal - 1.0) / std::sqrt(2.0));
    // 4.5 sigma: false alarm 7e-6; and within 1 deg the signal falls by cos^3, 0.05 %: times snr and the density 0.4.
    EXPECT_NEAR(detected / n, expected, 4.5 * std::sqrt(expected * (1 - expected) / n + 1e-9) + 5e-4 * 6 * 0.4);
  }
}

TEST(Radiometric, SignalFallsWithTheSquareOfRangeAndNoiseGrowsWithIt) {
  // Scatter of measured ranges at two ranges: sigma^2 = 0.02^2 + (0.75 / (2 snr s))^2.
  for (const double range_m : {10.0, 40.0}) {
    scene::SceneParts parts = testing::empty_parts();
    add_material(parts, "ten percent", 0.1);
    add_screen(parts, range_m, 2.0, "ten percent");
    LidarConfig config = level_laser();
    config.detector.name = "radiometric";
    config.range_noise_m = 0.02;
    config.azimuth_steps = 36000;
    double squares = 0, sum = 0;
    std::size_t n = 0;
    double intensity = 0;
    for (std::int64_t index = 0; index < 10; ++index) {
      const LidarOutput out = scan_of(parts, config, Pose{}, index);
      for (std::size_t i = 0; i < out.truth.size(); ++i) {
        if (std::abs(yaw_deg(out.scan.points[i])) > 1.0) continue;
        const double error = position(out.scan.points[i]).norm() - out.truth[i].range_m;
        sum += error, squares += error * error, ++n;
        intensity += out.scan.points[i].intensity;
      }
    }
    ASSERT_GE(n, 1900u);
    const double signal = 2500.0 / (range_m * range_m), edge_m = 0.75 / (2 * 6.0 * signal);
    const double sigma_m = std::sqrt(0.02 * 0.02 + edge_m * edge_m);
    const double count = static_cast<double>(n);
    EXPECT_NEAR(sum / count, 0, 4.5 * sigma_m / std::sqrt(count)) << range_m;
    EXPECT_NEAR(std::sqrt(squares / count), sigma_m, 4.5 * sigma_m / std::sqrt(2 * count)) << range_m;
    // The reported reflectivity is that of the surface at any range; its scatter is 0.1 / (snr s).
    EXPECT_NEAR(intensity / count, 0.1, 4.5 * 0.1 / (6 * signal) / std::sqrt(count) + 1e-4) << range_m;
  }
}

TEST(Radiometric, ARetroreflectorSaturates) {
  scene::SceneParts parts = testing::empty_parts();
  scene::Material sign;
  sign.name = "sign";
  sign.lidar_reflectance = 0.3;
  sign.lidar_retro_1_sr = 300.0;
  parts.materials.push_back(sign);
  add_screen(parts, 30.0, 2.0, "sign");
  LidarConfig config = level_laser();
  config.detector.name = "radiometric";
  set_keys(config, "saturation = 100\nsaturation_walk_m = 0.03");
  const LidarOutput out = scan_of(parts, config);
  ASSERT_GT(out.truth.size(), 5u);
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    EXPECT_EQ(out.scan.points[i].intensity, 1.0f);
    // pi R_A = 942 (and 0.3) of cos against 0.1: how far beyond the clipping, in factors of ten.
    const double r = out.truth[i].range_m;
    const double signal = (0.3 + kPi * 300.0) * out.truth[i].cos_incidence / 0.1 * (50.0 / r) * (50.0 / r);
    // Noise of the edge: 0.75 / (12 signal) < 3 um.
    EXPECT_NEAR(position(out.scan.points[i]).norm() - r, -0.03 * std::log10(signal / 100), 5 * 3e-6 + 1e-5);
  }
}

// Oren and Nayar's equation 30 for any two directions, here the same: the code's form is its product with the cosine.
TEST(Surfaces, ARoughSurfaceIsOrenAndNayars) {
  const auto sent = [](double slope_rad, double in_rad, double out_rad, double azimuth_rad) {
    const double s2 = slope_rad * slope_rad;
    const double along = 1.0 - 0.5 * s2 / (s2 + 0.33), grazing = 0.45 * s2 / (s2 + 0.09);
    return std::cos(in_rad) * (along + grazing * std::max(0.0, std::cos(azimuth_rad)) *
                                           std::sin(std::max(in_rad, out_rad)) * std::tan(std::min(in_rad, out_rad)));
  };
  scene::SceneParts parts = testing::empty_parts();
  for (const double slope_deg : {0.0, 10.0, 30.0, 45.0}) {
    scene::Material rough;
    rough.name = "rough " + std::to_string(slope_deg);
    rough.lidar_reflectance = 0.3;
    rough.lidar_slope_deg = slope_deg;
    parts.materials.push_back(rough);
  }
  const auto first = static_cast<std::uint16_t>(parts.materials.size() - 4);
  const scene::Scene scene(parts);
  const scene::SceneAt at(scene);
  const Surfaces rough(at, 905, MattReflection::kRough), matt(at, 905);
  const double slopes_deg[] = {0.0, 10.0, 30.0, 45.0};
  for (std::uint16_t k = 0; k < 4; ++k)
    for (const double deg : {0.0, 10.0, 45.0, 80.0, 89.0}) {
      const auto c = static_cast<float>(std::cos(deg * kDegree));
      const auto of = static_cast<std::uint16_t>(first + k);
      EXPECT_NEAR(rough.of_material(of, c), 0.3 * sent(slopes_deg[k] * kDegree, deg * kDegree, deg * kDegree, 0.0),
                  1e-7)
          << slopes_deg[k] << " " << deg;
      EXPECT_FLOAT_EQ(matt.of_material(of, c), 0.3f * c);
    }
}

TEST(Surfaces, AMirrorShinesOnlySquareToTheBeam) {
  scene::SceneParts parts = testing::empty_parts();
  scene::Material glossy;
  glossy.name = "glossy";
  glossy.lidar_reflectance = 0.2;
  glossy.lidar_specular = 0.1;
  glossy.lidar_specular_lobe_deg = 2.0;
  parts.materials.push_back(glossy);
  add_screen(parts, 10.0, 1.0, "glossy");
  const scene::Scene scene(parts);
  const scene::SceneAt at(scene);
  const Surfaces surfaces(at, 905);
  const double s = 2.0 * kDegree;
  EXPECT_NEAR(surfaces.reflectivity(0, 1.0f), 0.2 + 0.1 / (8 * s * s), 1e-4);
  // The mirror's light over all directions is its share: integral of f cos over the half-space, f = apparent / (pi cos)
  // where light comes in at the angle it goes out. Facets turned by t send square light to 2 t: solid angle 4 cos t dO.
  double sent = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) * 0.4 / kSteps, c = std::cos(t);
    const double facets = std::exp(-std::pow(std::tan(t), 2) / (2 * s * s)) / (2 * kPi * s * s * c * c * c * c);
    sent += facets * c * 2 * kPi * std::sin(t) * 0.4 / kSteps;
  }
  EXPECT_NEAR(sent, 1.0, 1e-6) << "the slopes are a distribution";
  const float c5 = static_cast<float>(std::cos(5 * kDegree));
  const double tan5 = std::tan(5 * kDegree);
  EXPECT_NEAR(surfaces.reflectivity(0, c5),
              0.2 * c5 + 0.1 * std::exp(-tan5 * tan5 / (2 * s * s)) / (8 * s * s * std::pow(c5, 5)), 1e-4);
  EXPECT_FLOAT_EQ(surfaces.reflectivity(0, 0.5f), 0.1f);
}

}  // namespace
}  // namespace canyon::lidar
