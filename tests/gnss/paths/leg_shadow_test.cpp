#include "canyon/gnss/paths/diffraction/leg_shadow.h"

#include <cmath>
#include <complex>
#include <utility>

#include <gtest/gtest.h>

#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::WallScene;
using Complex = std::complex<double>;

constexpr double kShadowWave_m = 0.19;

/// Straight up from a place, to a satellite.
Complex share_upwards(const scene::Scene& scene, const Eigen::Vector3d& from, double least = 0.01,
                      double needed = 0.0) {
  GnssCounters counters;
  const MirroredLeg leg{.from_W = from, .towards_W = {0, 0, 1}, .wavelength_m = kShadowWave_m};
  return leg_share(leg, least, scene::SceneAt(scene), counters, needed);
}

/// The rectangle from (x1, y1) to (x2, y2) of z = 0.
std::unique_ptr<scene::Scene> screen(double x1, double y1, double x2, double y2) {
  return WallScene().wall({x1, y1, 0.0}, {x2 - x1, 0, 0}, {0, y2 - y1, 0}).build();
}

TEST(LegShadow, BesideALongEdgeItIsKnifeEdges) {
  const auto scene = screen(-800, -800, 0, 800);
  for (const double depth_m : {3.0, 20.0, 90.0}) {
    for (double x = -2.0; x < 2.0; x += 0.11) {
      const double detour_m = std::hypot(x, depth_m) - depth_m;
      const Complex edge = knife_edge_field(2.0 * std::sqrt(detour_m / kShadowWave_m));
      const Complex expected = x < 0.0 ? edge : 1.0 - edge;
      EXPECT_NEAR(std::abs(share_upwards(*scene, {x, 0, -depth_m}) - expected), 0.0, 0.02) << x << ", " << depth_m;
    }
  }
}

// Babinet: what a screen leaves and what its opening would let through are the whole together.
TEST(LegShadow, BehindARectangleItIsWhatTheRectangleWouldNotLetThrough) {
  const double depth_m = 40.0, per_m = std::sqrt(2.0 / (kShadowWave_m * depth_m));
  const auto slit = [&](double from, double to) {
    return std::conj((fresnel_integral(to * per_m) - fresnel_integral(from * per_m)) / Complex(1.0, 1.0));
  };
  for (const double x : {-3.0, -1.7, -0.9, 0.01, 0.6}) {
    for (const double y : {-2.0, -0.4, 0.02}) {
      const auto scene = screen(x, y, x + 2.5, y + 3.0);
      const Complex expected = 1.0 - slit(x, x + 2.5) * slit(y, y + 3.0);
      EXPECT_NEAR(std::abs(share_upwards(*scene, {0, 0, -depth_m}) - expected), 0.0, 0.03) << x << ", " << y;
    }
  }
}

