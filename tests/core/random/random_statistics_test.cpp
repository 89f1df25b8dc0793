// Statistical tests of the random streams. The seeds are fixed, so a test passes always or never; the false-alarm rate
// stated is the chance that a perfect generator would have failed with the seed we happened to take.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon {
namespace {

std::vector<double> normals(const RandomStream& stream, std::size_t count, std::uint32_t entity = 0,
                            std::uint32_t n = 0, std::uint64_t first = 0) {
  std::vector<double> out(count);
  stream.fill_normal(out, entity, first, n);
  return out;
}

double mean_of_power(const std::vector<double>& x, int power) {
  double sum = 0.0;
  for (const double v : x) sum += std::pow(v, power);
  return sum / static_cast<double>(x.size());
}

// Six standard errors: false-alarm rate 2e-9 each. Variance of the k-th moment of a unit normal: (2k-1)!! - mean^2.
TEST(RandomStatistics, MomentsOfNormals) {
  constexpr std::size_t kCount = 4'000'000;
  const auto x = normals(RandomStream(1, "test.moments"), kCount);
  const double root = std::sqrt(static_cast<double>(kCount));
  EXPECT_NEAR(mean_of_power(x, 1), 0.0, 6 * std::sqrt(1.0) / root);
  EXPECT_NEAR(mean_of_power(x, 2), 1.0, 6 * std::sqrt(3.0 - 1.0) / root);
  EXPECT_NEAR(mean_of_power(x, 3), 0.0, 6 * std::sqrt(15.0) / root);
  EXPECT_NEAR(mean_of_power(x, 4), 3.0, 6 * std::sqrt(105.0 - 9.0) / root);
  EXPECT_NEAR(mean_of_power(x, 6), 15.0, 6 * std::sqrt(10395.0 - 225.0) / root);
}

// Counts beyond 1 to 5 sigma on either side against erfc, to six standard deviations of the binomial; where few are
// expected (4.6 beyond 5 sigma per side) the bound of Poisson's upper tail at 1e-9 is 21.
TEST(RandomStatistics, TailsOfNormals) {
  constexpr std::size_t kCount = 16'000'000;
  const auto x = normals(RandomStream(2, "test.tails"), kCount);
  for (int k = 1; k <= 5; ++k) {
    const double p = 0.5 * std::erfc(k / std::numbers::sqrt2);
    const double expected = p * static_cast<double>(kCount);
    const double sigma = std::sqrt(expected * (1 - p));
    const auto above = static_cast<double>(std::count_if(x.begin(), x.end(), [k](double v) { return v > k; }));
    const auto below = static_cast<double>(std::count_if(x.begin(), x.end(), [k](double v) { return v < -k; }));
    if (k < 5) {
      EXPECT_NEAR(above, expected, 6 * sigma) << k;
      EXPECT_NEAR(below, expected, 6 * sigma) << k;
    } else {
      EXPECT_LE(above, 21);
      EXPECT_LE(below, 21);
      EXPECT_GE(above + below, 1);  // 9.2 expected: none at all has the chance 1e-4
    }
  }
}

/// Kolmogorov's statistic sqrt(N) D of sorted samples of a distribution that should be uniform.
double kolmogorov(std::vector<double> u) {
  std::sort(u.begin(), u.end());
  const auto count = static_cast<double>(u.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto rank = static_cast<double>(i);
    distance = std::max({distance, u[i] - rank / count, (rank + 1) / count - u[i]});
  }
  return std::sqrt(count) * distance;
}

/// P(sqrt(N) D > x) is about 2 exp(-2 x^2): 1e-6 at this x.
const double kKolmogorovLimit = std::sqrt(-0.5 * std::log(0.5e-6));

TEST(RandomStatistics, DistributionOfNormalsAndUniforms) {
  constexpr std::size_t kCount = 1'000'000;
  auto x = normals(RandomStream(3, "test.distribution"), kCount);
  for (double& v : x) v = 0.5 * std::erfc(-v / std::numbers::sqrt2);
  EXPECT_LT(kolmogorov(x), kKolmogorovLimit);
  std::vector<double> u(kCount);
  RandomStream(3, "test.uniform").fill_uniform(u, 0, 0);
  EXPECT_LT(kolmogorov(u), kKolmogorovLimit);
  EXPECT_GE(*std::min_element(u.begin(), u.end()), 0.0);
  EXPECT_LT(*std::max_element(u.begin(), u.end()), 1.0);
}

// Chi-square over pairs (lane 0, lane 1) in 64 x 64 cells: 4095 degrees of freedom, six sigma of sqrt(2 k): false-alarm
// rate 1e-8.
TEST(RandomStatistics, PairsOfUniformsFillTheSquareEvenly) {
  constexpr std::size_t kPairs = 2'000'000, kCells = 64;
  std::vector<double> u(2 * kPairs);
  RandomStream(4, "test.square").fill_uniform(u, 0, 0);
  std::vector<double> counts(kCells * kCells);
  for (std::size_t i = 0; i < kPairs; ++i) {
    counts[static_cast<std::size_t>(u[2 * i] * kCells) * kCells + static_cast<std::size_t>(u[2 * i + 1] * kCells)] += 1;
  }
  const double expected = static_cast<double>(kPairs) / static_cast<double>(counts.size());
  double chi2 = 0.0;
  for (const double c : counts) chi2 += (c - expected) * (c - expected) / expected;
  const auto freedom = static_cast<double>(counts.size() - 1);
  EXPECT_NEAR(chi2, freedom, 6 * std::sqrt(2 * freedom));
}

double correlation(const std::vector<double>& a, const std::vector<double>& b, std::size_t shift = 0) {
  double sum = 0.0;
  for (std::size_t i = 0; i + shift < a.size(); ++i) sum += a[i] * b[i + shift];
  return sum / static_cast<double>(a.size() - shift);
}

double correlation_of_squares(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] * a[i] - 1) * (b[i] * b[i] - 1) / 2;
  return sum / static_cast<double>(a.size());
}

