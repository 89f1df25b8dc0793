// The LIDAR's models against closed forms.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "lidar/beam_table.h"
#include "lidar/footprint_rays.h"
#include "lidar/scanner.h"
#include "lidar/surfaces.h"
#include "lidar/weather.h"
#include "tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

using testing::ideal_lidar;
using testing::kStart;
using testing::pose_at;
using testing::position;

LidarOutput scan_of(const scene::SceneParts& parts, const LidarConfig& config, const Pose& X_WB = Pose{},
                    std::int64_t index = 0) {
  const scene::Scene scene(parts);
  auto scanner = make_scanner(config, 1);
  EXPECT_TRUE(scanner.ok()) << scanner.error().str();
  return (*scanner)->scan(index, kStart, testing::standing(X_WB), scene::SceneAt(scene));
}

/// A material that reflects light as said, and does nothing else.
void add_material(scene::SceneParts& parts, const std::string& name, double reflectance) {
  scene::Material m;
  m.name = name;
  m.lidar_reflectance = reflectance;
  parts.materials.push_back(m);
}

/// A plane square to x at x = range, wide enough for a beam that looks along x.
void add_screen(scene::SceneParts& parts, double range_m, double half_m, const std::string& material,
                double y_min = -1e9) {
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("screen " + std::to_string(parts.objects.size()), scene::ObjectKind::kWall);
  const double left = std::max(-half_m, y_min);
  mesh.quad({range_m, half_m, -half_m}, {range_m, left, -half_m}, {range_m, left, half_m}, {range_m, half_m, half_m},
            mesh.material(material));
}

/// One laser that looks along the horizon.
LidarConfig level_laser() {
  LidarConfig config = ideal_lidar();
  config.beams = "grid:1:0:0";
  config.azimuth_steps = 3600;
  config.max_range_m = 1000;
  return config;
}

double yaw_deg(const LidarPoint& p) {
  return std::atan2(p.y, p.x) / kDegree;
}

TEST(Footprint, OffsetsHaveTheBeamsMoments) {
  const FootprintOffsets o = footprint_offsets(1.5e-3, 0.5e-3);
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < FootprintOffsets::kRays; ++i) {
    mean_a += o.across[i], mean_b += o.along[i];
    aa += double{o.across[i]} * o.across[i], bb += double{o.along[i]} * o.along[i];
    ab += double{o.across[i]} * o.along[i];
  }
  constexpr double kFloat = 16 * 6e-8 * 3e-3;
  EXPECT_NEAR(mean_a, 0, kFloat);
  EXPECT_NEAR(mean_b, 0, kFloat);
  EXPECT_NEAR(aa / 16, 1.5e-3 * 1.5e-3, 1e-6 * 1.5e-3 * 1.5e-3);
  EXPECT_NEAR(bb / 16, 0.5e-3 * 0.5e-3, 1e-6 * 0.5e-3 * 0.5e-3);
  EXPECT_NEAR(ab / 16, 0, 1e-6 * 1.5e-3 * 0.5e-3);
}