// Left out is only what is too little.
TEST(LegShadow, WhatIsMoreThanNeededIsTheSame) {
  const auto scene = screen(-6, -4, 0, 9);
  int left_out = 0;
  for (double x = -4.0; x < 4.0; x += 0.17) {
    const Complex whole = share_upwards(*scene, {x, 0.3, -50.0});
    for (const double needed : {0.05, 0.3, 0.7, 0.99}) {
      const Complex found = share_upwards(*scene, {x, 0.3, -50.0}, 0.01, needed);
      const bool counts = std::abs(whole) > needed || found != 0.0;
      EXPECT_EQ(found, counts ? whole : Complex(0.0)) << x << ", " << needed;
      left_out += found == 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(left_out, 20) << "what is dark is not looked at closely";
}

TEST(LegShadow, AnEdgeInPiecesIsOne) {
  const auto whole = screen(-800, -800, 0, 800);
  const auto pieces =
      WallScene().wall({-800, -800, 0}, {800, 0, 0}, {0, 800, 0}).wall({-800, 0, 0}, {800, 0, 0}, {0, 800, 0}).build();
  for (const double y : {-3.0, -0.2, -0.008, -0.002, 0.0005, 0.004, 0.5})
    for (const double x : {-0.6, 0.001, 0.4})
      EXPECT_NEAR(std::abs(share_upwards(*pieces, {x, y, -20}) - share_upwards(*whole, {x, y, -20})), 0.0, 0.02)
          << x << ", " << y;
}

// Many short pieces each make little.
TEST(LegShadow, AnEdgeInManyPiecesIsOneWhateverMatters) {
  const auto whole = screen(-800, -50, 0, 50);
  WallScene cut;
  for (int k = -50; k < 50; ++k) cut.wall({-800, static_cast<double>(k), 0}, {800, 0, 0}, {0, 1, 0});
  const auto pieces = cut.build();
  for (const double least : {0.01, 0.1, 0.25})
    for (double x = -4.0; x < 4.0; x += 0.17)
      EXPECT_NEAR(std::abs(share_upwards(*pieces, {x, 0.3, -20}, least) - share_upwards(*whole, {x, 0.3, -20}, least)),
                  0.0, 0.02 + 0.5 * least)
          << x << ", " << least;
}

// Houses that share an edge have it twice. Whichever comes first, together they are one that reaches as far as both, at
// every place of the leg. The second one here is a roof that rises from the first, whose sides the first hides.
TEST(LegShadow, EdgesThatOverlapAreOne) {
  const auto twins = [](double y1, double y2, bool roof_first) {
    WallScene scene;
    for (const bool roof : {roof_first, !roof_first}) {
      if (roof)
        scene.wall({0, y1, 0}, {0, y2 - y1, 0}, {-60, 0, 30});
      else
        scene.wall({-800, -2, 0}, {800, 0, 0}, {0, 4, 0});
    }
    return scene.build();
  };
  const auto alone = screen(-800, -2, 0, 2);
  for (const auto& [y1, y2] : {std::pair{-0.7, 1.1}, std::pair{-1.5, 1.9}, std::pair{0.5, 5.0}}) {
    const auto one = twins(y1, y2, true), other = twins(y1, y2, false);
    for (const double y : {-3.0, -1.9, -0.5, 0.0, 1.0, 2.1, 4.0})
      for (const double x : {-1.3, -0.4, -0.002}) {
        const Complex expected = share_upwards(y2 > 2.0 ? *other : *alone, {x, y, -20});
        EXPECT_NEAR(std::abs(share_upwards(*one, {x, y, -20}) - expected), 0.0, 1e-3) << x << ", " << y << ", " << y1;
        EXPECT_NEAR(std::abs(share_upwards(*other, {x, y, -20}) - expected), 0.0, 1e-3) << x << ", " << y << ", " << y1;
      }
  }
}

TEST(LegShadow, ThreeQuartersAreLeftAtACorner) {
  EXPECT_NEAR(std::abs(share_upwards(*screen(1e-4, 1e-4, 600, 600), {0, 0, -20}) - 0.75), 0.0, 0.01);
}

TEST(LegShadow, IsContinuousAtTheBorderHoweverLittleMatters) {
  const auto scene = screen(-800, -800, 0, 800);
  for (const double least : {0.01, 0.2, 0.6, 1.2, 5.0})
    EXPECT_NEAR(std::abs(share_upwards(*scene, {1e-4, 0, -20}, least) - share_upwards(*scene, {-1e-4, 0, -20}, least)),
                0.0, 0.01)
        << least;
}

TEST(LegShadow, WhatCannotMatterIsNotLookedAt) {
  const auto scene = screen(-800, -800, 0, 800);
  EXPECT_EQ(share_upwards(*scene, {2, 0, -20}, 1.0), 1.0);
  EXPECT_EQ(share_upwards(*scene, {-2, 0, -20}, 1.0), 0.0);
  EXPECT_EQ(share_upwards(*scene, {9, 0, -20}, 0.2), 1.0);
  EXPECT_EQ(share_upwards(*scene, {0.5, 0, 20}), 1.0) << "it lies behind";
}

// From the image the way is straight: a roof's shadow is as wide as the whole way to it makes it.
TEST(LegShadow, CountsTheWayBeforeTheMirror) {
  const auto scene = screen(-800, -800, 0, 800);
  GnssCounters counters;
  for (const double x : {-1.0, -0.3, 0.4, 1.1}) {
    const MirroredLeg leg{.from_W = {x, 0, -10},
                          .towards_W = {0, 0, 1},
                          .length_m = 60.0,
                          .behind_m = 50.0,
                          .wavelength_m = kShadowWave_m};
    EXPECT_NEAR(std::abs(leg_share(leg, 0.01, scene::SceneAt(*scene), counters) - share_upwards(*scene, {x, 0, -60})),
                0.0, 1e-9)
        << x;
  }
}

TEST(LegShadow, AMirrorsOwnEdgesAreNotItsLegs) {
  const auto scene = WallScene().wall({-800, -800, 0}, {800, 0, 0}, {0, 1600, 0}).build();
  GnssCounters counters;
  MirroredLeg leg{.from_W = {0.2, 0, -1},
                  .towards_W = {0, 0, 1},
                  .length_m = 51.0,
                  .behind_m = 19.0,
                  .mirrors = {&scene->facets().facets().at(0), nullptr},
                  .wavelength_m = kShadowWave_m};
  EXPECT_EQ(leg_share(leg, 0.01, scene::SceneAt(*scene), counters), 1.0);
  // Nor is what stands behind another's plane.
  const auto higher = WallScene().wall({0, -800, 1}, {900, 0, 0}, {0, 1600, 0}).build();
  leg.mirrors[0] = &higher->facets().facets().at(0);
  EXPECT_EQ(leg_share(leg, 0.01, scene::SceneAt(*scene), counters), 1.0);
  leg.mirrors[0] = nullptr;
  EXPECT_GT(std::abs(leg_share(leg, 0.01, scene::SceneAt(*scene), counters) - 1.0), 0.1);
}

}  // namespace
}  // namespace canyon::gnss
