#include "canyon/study/statistics/cluster_bootstrap.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::study {
namespace {

std::vector<double> weighed_mean(const std::vector<double>& values, std::span<const double> times) {
  double sum = 0.0, count = 0.0;
  for (std::size_t c = 0; c < values.size(); ++c) {
    sum += times[c] * values[c];
    count += times[c];
  }
  return {sum / count};
}

/// Of a mean the percentiles are those of a normal law with the sample's own sigma / sqrt(n), but for the 1000
/// replicates: the 2.5 % point of so many has a 1-sigma of sqrt(0.025 * 0.975 / 1000) / 0.0584 = 0.085 sigma, of which
/// three are allowed.
TEST(ClusterBootstrap, OfAMeanIsItsStandardError) {
  constexpr std::size_t kClusters = 100;
  std::vector<double> values(kClusters);
  RandomStream(7, "test.clusters").fill_normal(values, 0, 0);
  double mean = 0.0, square = 0.0;
  for (const double v : values) mean += v / kClusters;
  for (const double v : values) square += (v - mean) * (v - mean) / kClusters;
  const double sigma = std::sqrt(square / kClusters);
  const auto intervals =
      cluster_bootstrap(kClusters, 1, [&](std::span<const double> times) { return weighed_mean(values, times); });
  ASSERT_EQ(intervals.size(), 1U);
  EXPECT_NEAR(intervals[0].low, mean - kNormal975 * sigma, 0.26 * sigma);
  EXPECT_NEAR(intervals[0].high, mean + kNormal975 * sigma, 0.26 * sigma);
}

TEST(ClusterBootstrap, FewClustersHaveNoInterval) {
  const auto one = [](std::span<const double>) { return std::vector<double>{1.0, 2.0}; };
  const auto intervals = cluster_bootstrap(kFewestClusters - 1, 1, one);
  ASSERT_EQ(intervals.size(), 2U);
  EXPECT_FALSE(intervals[0].defined());
  EXPECT_TRUE(cluster_bootstrap(kFewestClusters, 1, one)[1].defined());
}

TEST(ClusterBootstrap, InfiniteReplicatesAreLargeOnes) {
  // Cluster 0 stands in a replicate with probability 1 - (9/10)^10 = 0.65: the upper end is infinite, the lower is not.
  const auto intervals = cluster_bootstrap(10, 1, [](std::span<const double> times) {
    return std::vector<double>{times[0] > 0.0 ? std::numeric_limits<double>::infinity() : 1.0, kNaN};
  });
  EXPECT_EQ(intervals[0].low, 1.0);
  EXPECT_TRUE(std::isinf(intervals[0].high));
  EXPECT_TRUE(std::isnan(intervals[1].low)) << "without values there is no interval";
}

}  // namespace
}  // namespace canyon::study
