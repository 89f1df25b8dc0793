// What a log's times say of its samples, and what a curve of averages says of itself: gaps and stalls, averaging times,
// intervals by the noise that the slope shows, fits over many logs, and analyses as their files say them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/allan/degrees_of_freedom.h"
#include "canyon/inertial/allan/deviation.h"
#include "canyon/inertial/allan/log_analysis.h"
#include "canyon/inertial/allan/motion_check.h"
#include "canyon/inertial/allan/noise_fit.h"
#include "canyon/inertial/errors/flicker.h"
#include "canyon/inertial/errors/markov_process.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// Stamps of 100 Hz with gaps of known length at known samples, and a stall of the host that the following samples make
/// up: the segments are those between the gaps, the interval the mean within them and the jitter its scatter, by the
/// definition; a longer factor joins what a shorter one parts, and what is asked for is kept to.
StressFigure gaps_and_stalls() {
  Looks looks;
  const RandomStream draws(4, "stress.stamps");
  const std::vector<std::pair<std::size_t, double>> gaps = {
      {40, 0.7}, {41, 3.0}, {600, 0.2}, {1500, 0.065}, {1999, 9.0}};
  std::vector<double> t;
  double now = 12.5;
  for (std::size_t k = 0; k < 2000; ++k) {
    if (k > 0) now += 0.01;
    for (const auto& [at, length] : gaps)
      if (k == at) now += length - 0.01;
    t.push_back(now + 2e-4 * draws.normal(0, k));
  }
  // From 900 to 930 all come at once, a third of a second late, and on from there in time.
  for (std::size_t k = 900; k < 930; ++k) t[k] = t[930] - 1e-3 * static_cast<double>(930 - k);
  for (const double factor : {4.0, 5.0, 8.0, 50.0, 400.0}) {
    std::vector<Segment> expected;
    std::size_t begin = 0;
    for (const auto& [at, length] : gaps)
      if (length > 0.01 * factor) {
        expected.push_back({begin, at});
        begin = at;
      }
    expected.push_back({begin, t.size()});
    const Sampling found = sampling_of(t, factor);
    looks.right(found.segments.size() == expected.size());
    if (found.segments.size() != expected.size()) return looks.figure();
    long double sum = 0.0L, square = 0.0L, count = 0.0L;
    for (std::size_t s = 0; s < expected.size(); ++s) {
      looks.right(found.segments[s].begin == expected[s].begin && found.segments[s].end == expected[s].end);
      for (std::size_t k = expected[s].begin; k + 1 < expected[s].end; ++k) sum += t[k + 1] - t[k], count += 1.0L;
    }
    const long double mean = sum / count;
    for (const Segment& s : expected)
      for (std::size_t k = s.begin; k + 1 < s.end; ++k) square += (t[k + 1] - t[k] - mean) * (t[k + 1] - t[k] - mean);
    looks.near(found.interval_s, static_cast<double>(mean), 64.0 * kEpsilon);
    // A difference of squares of 0.01 s and more, over its root.
    looks.near(found.jitter_s / static_cast<double>(std::sqrt(square / count)), 1.0, 1e-13);
  }
  // One sample each: nothing within, and the interval that is usual.
  const std::vector<double> two = {1.0, 1.5};
  looks.near(sampling_of(two).interval_s, 0.5, 1e-15);
  looks.right(sampling_of(two).segments.size() == 1 && sampling_of(two).jitter_s == 0.0);
  looks.right(stress::not_refused([&] { sampling_of(two, 1.0); }) == 0);
  return looks.figure();
}