/// The plane x + y tan(tilt) = d seen by a level beam at yaw 0: the sub-rays' ranges are d / (1 + tan(a) tan(tilt))
/// with a the angle across, so that to second order their mean is d (1 + s^2 tan^2) and their spread d s tan, s =
/// sigma. Energy goes with cos(incidence) / range^2 = const * (1 + 3 a tan), which pulls the mean towards the nearer
/// part: the energy-weighted mean is d (1 + s^2 tan^2 - 3 s^2 tan^2) = d (1 - 2 s^2 tan^2).
TEST(Footprint, OnATiltedPlaneTheEchoIsTheEnergyWeightedMean) {
  for (const double tilt_deg : {0.0, 45.0, 70.0}) {
    const double tangent = std::tan(tilt_deg * kDegree), d = 40.0;
    scene::SceneParts parts = testing::empty_parts();
    add_material(parts, "grey", 0.5);
    scene::MeshBuilder mesh(parts);
    mesh.begin_object("plane", scene::ObjectKind::kWall);
    const auto corner = [&](double y, double z) { return Eigen::Vector3d(d - y * tangent, y, z); };
    mesh.quad(corner(3, -5), corner(-3, -5), corner(-3, 5), corner(3, 5), mesh.material("grey"));
    LidarConfig config = level_laser();
    config.model = "footprint";
    config.divergence_mrad = {8.0, 4.0};
    config.pulse_m = 5.0;
    const LidarOutput out = scan_of(parts, config);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < out.truth.size(); ++i) {
      if (std::abs(yaw_deg(out.scan.points[i])) > 0.06) continue;  // the middle beam or two
      const double yaw = std::atan2(out.scan.points[i].y, out.scan.points[i].x);
      const double middle_m = d / (std::cos(yaw) + std::sin(yaw) * tangent);
      const double s2 = 2e-3 * 2e-3 * tangent * tangent;
      // Of fourth order: 16-point moments of a Gaussian beam, 15 s^4 tan^4 with a margin of two; and 0.1 mm of ranges.
      EXPECT_NEAR(out.truth[i].range_m, middle_m * (1.0 - 2.0 * s2), middle_m * 30 * s2 * s2 + 1e-4)
          << "tilt " << tilt_deg;
      // Intensity: 0.5 cos, to second order in the beam's width.
      EXPECT_NEAR(out.scan.points[i].intensity, 0.5 * std::cos(tilt_deg * kDegree), 0.5 * 20 * (s2 + 4e-6));
      ++compared;
    }
    EXPECT_GE(compared, 1u);
  }
}

/// On a plane so oblique that the footprint is longer than the pulse the returns spread over it.
TEST(Footprint, TheSpreadOnATiltedPlaneIsTheFootprints) {
  const double tilt_deg = 80, tangent = std::tan(tilt_deg * kDegree), d = 40.0, sigma = 2e-3;
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("plane", scene::ObjectKind::kWall);
  const auto corner = [&](double y, double z) { return Eigen::Vector3d(d - y * tangent, y, z); };
  mesh.quad(corner(3, -5), corner(-3, -5), corner(-3, 5), corner(3, 5), mesh.material("concrete"));
  LidarConfig config = level_laser();
  config.model = "footprint";
  config.returns = "all";
  config.divergence_mrad = {4e3 * sigma, 4e3 * sigma};
  config.pulse_m = 1e-3;  // every sub-ray an echo of its own
  const LidarOutput out = scan_of(parts, config);
  std::map<float, std::vector<double>> shots;
  for (std::size_t i = 0; i < out.truth.size(); ++i)
    if (std::abs(yaw_deg(out.scan.points[i])) < 0.04) shots[out.scan.points[i].time_s].push_back(out.truth[i].range_m);
  ASSERT_GE(shots.size(), 1u);
  for (const auto& [time_s, ranges_m] : shots) {
    ASSERT_EQ(ranges_m.size(), 16u);
    double mean = 0, square = 0;
    for (const double r : ranges_m) mean += r / 16;
    for (const double r : ranges_m) square += (r - mean) * (r - mean) / 16;
    const double s = sigma * tangent;
    // Third-order terms of 1 / (1 + a tan): the variance is s^2 (1 + 8 s^2) of a Gaussian.
    EXPECT_NEAR(std::sqrt(square), d * s, d * s * 10 * s * s);
  }
}