// Streams that differ in one coordinate only are independent: products and products of squares average to zero within
// six standard errors (the products of squares have fourth moments of 1 and (60/4)^2 in their own; 6 sigma of unit
// variance).
TEST(RandomStatistics, StreamsAreIndependent) {
  constexpr std::size_t kCount = 1'000'000;
  const double limit = 6 / std::sqrt(static_cast<double>(kCount));
  const RandomStream stream(5, "imu.gyro.thermal");
  const auto base = normals(stream, kCount);
  const std::vector<std::vector<double>> others = {
      normals(RandomStream(6, "imu.gyro.thermal"), kCount),   // the next seed
      normals(RandomStream(5, "imu.accel.thermal"), kCount),  // another name
      normals(stream, kCount, 1),                             // the next entity
      normals(stream, kCount, 0, 1),                          // the next draw of the sample
      normals(stream, kCount, 0, 0, 1),                       // the next sample
      normals(stream, kCount, 0, 0, 2),
      normals(stream, kCount, 0, 0, 1ull << 33)};
  for (std::size_t i = 0; i < others.size(); ++i) {
    EXPECT_LT(std::abs(correlation(base, others[i])), limit) << i;
    EXPECT_LT(std::abs(correlation_of_squares(base, others[i])), limit) << i;
  }
  for (std::size_t shift = 1; shift <= 16; ++shift)
    EXPECT_LT(std::abs(correlation(base, base, shift)), limit * 1.001) << shift;
}

// Mean 0 and covariance I/3 per component; variance of z^2 is 1/5 - 1/9. Six standard errors.
TEST(RandomStatistics, DirectionsAreIsotropic) {
  constexpr std::uint64_t kCount = 300'000;
  const RandomStream stream(6, "test.direction");
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const Eigen::Vector3d d = stream.direction(2, i);
    mean += d / kCount;
    second += d * d.transpose() / kCount;
  }
  const double root = std::sqrt(static_cast<double>(kCount));
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 6 * std::sqrt(1.0 / 3) / root);
  const Eigen::Matrix3d error = (second - Eigen::Matrix3d::Identity() / 3).cwiseAbs();
  EXPECT_LT(error.diagonal().maxCoeff(), 6 * std::sqrt(1.0 / 5 - 1.0 / 9) / root);
  EXPECT_LT(std::max({error(0, 1), error(0, 2), error(1, 2)}), 6 * std::sqrt(1.0 / 15) / root);
}

}  // namespace
}  // namespace canyon
