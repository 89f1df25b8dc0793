#include "canyon/gnss/paths/diffraction/diffraction.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/signal.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::direction;
using testing::WallScene;

const Eigen::Vector3d kEdgeAntenna(0.0, 0.0, 2.0);

SignalPaths trace(const scene::Scene& scene, const Eigen::Vector3d& s, const char* diffraction,
                  const PathParameters& p = {}, bool ground = false) {
  const auto model = make_propagation(find_model(path_models(), "visibility")->make({}, p),
                                      find_model(diffraction_models(), diffraction)->make({}, p), ground, p);
  std::vector<SignalPaths> out(1);
  GnssCounters counters;
  model->trace(kEdgeAntenna, std::vector{s}, scene::SceneAt(scene), out, counters);
  return out[0];
}

// Abramowitz & Stegun, table 7.7 (argument of the same definition), to their seven digits.
TEST(KnifeEdge, FresnelIntegralsOfTheTable) {
  const double table[][3] = {{0.5, 0.4923442, 0.0647324}, {1.0, 0.7798934, 0.4382591}, {1.5, 0.4452612, 0.6975050},
                             {2.0, 0.4882534, 0.3434157}, {3.0, 0.6057208, 0.4963130}, {5.0, 0.5636312, 0.4991914}};
  for (const auto& row : table) {
    const auto v = fresnel_integral(row[0]);
    EXPECT_NEAR(v.real(), row[1], 5e-8) << row[0];
    EXPECT_NEAR(v.imag(), row[2], 5e-8) << row[0];
    EXPECT_EQ(fresnel_integral(-row[0]), -v);
  }
  // Series and continued fraction meet: the step there is the integrand's own.
  const auto step = fresnel_integral(2.0) - fresnel_integral(2.0 - 1e-9);
  EXPECT_NEAR(std::abs(step - std::polar(1e-9, 0.5 * kPi * 4.0)), 0.0, 1e-11);
}

// How many terms and levels are taken changes no bit: the same sums with many more.
TEST(KnifeEdge, FresnelIntegralsEndWhereNothingChanges) {
  using Complex = std::complex<double>;
  const auto series = [](double x) {
    Complex power = x, sum = 0.0;
    for (int n = 0; n < 60; ++n) {
      sum += power / (2.0 * n + 1.0);
      power *= Complex(0.0, 0.5 * kPi * x * x) / (n + 1.0);
    }
    return sum;
  };
  const auto fraction = [](double x) {
    const Complex z = 0.5 * std::sqrt(kPi) * Complex(1.0, -1.0) * x;
    Complex tail = z;
    for (int n = 120; n >= 1; --n) tail = z + 0.5 * n / tail;
    return 0.5 * Complex(1.0, 1.0) * (1.0 - std::exp(-z * z) / (std::sqrt(kPi) * tail));
  };
  for (double x = 1e-6; x < 1e3; x *= 1.0007) EXPECT_EQ(fresnel_integral(x), x < 2.0 ? series(x) : fraction(x)) << x;
}

// P.526-15 eq. 31 approximates the loss for nu > -0.78; the Recommendation's own figure shows both within a line's
// width.
TEST(KnifeEdge, LossFollowsTheRecommendation) {
  EXPECT_NEAR(std::abs(knife_edge_field(0.0)), 0.5, 1e-15);
  for (double nu = -0.7; nu < 10.0; nu += 0.1) {
    const double j_db = 6.9 + 20.0 * std::log10(std::sqrt((nu - 0.1) * (nu - 0.1) + 1.0) + nu - 0.1);
    EXPECT_NEAR(-20.0 * std::log10(std::abs(knife_edge_field(nu))), j_db, 0.35) << nu;
  }
  EXPECT_NEAR(std::abs(knife_edge_field(20.0)) * 20.0, 1.0 / (kPi * std::sqrt(2.0)), 1e-3);
  EXPECT_NEAR(std::abs(knife_edge_field(-30.0)), 1.0, 0.01);
}

/// A house whose roof edge stands `above_m` higher than the antenna, 20 m to the west.
WallScene house(double above_m) {
  return WallScene().box({-40, -500, 0}, {-20, 500, 2.0 + above_m});
}

