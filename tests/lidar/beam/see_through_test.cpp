// Light behind panes and through the gaps of tree crowns, against closed forms.
#include "canyon/lidar/beam/see_through.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/pane.h"
#include "canyon/tests/lidar/beam/screens.h"

namespace canyon::lidar {
namespace {

using testing::add_material;
using testing::add_screen;
using testing::kStart;
using testing::level_laser;
using testing::scan_of;
using testing::set_keys;
using testing::yaw_deg;

constexpr double kThrough = 0.8;

/// A material that lets the share `through` of the light pass.
void add_pane_material(scene::SceneParts& parts, double reflectance) {
  scene::Material pane;
  pane.name = "pane";
  pane.lidar_reflectance = reflectance;
  pane.lidar_transmittance = kThrough;
  parts.materials.push_back(pane);
}

/// Returns of the shots that point along x, by shot.
struct Seen {
  std::vector<double> ranges_m, intensities;
  std::vector<std::string> materials;
};
std::vector<Seen> along_x(const scene::SceneParts& parts, const LidarConfig& config, double half_width_deg) {
  const LidarOutput out = scan_of(parts, config);
  std::vector<Seen> shots;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const LidarPoint& p = out.scan.points[i];
    if (std::abs(yaw_deg(p)) > half_width_deg) continue;
    if (p.return_index == 0) shots.emplace_back();
    shots.back().ranges_m.push_back(out.truth[i].range_m);
    shots.back().intensities.push_back(p.intensity);
    shots.back().materials.push_back(parts.materials[out.truth[i].material].name);
  }
  return shots;
}

class Panes : public ::testing::TestWithParam<const char*> {};

/// Panes at 10 and 14 m and a wall at 20 m, square to the beam: echoes of rho_pane, t^2 rho_pane and t^4 rho_wall.
TEST_P(Panes, EachIsPassedTwice) {
  scene::SceneParts parts = testing::empty_parts();
  add_pane_material(parts, 0.06);
  add_material(parts, "wall", 0.5);
  add_screen(parts, 10.0, 1.0, "pane");
  add_screen(parts, 14.0, 1.4, "pane");
  add_screen(parts, 20.0, 2.0, "wall");
  LidarConfig config = level_laser();
  config.model.name = GetParam();
  config.report.returns = ReturnMode::kAll;
  set_keys(config, "divergence_mrad = [0.2, 0.2]");
  EXPECT_EQ(along_x(parts, config, 0.2).front().ranges_m.size(), 1u) << "nothing is seen through unless asked for";
  config.see_through = {.panes = true};
  const auto shots = along_x(parts, config, 0.2);
  ASSERT_GE(shots.size(), 3u);
  const double t2 = kThrough * kThrough;
  for (const Seen& shot : shots) {
    ASSERT_EQ(shot.ranges_m.size(), 3u);
    // 0.2 deg off square: 6e-6 of the range and of the cosine; 1 mm is where a ray starts anew, not an error.
    EXPECT_NEAR(shot.ranges_m[0], 10.0, 10 * 1e-5 + 1e-4);
    EXPECT_NEAR(shot.ranges_m[1], 14.0, 14 * 1e-5 + 1e-4);
    EXPECT_NEAR(shot.ranges_m[2], 20.0, 20 * 1e-5 + 1e-4);
    EXPECT_NEAR(shot.intensities[0], 0.06, 0.06 * 2e-5);
    EXPECT_NEAR(shot.intensities[1], 0.06 * t2, 0.06 * 2e-5);
    EXPECT_NEAR(shot.intensities[2], 0.5 * t2 * t2, 0.5 * 2e-5);
    EXPECT_EQ(shot.materials, (std::vector<std::string>{"pane", "pane", "wall"}));
  }
  config.report.returns = ReturnMode::kDual;
  for (const Seen& shot : along_x(parts, config, 0.2))
    EXPECT_EQ(shot.materials, (std::vector<std::string>{"pane", "wall"})) << "the strongest, 0.06 / 10^2, and the last";
}
INSTANTIATE_TEST_SUITE_P(BothBeams, Panes, ::testing::Values("single_ray", "footprint"));

/// Fresnel's formulas in their other form, by angles, and the way through a plate.
double by_angles(double at_normal, double angle_rad) {
  const double inside_rad = std::asin(std::sin(angle_rad) / 1.52);
  const double sum = angle_rad + inside_rad, difference = angle_rad - inside_rad;
  const double across = std::pow(std::sin(difference) / std::sin(sum), 2);
  const double along = std::pow(std::tan(difference) / std::tan(sum), 2);
  const double faces = 0.5 * ((1 - across) / (1 + across) + (1 - along) / (1 + along));
  const double at_zero = std::pow(0.52 / 2.52, 2), faces_at_zero = (1 - at_zero) / (1 + at_zero);
  return faces * std::pow(at_normal / faces_at_zero, 1 / std::cos(inside_rad));
}

TEST(Pane, PassesLessLightAtAnAngle) {
  constexpr double kRounding = 1e-14;  // some forty operations on numbers of order 1
  EXPECT_NEAR(pane_transmittance(0.8, 1.0), 0.8, kRounding);
  for (const double deg : {1.0, 20.0, 45.0, 60.0, 80.0, 89.0})
    EXPECT_NEAR(pane_transmittance(0.8, std::cos(deg * kDegree)), by_angles(0.8, deg * kDegree), kRounding) << deg;
  // A plate that takes nothing itself lets all of one polarisation through at Brewster's angle.
  const double clear = 2 * 1.52 / (1 + 1.52 * 1.52), brewster_rad = std::atan(1.52);
  const double across = std::pow(std::cos(2 * brewster_rad), 2);
  EXPECT_NEAR(pane_transmittance(clear, std::cos(brewster_rad)), 0.5 * (1 + (1 - across) / (1 + across)), kRounding);
  EXPECT_EQ(pane_transmittance(0.8, 0.0), 0.0);
  EXPECT_EQ(pane_transmittance(0.0, 0.5), 0.0);
}

/// A crown at 15 m before a wall at 30 m: radii so large across that all chords of a narrow fan are 2 radii_x.
scene::SceneParts crown_and_wall(double half_depth_m, double density) {
  scene::SceneParts parts = testing::empty_parts();
  add_material(parts, "wall", 0.5);
  add_screen(parts, 30.0, 5.0, "wall");
  scene::Foliage crown;
  crown.center_W = {15, 0, 0};
  crown.radii_m = {half_depth_m, 100.0, 100.0};
  crown.leaf_density_m2_m3 = density;
  parts.foliage.push_back(crown);
  return parts;
}

/// The wall is seen with probability exp(-density chord / 2), and where it is not, the first leaf lies as deep as an
/// exponential of rate density / 2 cut off at the chord.
TEST(Crowns, GapsFollowBeerAndLambert) {
  constexpr double kHalf_m = 2.0, kDensity = 0.6, kRate = 0.5 * kDensity, kChord_m = 2 * kHalf_m;
  const auto parts = crown_and_wall(kHalf_m, kDensity);
  LidarConfig config = level_laser();
  config.see_through = {.leaves = true};
  config.azimuth_steps = 36000;
  const LidarOutput out = scan_of(parts, config);
  double n = 0, clear = 0, depth = 0, leaves = 0, cosine = 0;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    if (std::abs(yaw_deg(out.scan.points[i])) > 8) continue;
    ++n;
    if (parts.materials[out.truth[i].material].name == "wall") {
      ++clear;
    } else {
      ++leaves;
      depth += out.truth[i].range_m - 13.0;
      cosine += out.truth[i].cos_incidence;
    }
  }
  ASSERT_GT(n, 1500);
  const double p = std::exp(-kRate * kChord_m);
  EXPECT_NEAR(clear / n, p, 4.5 * std::sqrt(p * (1 - p) / n)) << "4.5 sigma: false alarm 7e-6";
  // Mean of the cut exponential; its spread is below that of a uniform depth, chord / sqrt(12). Off the axis by up to 8
  // deg the crown is met up to 1 % later along the ray, 13 m / cos.
  const double mean = 1 / kRate - kChord_m * p / (1 - p);
  EXPECT_NEAR(depth / leaves, mean, 4.5 * kChord_m / std::sqrt(12 * leaves) + 13 * (1 / std::cos(8 * kDegree) - 1));
  // Leaves are met at 2 cos: mean 2/3, variance 1/18.
  EXPECT_NEAR(cosine / leaves, 2.0 / 3.0, 4.5 * std::sqrt(1.0 / 18.0 / leaves));
}

