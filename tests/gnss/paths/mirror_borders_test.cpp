#include "canyon/gnss/paths/diffraction/mirror_borders.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/diffraction/wedge.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::direction;
using testing::WallScene;
using Complex = std::complex<double>;

constexpr double kWave_m = 0.19;

/// The rectangle from (x1, y1) to (x2, y2) of z = 0, which faces up.
std::unique_ptr<scene::Scene> plate(double x1, double y1, double x2, double y2) {
  return WallScene().wall({x1, y1, 0.0}, {x2 - x1, 0, 0}, {0, y2 - y1, 0}).build();
}

/// Straight down onto the origin, the image so far below.
Complex share_at_origin(const scene::Scene& scene, double depth_m, double least = 0.0) {
  const scene::Facet& facet = scene.facets().facets().at(0);
  const Eigen::Vector3d at = Eigen::Vector3d::Zero();
  return mirrored_share(facet, scene::facet_contains(facet, scene, at), {{0, 0, -depth_m}, {0, 0, 1}, at, kWave_m},
                        least);
}

/// Fresnel's integral over x1 to x2 of an aperture in one direction.
Complex slit(double x1, double x2, double depth_m) {
  const double per_m = std::sqrt(2.0 / (kWave_m * depth_m));
  return std::conj((fresnel_integral(x2 * per_m) - fresnel_integral(x1 * per_m)) / Complex(1.0, 1.0));
}

TEST(MirroredShare, IsTheProductOfTwoSlitsForARectangle) {
  for (const double depth_m : {5.0, 40.0, 300.0}) {
    for (const double x1 : {-20.0, -3.0, -0.4, 0.7, 4.0}) {
      for (const double y1 : {-8.0, -1.0, 0.3}) {
        for (const double wide_m : {2.0, 4.0, 30.0}) {
          const double x2 = x1 + wide_m, y2 = y1 + 0.6 * wide_m;
          // Fresnel's approximation wants small angles.
          if (std::max({std::abs(x1), std::abs(x2), std::abs(y1), std::abs(y2)}) > 0.15 * depth_m) continue;
          const Complex expected = slit(x1, x2, depth_m) * slit(y1, y2, depth_m);
          const Complex found = share_at_origin(*plate(x1, y1, x2, y2), depth_m);
          EXPECT_NEAR(std::abs(found - expected), 0.0, 0.01)
              << "depth " << depth_m << ", from " << x1 << ", " << y1 << ", " << wide_m << " m wide";
        }
      }
    }
  }
}

TEST(MirroredShare, HalfAtASideAndAQuarterAtACorner) {
  EXPECT_NEAR(std::abs(share_at_origin(*plate(0, -600, 600, 600), 20.0) - 0.5), 0.0, 0.005);
  EXPECT_NEAR(std::abs(share_at_origin(*plate(-1e-4, -1e-4, 600, 600), 20.0) - 0.25), 0.0, 0.005);
  EXPECT_NEAR(std::abs(share_at_origin(*plate(-600, -600, 600, 600), 20.0) - 1.0), 0.0, 0.01);
}

TEST(MirroredShare, OfASmallPlateIsItsAreaOverWavelengthAndDistance) {
  const double depth_m = 200.0;
  EXPECT_NEAR(std::abs(share_at_origin(*plate(-1, -1, 1, 1), depth_m)), 4.0 / (kWave_m * depth_m), 5e-3);
}

// Its sides cancel out but for little, so that none may go for being short; of those that are far off each leaves out
// `least` at most.
TEST(MirroredShare, WhatIsLeftOutOfASmallPlateIsLittle) {
  const double depth_m = 40.0;
  for (const double wide_m : {1.5, 2.0, 3.0, 5.0}) {
    for (double aside_m = 0.0; aside_m < 12.0; aside_m += 0.13) {
      const auto scene = plate(aside_m - 0.5 * wide_m, -0.5 * wide_m, aside_m + 0.5 * wide_m, 0.5 * wide_m);
      const Complex whole = share_at_origin(*scene, depth_m);
      for (const double least : {0.05, 0.1})
        EXPECT_NEAR(std::abs(share_at_origin(*scene, depth_m, least) - whole), 0.0,
                    wide_m < 2.5 && aside_m < 0.1 ? 1e-12 : 4.0 * least)
            << wide_m << " m wide, " << aside_m << " m aside, " << least;
    }
  }
}