TEST(Diffraction, RoofEdgeHasTheClosedForm) {
  const auto scene = house(20.0).build();  // the edge is 45 deg high, 28.28 m away
  const double distance_m = std::sqrt(800.0);
  for (const double below_deg : {0.5, 1.0, 2.0, 4.0}) {
    const auto sharp = trace(*scene, direction(270, 45.0 - below_deg), "none");
    EXPECT_TRUE(sharp.echoes.empty());
    const auto paths = trace(*scene, direction(270, 45.0 - below_deg), "knife_edge");
    EXPECT_FALSE(paths.line_of_sight);
    EXPECT_EQ(std::abs(paths.direct), 0.0);
    ASSERT_EQ(paths.echoes.size(), 1u) << below_deg;
    const SignalPath& e = paths.echoes[0];
    const double detour_m = distance_m * (1.0 - std::cos(below_deg * kDegree));
    EXPECT_NEAR(e.excess_m, detour_m, 1e-9);
    EXPECT_EQ(e.diffractions, 1);
    EXPECT_EQ(e.reflections, 0);
    EXPECT_EQ(std::abs(e.crosspolar), 0.0);
    EXPECT_NEAR(std::abs(e.copolar), std::abs(knife_edge_field(2.0 * std::sqrt(detour_m / kL1WavelengthM))), 1e-9);
    // 3 cm outside of the edge.
    EXPECT_NEAR((e.arrival_W - direction(270, 45)).norm(), 0.0, 0.03 / distance_m);
  }
}

TEST(Diffraction, FieldIsHalfOnBothSidesOfTheShadowsBorder) {
  const auto scene = house(20.0).build();
  const auto dark = trace(*scene, direction(270, 44.99), "knife_edge");
  ASSERT_EQ(dark.echoes.size(), 1u);
  // nu = 0.022: the slope of the field is 1 / sqrt 2 per nu.
  EXPECT_NEAR(std::abs(dark.echoes[0].copolar), 0.5, 0.02);
  const auto lit = trace(*scene, direction(270, 45.01), "knife_edge");
  EXPECT_TRUE(lit.line_of_sight);
  EXPECT_TRUE(lit.echoes.empty());
  EXPECT_NEAR(std::abs(lit.direct), 0.5, 0.02);
  // Phase of the whole: continuous too.
  const double turned = 2.0 * kPi * dark.echoes[0].excess_m / kL1WavelengthM;
  EXPECT_NEAR(std::abs(lit.direct - dark.echoes[0].copolar * std::polar(1.0, -turned)), 0.0, 0.04);
  EXPECT_NEAR(std::abs(trace(*scene, direction(270, 80), "knife_edge").direct), 1.0, 1e-15);
}

// The bend is where the way is stationary along the edge.
TEST(Diffraction, ObliqueWaysObeyFermat) {
  const auto scene = house(20.0).build();
  const Eigen::Vector3d s = direction(245, 40.0);
  const auto paths = trace(*scene, s, "knife_edge");
  ASSERT_EQ(paths.echoes.size(), 1u);
  const auto detour = [&](double y) {
    const Eigen::Vector3d way = Eigen::Vector3d(-20, y, 22) - kEdgeAntenna;
    return way.norm() - way.dot(s);
  };
  double least = 1e9;
  for (double y = -100; y < 100; y += 1e-3) least = std::min(least, detour(y));
  EXPECT_NEAR(paths.echoes[0].excess_m, least, 1e-6);
}

TEST(Diffraction, CornersBendTooAndRowHousesHaveNone) {
  const auto tower = WallScene().box({-40, -20, 0}, {-20, 0.5, 200}).build();
  const auto paths = trace(*tower, direction(270.5, 20), "knife_edge");  // 0.33 m inside the shadow
  EXPECT_FALSE(paths.line_of_sight);
  ASSERT_EQ(paths.echoes.size(), 1u);
  EXPECT_NEAR(std::abs(paths.echoes[0].copolar),
              std::abs(knife_edge_field(knife_edge_nu(paths.echoes[0].excess_m, kL1WavelengthM))), 1e-12);
  EXPECT_GT(paths.echoes[0].arrival_W.y(), 0.0);
  // The neighbour goes on from there: the corner is inside of the row, only its far end is open.
  auto row = WallScene().box({-40, -20, 0}, {-20, 0.5, 200});
  row.box({-40, 0.5, 0}, {-20, 60, 200});
  EXPECT_TRUE(trace(*row.build(), direction(270.5, 20), "knife_edge").echoes.empty());
}

TEST(Diffraction, TwoEdges) {
  // A low house near, a higher one behind it: the first edge itself lies in the second's shadow.
  auto houses = WallScene().box({-14, -300, 0}, {-10, 300, 7.5});
  houses.box({-60, -300, 0}, {-50, 300, 29.0});
  const auto scene = houses.build();
  const Eigen::Vector3d s = direction(270, 28.0);
  PathParameters p;
  p.weakest_nlos_db = -60.0;
  EXPECT_TRUE(trace(*scene, direction(270, 27.0), "none", p).echoes.empty());
  const auto twice = trace(*scene, s, "double_knife_edge", p);
  ASSERT_FALSE(twice.line_of_sight);
  const SignalPath* path = nullptr;
  for (const SignalPath& e : twice.echoes)
    if (e.diffractions == 2) path = &e;
  ASSERT_NE(path, nullptr);
  const Eigen::Vector3d near(-10, 0, 7.5), far(-50, 0, 29.0);
  // Level with its roof's west edge, the wave passes the high house over its east edge.
  const double whole_m = (near - kEdgeAntenna).norm() + (far - near).norm() - (far - kEdgeAntenna).dot(s);
  EXPECT_NEAR(path->excess_m, whole_m, 0.02);  // legs pass 3 cm outside of the edges
  EXPECT_LT(std::abs(path->copolar), 0.5);
  for (const SignalPath& e : trace(*scene, s, "knife_edge", p).echoes) EXPECT_EQ(e.diffractions, 1);
}