TEST(Footprint, AtAnEdgeTheEchoesMixWithinAPulseAndPartBeyondIt) {
  // A screen that covers the left half of the beam at yaw 0, and one behind it.
  for (const double gap_m : {0.5, 3.0}) {
    scene::SceneParts parts = testing::empty_parts();
    add_material(parts, "grey", 0.4);
    add_screen(parts, 20.0, 2.0, "grey", 0.0);
    add_screen(parts, 20.0 + gap_m, 4.0, "grey");
    LidarConfig config = level_laser();
    config.model = "footprint";
    config.returns = "dual";
    config.divergence_mrad = {3.0, 3.0};
    const LidarOutput out = scan_of(parts, config);
    std::vector<double> at_edge;
    for (std::size_t i = 0; i < out.truth.size(); ++i)
      if (std::abs(yaw_deg(out.scan.points[i])) < 0.02) at_edge.push_back(out.truth[i].range_m);
    if (gap_m < 0.75) {
      ASSERT_EQ(at_edge.size(), 1u) << "one echo within a pulse";
      // Half the rays each; energies as 1 / range^2.
      const double near = 1 / (20.0 * 20.0), far = 1 / (20.5 * 20.5);
      EXPECT_NEAR(at_edge[0], 20.0 + 0.5 * far / (near + far), 1e-3) << "a mixed pixel between the two";
    } else {
      ASSERT_EQ(at_edge.size(), 2u) << "a return of each";
      EXPECT_NEAR(at_edge[0], 20.0, 1e-3);
      EXPECT_NEAR(at_edge[1], 23.0, 1e-3);
    }
  }
}

TEST(Returns, EachModeReportsWhatItSays) {
  // Two screens under one beam: the near one covers a quarter or so and is darker.
  scene::SceneParts parts = testing::empty_parts();
  add_material(parts, "dark", 0.1);
  add_material(parts, "bright", 0.9);
  add_screen(parts, 20.0, 1.0, "dark", 0.0);
  add_screen(parts, 25.0, 4.0, "bright");
  std::map<std::string, std::vector<double>> ranges_m;
  for (const std::string mode : {"strongest", "first", "last", "dual", "all"}) {
    LidarConfig config = level_laser();
    config.model = "footprint";
    config.returns = mode;
    const LidarOutput out = scan_of(parts, config);
    for (std::size_t i = 0; i < out.truth.size(); ++i) {
      if (std::abs(yaw_deg(out.scan.points[i])) > 0.02) continue;
      EXPECT_EQ(out.scan.points[i].return_index, ranges_m[mode].size()) << mode;
      ranges_m[mode].push_back(std::round(out.truth[i].range_m));
    }
  }
  EXPECT_EQ(ranges_m["strongest"], std::vector<double>({25}));
  EXPECT_EQ(ranges_m["first"], std::vector<double>({20}));
  EXPECT_EQ(ranges_m["last"], std::vector<double>({25}));
  EXPECT_EQ(ranges_m["dual"], std::vector<double>({20, 25}))
      << "the strongest is the last: the second strongest with it";
  EXPECT_EQ(ranges_m["all"], std::vector<double>({20, 25}));
}

/// A screen of 10 % at the range where it is at the threshold, and at others: the share detected is Phi(snr (s - 1)).
TEST(Radiometric, DetectionFollowsTheRadarEquation) {
  for (const double ratio : {0.85, 0.95, 1.0, 1.1}) {
    const double range_m = 50.0 * ratio, signal = 1.0 / (ratio * ratio);
    scene::SceneParts parts = testing::empty_parts();
    add_material(parts, "ten percent", 0.1);
    add_screen(parts, range_m, 2.0, "ten percent");
    LidarConfig config = level_laser();
    config.detector = "radiometric";
    config.azimuth_steps = 36000;  // a narrow fan: the screen's middle is square to it
    std::size_t fired = 0, detected = 0;
    for (std::int64_t index = 0; index < 10; ++index) {
      const LidarOutput ideal = [&] {
        LidarConfig all = config;
        all.detector = "ideal";
        return scan_of(parts, all, Pose{}, index);
      }();
      const LidarOutput out = scan_of(parts, config, Pose{}, index);
      const auto middle = [](const LidarPoint& p) { return std::abs(yaw_deg(p)) < 1.0; };
      fired += static_cast<std::size_t>(std::count_if(ideal.scan.points.begin(), ideal.scan.points.end(), middle));
      detected += static_cast<std::size_t>(std::count_if(out.scan.points.begin(), out.scan.points.end(), middle));
    }
    ASSERT_GE(fired, 1900u);
    const auto n = static_cast<double>(fired);
    const double expected = 0.5 * std::erfc(-config.threshold_snr * (signal - 1.0) / std::sqrt(2.0));
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
    config.detector = "radiometric";
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
  config.detector = "radiometric";
  config.saturation = 100;
  config.saturation_walk_m = 0.03;
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
    EXPECT_NEAR(rain_laws()[0].extinction_1_m(rate, 905) / extinction, 1.0, 0.015) << rate;
    EXPECT_DOUBLE_EQ(rain_laws()[0].extinction_1_m(rate, 905), 3.6e-4 * std::pow(rate, 0.63));
  }
  EXPECT_GT(rain_laws()[2].extinction_1_m(10, 905), 20 * rain_laws()[0].extinction_1_m(10, 905))
      << "the strong empirical form goes by its own name";
}

