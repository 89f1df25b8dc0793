// The footprint of a beam and its returns, against closed forms.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "canyon/core/config/text.h"
#include "canyon/lidar/beam/footprint/footprint_rays.h"
#include "canyon/tests/lidar/beam/screens.h"

namespace canyon::lidar {
namespace {

using testing::add_material;
using testing::add_screen;
using testing::level_laser;
using testing::scan_of;
using testing::set_keys;
using testing::yaw_deg;

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
    config.model.name = "footprint";
    set_keys(config, "divergence_mrad = [8.0, 4.0]");
    config.signal.pulse_m = 5.0;
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
  config.model.name = "footprint";
  config.report.returns = ReturnMode::kAll;
  const std::string width = number_text(4e3 * sigma);
  set_keys(config, "divergence_mrad = [" + width + ", " + width + "]");
  config.signal.pulse_m = 1e-3;  // every sub-ray an echo of its own
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
    config.model.name = "footprint";
    config.report.returns = ReturnMode::kDual;
    set_keys(config, "divergence_mrad = [3.0, 3.0]");
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
  for (const auto& row : return_modes()) {
    const std::string mode = row.name;
    LidarConfig config = level_laser();
    config.model.name = "footprint";
    config.report.returns = row.make;
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

/// Nearer than full_overlap_m (5 m) nearness brings no more light: a weak echo at 1 m is not stronger than a wall at 20
/// m.
TEST(Returns, StrengthIsWhatTheReceiverGets) {
  scene::SceneParts parts = testing::empty_parts();
  add_material(parts, "veil", 0.01);
  add_material(parts, "wall", 0.5);
  add_screen(parts, 1.0, 0.2, "veil", 0.0);
  add_screen(parts, 20.0, 4.0, "wall");
  LidarConfig config = level_laser();
  config.model.name = "footprint";
  // Half of the beam each: 0.01 / 5^2 against 0.5 / 20^2.
  const LidarOutput out = scan_of(parts, config);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    if (std::abs(yaw_deg(out.scan.points[i])) > 0.02) continue;
    EXPECT_NEAR(out.truth[i].range_m, 20.0, 1e-2);
    ++compared;
  }
  EXPECT_GE(compared, 1u);
}

}  // namespace
}  // namespace canyon::lidar
