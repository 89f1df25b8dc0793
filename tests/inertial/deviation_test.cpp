#include "canyon/inertial/allan/deviation.h"

#include <cmath>
#include <cstring>
#include <numeric>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/random/random.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::inertial {
namespace {

Sampling uniform(std::size_t n, double interval_s) {
  return {interval_s, {{0, n}}, 0.0};
}

std::vector<double> white(std::size_t n, std::uint64_t seed) {
  const RandomStream stream(seed, "test.white");
  std::vector<double> x(n);
  for (std::size_t k = 0; k < n; ++k) x[k] = stream.normal(0, k);
  return x;
}

/// Straight from the definition, average by average.
double overlapping_by_definition(const std::vector<double>& y, std::size_t m) {
  double sum = 0.0;
  std::size_t count = 0;
  const auto average = [&](std::size_t k) {
    return std::accumulate(y.begin() + static_cast<std::ptrdiff_t>(k), y.begin() + static_cast<std::ptrdiff_t>(k + m),
                           0.0) /
           static_cast<double>(m);
  };
  for (std::size_t k = 0; k + 2 * m <= y.size(); ++k, ++count) sum += std::pow(average(k + m) - average(k), 2);
  return std::sqrt(sum / (2.0 * static_cast<double>(count)));
}

double hadamard_by_definition(const std::vector<double>& y, std::size_t m) {
  double sum = 0.0;
  std::size_t count = 0;
  const auto average = [&](std::size_t k) {
    return std::accumulate(y.begin() + static_cast<std::ptrdiff_t>(k), y.begin() + static_cast<std::ptrdiff_t>(k + m),
                           0.0) /
           static_cast<double>(m);
  };
  for (std::size_t k = 0; k + 3 * m <= y.size(); ++k, ++count)
    sum += std::pow(average(k + 2 * m) - 2.0 * average(k + m) + average(k), 2);
  return std::sqrt(sum / (6.0 * static_cast<double>(count)));
}

double modified_by_definition(const std::vector<double>& y, std::size_t m) {
  double sum = 0.0;
  std::size_t count = 0;
  const auto average = [&](std::size_t k) {
    return std::accumulate(y.begin() + static_cast<std::ptrdiff_t>(k), y.begin() + static_cast<std::ptrdiff_t>(k + m),
                           0.0) /
           static_cast<double>(m);
  };
  for (std::size_t k = 0; k + 3 * m - 1 <= y.size(); ++k, ++count) {
    double mean = 0.0;
    for (std::size_t i = 0; i < m; ++i) mean += (average(k + i + m) - average(k + i)) / static_cast<double>(m);
    sum += mean * mean;
  }
  return std::sqrt(sum / (2.0 * static_cast<double>(count)));
}

/// The rate mirrored at both ends, the Allan variance about each inner edge between samples.
double total_by_definition(const std::vector<double>& y, std::size_t m) {
  const auto n = static_cast<std::int64_t>(y.size()), length = static_cast<std::int64_t>(m);
  const auto mirrored = [&](std::int64_t k) {
    if (k < 0) k = -1 - k;
    if (k >= n) k = 2 * n - 1 - k;
    return y[static_cast<std::size_t>(k)];
  };
  double sum = 0.0;
  for (std::int64_t edge = 1; edge < n; ++edge) {
    double after = 0.0, before = 0.0;
    for (std::int64_t i = 0; i < length; ++i) {
      after += mirrored(edge + i) / static_cast<double>(m);
      before += mirrored(edge - 1 - i) / static_cast<double>(m);
    }
    sum += (after - before) * (after - before);
  }
  return std::sqrt(sum / (2.0 * static_cast<double>(n - 1)));
}

TEST(Deviation, EqualsTheDefinition) {
  auto y = white(500, 3);
  for (std::size_t k = 1; k < y.size(); ++k) y[k] += 0.3 * y[k - 1] + 100.0;
  const std::int64_t factors[] = {1, 2, 3, 10, 55, 160};
  const auto oadev = deviation("overlapping", y, uniform(y.size(), 0.01), factors);
  const auto hadev = deviation("hadamard", y, uniform(y.size(), 0.01), factors);
  const auto mdev = deviation("modified", y, uniform(y.size(), 0.01), factors);
  ASSERT_EQ(oadev.size(), 6U);
  ASSERT_EQ(hadev.size(), 6U);
  ASSERT_EQ(mdev.size(), 6U);
  const std::int64_t up_to_half[] = {1, 3, 55, 160, 249};  // most of the differences then reach beyond the ends
  for (const auto& p : deviation("total", y, uniform(y.size(), 0.01), up_to_half))
    EXPECT_NEAR(p.deviation / total_by_definition(y, static_cast<std::size_t>(p.m)), 1.0, 1e-9) << p.m;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(oadev[i].deviation / overlapping_by_definition(y, static_cast<std::size_t>(factors[i])), 1.0, 1e-9);
    EXPECT_NEAR(hadev[i].deviation / hadamard_by_definition(y, static_cast<std::size_t>(factors[i])), 1.0, 1e-9);
    EXPECT_NEAR(mdev[i].deviation / modified_by_definition(y, static_cast<std::size_t>(factors[i])), 1.0, 1e-9);
    EXPECT_DOUBLE_EQ(oadev[i].tau_s, 0.01 * static_cast<double>(factors[i]));
  }
}