TEST(Weather, LawsAtValuesComputedByHand) {
  // 3.912 / 1000 m * (905 / 550)^-0.585 and, of thick fog, no wavelength at all.
  EXPECT_NEAR(fog_laws()[0].extinction_1_m(1000, 905), 3.912e-3 * std::pow(905.0 / 550.0, -0.585), 1e-12);
  EXPECT_DOUBLE_EQ(fog_laws()[1].extinction_1_m(200, 905), 3.912 / 200);
  EXPECT_DOUBLE_EQ(fog_laws()[1].extinction_1_m(200, 1550), 3.912 / 200);
  // 3.878 dB/km for 1 mm/h of wet snow at 905 nm: 8.93e-4 per metre.
  EXPECT_NEAR(snow_laws()[0].extinction_1_m(1, 905), (1.023e-4 * 905 + 3.7855466) / 4342.944819, 1e-12);
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

TEST(Weather, ThickFogAnswersAsOftenAsItsProbabilitySays) {
  LidarConfig config = ideal_lidar();
  config.weather.fog_visibility_m = 60;
  config.max_range_m = 60;
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

TEST(Effects, CrosstalkIsAsFrequentAsSaid) {
  LidarConfig config = ideal_lidar();
  config.crosstalk = 0.02;
  const LidarOutput out = scan_of(testing::empty_parts(), config);
  const double n = 28800;
  EXPECT_NEAR(static_cast<double>(out.truth.size()) / n, 0.02, 4.5 * std::sqrt(0.02 * 0.98 / n));
  for (const LidarPointTruth& t : out.truth) EXPECT_EQ(t.material, kNoMaterial);
}

TEST(Effects, BiasBelongsToTheLaserAndStays) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_wall(parts, {20, -200}, {20, 200}, 60);
  LidarConfig config = ideal_lidar();
  config.range_bias_m = 0.03;
  std::map<int, double> bias_m;
  double squares = 0;
  for (const std::int64_t index : {0, 5}) {
    const LidarOutput out = scan_of(parts, config, Pose{}, index);
    const BeamTable table = *load_beam_table("vlp16");
    for (std::size_t i = 0; i < out.truth.size(); ++i) {
      const LidarPoint& p = out.scan.points[i];
      const double error_m =
          (position(p) - Eigen::Vector3d(0, 0, table.beams[p.ring].origin_up_m)).norm() - out.truth[i].range_m;
      const auto [known, fresh] = bias_m.emplace(p.ring, error_m);
      if (fresh) squares += error_m * error_m;
      EXPECT_NEAR(error_m, known->second, 200 * 6 * 6e-8);
    }
  }
  ASSERT_GE(bias_m.size(), 8u);
  // Chi-square of 8 or more lasers: 4.5 sigma either side.
  const auto n = static_cast<double>(bias_m.size());
  EXPECT_NEAR(squares / n, 0.03 * 0.03, 4.5 * 0.03 * 0.03 * std::sqrt(2 / n));
}

TEST(Effects, AngleNoiseMovesTheRayNotTheReport) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_wall(parts, {20, -50}, {20, 50}, 60);
  LidarConfig config = level_laser();
  config.angle_noise_deg = 0.1;
  const LidarOutput out = scan_of(parts, config);
  double squares = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const double yaw = yaw_deg(out.scan.points[i]) * kDegree;
    if (std::abs(std::abs(yaw) - 45 * kDegree) > 10 * kDegree) continue;
    // range = 20 / cos(yaw): an error of angle e changes it by range tan(yaw) e.
    const double e = (out.truth[i].range_m * std::cos(yaw) / 20 - 1) / std::tan(yaw);
    squares += e * e, ++n;
  }
  ASSERT_GT(n, 300u);
  const double sigma = 0.1 * kDegree;
  // 4.5 sigma, and second-order terms of 0.2 %.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(n)), sigma,
              4.5 * sigma / std::sqrt(2.0 * static_cast<double>(n)) + 0.005 * sigma);
}