TEST(MirroredShare, IsNoMoreThanTheMostThatIsSaidOfIt) {
  double nearest = 10.0;
  for (const double wide_m : {1.5, 3.0, 12.0, 40.0}) {
    for (const double depth_m : {4.0, 60.0, 400.0}) {
      for (double x = -3.0; x < 3.0; x += 0.23) {
        const auto scene = plate(x, x - 0.4 * wide_m, x + wide_m, x + 0.7 * wide_m);
        const scene::Facet& facet = scene->facets().facets().at(0);
        const Eigen::Vector3d at = Eigen::Vector3d::Zero();
        const MirroredWave wave{{0, 0, -depth_m}, {0, 0, 1}, at, kWave_m};
        const bool holds = scene::facet_contains(facet, *scene, at);
        for (const double least : {0.0, 0.05}) {
          const double share = std::abs(mirrored_share(facet, holds, wave, least));
          const double most = most_mirrored(facet, holds, wave, least);
          EXPECT_LE(share, most + 1e-12) << wide_m << " m wide, " << depth_m << " m, " << x << ", " << least;
          EXPECT_LE(share, kMostMirrored);
          if (share > 0.1) nearest = std::min(nearest, most / share);
        }
      }
    }
  }
  EXPECT_LT(nearest, 1.1) << "it says no more than it must";
}

TEST(MirroredShare, HasTheBordersOfItsFacetAlone) {
  const auto scene = WallScene().box({0, 0, 0}, {10, 20, 30}).build();
  for (const scene::Facet& facet : scene->facets().facets()) {
    ASSERT_EQ(facet.borders.size(), 4u);
    for (const scene::FacetBorder& side : facet.borders) {
      const Eigen::Vector3d inward = facet.normal_W.cross(side.to_W - side.from_W);
      EXPECT_GT(inward.dot(facet.center_W - side.from_W), 0.0);
    }
  }
}

TEST(MirroredShare, SidesAreFiniteEdges) {
  for (const double nu : {0.0, 1e-7, 0.01, 0.4, 2.3, 9.99, 10.01, 40.0})
    for (const double u1 : {-30.0, -2.0, -0.1, 0.3, 4.0})
      for (const double wide : {0.01, 0.5, 3.0, 50.0})
        EXPECT_NEAR(std::abs(finite_edge_field(nu, u1, u1 + wide) -
                             knife_edge_field(nu) * finite_edge_factor(nu, u1, u1 + wide)),
                    0.0, 2e-4)
            << nu << ", " << u1 << " to " << u1 + wide;
}

TEST(MirroredShare, BeyondItsLargestNuASideIsTooWeak) {
  for (const double weakest_db : {-3.0, -14.0, -20.0, -26.0, -40.0}) {
    const double nu = largest_border_nu(weakest_db),
                 weakest = std::max(std::pow(10.0, weakest_db / 20.0), kFaintestBorder);
    for (double beyond = 1.0; beyond < 20.0; beyond *= 1.01)
      EXPECT_LE(std::abs(knife_edge_field(nu * beyond)), weakest) << weakest_db << " dB, nu " << nu * beyond;
    if (weakest_db > -10.0) continue;
    EXPECT_GT(std::abs(knife_edge_field(0.9 * nu)), weakest) << "it looks no farther than it must";
  }
}

TEST(MirroredShare, NearestPointOfTheBorder) {
  const auto scene = plate(0, 0, 10, 6);
  const scene::Facet& facet = scene->facets().facets().at(0);
  EXPECT_LT((nearest_of_border(facet, {12, 3, 0}) - Eigen::Vector3d(10, 3, 0)).norm(), 1e-9);
  EXPECT_LT((nearest_of_border(facet, {-3, -4, 0}) - Eigen::Vector3d(0, 0, 0)).norm(), 1e-9);
}

PathParameters with_borders() {
  PathParameters p;
  p.cutoff_m = 1000.0;
  p.weakest_db = p.weakest_nlos_db = -26.0;
  p.reflection_borders = true;
  return p;
}

/// Field of all echoes together, their longer ways' phases in it.
Complex echoes_at(const PathModel& model, const scene::Scene& scene, const Eigen::Vector3d& s,
                  const Eigen::Vector3d& p) {
  std::vector<SignalPaths> out(1);
  GnssCounters counters;
  model.trace(p, std::vector<Eigen::Vector3d>{s}, scene::SceneAt(scene), out, counters);
  Complex sum = 0.0;
  for (const SignalPath& path : out[0].echoes)
    sum += path.crosspolar * std::polar(1.0, -2.0 * kPi * path.excess_m / kWave_m);
  return sum;
}