// Deterministic closed forms: a ramp R t has an Allan deviation of R tau / sqrt(2), and none for Hadamard's.
TEST(Deviation, RampAndOffset) {
  std::vector<double> y(10000);
  for (std::size_t k = 0; k < y.size(); ++k) y[k] = 7.0 + 1e-3 * static_cast<double>(k);
  const std::int64_t factors[] = {1, 8, 64, 512};
  for (const auto& p : deviation("overlapping", y, uniform(y.size(), 1.0), factors))
    EXPECT_NEAR(p.deviation / (1e-3 * p.tau_s / std::sqrt(2.0)), 1.0, 1e-8);
  for (const auto& p : deviation("hadamard", y, uniform(y.size(), 1.0), factors)) EXPECT_LT(p.deviation, 1e-8);
}

// White rate noise of density N: N / sqrt(tau) for all but the modified deviation, which is smaller by sqrt(2) at large
// m ((m^2 + 1) / (2 m^2) of the variance). Random walk K: K sqrt(tau / 3). 200,000 samples; the band is five times the
// standard deviation that edf tells, 1 / sqrt(2 edf).
TEST(Deviation, WhiteNoiseAndRandomWalk) {
  const auto y = white(200000, 11);
  std::vector<double> walk(y.size());
  std::partial_sum(y.begin(), y.end(), walk.begin());
  const std::int64_t factors[] = {1, 2, 4, 16, 64, 256, 1024};
  for (const std::string kind : {"overlapping", "modified", "hadamard", "total"}) {
    for (const auto& p : deviation(kind, y, uniform(y.size(), 1.0), factors)) {
      const auto m = static_cast<double>(p.m);
      const double factor = kind == "modified" ? std::sqrt((m * m + 1.0) / (2.0 * m * m)) : 1.0;
      EXPECT_NEAR(p.deviation * std::sqrt(m) / factor, 1.0, 5.0 / std::sqrt(2.0 * p.edf)) << kind << " " << p.m;
    }
  }
  for (const auto& p : deviation("overlapping", walk, uniform(y.size(), 1.0), factors)) {
    const auto m = static_cast<double>(p.m);  // the sampled walk has steps: m / 3 + 1 / (6 m)
    EXPECT_NEAR(p.deviation / std::sqrt((2.0 * m * m + 1.0) / (6.0 * m)), 1.0, 5.0 / std::sqrt(2.0 * p.edf)) << p.m;
  }
}