// A low house whose roof rises through the line from the antenna to the high one's roof, which hides the satellite. All
// echoes together are the field over the far edge times that over the near one, on both sides of the line and through
// it.
TEST(Diffraction, TwoEdgesAddUpOnBothSidesOfTheLine) {
  const Eigen::Vector3d s = direction(270, 28.0);
  const Eigen::Vector3d far(-50, 0, 2.0 + 50.0 * std::tan(28.4 * kDegree));
  // P.526-15 section 4.2: the far edge's loss as the near edge sees it, where that cuts the way off.
  const auto over_far = [&](const Eigen::Vector3d& from) {
    return knife_edge_field(knife_edge_nu((far - from).norm() - (far - from).dot(s), kL1WavelengthM));
  };
  PathParameters p;
  p.weakest_nlos_db = -60.0;
  // Not within half a centimetre of the line: legs are tested 3 cm outside of the far edge.
  for (double elevation_deg = 27.45; elevation_deg < 29.5; elevation_deg += 0.1) {
    const Eigen::Vector3d near(-10, 0, 2.0 + 10.0 * std::tan(elevation_deg * kDegree));
    const auto scene =
        WallScene().box({-14, -300, 0}, {-10, 300, near.z()}).box({-60, -300, 0}, {-50, 300, far.z()}).build();
    std::complex<double> sum = 0.0;
    for (const SignalPath& e : trace(*scene, s, "double_knife_edge", p).echoes)
      sum += e.copolar * std::polar(1.0, -2.0 * kPi * e.excess_m / kL1WavelengthM);
    const double more_m = (far - near).norm() + (near - kEdgeAntenna).norm() - (far - kEdgeAntenna).norm();
    const double nu = std::copysign(knife_edge_nu(more_m, kL1WavelengthM), elevation_deg - 28.4);
    // The roofs' far sides are edges too, at 14 and 60 m; level roofs hide them from below but for their ripples.
    EXPECT_LT(std::abs(sum - over_far(nu > 0.0 ? near : kEdgeAntenna) * knife_edge_field(nu)), 0.02) << elevation_deg;
  }
}

TEST(GroundReflection, LevelGroundHasTheClosedForm) {
  scene::SceneParts parts;
  parts.frame = LocalFrame(Geodetic{testing::kVicksburgLat, testing::kVicksburgLon, 60.0});
  parts.materials = scene::builtin_materials();
  parts.objects.push_back({"ground", scene::ObjectKind::kTerrain});
  std::uint16_t grass = 0;
  while (parts.materials[grass].name != "grass") ++grass;
  for (const auto& [x, y] : {std::pair{-200, -200}, {200, -200}, {200, 200}, {-200, 200}})
    parts.mesh.vertices.push_back(
        Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), 0.1F * static_cast<float>(x)));
  parts.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  parts.mesh.material = {grass, grass};
  parts.mesh.object = {0, 0};
  const scene::Scene scene(parts);
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.1, 0, 1).normalized();
  for (const double elevation_deg : {10.0, 30.0, 60.0, 90.0}) {
    for (const double azimuth_deg : {0.0, 90.0, 200.0}) {
      const Eigen::Vector3d s = direction(azimuth_deg, elevation_deg);
      const auto paths = trace(scene, s, "none", {}, true);
      ASSERT_EQ(paths.echoes.size(), 1u) << azimuth_deg << " " << elevation_deg;
      const SignalPath& e = paths.echoes[0];
      const double height_m = normal.z() * 2.0, cosine = normal.dot(s);
      EXPECT_NEAR(e.excess_m, 2.0 * height_m * cosine, 1e-6);
      EXPECT_EQ(e.facets[0], SignalPath::kTerrain);
      const Fresnel f = fresnel(parts.materials[grass].permittivity(kL1Hz), std::acos(std::min(cosine, 1.0)));
      const double rough = roughness_factor(parts.materials[grass].roughness_m, cosine, kL1WavelengthM);
      EXPECT_NEAR(std::abs(e.copolar - rough * f.co), 0.0, 1e-6);
      EXPECT_NEAR(std::abs(e.crosspolar - rough * f.cross), 0.0, 1e-6);
      // Arrives from the mirrored direction.
      EXPECT_NEAR((e.arrival_W - (s - 2.0 * cosine * normal)).norm(), 0.0, 1e-5);
    }
  }
  // Past the end of the terrain there is nothing to reflect.
  EXPECT_TRUE(trace(scene, direction(0, 0.1), "none", {}, true).echoes.empty());
}

}  // namespace
}  // namespace canyon::gnss
