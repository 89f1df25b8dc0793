#include "canyon/inertial/allan/deviation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "canyon/core/check.h"
#include "canyon/core/math/chi_square.h"
#include "canyon/core/model_table.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/inertial/allan/degrees_of_freedom.h"

namespace canyon::inertial {
namespace {

constexpr double kIndependentAverages = 9.0;

/// Sum of squares and count of the differences of one segment's phase x (rate integrated, in samples) at factor m.
struct SquareSum {
  double sum = 0.0;
  std::int64_t count = 0;
};
using Kernel = SquareSum(std::span<const double> x, std::int64_t m);

/// Sums in fixed blocks, so that rounding stays small and vector units have something to do.
template <class Difference>
SquareSum sum_squares(std::int64_t count, Difference difference) {
  if (count <= 0) return {};
  constexpr std::int64_t kBlock = 4096;
  double total = 0.0;
  for (std::int64_t begin = 0; begin < count; begin += kBlock) {
    throw_if_cancelled();
    const std::int64_t end = std::min(count, begin + kBlock);
    double lanes[4] = {};
    std::int64_t k = begin;
    for (; k + 4 <= end; k += 4)
      for (int lane = 0; lane < 4; ++lane) {
        const double d = difference(k + lane);
        lanes[lane] += d * d;
      }
    for (; k < end; ++k) lanes[0] += difference(k) * difference(k);
    total += (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
  }
  return {total, count};
}

SquareSum overlapping(std::span<const double> x, std::int64_t m) {
  const double* p = x.data();
  return sum_squares(static_cast<std::int64_t>(x.size()) - 2 * m,
                     [=](std::int64_t k) { return p[k + 2 * m] - 2.0 * p[k + m] + p[k]; });
}

SquareSum hadamard(std::span<const double> x, std::int64_t m) {
  const double* p = x.data();
  auto s = sum_squares(static_cast<std::int64_t>(x.size()) - 3 * m,
                       [=](std::int64_t k) { return p[k + 3 * m] - 3.0 * (p[k + 2 * m] - p[k + m]) - p[k]; });
  s.sum /= 3.0;  // the variance is 1/6 of the mean square, the shared scaling below 1/2
  return s;
}

SquareSum modified(std::span<const double> x, std::int64_t m) {
  const auto n = static_cast<std::int64_t>(x.size());
  const std::int64_t count = n - 3 * m + 1;
  if (count <= 0) return {};
  // Sum over m neighbouring second differences, moved along by one at a time. Prefix sums of the phase keep it free of
  // the drift that a running sum would gather.
  std::vector<double> prefix(static_cast<std::size_t>(n + 1), 0.0);
  throw_if_cancelled();
  for (std::int64_t k = 0; k < n; ++k)
    prefix[static_cast<std::size_t>(k + 1)] = prefix[static_cast<std::size_t>(k)] + x[static_cast<std::size_t>(k)];
  const double* p = prefix.data();
  const auto window = [=](std::int64_t k) { return p[k + m] - p[k]; };
  const double scale = 1.0 / static_cast<double>(m);
  return sum_squares(count,
                     [=](std::int64_t k) { return scale * (window(k + 2 * m) - 2.0 * window(k + m) + window(k)); });
}

SquareSum total(std::span<const double> x, std::int64_t m) {
  const auto n = static_cast<std::int64_t>(x.size());
  if (n < 2 * m + 1 || n < 3) return {};
  // x*(-j) = 2 x(0) - x(j), x*(n-1+j) = 2 x(n-1) - x(n-1-j).
  const double* p = x.data();
  const auto extended = [=](std::int64_t k) {
    if (k < 0) return 2.0 * p[0] - p[-k];
    if (k >= n) return 2.0 * p[n - 1] - p[2 * (n - 1) - k];
    return p[k];
  };
  return sum_squares(n - 2, [=](std::int64_t k) { return extended(k + 1 - m) - 2.0 * p[k + 1] + extended(k + 1 + m); });
}

struct Deviation {
  Kernel* kernel;
  std::int64_t reach;  ///< averages that a difference spans
  DegreesOfFreedom* degrees_of_freedom;
  double (*bias)(NoiseType, double samples, double m) = nullptr;  ///< of the variance, as a factor; none: 1
};
constexpr ModelRow<Deviation> kRows[] = {
    {"overlapping", {overlapping, 2, overlapping_degrees}, "Allan deviation, all overlapping differences"},
    {"modified", {modified, 3, modified_degrees}, "the same of phase averaged over tau"},
    {"hadamard", {hadamard, 3, hadamard_degrees}, "second differences of the rate, blind to a linear drift"},
    {"total", {total, 2, total_degrees, total_bias}, "overlapping on data extended by reflection"}};

ModelTable<Deviation> deviations() {
  return kRows;
}

/// Rate integrated within each segment, in units of rate x sample; the mean is taken off, which no deviation sees, so
/// that the sums stay small.
std::vector<std::vector<double>> phases(std::span<const double> rate, const std::vector<Segment>& segments) {
  std::vector<std::vector<double>> out;
  for (const Segment& s : segments) {
    throw_if_cancelled();
    const std::span<const double> part = rate.subspan(s.begin, s.end - s.begin);
    const double mean =
        std::accumulate(part.begin(), part.end(), 0.0) / static_cast<double>(std::max<std::size_t>(1, part.size()));
    std::vector<double> x(part.size() + 1, 0.0);
    for (std::size_t k = 0; k < part.size(); ++k) x[k + 1] = x[k] + (part[k] - mean);
    out.push_back(std::move(x));
  }
  return out;
}

/// Each segment estimates by itself: degrees of freedom add up.
void add_intervals(std::vector<DeviationPoint>& points, const Deviation& row, const std::vector<Segment>& segments,
                   double confidence) {
  const double outside_each_side = 0.5 * (1.0 - confidence);
  bool still_quantized = true;  // it falls fastest, so once another noise rules it does not come back
  for (std::size_t i = 0; i < points.size(); ++i) {
    DeviationPoint& p = points[i];
    // Slope over about a factor of two to each side, where the curve has that much.
    std::size_t a = i, b = i;
    while (a > 0 && points[a].tau_s * 2.0 > p.tau_s) --a;
    while (b + 1 < points.size() && points[b].tau_s < 2.0 * p.tau_s) ++b;
    double slope = -0.5;
    if (a != b && points[a].deviation > 0.0 && points[b].deviation > 0.0)
      slope = std::log(points[b].deviation / points[a].deviation) / std::log(points[b].tau_s / points[a].tau_s);
    NoiseType noise = noise_of_slope(slope);
    still_quantized = still_quantized && noise == NoiseType::kQuantization;
    if (noise == NoiseType::kQuantization && !still_quantized) noise = NoiseType::kWhite;
    const auto m = static_cast<double>(p.m);
    double bias = 0.0, weight = 0.0;
    p.edf = 0.0;
    for (const Segment& s : segments) {
      const auto samples = static_cast<double>(s.end - s.begin);
      if (samples < static_cast<double>(row.reach) * m) continue;
      p.edf += row.degrees_of_freedom(noise, samples, m);
      bias += samples * (row.bias ? row.bias(noise, samples, m) : 1.0);
      weight += samples;
    }
    const double centre = p.deviation / std::sqrt(bias / weight);
    p.low = centre * std::sqrt(p.edf / chi_square_threshold(outside_each_side, p.edf));
    p.high = centre * std::sqrt(p.edf / chi_square_threshold(1.0 - outside_each_side, p.edf));
  }
}

}  // namespace

Sampling sampling_of(std::span<const double> t_s, double gap_factor) {
  CANYON_CHECK(t_s.size() >= 2 && gap_factor > 1.0, t_s.size(), " times, gap factor ", gap_factor);
  for (std::size_t k = 0; k + 1 < t_s.size(); ++k)
    CANYON_CHECK(t_s[k + 1] > t_s[k], "time does not increase at sample ", k + 1);
  const std::size_t n = t_s.size(), window = std::min<std::size_t>(100, n - 1);
  std::vector<double> slopes;
  for (std::size_t k = 0; k + window < n; ++k)
    slopes.push_back((t_s[k + window] - t_s[k]) / static_cast<double>(window));
  std::nth_element(slopes.begin(), slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2), slopes.end());
  const double usual_s = slopes[slopes.size() / 2], longest_s = gap_factor * usual_s;
  // Lateness of a sample against an even clock; its lowest values near a sample are the sensor's own time there.
  const auto lateness = [&](std::size_t k) { return t_s[k] - t_s[0] - usual_s * static_cast<double>(k); };
  const auto lowest = [&](std::size_t begin, std::size_t end) {
    double least = lateness(begin);
    for (std::size_t k = begin + 1; k < end; ++k) least = std::min(least, lateness(k));
    return least;
  };
  Sampling out;
  std::size_t begin = 0;
  for (std::size_t k = 0; k + 1 < n; ++k) {
    if (t_s[k + 1] - t_s[k] <= longest_s) continue;
    const double before = lowest(k + 1 > window ? k + 1 - window : 0, k + 1);
    const double after = lowest(k + 1, std::min(n, k + 1 + window));
    if (after - before <= longest_s) continue;  // a stall of the host that the following samples make up
    out.segments.push_back({begin, k + 1});
    begin = k + 1;
  }
  out.segments.push_back({begin, n});
  double span_s = 0.0, intervals = 0.0, square = 0.0;
  for (const Segment& s : out.segments) {
    span_s += t_s[s.end - 1] - t_s[s.begin];
    intervals += static_cast<double>(s.end - s.begin - 1);
    for (std::size_t k = s.begin; k + 1 < s.end; ++k) square += (t_s[k + 1] - t_s[k]) * (t_s[k + 1] - t_s[k]);
  }
  out.interval_s = intervals > 0.0 ? span_s / intervals : usual_s;
  out.jitter_s = intervals > 0.0 ? std::sqrt(std::max(0.0, square / intervals - out.interval_s * out.interval_s)) : 0.0;
  return out;
}

std::vector<std::int64_t> averaging_factors(std::int64_t samples, int per_octave) {
  CANYON_CHECK(per_octave >= 1, "per_octave = ", per_octave);
  std::vector<std::int64_t> factors;
  const double most = static_cast<double>(samples) / kIndependentAverages;
  for (int step = 0;; ++step) {
    const double m = std::exp2(static_cast<double>(step) / per_octave);
    if (m > std::max(1.0, most)) break;
    const std::int64_t whole = std::llround(m);
    if (factors.empty() || whole > factors.back()) factors.push_back(whole);
  }
  return factors;
}

std::vector<std::string> deviation_kinds() {
  return model_names(deviations());
}

std::vector<DeviationPoint> deviation(const std::string& kind, std::span<const double> rate, const Sampling& sampling,
                                      std::span<const std::int64_t> factors, double confidence) {
  CANYON_CHECK(confidence > 0.0 && confidence < 1.0, "confidence = ", confidence);
  const Deviation& row = model_row(deviations(), kind).make;
  for (const Segment& s : sampling.segments)
    CANYON_CHECK(s.begin < s.end && s.end <= rate.size(), "segment ", s.begin, " to ", s.end, " of ", rate.size());
  const auto x = phases(rate, sampling.segments);
  std::vector<DeviationPoint> all(factors.size());
  parallel_for(factors.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      CANYON_CHECK(factors[i] >= 1, "averaging factor ", factors[i]);
      SquareSum sum;
      for (const auto& segment : x) {
        const SquareSum part = row.kernel(segment, factors[i]);
        sum.sum += part.sum;
        sum.count += part.count;
      }
      all[i].m = factors[i];
      all[i].tau_s = static_cast<double>(factors[i]) * sampling.interval_s;
      if (sum.count > 0)
        all[i].deviation =
            std::sqrt(sum.sum / (2.0 * static_cast<double>(sum.count))) / static_cast<double>(factors[i]);
      all[i].edf = static_cast<double>(sum.count);
    }
  });
  std::vector<DeviationPoint> points;
  for (const DeviationPoint& p : all)
    if (p.edf > 0.0) points.push_back(p);
  add_intervals(points, row, sampling.segments, confidence);
  return points;
}

}  // namespace canyon::inertial