/// 300 logs of 4096 samples, white or a random walk, in segments of equal length: how often the intervals of a kind
/// hold the true deviation. Truth: the white noise's closed form; for the random walk the mean of the variance over the
/// logs (of the overlapping one for the total, whose own lies low).
std::vector<double> coverage(const std::string& kind, bool walk, std::size_t segments, double confidence,
                             std::span<const std::int64_t> factors) {
  constexpr int kLogs = 300;
  constexpr std::size_t kSamples = 4096;
  Sampling sampling{1.0, {}, 0.0};
  const std::size_t length = kSamples / segments;
  for (std::size_t s = 0; s < segments; ++s) sampling.segments.push_back({s * length, (s + 1) * length});
  std::vector<std::vector<DeviationPoint>> all;
  std::vector<double> truth2(factors.size(), 0.0);
  for (int log = 0; log < kLogs; ++log) {
    auto y = white(kSamples, 1000 + static_cast<std::uint64_t>(log));
    if (walk) std::partial_sum(y.begin(), y.end(), y.begin());
    all.push_back(deviation(kind, y, sampling, factors, confidence));
    const auto reference = kind == "total" ? deviation("overlapping", y, sampling, factors) : all.back();
    for (std::size_t i = 0; i < factors.size(); ++i)
      truth2[i] += reference[i].deviation * reference[i].deviation / kLogs;
  }
  std::vector<double> held(factors.size(), 0.0);
  for (const auto& points : all)
    for (std::size_t i = 0; i < factors.size(); ++i) {
      const auto m = static_cast<double>(factors[i]);
      const double factor = kind == "modified" ? (m * m + 1.0) / (2.0 * m * m) : 1.0;
      const double truth = std::sqrt(walk ? truth2[i] : factor / m);
      held[i] += (points[i].low <= truth && truth <= points[i].high ? 1.0 : 0.0) / kLogs;
    }
  return held;
}

// The intervals hold the true deviation as often as they say; the band is four times the standard deviation of that
// share.
TEST(Deviation, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const std::int64_t factors[] = {1, 8, 64, 256};
  for (const double confidence : {0.683, 0.95}) {
    const double band = 4.0 * std::sqrt(confidence * (1.0 - confidence) / 300.0);
    for (const std::string kind : {"overlapping", "modified", "hadamard", "total"})
      for (const double share : coverage(kind, false, 1, confidence, factors))
        EXPECT_NEAR(share, confidence, band) << kind;
  }
}

TEST(Deviation, IntervalsOfARandomWalkHoldTheTruth) {
  const std::int64_t factors[] = {16, 64, 256};
  const double band = 4.0 * std::sqrt(0.95 * 0.05 / 300.0);
  for (const std::string kind : {"overlapping", "modified", "hadamard", "total"})
    for (const double share : coverage(kind, true, 1, 0.95, factors)) EXPECT_NEAR(share, 0.95, band) << kind;
}

// Eight segments of 512 samples: each estimates by itself, 204 of them a single 3.4 averages long.
TEST(Deviation, IntervalsHoldTheTruthAcrossGaps) {
  const std::int64_t factors[] = {1, 8, 64, 150};
  const double band = 4.0 * std::sqrt(0.95 * 0.05 / 300.0);
  for (const std::string kind : {"overlapping", "modified", "hadamard", "total"})
    for (const double share : coverage(kind, false, 8, 0.95, factors)) EXPECT_NEAR(share, 0.95, band) << kind;
}