/// Averaging times: whole samples, ascending, each power of two, as many to an octave as is asked for once it has so
/// many, none that leaves fewer than nine averages, and the next one would.
StressFigure averaging_times() {
  int wrong = 0;
  for (const std::int64_t samples : {1, 8, 9, 17, 18, 19, 100, 5000, 1'000'000})
    for (const int per_octave : {1, 2, 3, 4, 7}) {
      const auto m = averaging_factors(samples, per_octave);
      if (m.empty() || m.front() != 1) return {kInfinity, 0.0};
      for (std::size_t i = 1; i < m.size(); ++i) wrong += m[i] > m[i - 1] ? 0 : 1;
      const auto most = worse<std::int64_t>(1, samples / 9);
      wrong += m.back() <= most + 1 ? 0 : 1;  // rounded to a whole number
      wrong += static_cast<double>(m.back()) * std::exp2(1.0 / per_octave) + 1.0 > static_cast<double>(samples) / 9.0
                   ? 0
                   : 1;
      for (std::int64_t power = 1; power <= most; power *= 2) {
        wrong += std::count(m.begin(), m.end(), power) == 1 ? 0 : 1;
        if (power < 32 || 2 * power > most) continue;
        wrong += std::count_if(m.begin(), m.end(), [&](auto x) { return x >= power && x < 2 * power; }) == per_octave
                     ? 0
                     : 1;
      }
    }
  return {1.0 * wrong, 0.0};
}

/// Rates of one kind of noise.
std::vector<double> rates_of(NoiseType noise, std::size_t count) {
  const RandomStream draws(11, "stress.averages");
  std::vector<double> y(count, 0.0);
  double walk = 0.0;
  std::vector<MarkovProcess> parts;
  if (noise == NoiseType::kFlicker)
    for (const FlickerPart& part : flicker_parts(1.0, 1e-4, 10.0))
      parts.push_back(MarkovProcess::gauss_markov(1, "stress.averages", static_cast<std::uint32_t>(parts.size()),
                                                  part.sigma, part.tau_s, 0.01));
  for (std::size_t k = 0; k < count; ++k) {
    walk += draws.normal(1, k);
    if (noise == NoiseType::kQuantization) y[k] = draws.normal(0, k + 1) - draws.normal(0, k);
    if (noise == NoiseType::kWhite) y[k] = draws.normal(0, k);
    if (noise == NoiseType::kRandomWalk) y[k] = walk;
    for (MarkovProcess& part : parts) y[k] += part.at(static_cast<std::int64_t>(k)).x();
  }
  return y;
}

/// Intervals of a curve of one noise, over segments of unequal length: degrees of freedom are those of that noise for
/// each segment that is long enough, added up, wherever averages are short enough for the slope to show it (four sigma
/// of it below its border); the interval is chi-square's of so many, about the deviation as its kind reads that noise,
/// which of the total one is low by its law, segments by their samples.
StressFigure intervals(const std::string& kind, NoiseType noise) {
  Looks looks;
  constexpr double kConfidence = 0.8;
  const auto y = rates_of(noise, 9000);
  const Sampling sampling{0.01, {{0, 300}, {300, 6300}, {6300, 6310}, {6400, 9000}}, 0.0};
  const std::vector<std::int64_t> factors{1, 2, 3, 4, 6, 8, 11, 16, 23, 32};
  DegreesOfFreedom* const degrees = kind == "overlapping" ? overlapping_degrees
                                    : kind == "modified"  ? modified_degrees
                                    : kind == "hadamard"  ? hadamard_degrees
                                                          : total_degrees;
  const double reach = kind == "modified" || kind == "hadamard" ? 3.0 : 2.0;
  const auto points = deviation(kind, y, sampling, factors, kConfidence);
  looks.right(points.size() == factors.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const DeviationPoint& p = points[i];
    looks.right(p.m == factors[i]);
    const auto m = static_cast<double>(p.m);
    // Slopes of short averages of the modified deviation are those of white phase and white rate alike, and of a walk
    // in steps Hadamard's is lower.
    if (kind != "overlapping" && kind != "total" && p.m < 6) continue;
    double edf = 0.0, bias = 0.0, weight = 0.0;
    for (const Segment& s : sampling.segments) {
      const auto n = static_cast<double>(s.end - s.begin);
      if (n < reach * m) continue;
      edf += degrees(noise, n, m), weight += n;
      bias += n * (kind == "total" ? total_bias(noise, n, m) : 1.0);
    }
    looks.close(p.edf, edf, 16.0);
    const double centre = p.deviation / std::sqrt(bias / weight);
    // The quantile of degrees that are rounded otherwise.
    looks.close(p.low, centre * std::sqrt(edf / chi_square_threshold(0.1, edf)), 64.0);
    looks.close(p.high, centre * std::sqrt(edf / chi_square_threshold(0.9, edf)), 64.0);
  }
  return looks.figure();
}