/// Of sixteen sub-rays each finds its own gap: the wall's echo has the share exp(-density chord / 2) of its energy in
/// the mean, and most beams give a first return of leaves and a last of the wall.
TEST(Crowns, ABeamIsSharedBetweenLeavesAndWhatIsBehind) {
  constexpr double kHalf_m = 1.0, kDensity = 1.0;
  const auto parts = crown_and_wall(kHalf_m, kDensity);
  LidarConfig config = level_laser();
  config.model.name = "footprint";
  config.report.returns = ReturnMode::kAll;
  config.see_through = {.leaves = true};
  config.azimuth_steps = 36000;
  const LidarOutput out = scan_of(parts, config);
  double shots = 0, energy = 0, both = 0;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const LidarPoint& p = out.scan.points[i];
    if (std::abs(yaw_deg(p)) > 5) continue;
    if (p.return_index == 0) ++shots;
    if (parts.materials[out.truth[i].material].name != "wall") continue;
    energy += p.intensity / (0.5 * out.truth[i].cos_incidence);
    if (p.return_index > 0) ++both;
  }
  ASSERT_GT(shots, 900);
  const double share = std::exp(-0.5 * kDensity * 2 * kHalf_m);
  // Sixteen draws a shot.
  EXPECT_NEAR(energy / shots, share, 4.5 * std::sqrt(share * (1 - share) / (16 * shots)) + 1e-3);
  EXPECT_GT(both / shots, 0.99);
}

