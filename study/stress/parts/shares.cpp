// Shares, medians, means and resamplings of a study, each made again by another way.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/study/statistics/batch_means.h"
#include "canyon/study/statistics/block_bootstrap.h"
#include "canyon/study/statistics/cluster_bootstrap.h"
#include "canyon/study/statistics/proportions.h"
#include "canyon/study/statistics/sample.h"
#include "canyon/study/stress/parts/subjects.h"

namespace canyon::study {
namespace {

using stress::kEpsilon;
using stress::Looks;

constexpr double kTwoSided = 1.959963984540054;  // 97.5 % of the normal distribution, from tables

/// Where |share - p| = z sqrt(p (1 - p) / n), by halving.
Interval by_halving(int successes, int n) {
  const double share = static_cast<double>(successes) / n;
  const auto end = [&](double inside, double outside) {
    for (int i = 0; i < 200; ++i) {
      const double p = 0.5 * (inside + outside);
      (std::abs(share - p) < kTwoSided * std::sqrt(p * (1.0 - p) / n) ? inside : outside) = p;
    }
    return 0.5 * (inside + outside);
  };
  // Just beside the share itself the score is within its bound.
  return {successes == 0 ? 0.0 : end(share - 1e-13, 0.0), successes == n ? 1.0 : end(share + 1e-13, 1.0)};
}

/// Wilson's ends solve the score's equation; Newcombe's of two paired shares are made of them by his method 10. Halving
/// ends at a rounding; of counts up to 9 that is some tens of it.
StressFigure shares() {
  Looks looks;
  const double bound = 1e-10;
  for (int n = 1; n <= 9; ++n)
    for (int x = 0; x <= n; ++x) {
      const Interval found = wilson_interval(x, n), expected = by_halving(x, n);
      looks.near(found.low, expected.low, bound), looks.near(found.high, expected.high, bound);
    }
  looks.right(!wilson_interval(0, 0).defined());
  looks.right(stress::not_refused([] { wilson_interval(5, 4); }) == 0 &&
              stress::not_refused([] { wilson_interval(-1, 4); }) == 0);
  for (int e = 0; e <= 3; ++e)
    for (int f = 0; f <= 3; ++f)
      for (int g = 0; g <= 3; ++g)
        for (int h = 0; h <= 3; ++h) {
          const PairedCounts counts{.both = e, .only_a = f, .only_b = g, .neither = h};
          const int n = e + f + g + h;
          looks.right(counts.n() == n);
          if (n == 0) {
            looks.right(!paired_difference_interval(counts).defined() && std::isnan(counts.difference()));
            continue;
          }
          const double a = static_cast<double>(e + f) / n, b = static_cast<double>(e + g) / n;
          const Interval A = by_halving(e + f, n), B = by_halving(e + g, n);
          double phi = 0.0;
          const double margins = a * (1.0 - a) * b * (1.0 - b) * std::pow(n, 4);
          if (margins > 0.5) {
            double product = static_cast<double>(e * h - f * g);
            if (product > 0.0) product = product > 0.5 * n ? product - 0.5 * n : 0.0;
            phi = product / std::sqrt(margins);
          }
          const auto reach = [&](double u, double v) { return std::sqrt(u * u - 2.0 * phi * u * v + v * v + 1e-300); };
          const Interval found = paired_difference_interval(counts);
          looks.near(counts.difference(), b - a, 4.0 * kEpsilon);
          // A root of what is nearly nothing has half of its digits.
          looks.near(found.low, b - a - reach(b - B.low, A.high - a), 1e-6);
          looks.near(found.high, b - a + reach(B.high - b, a - A.low), 1e-6);
        }
  return looks.figure();
}

/// Sums of Pascal's triangle, exact up to 2^50; the median's ranks by them; McNemar's p as twice the tail.
StressFigure coins_and_medians() {
  Looks looks;
  std::vector<double> row{1.0};
  for (int n = 1; n <= 50; ++n) {
    std::vector<double> next(row.size() + 1, 1.0);
    for (std::size_t i = 1; i < row.size(); ++i) next[i] = row[i - 1] + row[i];
    row = next;
    double sum = 0.0;
    int rank = 0;
    looks.right(fair_coin_tail(-1, n) == 0.0 && fair_coin_tail(n, n) == 1.0);
    for (int k = 0; k < n; ++k) {
      sum += row[static_cast<std::size_t>(k)];
      const double tail = sum / std::pow(2.0, n);
      looks.near(fair_coin_tail(k, n), tail, 64.0 * kEpsilon * tail);
      looks.near(mcnemar_exact_p(k, n - k), 2 * k < n ? std::min(1.0, 2.0 * tail) : mcnemar_exact_p(n - k, k),
                 128.0 * kEpsilon);
      if (2.0 * tail <= 0.05 && 2 * (k + 1) <= n) rank = k + 1;
    }
    std::vector<double> values;
    for (int k = 0; k < n; ++k) values.push_back(static_cast<double>((7 * k + 3) % n) + (n % 7 == 0 ? 0.0 : 0.5));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const Interval found = median_interval(values);
    looks.right(found.defined() == (rank > 0) && (n >= 6) == (rank > 0));
    if (rank > 0)
      looks.right(found.low == sorted[static_cast<std::size_t>(rank - 1)] &&
                  found.high == sorted[static_cast<std::size_t>(n - rank)]);
  }
  return looks.figure();
}

/// Student's quantile: exact for one and two degrees, to the digits that are given; beyond, what the integral of its
/// density says, to twice the expansion's next term (Abramowitz & Stegun 26.7.5). And the mean's interval by it.
StressFigure students() {
  Looks looks;
  looks.near(student_975(1), std::tan(3.141592653589793 * 0.475), 6e-5);
  looks.near(student_975(2), 0.95 / std::sqrt(2.0 * 0.975 * 0.025), 6e-6);
  for (const int n : {3, 4, 6, 10, 30, 100}) {
    const double v = n, t = student_975(n);
    const double scale =
        std::exp(std::lgamma(0.5 * (v + 1.0)) - std::lgamma(0.5 * v)) / std::sqrt(v * 3.141592653589793);
    const auto density = [&](double x) { return scale * std::pow(1.0 + x * x / v, -0.5 * (v + 1.0)); };
    double integral = 0.5;
    constexpr int kPieces = 400;
    const double h = t / kPieces;
    for (int k = 0; k < kPieces; ++k)
      integral += h / 6.0 * (density(k * h) + 4.0 * density((k + 0.5) * h) + density((k + 1) * h));
    const double z = kTwoSided;
    const double next = (79.0 * std::pow(z, 9) + 776.0 * std::pow(z, 7) + 1482.0 * std::pow(z, 5) -
                         1920.0 * std::pow(z, 3) - 945.0 * z) /
                        (92160.0 * std::pow(v, 4));
    looks.near(integral, 0.975, density(t) * 2.0 * next + 1e-9);
  }
  const std::vector<double> values{3.0, -1.0, 4.5, 2.0, 0.5};
  // Mean 1.8; squares about it 1.44 + 7.84 + 7.29 + 0.04 + 1.69.
  const double reach = student_975(4) * std::sqrt(18.3 / 4.0 / 5.0);
  looks.near(mean(values), 1.8, 8.0 * kEpsilon);
  looks.near(mean_interval(values).low, 1.8 - reach, 1e-13), looks.near(mean_interval(values).high, 1.8 + reach, 1e-13);
  looks.right(!mean_interval({1.0}).defined() && std::isnan(mean({})));
  return looks.figure();
}

/// Means over batches of 30 s from the first sample on, what is left over with the last whole one; gaps leave batches
/// that do not count, here those from 90 to 150 s. Sums of a few hundred terms.
StressFigure batches() {
  Looks looks;
  const RandomStream draws(3, "stress.batches");
  for (const double gap_s : {0.0, 70.0}) {
    BatchMeans means;
    std::array<double, 20> sum{}, count{};
    std::size_t last = 0;
    double total = 0.0;
    int n = 0;
    looks.right(!means.interval().defined() && std::isnan(means.mean()) && means.samples() == 0);
    for (int k = 0; k < 200; ++k) {
      const double t = 12.5 + 0.9 * k + (k >= 100 ? gap_s : 0.0);
      const double value = draws.normal(0, static_cast<std::uint64_t>(k)) + 0.01 * k;
      means.add(t, value);
      last = static_cast<std::size_t>((t - 12.5) / 30.0);
      sum[last] += value, count[last] += 1.0, total += value, ++n;
    }
    sum[last - 1] += sum[last], count[last - 1] += count[last];
    const double mean = total / n;
    double squares = 0.0, used = 0.0;
    for (std::size_t i = 0; i < last; ++i)
      if (count[i] > 0.0) squares += std::pow(sum[i] / count[i] - mean, 2), used += 1.0;
    looks.right(used == static_cast<double>(last) - (gap_s > 0.0 ? 2.0 : 0.0));
    const double reach = student_975(static_cast<int>(used) - 1) * std::sqrt(squares / (used - 1.0) / used);
    looks.near(means.mean(), mean, 1e-13), looks.right(means.samples() == 200);
    looks.near(means.interval().low, mean - reach, 1e-12), looks.near(means.interval().high, mean + reach, 1e-12);
  }
  BatchMeans brief;
  for (int k = 0; k < 59; ++k) brief.add(k, 1.0);
  looks.right(!brief.interval().defined());
  return looks.figure();
}

/// Resampled from the documented streams: blocks of n^(1/3) that go round, whole clusters; ranks of 1000 replicates.
StressFigure resampled() {
  Looks looks;
  const RandomStream draws(4, "stress.resampled");
  for (const std::size_t n : {8U, 27U, 30U}) {
    std::vector<SquareSum> samples;
    for (std::size_t k = 0; k < n; ++k)
      samples.push_back({std::pow(draws.normal(1, k), 2) + 0.1, k % 5 == 4 ? 0.0 : 1.0 + static_cast<double>(k % 3)});
    const std::size_t length = n == 8U ? 2 : n == 27U ? 3 : 4;
    const RandomStream blocks(9, "tradeoff.bootstrap");
    std::vector<double> values;
    for (std::uint64_t r = 0; r < 1000; ++r) {
      double sum = 0.0, count = 0.0;
      std::size_t begun = 0;
      for (std::size_t k = 0; k < n; ++k) {
        const auto block = static_cast<std::uint32_t>(k / length);
        if (k % length == 0) begun = static_cast<std::size_t>(blocks.uniform(block, r) * static_cast<double>(n));
        const SquareSum& one = samples[(begun + k % length) % n];
        sum += one.sum, count += one.count;
      }
      values.push_back(std::sqrt(sum / count));
    }
    std::sort(values.begin(), values.end());
    double mean = 0.0, squares = 0.0, sum = 0.0, count = 0.0;
    for (const double v : values) mean += v / 1000.0;
    for (const double v : values) squares += (v - mean) * (v - mean);
    for (const SquareSum& one : samples) sum += one.sum, count += one.count;
    const RmsEstimate found = block_bootstrap_rms(samples, 9);
    looks.near(found.rms, std::sqrt(sum / count), 1e-13);
    looks.near(found.sigma, std::sqrt(squares / 999.0), 1e-12);
    looks.near(found.interval.low, values[24], 1e-13), looks.near(found.interval.high, values[974], 1e-13);
    samples.resize(7);
    looks.right(std::isnan(block_bootstrap_rms(samples, 9).sigma) &&
                !block_bootstrap_rms(samples, 9).interval.defined());
  }
  const std::vector<double> of{3.0, 1.0, 4.0, 1.5, 9.0, 2.6, 5.0};
  const auto statistics = [&](std::span<const double> times) {
    double sum = 0.0, count = 0.0;
    for (std::size_t c = 0; c < of.size(); ++c) sum += times[c] * of[c], count += times[c];
    // Of those without the first one two statistics: one that is infinite, and one that is none.
    return std::vector<double>{sum / count, times[0] == 0.0 ? stress::kInfinity : 1.0,
                               times[0] == 0.0 ? kNaN : times[0]};
  };
  const RandomStream clusters(5, "study.clusters");
  std::vector<double> means, firsts;
  for (std::uint64_t r = 0; r < 1000; ++r) {
    double sum = 0.0, first = 0.0;
    for (std::uint32_t k = 0; k < 7; ++k) {
      const auto c = static_cast<std::size_t>(7.0 * clusters.uniform(k, r));
      sum += of[c], first += c == 0 ? 1.0 : 0.0;
    }
    means.push_back(sum / 7.0);
    if (first > 0.0) firsts.push_back(first);
  }
  std::sort(means.begin(), means.end()), std::sort(firsts.begin(), firsts.end());
  const auto found = cluster_bootstrap(7, 5, statistics);
  looks.right(found.size() == 3);
  looks.near(found[0].low, means[24], 1e-13), looks.near(found[0].high, means[974], 1e-13);
  looks.right(found[1].low == 1.0 && found[1].high == stress::kInfinity);
  const auto rank = [&](double q) {
    return firsts[static_cast<std::size_t>(q * static_cast<double>(firsts.size() - 1))];
  };
  looks.right(found[2].low == rank(0.025) && found[2].high == rank(0.975));
  looks.right(!cluster_bootstrap(5, 5, [](std::span<const double>) { return std::vector<double>{1.0}; })[0].defined());
  return looks.figure();
}

}  // namespace

std::vector<StressCase> share_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "what a study says of shares, medians and means",
           .why = "an end of the other side, a continuity correction of the other sign, a rank or a degree off by one",
           .expected = "equations solved by halving, Pascal's triangle, integrals, the documented streams: roundings",
           .unit = "of the bound",
           .loose = "roundings of the least of many figures"});
  rows.add("shares/of_success", shares)
      .add("shares/coins_and_medians", coins_and_medians)
      .add("shares/students", students)
      .add("shares/batches", batches)
      .add("shares/resampled", resampled);
  return rows.take();
}

}  // namespace canyon::study
