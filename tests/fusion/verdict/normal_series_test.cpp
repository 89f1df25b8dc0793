#include "canyon/fusion/verdict/normal_series.h"

#include <cmath>
#include <deque>

#include <gtest/gtest.h>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"

namespace canyon::fusion {
namespace {

constexpr double kInterval_s = 0.5;

GpsTime at(int k) {
  return GpsTime::from_week_sow(1590, 396000.0) + kInterval_s * k;
}

/// x' = kept x + noise, stationary, of unit variance.
class Markov {
 public:
  Markov(std::uint64_t seed, double kept) : stream_(seed, "test.markov"), kept_(kept), x_(stream_.normal(0, 0)) {}
  double next() { return x_ = kept_ * x_ + std::sqrt(1.0 - kept_ * kept_) * stream_.normal(0, ++n_); }

 private:
  RandomStream stream_;
  double kept_, x_;
  std::uint64_t n_ = 0;
};

NormalSeries markov_series(std::uint64_t seed, double kept, int count) {
  Markov process(seed, kept);
  NormalSeries out(1);
  for (int k = 0; k < count; ++k) out.add(at(k), Eigen::VectorXd::Constant(1, process.next()));
  return out;
}

TEST(NormalSeries, MeansAndShortLagsAreThoseOfTheSamples) {
  constexpr int kCount = 1000;
  RandomStream stream(1, "test");
  std::vector<Eigen::Vector2d> z;
  NormalSeries series(2);
  double squares = 0.0;
  for (int k = 0; k < kCount; ++k) {
    z.emplace_back(stream.normal(0, static_cast<std::uint64_t>(k)), stream.normal(1, static_cast<std::uint64_t>(k)));
    series.add(at(k), z.back());
    squares += z.back().squaredNorm();
  }
  const double eps = 1e-15 * kCount;
  EXPECT_NEAR(series.mean_square(), squares / (2 * kCount), eps);
  EXPECT_NEAR(series.interval_s(), kInterval_s, eps);
  const auto lags = series.lags();
  for (int lag = 1; lag <= NormalSeries::kLags; ++lag) {
    double sum = 0.0, earlier = 0.0, later = 0.0;
    for (std::size_t k = static_cast<std::size_t>(lag); k < z.size(); ++k) {
      const Eigen::Vector2d& before = z[k - static_cast<std::size_t>(lag)];
      sum += z[k].dot(before);
      earlier += before.squaredNorm();
      later += z[k].squaredNorm();
    }
    EXPECT_EQ(lags[static_cast<std::size_t>(lag - 1)].samples, lag);
    EXPECT_NEAR(lags[static_cast<std::size_t>(lag - 1)].r, sum / std::sqrt(earlier * later), eps);
  }
}

TEST(NormalSeries, AConstantIsOneSample) {
  NormalSeries series(1);
  for (int k = 0; k < 700; ++k) series.add(at(k), Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_EQ(series.mean_square(), 4.0);
  // Of the lags those beyond the last that has pairs are missing, 1 - k / N being what each counts for.
  const double missing = 1.0 - series.lags().back().samples / 700.0;
  EXPECT_GT(series.effective_samples(), 1.0 - 1e-12);
  EXPECT_NEAR(series.effective_samples(), 1.0, missing * missing);
}

// 2026-11-30: 16 innovations had an autocorrelation of 1.0246, by the mean square of all of them. Of ones between two
// halves the 15 pairs come to 13 + 2/2, the squares on either side of them to 14 + 1/4.
TEST(NormalSeries, IsNeverMoreAlikeThanTheSame) {
  NormalSeries series(1);
  for (int k = 0; k < 16; ++k) series.add(at(k), Eigen::VectorXd::Constant(1, k == 0 || k == 15 ? 0.5 : 1.0));
  EXPECT_NEAR(series.lags().front().r, 14.0 / 14.25, 1e-15 * 16);
  for (int count = 2; count < 200; ++count) {
    RandomStream stream(static_cast<std::uint64_t>(count), "test.short");
    NormalSeries rising(2);
    for (int k = 0; k < count; ++k) {
      const auto n = static_cast<std::uint64_t>(k);
      rising.add(at(k), Eigen::Vector2d(1.0 + 0.3 * stream.normal(0, n), std::exp(stream.normal(1, n))) * (k % 50));
    }
    for (const auto& lag : rising.lags()) ASSERT_LE(std::abs(lag.r), 1.0) << count << " samples, lag " << lag.samples;
  }
  NormalSeries one_pulse(1);
  for (int k = 0; k < 40; ++k) one_pulse.add(at(k), Eigen::VectorXd::Constant(1, k == 39 ? 1.0 : 0.0));
  for (const auto& lag : one_pulse.lags()) EXPECT_EQ(lag.r, 0.0) << "nothing before it to be like";
}

// Lags beyond the first sixteen are of means of pairs, by what the squares of their samples are in the mean: by hand.
TEST(NormalSeries, FartherLagsAreOfMeansOfPairs) {
  constexpr std::size_t kCount = 64, kFirst = 9;  // the first lag of pairs, 18 samples
  const RandomStream stream(3, "test.pairs");
  NormalSeries series(1);
  std::vector<double> means, squares;
  for (std::size_t j = 0; j < kCount / 2; ++j) {
    double z[2];
    for (std::size_t i : {0, 1}) {
      z[i] = stream.normal(0, 2 * j + i) + std::sin(0.3 * static_cast<double>(2 * j + i));
      series.add(at(static_cast<int>(2 * j + i)), Eigen::VectorXd::Constant(1, z[i]));
    }
    means.push_back(0.5 * (z[0] + z[1]));
    squares.push_back(0.5 * (z[0] * z[0] + z[1] * z[1]));
  }
  double sum = 0.0, earlier = 0.0, later = 0.0;
  for (std::size_t j = kFirst; j < means.size(); ++j) {
    sum += means[j] * means[j - kFirst];
    earlier += squares[j - kFirst];
    later += squares[j];
  }
  const auto lag = series.lags().at(NormalSeries::kLags);
  EXPECT_EQ(lag.samples, 2.0 * kFirst);
  EXPECT_NEAR(lag.r, sum / std::sqrt(earlier * later), 1e-14);
}

TEST(NormalSeries, AMarkovProcessIsWorthWhatItsCorrelationSays) {
  // Of N samples of r_k = kept^k, N (1 - kept^2) / (1 + kept^2) are independent as far as squares go; 1 / e after
  // -dt / ln(kept).
  constexpr int kCount = 100000;
  for (const double kept : {0.5, 0.9, 0.99}) {
    const NormalSeries series = markov_series(7, kept, kCount);
    const double worth = kCount * (1.0 - kept * kept) / (1.0 + kept * kept);
    // r at a lag is off by 1 / sqrt(independent samples) (1-sigma), which at 4 sigma moves sum and time by so much.
    const double off = 4.0 / std::sqrt(worth);
    EXPECT_NEAR(series.effective_samples() / worth, 1.0, 4.0 * off) << kept;
    const double tau_s = -kInterval_s / std::log(kept);
    EXPECT_NEAR(series.correlation_s() / tau_s, 1.0, 4.0 * off + 1.0 / NormalSeries::kLags) << kept;
  }
}

TEST(NormalSeries, PassesAWhiteSeriesAsOftenAsItSays) {
  // 2000 series, false alarms at 5 %: binomial, 4 sigma = 0.0195.
  constexpr int kSeries = 2000, kCount = 200;
  int alarms = 0;
  for (int s = 0; s < kSeries; ++s) {
    const auto [statistic, degrees] = markov_series(static_cast<std::uint64_t>(s), 0.0, kCount).portmanteau();
    EXPECT_EQ(degrees, NormalSeries::kLags);
    alarms += statistic > chi_square_threshold(0.05, degrees) ? 1 : 0;
  }
  const double share = static_cast<double>(alarms) / kSeries;
  EXPECT_NEAR(share, 0.05, 4.0 * std::sqrt(0.05 * 0.95 / kSeries) + 1.0 / kCount);
}

TEST(NormalSeries, LeavesOutWhatIsNotFinite) {
  NormalSeries series(1);
  series.add(at(0), Eigen::VectorXd::Constant(1, 1.0));
  series.add(at(1), Eigen::VectorXd::Constant(1, std::nan("")));
  EXPECT_EQ(series.samples(), 1);
  EXPECT_TRUE(std::isnan(NormalSeries(3).mean_square()));
  EXPECT_EQ(NormalSeries(3).portmanteau().degrees, 0);
  EXPECT_EQ(NormalSeries(3).effective_samples(), 1.0);
}

}  // namespace
}  // namespace canyon::fusion
