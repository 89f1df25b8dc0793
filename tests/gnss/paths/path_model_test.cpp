#include "canyon/gnss/paths/path_model.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/signal.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::direction;
using testing::WallScene;

const Eigen::Vector3d kPathAntenna(0.0, 0.0, 2.0);

std::vector<SignalPaths> traced(const PathModel& model, const scene::Scene& scene,
                                const std::vector<Eigen::Vector3d>& directions,
                                const Eigen::Vector3d& antenna = kPathAntenna, GnssCounters* counters = nullptr) {
  std::vector<SignalPaths> out(directions.size());
  GnssCounters own;
  model.trace(antenna, directions, scene::SceneAt(scene), out, counters != nullptr ? *counters : own);
  return out;
}

/// A wall x = -distance that faces east.
WallScene west_wall(double distance_m, double half_width_m = 400.0, double height_m = 800.0,
                    const std::string& material = "concrete") {
  return WallScene().wall({-distance_m, -half_width_m, -50.0}, {0, 2.0 * half_width_m, 0}, {0, 0, height_m}, material);
}

TEST(PathModel, NoneSeesEverything) {
  const auto scene = west_wall(5.0).build();
  for (const auto& p :
       traced(*find_model(path_models(), "none")->make({}, {}), *scene, {direction(270, 20), direction(90, 20)})) {
    EXPECT_TRUE(p.line_of_sight);
    EXPECT_TRUE(p.echoes.empty());
  }
}

TEST(PathModel, VisibilityIsTheSilhouette) {
  const auto scene = WallScene().box({-30, -500, 0}, {-20, 500, 22}).build();
  const auto model = make_visibility({});
  GnssCounters counters;
  // The roof edge stands 20 m above the antenna at 20 m: 45 deg towards the west.
  const auto paths =
      traced(*model, *scene, {direction(270, 44.9), direction(270, 45.1), direction(90, 10)}, kPathAntenna, &counters);
  EXPECT_FALSE(paths[0].line_of_sight);
  EXPECT_TRUE(paths[1].line_of_sight);
  EXPECT_TRUE(paths[2].line_of_sight);
  EXPECT_EQ(counters.occlusion_rays, 3);
  EXPECT_FALSE(scene->facets_built());  // visibility alone never pays for facets
}

TEST(PathModel, FoliageAttenuatesAndDoesNotBlock) {
  const auto scene = WallScene().box({-3000, -3000, -20}, {-2990, -2990, -10}).crown({10, 0, 12}, {4, 4, 4}).build();
  const auto paths = traced(*make_visibility({}), *scene, {direction(90, 45), direction(270, 45)});
  EXPECT_TRUE(paths[0].line_of_sight);
  EXPECT_NEAR(paths[0].foliage_m, 8.0, 1e-6);  // through the centre
  EXPECT_EQ(paths[1].foliage_m, 0.0);
}

// One wall, closed form: excess 2 d cos(i), cos(i) = cos(el) sin(az) for a wall that faces east; a reflection exists
// exactly for the satellites in front of it.
TEST(Specular1, SingleWallAgainstTheClosedForm) {
  const double distance_m = 12.5;
  const auto scene = west_wall(distance_m).build();
  const auto model = make_specular1({.cutoff_m = 1000.0, .leave_out = {}});
  int found = 0;
  for (double az = 2.0; az < 360.0; az += 7.0) {
    for (double el = 5.0; el < 80.0; el += 7.5) {
      const auto paths = traced(*model, *scene, {direction(az, el)});
      const double cos_incidence = std::cos(el * kDegree) * std::sin(az * kDegree);
      const double leg_m = distance_m / std::abs(cos_incidence);
      // Where the wave, reflected or direct, meets the plane of the wall: within its 2 x 400 m and up to 750 m?
      const double y_m = leg_m * std::cos(el * kDegree) * std::cos(az * kDegree),
                   z_m = 2.0 + leg_m * std::sin(el * kDegree);
      const bool meets = std::abs(y_m) <= 400.0 && z_m <= 750.0;
      const bool expected = cos_incidence > 0.0 && leg_m <= 1000.0 && meets;
      ASSERT_EQ(paths[0].echoes.size(), expected ? 1u : 0u) << az << " " << el;
      EXPECT_EQ(paths[0].line_of_sight, cos_incidence > 0.0 || !meets) << az << " " << el;
      if (!expected) continue;
      const SignalPath& r = paths[0].echoes[0];
      EXPECT_NEAR(r.excess_m, 2.0 * distance_m * cos_incidence, 1e-12 * leg_m);
      EXPECT_EQ(r.reflections, 1);
      EXPECT_EQ(r.diffractions, 0);
      EXPECT_NEAR(r.arrival_W.norm(), 1.0, 1e-14);
      // Plane wave: the excess is also leg - leg . direction, whatever formula gave it.
      EXPECT_NEAR(r.excess_m, leg_m * (1.0 - r.arrival_W.dot(direction(az, el))), 1e-11 * leg_m);
      ++found;
    }
  }
  EXPECT_GT(found, 150);
}