/// Largest change of the echoes' field from millimetre to millimetre on a straight way of 24 m north.
double largest_step(const PathModel& model, const scene::Scene& scene, const Eigen::Vector3d& s) {
  Complex before = echoes_at(model, scene, s, {0.0, -12.0, 2.0});
  double largest = 0.0;
  for (int i = 1; i <= 24'000; ++i) {
    const Complex now = echoes_at(model, scene, s, {0.0, -12.0 + 1e-3 * i, 2.0});
    largest = std::max(largest, std::abs(now - before));
    before = now;
  }
  return largest;
}

// A millimetre makes a way 2 mm longer at most, which turns a field below 1 by 2 pi 2 mm / 0.19 m = 0.066.
TEST(ReflectionBorders, OneReflectionIsContinuous) {
  const auto scene = WallScene().box({-22, -6, 0}, {-12, 5, 9}).build();
  const auto model = make_specular1(with_borders());
  for (const auto& [azimuth_deg, elevation_deg] : {std::pair{60.0, 15.0}, {90.0, 28.0}, {130.0, 25.0}})
    EXPECT_LT(largest_step(*model, *scene, direction(azimuth_deg, elevation_deg)), 0.07) << azimuth_deg;
  PathParameters sharp = with_borders();
  sharp.reflection_borders = false;
  EXPECT_GT(largest_step(*make_specular1(sharp), *scene, direction(90.0, 15.0)), 0.2);
}

TEST(ReflectionBorders, TwoReflectionsAreContinuous) {
  const auto scene = WallScene().box({-22, -6, 0}, {-12, 5, 9}).box({9, -7, 0}, {14, 4, 14}).build();
  PathParameters sharp = with_borders();
  sharp.reflection_borders = false;
  EXPECT_LT(largest_step(*make_specular2(with_borders()), *scene, direction(275.0, 50.0)), 0.07);
  EXPECT_GT(largest_step(*make_specular2(sharp), *scene, direction(275.0, 50.0)), 0.2);
}

// A box before the satellite's leg, before the antenna's, and over both.
TEST(ReflectionBorders, ShadowsOverALegAreContinuous) {
  PathParameters sharp = with_borders();
  sharp.reflection_borders = false;
  const auto mirror = WallScene().box({-22, -60, 0}, {-12, 60, 30});
  for (const auto& [low, high] : {std::pair{Eigen::Vector3d(4, -3, 0), Eigen::Vector3d(8, 3, 20)},
                                  {Eigen::Vector3d(-8, -1, 0), Eigen::Vector3d(-6, 1, 8)},
                                  {Eigen::Vector3d(-8, -1, 0), Eigen::Vector3d(-6, 1, 12)}}) {
    const auto scene = WallScene(mirror).box(low, high).build();
    for (const double azimuth_deg : {90.0, 75.0}) {
      const Eigen::Vector3d s = direction(azimuth_deg, 20.0);
      EXPECT_LT(largest_step(*make_specular1(with_borders()), *scene, s), 0.07)
          << low.transpose() << ", " << azimuth_deg;
      EXPECT_GT(largest_step(*make_specular1(sharp), *scene, s), 0.2) << low.transpose() << ", " << azimuth_deg;
    }
  }
}

TEST(ReflectionBorders, WallsSideBySideAreOne) {
  const auto whole = WallScene().wall({-12, -9, 0}, {0, 18, 0}, {0, 0, 12}).build();
  const auto parts =
      WallScene().wall({-12, -9, 0}, {0, 10, 0}, {0, 0, 12}).wall({-12, 1, 0}, {0, 8, 0}, {0, 0, 12}).build();
  PathParameters all = with_borders();
  all.weakest_db = all.weakest_nlos_db = -40.0;
  const auto model = make_specular1(all);
  for (double y = -14.0; y < 14.0; y += 0.37) {
    const Eigen::Vector3d p(0.0, y, 2.0), s = direction(80.0, 20.0);
    EXPECT_NEAR(std::abs(echoes_at(*model, *whole, s, p) - echoes_at(*model, *parts, s, p)), 0.0, 0.02) << y;
  }
}

}  // namespace
}  // namespace canyon::gnss