/// Of averages one after another the first are rounded, then white: a wave of long period falls as fast as rounding
/// does, and yet counts as white noise, since it is not the first; factors that no segment is long enough for are left
/// out.
StressFigure noise_that_follows() {
  Looks looks;
  std::vector<double> y = rates_of(NoiseType::kWhite, 4000);
  for (std::size_t k = 0; k < y.size(); ++k) y[k] += 30.0 * std::sin(2.0 * kPi * static_cast<double>(k) / 64.0);
  const Sampling sampling{0.01, {{0, 4000}}, 0.0};
  const std::vector<std::int64_t> factors{1, 2, 4, 8, 16, 30, 36, 42, 48, 54, 3000};
  const auto points = deviation("overlapping", y, sampling, factors, 0.9);
  looks.right(points.size() == factors.size() - 1);
  for (const DeviationPoint& p : points)
    if (p.m == 42) looks.close(p.edf, overlapping_degrees(NoiseType::kWhite, 4000.0, 42.0), 4.0);
  return looks.figure();
}

/// Seventy logs of a known noise, fitted with the processes that they hold: the errors of the logarithms have mean
/// nothing and the scatter that each fit says, to five deviations (and to the tenth that the curve's covariance is that
/// of white noise alone).
StressFigure fits_of_many(double walk) {
  if (!can_fit_noise()) return {0.0, 1.0};
  Looks looks;
  constexpr int kLogs = 70;
  constexpr std::size_t kSamples = 3000;
  constexpr double kStep_s = 0.01, kN = 0.02;
  const std::vector<std::string> allowed =
      walk > 0.0 ? std::vector<std::string>{"white", "rate_random_walk"} : std::vector<std::string>{"white"};
  const auto factors = averaging_factors(kSamples, 4);
  double mean = 0.0, square = 0.0, mean_walk = 0.0, square_walk = 0.0, misfit = 0.0;
  for (int log = 0; log < kLogs; ++log) {
    const RandomStream draws(static_cast<std::uint64_t>(log), "stress.fits");
    std::vector<double> y(kSamples);
    double bias = 0.0;
    for (std::size_t k = 0; k < kSamples; ++k) {
      bias += walk * std::sqrt(kStep_s) * draws.normal(1, k);
      y[k] = kN / std::sqrt(kStep_s) * draws.normal(0, k) + bias;
    }
    const auto points = deviation("overlapping", y, {kStep_s, {{0, kSamples}}, 0.0}, factors);
    const auto fit = fit_noise(points, 4, allowed);
    if (!fit) return {kInfinity, 1.0};
    for (const FittedTerm& term : fit->terms)
      looks.right(term.determined == (term.name == "white" || (walk > 0.0 && term.name == "rate_random_walk")) &&
                  (term.determined || term.value == 0.0));
    looks.close(fit->interval_s, kStep_s, 8.0);
    const FittedTerm& white = fit->term("white");
    const double off = std::log(white.value / kN) * white.value / white.sigma;
    mean += off / kLogs, square += off * off / kLogs;
    misfit += fit->chi_square_per_dof / kLogs;
    if (walk == 0.0) continue;
    const FittedTerm& slow = fit->term("rate_random_walk");
    const double beside = std::log(slow.value / walk) * slow.value / slow.sigma;
    mean_walk += beside / kLogs, square_walk += beside * beside / kLogs;
  }
  const double five = 5.0 / std::sqrt(1.0 * kLogs);
  looks.near(mean, 0.0, five), looks.near(square, 1.0, std::sqrt(2.0) * five + 0.1);
  if (walk > 0.0) looks.near(mean_walk, 0.0, five), looks.near(square_walk, 1.0, std::sqrt(2.0) * five + 0.1);
  // Of octaves that hang together the misfit is less than 1, and scatters by half of it.
  looks.right(misfit > 0.1 && misfit < 1.5);
  return looks.figure();
}