// The antenna sees a wall 300 m away by the light of a satellite that is high, and that far only because the excess is
// what is limited.
TEST(Specular1, ReachFollowsFromTheCutoffAndTheElevation) {
  const auto scene = west_wall(300.0).build();
  const Eigen::Vector3d high = direction(90, 86), low = direction(90, 60);  // excess 600 m x cos(86 deg) = 41.9 m
  EXPECT_EQ(traced(*make_specular1({}), *scene, {high, low})[0].echoes.size(), 0u) << "800 m is not high enough";
  const auto tower = west_wall(300.0, 400.0, 5000.0).build();
  const auto paths = traced(*make_specular1({}), *tower, {high, low});
  ASSERT_EQ(paths[0].echoes.size(), 1u);
  EXPECT_NEAR(paths[0].echoes[0].excess_m, 600.0 * std::cos(86 * kDegree), 1e-9);
  EXPECT_EQ(paths[1].echoes.size(), 0u);
  PathParameters just_less;
  just_less.cutoff_m = paths[0].echoes[0].excess_m - 1e-6;
  EXPECT_EQ(traced(*make_specular1(just_less), *tower, {high})[0].echoes.size(), 0u);
}

// Whether a blocked satellite is tracked depends on the strength alone.
TEST(Specular1, ABlockedSatelliteHasNoCutoff) {
  auto walls = west_wall(300.0);
  walls.box({5, -5, 0}, {6, 5, 20}, "absorber");
  const auto paths = traced(*make_specular1({}), *walls.build(), {direction(90, 30)});
  EXPECT_FALSE(paths[0].line_of_sight);
  ASSERT_EQ(paths[0].echoes.size(), 1u);
  EXPECT_NEAR(paths[0].echoes[0].excess_m, 600.0 * std::cos(30 * kDegree), 1e-9);
  PathParameters deaf;
  deaf.weakest_nlos_db = -5.0;
  EXPECT_TRUE(traced(*make_specular1(deaf), *walls.build(), {direction(90, 30)})[0].echoes.empty());
}

TEST(Specular1, BlockedLegsGiveNothing) {
  const Eigen::Vector3d s = direction(90, 30);
  const auto model = make_specular1({});
  // Reflection point at (-20, 0, 2 + 20 tan 30 = 13.5).
  EXPECT_EQ(traced(*model, *west_wall(20.0).build(), {s})[0].echoes.size(), 1u);
  // A screen between antenna and reflection point, which leaves the direct way free.
  auto inner = west_wall(20.0);
  inner.box({-10.5, -1, 6}, {-10, 1, 9}, "absorber");
  const auto inside = traced(*model, *inner.build(), {s})[0];
  EXPECT_TRUE(inside.line_of_sight);
  EXPECT_EQ(inside.echoes.size(), 0u);
  // A screen between reflection point and satellite: the incoming way is 11.55 m above the direct one at the antenna's
  // x = 0.
  auto outer = west_wall(20.0);
  outer.box({5, -1, 26}, {5.5, 1, 30}, "absorber");
  const auto outside = traced(*model, *outer.build(), {s})[0];
  EXPECT_TRUE(outside.line_of_sight);
  EXPECT_EQ(outside.echoes.size(), 0u);
  // A screen that blocks only the direct way.
  auto direct = west_wall(20.0);
  direct.box({5, -1, 3.5}, {5.5, 1, 6.5}, "absorber");
  const auto nlos = traced(*model, *direct.build(), {s})[0];
  EXPECT_FALSE(nlos.line_of_sight);
  ASSERT_EQ(nlos.echoes.size(), 1u);
  EXPECT_NEAR(nlos.echoes[0].excess_m, 40.0 * std::cos(30 * kDegree), 1e-9);
}