/// The leaves that a mesh shows in place of a crown do not count twice; a trunk stops light as ever.
TEST(Crowns, LeavesOfTheMeshAreLeftOut) {
  scene::SceneParts parts = crown_and_wall(2.0, 1e-9);
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("tree", scene::ObjectKind::kTree);
  mesh.quad({15, 1, -0.5}, {15, -1, -0.5}, {15, -1, 0.5}, {15, 1, 0.5}, mesh.material("foliage"));
  mesh.quad({15.5, 0.1, -0.5}, {15.5, 0, -0.5}, {15.5, 0, 0.5}, {15.5, 0.1, 0.5}, mesh.material("bark"));
  LidarConfig config = level_laser();
  const auto material_at = [&](double yaw) {
    const LidarOutput out = scan_of(parts, config);
    for (std::size_t i = 0; i < out.truth.size(); ++i)
      if (std::abs(yaw_deg(out.scan.points[i]) - yaw) < 0.06) return parts.materials[out.truth[i].material].name;
    return std::string("nothing");
  };
  EXPECT_EQ(material_at(0.2), "foliage");
  EXPECT_EQ(material_at(-1.0), "foliage");
  config.see_through = {.leaves = true};
  EXPECT_EQ(material_at(0.2), "bark");
  EXPECT_EQ(material_at(-1.0), "wall");
}

TEST(SeeThroughModes, SameBitsForAnyNumberOfThreads) {
  const scene::Scene scene(crown_and_wall(2.0, 0.6));
  LidarConfig config = level_laser();
  config.model.name = "footprint";
  config.report.returns = ReturnMode::kAll;
  config.see_through = {.panes = true, .leaves = true};
  std::vector<LidarOutput> outputs;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    outputs.push_back((*make_scanner(config, 1))->scan(3, kStart, testing::standing(Pose{}), scene::SceneAt(scene)));
  }
  set_threads(0);
  EXPECT_GT(outputs[0].scan.points.size(), 50u);
  EXPECT_TRUE(testing::same(outputs[0], outputs[1]));
  EXPECT_TRUE(testing::same(outputs[0], outputs[2]));
}

}  // namespace
}  // namespace canyon::lidar