TEST(Effects, LatencyShowsThePast) {
  // At 10 m/s towards a wall, stamps 50 ms late: all ranges are longer by 0.5 m at the stamp's own instant.
  Vector6d twist;
  twist << 0, 0, 0, 10, 0, 0;
  scene::SceneParts parts = testing::empty_parts();
  add_screen(parts, 40, 30, "concrete");
  const scene::Scene scene(parts);
  LidarConfig config = level_laser();
  const auto ranges = [&](double latency_s) {
    config.latency_s = latency_s;
    return (*make_scanner(config, 1))->scan(0, kStart, testing::twisting(Pose{}, twist), scene::SceneAt(scene));
  };
  const LidarOutput prompt = ranges(0), late = ranges(0.05);
  EXPECT_EQ(prompt.scan.t, late.scan.t);
  ASSERT_GT(late.scan.points.size(), 100u);
  for (const LidarPoint& p : late.scan.points) EXPECT_NEAR(p.x, 40 - 10 * (p.time_s - 0.05), 2e-4);
  for (const LidarPoint& p : prompt.scan.points) EXPECT_NEAR(p.x, 40 - 10 * p.time_s, 2e-4);
}

TEST(Effects, TheOwnVehicleIsHidden) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_ground(parts, 200);
  LidarConfig config = ideal_lidar();
  config.mount_m = {0.3, 0, 1.8};
  const std::size_t all = scan_of(parts, config).truth.size();
  config.ego_min_m = {-1, -0.9, 0.2}, config.ego_max_m = {3, 0.9, 1.5};
  const LidarOutput out = scan_of(parts, config);
  EXPECT_LT(out.truth.size(), all);
  const BeamTable table = *load_beam_table("vlp16");
  for (const LidarPoint& p : out.scan.points) {
    // The way from the laser to the point never enters the box.
    const Eigen::Vector3d up(0, 0, table.beams[p.ring].origin_up_m);
    const Eigen::Vector3d origin = config.mount_m + up, way = position(p) - up;
    for (int k = 0; k <= 1000; ++k) {
      const Eigen::Vector3d at = origin + way * (k / 1000.0);
      const bool inside =
          ((at - config.ego_min_m).array() > 1e-6).all() && ((config.ego_max_m - at).array() > 1e-6).all();
      ASSERT_FALSE(inside);
    }
  }
}