/// What cannot be fitted is refused: points that are too few, or too few of them numbers; and a process that there is
/// not is a mistake of the program.
StressFigure refused_curves() {
  if (!can_fit_noise()) return {0.0, 0.0};
  int passed = 0;
  std::vector<DeviationPoint> points(5);
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k].m = static_cast<std::int64_t>(1) << k;
    points[k].tau_s = 0.1 * static_cast<double>(points[k].m);
    points[k].deviation = 1.0 / std::sqrt(points[k].tau_s);
    points[k].edf = 1000.0 / static_cast<double>(points[k].m);
  }
  const auto fit = fit_noise(points, 1, {"white"});
  passed += fit.ok() && std::abs(fit->term("white").value - 1.0) < 0.05 ? 0 : 1;
  passed += fit.ok() && stress::not_refused([&] { fit->term("blue"); }) == 0 ? 0 : 1;
  passed += fit_noise(std::span(points).first(2), 1, {"white"}).ok() ? 1 : 0;
  points[1].deviation = std::nan(""), points[2].deviation = 0.0, points[3].deviation = kInfinity;
  passed += fit_noise(points, 1, {"white"}).ok() ? 1 : 0;
  passed += stress::not_refused([&] { (void)fit_noise(points, 0); });
  return {1.0 * passed, 0.0};
}

/// The whole analysis of a log without a gyroscope's z and with a gap, and its file: the channels that there are, each
/// with the curves that are asked for as they are by themselves, to the nine digits that are written.
StressFigure analysed() {
  Looks looks;
  const RandomStream draws(6, "stress.analysed");
  ImuLog log;
  for (std::size_t k = 0; k < 4000; ++k) log.t_s.push_back(0.02 * static_cast<double>(k) + (k < 1500 ? 0.0 : 30.0));
  for (std::uint32_t c = 0; c < 6; ++c)
    if (c != 2)
      for (std::size_t k = 0; k < 4000; ++k)
        log.channels[c].push_back((c == 5 ? 9.8 : 0.0) + (c < 3 ? 1e-3 : 2e-2) * draws.normal(c, k));
  LogAnalysisOptions options;
  options.noise.per_octave = 2, options.noise.confidence = 0.7;
  if (can_fit_noise()) options.noise.processes = {"white"};
  options.kinds = {"modified", "total"};
  const auto analysis = analyse_log(log, options);
  if (!analysis) return {kInfinity, 1.0};
  looks.near(analysis->duration_s(), 3999 * 0.02 + 30.0 + 0.02, 1e-9);
  looks.right(analysis->sampling.segments.size() == 2 && !analysis->motion.moves() && analysis->channels.size() == 5);
  if (analysis->channels.size() != 5 || analysis->more.size() != 5) return {kInfinity, 1.0};
  const auto factors = averaging_factors(4000, 2);
  struct Row {
    std::string axis, kind, unit;
    DeviationPoint point;
    double fit;
  };
  std::vector<Row> expected;
  for (std::size_t i = 0; i < 5; ++i) {
    const auto c = static_cast<std::size_t>(i < 2 ? i : i + 1);
    const ChannelNoise& noise = analysis->channels[i];
    looks.right(noise.channel == static_cast<int>(c) && noise.fit.has_value() == can_fit_noise());
    for (const std::string& kind : {std::string("overlapping"), std::string("modified"), std::string("total")}) {
      const auto points = deviation(kind, log.channels[c], analysis->sampling, factors, 0.7);
      const auto& found = kind == "overlapping" ? noise.points : analysis->more[i][kind == "modified" ? 0 : 1];
      looks.right(found.size() == points.size());
      for (std::size_t k = 0; k < points.size() && k < found.size(); ++k) {
        looks.right(found[k].m == points[k].m && found[k].deviation == points[k].deviation &&
                    found[k].low == points[k].low && found[k].edf == points[k].edf);
        expected.push_back({kChannelNames[c], kind, c < 3 ? "rad/s" : "m/s^2", points[k],
                            kind == "overlapping" && noise.fit ? noise.fit->deviation_at(points[k].tau_s) : 0.0});
      }
    }
    // Averages of many samples are white to some per cent, of which the fit is one curve: its coefficient over
    // sqrt(tau).
    if (noise.fit) looks.near(noise.fit->term("white").value / ((c < 3 ? 1e-3 : 2e-2) * std::sqrt(0.02)), 1.0, 0.1);
  }
  std::istringstream text(deviations_csv(*analysis));
  std::string line;
  std::getline(text, line);
  for (const Row& row : expected) {
    if (!std::getline(text, line)) return {kInfinity, 1.0};
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, ',');) fields.push_back(field);
    if (fields.size() != 10) return {kInfinity, 1.0};
    looks.right(fields[0] == row.axis && fields[1] == row.kind && fields[9] == row.unit);
    const double values[] = {row.point.tau_s, static_cast<double>(row.point.m), row.point.deviation, row.point.low,
                             row.point.high};
    for (std::size_t k = 0; k < 5; ++k) looks.near(std::stod(fields[2 + k]) / values[k], 1.0, 1e-8);
    looks.near(std::stod(fields[7]) / row.point.edf, 1.0, 1e-3);
    looks.right(fields[8].empty() == (row.fit == 0.0));
    if (row.fit > 0.0) looks.near(std::stod(fields[8]) / row.fit, 1.0, 1e-8);
  }
  looks.right(!std::getline(text, line));
  return looks.figure();
}

