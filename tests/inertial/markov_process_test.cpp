#include "canyon/inertial/errors/markov_process.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/tests/support/four_sigma.h"

namespace canyon::inertial {
namespace {

using canyon::testing::four_sigma_of_variance;

constexpr std::int64_t kBlock = kImuBlock;

/// Covariance of the values at two samples over an ensemble of runs: within a block, across a border, many blocks on.
/// Expected for Gauss-Markov: sigma^2 exp(-lag / tau).
TEST(MarkovProcess, GaussMarkovIsStationaryAndRateIndependent) {
  const double sigma = 2.0, tau_s = 3.0;
  const int runs = 2000, n = 3 * runs;
  for (const double rate_hz : {1.0, 50.0, 1000.0}) {
    const auto lag = static_cast<std::int64_t>(3.0 * rate_hz);
    for (const std::int64_t first : {std::int64_t{0}, kBlock - 2, 5 * kBlock + 17}) {
      double before = 0.0, after = 0.0, product = 0.0;
      for (int run = 0; run < runs; ++run) {
        auto process =
            MarkovProcess::gauss_markov(static_cast<std::uint64_t>(run), "test.gm", 0, sigma, tau_s, 1.0 / rate_hz);
        const Eigen::Vector3d a = process.at(first), b = process.at(first + lag);
        before += a.squaredNorm();
        after += b.squaredNorm();
        product += a.dot(b);
      }
      const double scale = n * sigma * sigma;
      EXPECT_NEAR(before / scale, 1.0, four_sigma_of_variance(n)) << rate_hz << " " << first;
      EXPECT_NEAR(after / scale, 1.0, four_sigma_of_variance(n)) << rate_hz << " " << first;
      // The product of two normals of correlation r has variance 1 + r^2.
      const double r = std::exp(-1.0);
      EXPECT_NEAR(product / scale, r, 4.0 * std::sqrt((1.0 + r * r) / n)) << rate_hz << " " << first;
    }
  }
}

/// Steps x_(k+1) - phi x_k must be white, whether inside a block, at its border or beside it: variance drive^2 and no
/// correlation with the step before.
TEST(MarkovProcess, StepsAreWhiteAcrossBorders) {
  const double tau_s = 4.0, dt_s = 0.1;
  const int runs = 3000, n = 3 * runs;
  const double phi = std::exp(-dt_s / tau_s), drive2 = 1.0 - phi * phi;
  for (const std::int64_t k : {std::int64_t{3}, kBlock - 2, kBlock - 1, kBlock, 2 * kBlock + 100}) {
    double square = 0.0, product = 0.0;
    for (int run = 0; run < runs; ++run) {
      auto p = MarkovProcess::gauss_markov(static_cast<std::uint64_t>(run), "test.steps", 1, 1.0, tau_s, dt_s);
      const Eigen::Vector3d a = p.at(k), b = p.at(k + 1), c = p.at(k + 2);
      square += (c - phi * b).squaredNorm();
      product += (c - phi * b).dot(b - phi * a);
    }
    EXPECT_NEAR(square / n / drive2, 1.0, four_sigma_of_variance(n)) << k;
    EXPECT_NEAR(product / n / drive2, 0.0, 4.0 / std::sqrt(n)) << k;
  }
}

TEST(MarkovProcess, RandomWalkGrowsWithTheRootOfTime) {
  const double per_sqrt_s = 0.3;
  const int runs = 2000, n = 3 * runs;
  for (const double rate_hz : {25.0, 1000.0}) {
    for (const double t_s : {0.2, 10.4, 60.0}) {
      double square = 0.0;
      for (int run = 0; run < runs; ++run) {
        auto p = MarkovProcess::random_walk(static_cast<std::uint64_t>(run), "test.walk", 0, per_sqrt_s, 1.0 / rate_hz);
        EXPECT_EQ(p.at(0), Eigen::Vector3d::Zero());
        square += p.at(std::llround(t_s * rate_hz)).squaredNorm();
      }
      EXPECT_NEAR(square / n / (per_sqrt_s * per_sqrt_s * t_s), 1.0, four_sigma_of_variance(n))
          << rate_hz << " " << t_s;
    }
  }
}

/// The integral over T of a Gauss-Markov process has variance 2 sigma^2 tau (T - tau (1 - exp(-T / tau))), also where T
/// is a single sample that is long or short against tau.
TEST(MarkovProcess, MeansAreThoseOfTheContinuousProcess) {
  const double sigma = 1.5, tau_s = 0.5;
  const int runs = 400, n = 3 * runs;
  for (const double dt_s : {0.04, 0.5, 2.0}) {
    for (const std::size_t samples : {std::size_t{1}, std::size_t{8}, kImuBlock}) {
      double square = 0.0;
      for (int run = 0; run < runs; ++run) {
        const auto seed = static_cast<std::uint64_t>(run);
        auto p = MarkovProcess::gauss_markov(seed, "test.mean", 0, sigma, tau_s, dt_s);
        const RandomStream within(seed, "test.mean.within");
        AxisArrays means{};
        p.add_means(2, means);
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
          double integral = 0.0;
          for (std::size_t i = 0; i < samples; ++i) {
            integral += dt_s * (means[axis][i] + p.within_sigma() * within.normal(axis, i));
          }
          square += integral * integral;
        }
      }
      const double t_s = static_cast<double>(samples) * dt_s;
      const double expected = 2.0 * sigma * sigma * tau_s * (t_s + tau_s * std::expm1(-t_s / tau_s));
      EXPECT_NEAR(square / n / expected, 1.0, four_sigma_of_variance(n)) << dt_s << " x " << samples;
    }
  }
}

TEST(MarkovProcess, AnySampleIsReachedFromAnywhere) {
  const auto make = [] { return MarkovProcess::gauss_markov(7, "test.jump", 2, 1.0, 20.0, 0.01); };
  auto in_order = make();
  std::vector<Eigen::Vector3d> values;
  for (std::int64_t k = 0; k < 4 * kBlock; ++k) values.push_back(in_order.at(k));
  auto jumping = make();
  for (const std::int64_t k : {4 * kBlock - 1, std::int64_t{0}, 2 * kBlock, 2 * kBlock - 1, kBlock + 3}) {
    EXPECT_EQ(jumping.at(k), values[static_cast<std::size_t>(k)]) << k;
  }
  EXPECT_THROW(jumping.at(-1), ProgramError);
}

}  // namespace
}  // namespace canyon::inertial