TEST(Beams, RangesToASphere) {
  constexpr int kAround = 4096, kUp = 256;
  constexpr double kRadius_m = 2.0;
  const Eigen::Vector3d center(15, 4, 1);
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ball", scene::ObjectKind::kOther);
  const auto corner = [&](int i, int j) -> Eigen::Vector3d {
    const double azimuth = 2 * kPi * i / kAround, up = -0.2 + 0.4 * j / kUp;  // a band about its equator
    return center + kRadius_m * Eigen::Vector3d(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth),
                                                std::sin(up));
  };
  for (int i = 0; i < kAround; ++i)
    for (int j = 0; j < kUp; ++j) mesh.quad(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1), 0);
  // A chord of angle a lies at most r a^2 / 8 inside: 2 pi / 4096 and 0.4 / 256 together, 1.2 um.
  const double sag_m = kRadius_m * (std::pow(2 * kPi / kAround, 2) + std::pow(0.4 / kUp, 2)) / 8;
  ASSERT_LT(sag_m, 2e-6);
  LidarConfig config = ideal_lidar();
  config.beams = "grid:24:0:6";
  config.azimuth_steps = 9000;
  const LidarOutput out = scan_of(parts, config);
  const BeamTable table = *load_beam_table("grid:24:0:6");
  std::size_t compared = 0;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    if (out.truth[i].cos_incidence < 0.2) continue;
    // The nominal direction, from ring and time as a driver would compute it.
    const LidarPoint& p = out.scan.points[i];
    const double elevation = table.beams[p.ring].elevation_rad;
    const auto cycle = std::lround((p.time_s + 0.1) / (0.1 / 9000) - 1);
    const double yaw = kPi - 2 * kPi * static_cast<double>(cycle) / 9000;
    const Eigen::Vector3d d(std::cos(elevation) * std::cos(yaw), std::cos(elevation) * std::sin(yaw),
                            std::sin(elevation));
    const double b = d.dot(center);
    const double expected = b - std::sqrt(b * b - center.squaredNorm() + kRadius_m * kRadius_m);
    if (std::abs(expected * d.z() - center.z()) > 0.95 * kRadius_m * std::sin(0.2))
      continue;  // above or below the band
    ASSERT_NEAR(out.truth[i].range_m, expected, 1e-4) << i;
    ++compared;
  }
  EXPECT_GT(compared, 2000u);
}