TEST(Deviation, GapsAreNotBridged) {
  // A step of the offset between two segments would dominate if a difference crossed the gap.
  auto y = white(4000, 5);
  for (std::size_t k = 2000; k < 4000; ++k) y[k] += 1000.0;
  std::vector<double> t(4000);
  for (std::size_t k = 0; k < 4000; ++k) t[k] = 0.01 * static_cast<double>(k) + (k >= 2000 ? 5.0 : 0.0);
  const Sampling sampling = sampling_of(t);
  ASSERT_EQ(sampling.segments.size(), 2U);
  EXPECT_NEAR(sampling.interval_s, 0.01, 1e-12);
  const std::int64_t factors[] = {1, 16, 128, 1500};
  const auto points = deviation("overlapping", y, sampling, factors);
  ASSERT_EQ(points.size(), 3U);  // no segment is 3000 samples long
  for (const auto& p : points) EXPECT_LT(p.deviation, 2.0 / std::sqrt(static_cast<double>(p.m)));
}

TEST(Deviation, FactorsHaveEveryOctave) {
  const auto factors = averaging_factors(180000, 5);
  for (std::int64_t octave = 1; octave * 9 <= 180000; octave *= 2)
    EXPECT_NE(std::find(factors.begin(), factors.end(), octave), factors.end()) << octave;
  EXPECT_TRUE(std::is_sorted(factors.begin(), factors.end()));
  EXPECT_LE(factors.back() * 9, 180000);
}

TEST(Deviation, SameBitsForAnyNumberOfThreads) {
  const auto y = white(100000, 8);
  const auto factors = averaging_factors(100000, 6);
  const auto bits = [&](int n) {
    set_threads(n);
    std::vector<double> out;
    for (const auto& p : deviation("overlapping", y, uniform(y.size(), 0.01), factors)) out.push_back(p.deviation);
    return out;
  };
  const auto one = bits(1), eight = bits(8);
  set_threads(0);
  EXPECT_EQ(0, std::memcmp(one.data(), eight.data(), one.size() * sizeof(double)));
}

struct Reference {
  std::vector<double> tau_s;
  std::vector<std::vector<double>> axes;
};

Reference read_reference(const std::string& path) {
  LineReader in(path, *read_text_file(path));
  Reference out;
  out.axes.resize(6);
  std::string_view line;
  in.next(line);
  while (in.next(line)) {
    const auto fields = split(line, ",", false);
    out.tau_s.push_back(*parse_number(in, fields[0]));
    for (std::size_t a = 0; a < 6; ++a) out.axes[a].push_back(*parse_number(in, fields[a + 1]));
  }
  return out;
}

// Thirty minutes of a real, static ADIS16405 against a published overlapping Allan deviation: 1e-5 at every point, the
// digits it is printed with.
TEST(DeviationReal, Adis16405EqualsThePublishedCurve) {
  CANYON_REAL_DATA(log, "inertial/allan_adis16405/adis16405_imu1_first30min_100hz.i16");
  CANYON_REAL_DATA(curve, "inertial/allan_adis16405/adev_overlapping_first30min.csv");
  const std::string bytes = *read_text_file(log);
  std::vector<std::int16_t> counts(bytes.size() / 2);
  std::memcpy(counts.data(), bytes.data(), bytes.size());
  const std::size_t n = counts.size() / 6;
  ASSERT_EQ(n, 180000U);
  const Reference reference = read_reference(curve);
  std::vector<std::int64_t> factors;
  for (const double tau : reference.tau_s) factors.push_back(std::llround(tau * 100.0));
  std::size_t compared = 0;
  for (std::size_t a = 0; a < 6; ++a) {
    std::vector<double> y(n);
    for (std::size_t k = 0; k < n; ++k) y[k] = counts[6 * k + a] * (a < 3 ? 0.05 : 0.00333);
    const auto points = deviation("overlapping", y, uniform(n, 0.01), factors);
    ASSERT_EQ(points.size(), factors.size());
    for (std::size_t i = 0; i < points.size(); ++i, ++compared)
      EXPECT_NEAR(points[i].deviation / reference.axes[a][i], 1.0, 1e-5) << "axis " << a << " tau " << points[i].tau_s;
  }
  EXPECT_GE(compared, 108U);
}

}  // namespace
}  // namespace canyon::inertial
