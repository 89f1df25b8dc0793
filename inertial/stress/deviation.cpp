#include "canyon/inertial/allan/deviation.h"

#include <array>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

constexpr std::size_t kSamples = 4'000;

Sampling whole(std::size_t samples) {
  Sampling s;
  s.interval_s = 0.01;
  s.segments = {{0, samples}};
  return s;
}

/// Noise of 1 on a mean of 10^9, which a double holds in steps of 1.2e-7. A deviation is a norm: it changes by no more
/// than that of the roundings, of which none is above half a step, and sqrt(2) of them makes of it (2 for hadamard's
/// and total's end terms).
StressFigure large_mean(const std::string& kind) {
  std::vector<double> small(kSamples), large(kSamples);
  RandomStream(6, "stress").fill_normal(small, 0, 0);
  constexpr double kMean = 1e9;
  for (std::size_t i = 0; i < kSamples; ++i) large[i] = kMean + small[i];
  const std::array<std::int64_t, 3> factors = {1, 10, 1000};
  const auto a = deviation(kind, small, whole(kSamples), factors), b = deviation(kind, large, whole(kSamples), factors);
  double worst = a.size() == 3 && b.size() == 3 ? 0.0 : stress::kInfinity;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = worse(worst, std::abs(a[i].deviation - b[i].deviation));
  return {worst, 2.0 * 0.5 * 1.2e-7};
}

/// A channel that stands still has no deviation. Its mean is wrong by up to n epsilons, a slope of the phase that grows
/// to n^2 of them; an epsilon of that is what differences leave.
StressFigure constant(double value) {
  const std::vector<double> rate(kSamples, value);
  const std::array<std::int64_t, 3> factors = {1, 10, 1000};
  double worst = 0.0;
  for (const std::string& kind : deviation_kinds())
    for (const DeviationPoint& p : deviation(kind, rate, whole(kSamples), factors))
      worst = worse(worst, std::isfinite(p.low + p.high + p.edf) ? p.deviation : stress::kInfinity);
  constexpr double n = kSamples;
  return {worst, n * n * stress::kEpsilon * stress::kEpsilon * std::abs(value)};
}

/// Stamps since 1980 in double seconds, whose last bit is 2.4e-7 s at 2^31: the mean interval is that of the ends.
StressFigure late_stamps() {
  std::vector<double> t_s;
  for (int k = 0; k < 20'000; ++k) t_s.push_back(2147483648.0 + 0.01 * k);
  const Sampling s = sampling_of(t_s);
  stress::Worst worst;
  worst.look(s.segments.size() == 1 ? 0.0 : stress::kInfinity, 1.0);
  worst.look(s.interval_s - 0.01, 2.4e-7 / 20'000 + 2e-16);
  worst.look(s.jitter_s, 2.4e-7);  // two roundings of up to half a bit each
  return worst.figure();
}

StressFigure refused_stamps() {
  int passed = 0;
  const double inf = stress::kInfinity;
  for (const std::vector<double>& t_s : {std::vector<double>{},
                                         {1.0},
                                         {1.0, 1.0, 2.0},
                                         {1.0, 2.0, 1.5},
                                         {1.0, std::nan(""), 3.0},
                                         {std::nan(""), 1.0, 2.0},
                                         {-inf, -inf}})
    passed += stress::not_refused([&] { return sampling_of(t_s); });
  passed += stress::not_refused([] { return averaging_factors(100, 0); });
  const std::array<std::int64_t, 1> zero = {0};
  const std::vector<double> rate(100, 1.0);
  passed += stress::not_refused([&] { return deviation("overlapping", rate, whole(100), zero); });
  passed +=
      stress::not_refused([&] { return deviation("overlapping", rate, whole(101), std::array<std::int64_t, 1>{1}); });
  return {1.0 * passed, 0.0};
}

}  // namespace

std::vector<StressCase> deviation_cases() {
  const auto group = StressGroup::kData;
  const StressMechanism mean{group, "noise on a mean 10^9 times as large",
                             "sums of the raw channel reach 10^13 and hold the noise to no digit",
                             "the same as without the mean, to the roundings of the data themselves", ""};
  const StressMechanism still{group, "a channel that stands still",
                              "a logarithm of zero in the slope makes the interval no number",
                              "zero, to n^2 squared epsilons of the value, and a finite interval", ""};
  const StressMechanism stamps{StressGroup::kLong, "stamps near 2^31 s in double seconds",
                               "intervals of 0.01 s that are good to 2e-5 of themselves look "
                               "like gaps or jitter",
                               "one segment, the interval of its ends, jitter below the last bit", "of the bound"};
  const StressMechanism refusal{group, "stamps that do not increase", "an interval of zero or no number divides",
                                "each is refused", "let through"};
  StressRows rows;
  for (const std::string& kind : deviation_kinds())
    rows.of(mean).add("deviation/" + kind + "_on_a_mean_of_1e9", [kind] { return large_mean(kind); });
  for (const double value : {0.1, 1e9})
    rows.of(still).add("deviation/of_a_constant_" + stress::text(value), [value] { return constant(value); });
  rows.of(stamps).add("deviation/stamps_near_31_bits_of_seconds", late_stamps);
  rows.of(refusal).add("deviation/stamps_refused", refused_stamps);
  return rows.take();
}

}  // namespace canyon::inertial