/// Limits of rest that are not those of a quiet unit at 100 Hz: windows of ten samples at a slow rate, an even turn, a
/// noisy unit whose own scatter is the measure and one whose noise nothing excuses, and motion in several seconds that
/// is told as one stretch with its worst.
StressFigure limits_of_rest() {
  Looks looks;
  const RandomStream draws(9, "stress.rest");
  const auto log_of = [&](double rate_hz, std::size_t count, double gyro,
                          const std::function<double(std::size_t, double)>& added) {
    ImuLog log;
    for (std::size_t k = 0; k < count; ++k) log.t_s.push_back(static_cast<double>(k) / rate_hz);
    for (std::size_t c = 0; c < 6; ++c)
      for (std::size_t k = 0; k < count; ++k)
        log.channels[c].push_back((c < 3 ? gyro : 1e-3) * draws.normal(static_cast<std::uint32_t>(c), k) +
                                  (c == 5 ? 9.8 : 0.0) + added(c, log.t_s[k]));
    return log;
  };
  // At 5 Hz a window is two seconds: the one that holds a push of 20 s is found whole.
  const MotionFound slow = find_motion(
      log_of(5.0, 1000, 1e-5, [](std::size_t c, double t) { return c == 4 && t >= 60.0 && t < 80.0 ? 1.0 : 0.0; }));
  looks.right(slow.intervals.size() == 1);
  if (slow.moves()) {
    looks.near(slow.worst().from_s, 60.0, 1e-9), looks.near(slow.worst().to_s, 79.8, 1e-9);
    looks.near(slow.share, 0.1, 1e-9);
    looks.near(slow.worst().excess, 2.0, 0.02);  // four sigmas of a mean of ten, 1.3e-3 of 0.5
  }
  // An even turn is a bias up to 10 deg/s, beside which gravity is none.
  for (const double turn_deg_s : {9.8, 10.2}) {
    const MotionFound even = find_motion(
        log_of(100.0, 3000, 1e-4, [&](std::size_t c, double) { return c == 1 ? -turn_deg_s * kDegree : 0.0; }));
    looks.right(even.moves() == (turn_deg_s > 10.0));
    if (even.moves()) {
      looks.right(even.intervals.size() == 1 && even.worst().channel == 1 && !even.worst().shakes);
      looks.near(even.share, 1.0, 1e-9), looks.near(even.worst().amount / kDegree, turn_deg_s, 1e-2);
      looks.near(even.worst().excess, 0.1 * turn_deg_s, 1e-3);
    }
  }
  // A unit of noise s: its seconds shake from five times that of its quietest on, but not beyond 5 deg/s. The quietest
  // tenth of scatters of 100 samples lies a tenth below.
  for (const auto& [noise_deg_s, limit_deg_s] : {std::pair(0.3, 1.4), std::pair(2.0, 5.0)})
    for (const double times : {0.8, 1.3}) {
      const double shaken = std::sqrt(std::pow(times * limit_deg_s, 2) - noise_deg_s * noise_deg_s) * std::sqrt(2.0);
      const MotionFound found =
          find_motion(log_of(100.0, 6000, noise_deg_s * kDegree, [&, size = shaken](std::size_t c, double t) {
            return c == 0 && t >= 30.0 && t < 40.0 ? size * kDegree * std::sin(2.0 * kPi * 13.0 * t) : 0.0;
          }));
      looks.right(found.moves() == (times > 1.0));
      if (!found.moves()) continue;
      looks.right(found.worst().channel == 0 && found.worst().shakes);
      looks.near(found.worst().from_s, 30.0, 1.01), looks.near(found.worst().to_s, 40.0, 1.01);
    }
  // One stretch of three pushes, the middle one the worst, and a second stretch after rest.
  const MotionFound several = find_motion(log_of(50.0, 3000, 1e-5, [](std::size_t c, double t) {
    if (c == 3 && t >= 10.0 && t < 12.0) return 0.8;
    if (c == 4 && t >= 12.0 && t < 14.0) return -1.7;
    if (c == 3 && t >= 14.0 && t < 16.0) return 0.9;
    return c == 5 && t >= 30.0 && t < 31.0 ? 1.2 : 0.0;
  }));
  looks.right(several.intervals.size() == 2);
  if (several.intervals.size() == 2) {
    const MovingInterval &first = several.intervals[0], &second = several.intervals[1];
    looks.near(first.from_s, 10.0, 1e-9), looks.near(first.to_s, 15.98, 1e-9);
    looks.right(first.channel == 4 && second.channel == 5 && &several.worst() == &first);
    looks.near(first.amount, 1.7, 1e-3), looks.near(second.amount, 1.2, 1e-3);
    looks.near(several.share, 7.0 / 60.0, 1e-9);
  }
  looks.right(stress::not_refused([] { MotionFound{}.worst(); }) == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> average_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "what the times of a log say of its samples",
           "a stall of the host that is taken for a gap, a mean across one",
           "segments, interval and scatter by their definitions: roundings", "of the bound"});
  rows.add("averages/gaps_and_stalls", gaps_and_stalls);
  rows.of({StressGroup::kData, "averaging times of a log",
           "one that leaves fewer than nine averages, an octave without one",
           "whole, ascending, each power of two, as many as may be: exact", "wrong"});
  rows.add("averages/averaging_times", averaging_times);
  rows.of({StressGroup::kData, "intervals of a curve of one noise",
           "degrees of freedom of another slope, of segments that are too short, a bias of another kind",
           "those of the noise that is there, added up, and chi-square's interval: roundings", "of the bound"});
  for (const auto& [name, noise] :
       {std::pair("rounding", NoiseType::kQuantization), std::pair("white", NoiseType::kWhite),
        std::pair("flicker", NoiseType::kFlicker), std::pair("walk", NoiseType::kRandomWalk)})
    for (const std::string& kind : deviation_kinds()) {
      // Blind to what falls faster, or to what rises: the slope of another noise.
      rows.add("averages/" + kind + "_of_" + name, [k = kind, n = noise] { return intervals(k, n); });
    }
  rows.add("averages/noise_that_follows", noise_that_follows);
  rows.of({StressGroup::kData, "coefficients fitted to many logs",
           "a sigma of another scale, a process that is not there",
           "errors as large as is said: five deviations of 70 logs", "of the bound"});
  rows.add("averages/fits_of_white_logs", [] { return fits_of_many(0.0); });
  rows.add("averages/fits_of_walking_logs", [] { return fits_of_many(0.05); });
  rows.of({StressGroup::kData, "curves that cannot be fitted", "two points, or numbers that are none, make a fit",
           "refused, and a fit of what can be", "let through"});
  rows.add("averages/curves_refused", refused_curves);
  rows.of({StressGroup::kData, "a log's analysis, and its file", "another channel's curve, a kind in the other's place",
           "each curve as by itself, and to nine digits in the file", "of the bound"});
  rows.add("averages/analysis_of_a_log", analysed);
  rows.of({StressGroup::kData, "what rest allows", "a limit of the other triad, a window of one second of five samples",
           "told from its limit on and not below, where it begins and ends: windows", "of the bound"});
  rows.add("averages/limits_of_rest", limits_of_rest);
  return rows.take();
}

}  // namespace canyon::inertial
