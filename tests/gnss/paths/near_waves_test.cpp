#include "canyon/gnss/paths/rows/near_waves.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::gnss {
namespace {

Eigen::Vector3d direction(const RandomStream& draws, std::uint32_t i) {
  return draws.normal3(i).normalized();
}

// Every pair that double precision finds, in order, and of those that it does not only what lies within rounding.
TEST(NearWaves, FindsEveryPairThatDoublePrecisionFinds) {
  const RandomStream wave_draws(3, "near_waves.wave"), axis_draws(3, "near_waves.axis");
  NearWaves near;  // filled anew, with fewer and with more
  for (const std::size_t count : {64, 1, 7, 31, 32, 33, 130}) {
    std::vector<Eigen::Vector3d> waves;
    for (std::uint32_t i = 0; i < count; ++i) waves.push_back(direction(wave_draws, i));
    std::vector<Eigen::Vector3d> axes;
    std::vector<double> least;
    WaveAxes columns;
    for (std::uint32_t i = 0; i < 3000; ++i) {
      const double length = std::pow(10.0, 4.0 * axis_draws.uniform(i, 3));
      axes.emplace_back(length * direction(axis_draws, i));
      // At what one of the waves just reaches, in cones of any width, and in narrow ones.
      const double share = axis_draws.uniform(i, 4);
      least.push_back(i % 3 == 0   ? axes.back().dot(waves[i % count])
                      : i % 3 == 1 ? length * (2.0 * share - 1.0)
                                   : length * (1.0 - std::pow(10.0, -6.0 * share)));
      columns.add(axes.back(), length, least.back());
    }
    near.fill(waves);
    std::vector<AxisAndWave> found;
    near.find(columns, found);
    std::size_t at = 0;
    for (std::uint32_t a = 0; a < axes.size(); ++a) {
      for (std::uint32_t w = 0; w < count; ++w) {
        const double over = axes[a].dot(waves[w]) - least[a];
        const bool is_found = at < found.size() && found[at].axis == a && found[at].wave == w;
        if (!is_found) {
          ASSERT_LT(over, 0.0) << a << " " << w;
          continue;
        }
        EXPECT_GE(over, -2.0 * WaveAxes::kRounding * axes[a].norm());
        ++at;
      }
    }
    EXPECT_EQ(at, found.size());
  }
}

TEST(NearWaves, NoWaveIsNearAnythingAndNoAxisNearAWave) {
  WaveAxes columns;
  columns.add(Eigen::Vector3d::UnitZ(), 1.0, -1.0);
  NearWaves near;
  near.fill({});
  std::vector<AxisAndWave> found{{7, 7}};
  near.find(columns, found);
  EXPECT_TRUE(found.empty());
  const std::vector<Eigen::Vector3d> waves(9, Eigen::Vector3d::UnitZ());
  near.fill(waves);
  columns.clear();
  found.push_back({7, 7});
  near.find(columns, found);
  EXPECT_TRUE(found.empty());
}

TEST(NearWaves, AnAxisWithoutLengthIsNearAll) {
  WaveAxes columns;
  columns.add(Eigen::Vector3d::Zero(), 0.0, 0.0);
  const std::vector<Eigen::Vector3d> waves(9, Eigen::Vector3d::UnitZ());
  NearWaves near;
  near.fill(waves);
  std::vector<AxisAndWave> found;
  near.find(columns, found);
  EXPECT_EQ(found.size(), waves.size());
}

}  // namespace
}  // namespace canyon::gnss
