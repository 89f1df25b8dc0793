// The brightness of places on surfaces against the law that it is made of.
#include "canyon/lidar/beam/texture/value_noise.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::lidar {
namespace {

constexpr double kSpread = 0.2, kGrain_m = 0.5;
constexpr auto kPerMetre = static_cast<float>(1.0 / kGrain_m);

double widest_of(double spread) {
  scene::Material m;
  m.lidar_spread = spread;
  return m.widest();
}

/// (2/3)^3 of the corners' variance is left between them, and E[(sum w^2)^2] = (7/15)^3, E[sum w^4] = (2/5)^3: of
/// corners that are uniform (fourth moment 9/5 of the squared variance) the kurtosis is
/// (3 (7/15)^3 - 6/5 (2/5)^3) / (2/3)^6.
double kurtosis() {
  return (3.0 * std::pow(7.0 / 15.0, 3) - 1.2 * std::pow(0.4, 3)) / std::pow(2.0 / 3.0, 6);
}

/// A plane of many independent places, turned somehow.
struct Sheet {
  const char* name;
  Eigen::Vector3d corner, right, up;
};
std::vector<Sheet> sheets() {
  const Eigen::Matrix3d turned = rotation_from({.yaw_rad = 0.7, .pitch_rad = 0.2, .roll_rad = -0.4}).toRotationMatrix();
  return {{"level ground", {-200, -300, 0}, {1, 0, 0}, {0, 1, 0}},
          {"a wall that looks east", {40, -300, 0}, {0, 1, 0}, {0, 0, 1}},
          {"a wall that looks north, 9 km off", {9000, 7000, 2}, {1, 0, 0}, {0, 0, 1}},
          {"a roof", {3, 5, 9}, turned.col(0), turned.col(1)}};
}

constexpr std::size_t kSide = 200;
/// Places four grains apart, more than sqrt(3): no two share a corner.
std::vector<double> factors(const Sheet& sheet, double spread, std::uint32_t key) {
  std::vector<double> out;
  for (std::size_t a = 0; a < kSide; ++a)
    for (std::size_t b = 0; b < kSide; ++b)
      out.push_back(double{vary(
          sheet.corner + 4.0 * kGrain_m * (static_cast<double>(a) * sheet.right + static_cast<double>(b) * sheet.up),
          static_cast<float>(widest_of(spread)), kPerMetre, key)});
  return out;
}

TEST(ValueNoise, MeanAndSpreadAreAsAskedOnAnyPlane) {
  for (const Sheet& sheet : sheets()) {
    for (const double spread : {0.05, kSpread, 0.3}) {
      const std::vector<double> all = factors(sheet, spread, 17);
      const auto n = static_cast<double>(all.size());
      double sum = 0, squares = 0;
      for (const double f : all) {
        sum += f - 1.0, squares += (f - 1.0) * (f - 1.0);
        EXPECT_GE(f, 1.0 - widest_of(spread) - 1e-6);
        EXPECT_LE(f, 1.0 + widest_of(spread) + 1e-6);
        EXPECT_GE(f, 0.0);
      }
      // 4.5 sigma: false alarm 7e-6 each, 24 looks.
      EXPECT_NEAR(sum / n, 0.0, 4.5 * spread / std::sqrt(n)) << sheet.name << ' ' << spread;
      EXPECT_NEAR(squares / n, spread * spread, 4.5 * spread * spread * std::sqrt((kurtosis() - 1.0) / n))
          << sheet.name << ' ' << spread;
    }
  }
}

TEST(ValueNoise, PlacesApartThingsAndGrainsHaveNothingInCommon) {
  const Sheet wall = sheets()[1];
  const std::vector<double> one = factors(wall, kSpread, 17), other = factors(wall, kSpread, 18);
  const auto n = static_cast<double>(one.size());
  double of_neighbours = 0, of_things = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    of_things += (one[i] - 1.0) * (other[i] - 1.0);
    of_neighbours += (one[i] - 1.0) * (one[(i + 1) % one.size()] - 1.0);
  }
  // A product of independents has the standard deviation spread^2; 4.5 sigma.
  EXPECT_NEAR(of_things / n, 0.0, 4.5 * kSpread * kSpread / std::sqrt(n));
  EXPECT_NEAR(of_neighbours / n, 0.0, 4.5 * kSpread * kSpread / std::sqrt(n));
}

/// Between corners it is linear along the cubes: two places h apart differ by no more than 2 widest sqrt(3) h / grain.
TEST(ValueNoise, ItIsContinuous) {
  const auto widest = static_cast<float>(widest_of(0.3));
  const RandomStream draw(5, "test.places");
  for (std::uint64_t k = 0; k < 20000; ++k) {
    const Eigen::Vector3d p(400.0 * draw.normal3(k)), q = p + 1e-4 * draw.direction(7, k);
    EXPECT_NEAR(vary(p, widest, kPerMetre, 3), vary(q, widest, kPerMetre, 3),
                2.0 * double{widest} * std::sqrt(3.0) * 1e-4 / kGrain_m + 8.0 * 0x1p-24);
  }
}

TEST(ValueNoise, SixteenPlacesAreToTheBitWhatEachIs) {
  const RandomStream draw(6, "test.places");
  for (std::uint64_t k = 0; k < 500; ++k) {
    Places places;
    Grains grains;
    float factor[16];
    for (std::uint32_t i = 0; i < 16; ++i) {
      places.x[i] = 3000.0 * draw.normal(i, k, 0), places.y[i] = 3000.0 * draw.normal(i, k, 1);
      places.z[i] = 30.0 * draw.normal(i, k, 2);
      grains.widest[i] = static_cast<float>(widest_of(0.1 * (i % 4)));
      grains.per_m[i] = i % 3 == 0 ? 10.0f : 1.0f;
      grains.key[i] = i * 977u;
    }
    vary(places, grains, factor);
    for (std::size_t i = 0; i < 16; ++i) {
      EXPECT_EQ(factor[i],
                vary({places.x[i], places.y[i], places.z[i]}, grains.widest[i], grains.per_m[i], grains.key[i]));
      if (i % 4 == 0) {
        EXPECT_EQ(factor[i], 1.0f) << "what has no spread is uniform";
      }
    }
  }
}

}  // namespace
}  // namespace canyon::lidar