TEST(Specular1, AbsorbersReflectNothingAndBlockStill) {
  const auto scene = west_wall(20.0, 400.0, 800.0, "absorber").build();
  const auto paths = traced(*make_specular1({}), *scene, {direction(90, 30), direction(270, 30)});
  EXPECT_TRUE(paths[0].echoes.empty());
  EXPECT_FALSE(paths[1].line_of_sight);
}

TEST(Specular1, MaterialGivesTheCoefficients) {
  const auto scene = west_wall(20.0, 400.0, 800.0, "glass").build();
  const auto paths = traced(*make_specular1({}), *scene, {direction(90, 45)});
  ASSERT_EQ(paths[0].echoes.size(), 1u);
  const scene::Material& glass = scene->materials()[WallScene().material("glass")];
  EXPECT_EQ(glass.thickness_m, 0.006);
  const Fresnel pane = fresnel_slab(glass.permittivity(kL1Hz), 0.006, kL1WavelengthM, 45.0 * kDegree);
  EXPECT_NEAR(std::abs(paths[0].echoes[0].crosspolar), std::abs(pane.cross), 1e-12);
  EXPECT_NEAR(std::abs(paths[0].echoes[0].copolar), std::abs(pane.co), 1e-12);
}

// Reflections come sorted by excess, and each satisfies the law of reflection with a clear way; the street canyon has
// two walls.
TEST(Specular1, StreetCanyon) {
  auto walls = WallScene().box({-60, -300, 0}, {-12, 300, 60});
  walls.box({9, -300, 0}, {60, 300, 60}, "glass");
  const auto scene = walls.build();
  const RandomStream random(3, "test.directions");
  std::vector<Eigen::Vector3d> directions;
  for (std::uint64_t i = 0; i < 400; ++i)
    directions.push_back(direction(random.uniform(0, 360, 0, i), random.uniform(5, 89, 1, i)));
  const auto paths = traced(*make_specular1({}), *scene, directions);
  std::size_t reflections = 0, blocked = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    blocked += paths[i].line_of_sight ? 0u : 1u;
    for (std::size_t k = 0; k < paths[i].echoes.size(); ++k) {
      const SignalPath& r = paths[i].echoes[k];
      ++reflections;
      EXPECT_GE(r.excess_m, k > 0 ? paths[i].echoes[k - 1].excess_m : 0.0);
      const scene::Facet& f = scene->facets().facets()[r.facets[0]];
      const double to_plane_m = f.normal_W.dot(kPathAntenna) - f.offset_m;
      EXPECT_NEAR(r.excess_m, 2.0 * to_plane_m * f.normal_W.dot(directions[i]), 1e-9);
      EXPECT_NEAR((r.arrival_W - directions[i]).cross(f.normal_W).norm(), 0.0, 1e-12);
    }
  }
  EXPECT_GT(reflections, 50u);
  EXPECT_GT(blocked, 100u);
}

TEST(Specular1, FoliageOnEitherLegCounts) {
  const Eigen::Vector3d s = direction(90, 30);
  auto walls = west_wall(20.0);
  walls.crown({-10, 0, 2 + 10 * std::tan(30 * kDegree)}, {2, 2, 2});
  const auto paths = traced(*make_specular1({}), *walls.build(), {s});
  ASSERT_EQ(paths[0].echoes.size(), 1u);
  EXPECT_EQ(paths[0].foliage_m, 0.0);
  // The traced leg ends 2 cm in front of the wall, so it passes the crown's centre within 2 cm: the chord is short of 4
  // m by 1e-4.
  EXPECT_NEAR(paths[0].echoes[0].foliage_m, 4.0, 2e-4);
}

}  // namespace
}  // namespace canyon::gnss