TEST(Beams, EveryBuiltInSensorScansARoom) {
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("room", scene::ObjectKind::kBuilding);
  mesh.box({0, 0, 0}, Eigen::Matrix3d::Identity(), {20, 15, 8}, 0);
  for (const std::string& name : builtin_beam_tables()) {
    LidarConfig config = ideal_lidar();
    config.beams = name;
    const BeamTable table = *load_beam_table(name);
    config.azimuth_steps = table.cycle_s > 0 ? 0 : 1024;
    const LidarOutput out = scan_of(parts, config);
    ASSERT_GT(out.truth.size(), 10'000u) << name;
    for (std::size_t i = 0; i < out.truth.size(); ++i) {
      const Eigen::Vector3d p = position(out.scan.points[i]);
      // On a wall, the floor or the ceiling.
      const double off =
          std::min({std::abs(std::abs(p.x()) - 20), std::abs(std::abs(p.y()) - 15), std::abs(std::abs(p.z()) - 8)});
      ASSERT_LT(off, 1e-4) << name << " " << p.transpose();
    }
  }
}

TEST(Beams, ARosetteFillsItsFieldOfViewMoreAndMore) {
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("room", scene::ObjectKind::kBuilding);
  mesh.box({0, 0, 0}, Eigen::Matrix3d::Identity(), {20, 20, 20}, 0);
  LidarConfig config = ideal_lidar();
  config.beams = "mid360";
  config.azimuth_steps = 0;
  std::map<std::pair<int, int>, int> cells;  // 1 deg x 1 deg
  std::vector<std::size_t> filled;
  double low = 90, high = -90;
  for (std::int64_t index = 0; index < 10; ++index) {
    const LidarOutput out = scan_of(parts, config, Pose{}, index);
    EXPECT_NEAR(static_cast<double>(out.scan.points.size()), 20'000, 4.0) << "200,000 points per second";
    for (const LidarPoint& p : out.scan.points) {
      const double elevation = std::asin(p.z / position(p).norm()) / kDegree;
      low = std::min(low, elevation), high = std::max(high, elevation);
      ++cells[{static_cast<int>(std::floor(yaw_deg(p))), static_cast<int>(std::floor(elevation))}];
    }
    filled.push_back(cells.size());
  }
  EXPECT_NEAR(low, -7, 0.01);
  EXPECT_NEAR(high, 52, 0.01);
  EXPECT_GT(filled[9], filled[0] * 3 / 2) << "new places in every frame";
  EXPECT_GT(filled[9], 360u * 59 * 9 / 10);
}

TEST(Extremes, DefinedResults) {
  const auto all_finite = [](const LidarOutput& out) {
    return std::all_of(out.scan.points.begin(), out.scan.points.end(), [](const LidarPoint& p) {
      return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(p.intensity);
    });
  };
  for (const char* model : {"single_ray", "footprint"}) {
    LidarConfig config = ideal_lidar();
    config.model = model;
    config.detector = "radiometric";
    config.weather.rain_mm_h = 10;
    // Inside a wall: a closed box of 10 cm around the sensor; everything is nearer than min_range_m.
    scene::SceneParts inside = testing::empty_parts();
    testing::add_box(inside, {0, 0, 0}, {0.05, 0.05, 0.05}, 0);
    EXPECT_TRUE(scan_of(inside, config).scan.points.empty()) << model;
    // In the plane of a wall, exactly.
    scene::SceneParts within = testing::empty_parts();
    testing::add_wall(within, {-10, 0}, {10, 0}, 10);
    EXPECT_TRUE(all_finite(scan_of(within, config))) << model;
    // Nothing at all.
    LidarConfig clear = config;
    clear.weather = {};
    EXPECT_TRUE(scan_of(testing::empty_parts(), clear).scan.points.empty()) << model;
  }
  // Grazing at 89.99 deg: a level floor 1 cm below a beam that is 0.01 deg down, met 57.3 m away.
  scene::SceneParts floor = testing::empty_parts();
  testing::add_ground(floor, 200, -0.01);
  LidarConfig grazing = ideal_lidar();
  grazing.beams = "grid:1:-0.01:-0.01";
  const LidarOutput out = scan_of(floor, grazing);
  ASSERT_EQ(out.truth.size(), 1800u);
  for (const LidarPointTruth& t : out.truth) {
    // A direction in floats is off by 6e-8 or so, which the slope of 1.7e-4 makes 57 m * 3.4e-4.
    EXPECT_NEAR(t.range_m, 0.01 / std::sin(0.01 * kDegree), 57.3 * 4 * 6e-8 / std::sin(0.01 * kDegree));
    EXPECT_NEAR(t.cos_incidence, std::sin(0.01 * kDegree), 4e-7);
  }
}

TEST(Extremes, FiveKilometresFromTheOrigin) {
  // Single precision resolves 0.5 mm at 5 km: the origin of the rays and the corners of the wall are rounded to half of
  // that each.
  const double far_m = 5000.3;
  scene::SceneParts parts = testing::empty_parts();
  testing::add_wall(parts, {far_m + 20, -100}, {far_m + 20, 100}, 60);
  LidarConfig config = ideal_lidar();
  const LidarOutput out = scan_of(parts, config, pose_at(far_m, 0, 2, 0));
  ASSERT_GT(out.truth.size(), 1000u);
  for (std::size_t i = 0; i < out.truth.size(); ++i) EXPECT_NEAR(out.scan.points[i].x, 20.0, 2 * 0.25e-3 + 1e-4);
}

TEST(Models, SameBitsForAnyNumberOfThreads) {
  const scene::Scene scene(testing::street_crossing());
  Vector6d twist;
  twist << 0, 0, 0.5, 8, 0, 0;
  const Trajectory motion = testing::twisting(pose_at(-10, 1, 0, 10), twist);
  LidarConfig config;
  config.model = "footprint";
  config.detector = "radiometric";
  config.returns = "dual";
  config.weather.rain_mm_h = 20;
  config.crosstalk = 0.001;
  config.angle_noise_deg = 0.05;
  config.range_bias_m = 0.01;
  std::vector<LidarOutput> outputs;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    outputs.push_back((*make_scanner(config, 1))->scan(5, kStart, motion, scene::SceneAt(scene)));
  }
  set_threads(0);
  EXPECT_GT(outputs[0].scan.points.size(), 10000u);
  EXPECT_TRUE(testing::same(outputs[0], outputs[1]));
  EXPECT_TRUE(testing::same(outputs[0], outputs[2]));
}

}  // namespace
}  // namespace canyon::lidar
