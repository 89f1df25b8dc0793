#include "inertial/allan/noise_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "inertial/allan/noise_terms.h"

#ifdef CANYON_WITH_CERES
#include <ceres/ceres.h>
#endif

namespace canyon::inertial {

std::vector<std::string> noise_process_names() {
  std::vector<std::string> names(std::begin(kNoiseTermNames), std::end(kNoiseTermNames));
  names.emplace_back("band_limit");
  return names;
}

const FittedTerm& NoiseFit::term(const std::string& name) const {
  for (const FittedTerm& t : terms)
    if (t.name == name) return t;
  CANYON_CHECK(false, "no noise process of that name: ", name);
  return terms.front();
}

double NoiseFit::deviation_at(double tau_s) const {
  double variance = 0.0;
  for (int k = 0; k < kNoiseTerms; ++k) {
    const double value = terms.at(static_cast<std::size_t>(k)).value;
    const double second = k == kWhite      ? neighbour_correlation / (1.0 + 2.0 * neighbour_correlation)
                          : k == kSinusoid ? frequency_hz
                                           : correlation_time_s;
    if (value > 0.0) variance += allan_variance(k, value, second, tau_s, interval_s);
  }
  return std::sqrt(variance);
}

#ifndef CANYON_WITH_CERES

Result<NoiseFit> fit_noise(std::span<const DeviationPoint>, int, const std::vector<std::string>&) {
  return Error{"", 0, "", "this build has no noise fit", "a build with CANYON_WITH_CERES=ON"};
}

#else

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Real sensors are not exactly a sum of these processes: filters and rounding bend the curve by some per cent where
// long logs would tell it to a tenth of one. 1-sigma of a point's deviation beyond statistics: the smallest of these
// with which the misfit is what statistics and it explain.
constexpr double kModelTolerances[] = {0.001, 0.005, 0.02};
constexpr double kDeterminedSigmas = 2.0;
// A process that forgets within a hundred samples is white noise as the sensor's bandwidth shapes it, not a bias.
constexpr double kLeastCorrelationSamples = 100.0;
// rho / (1 + 2 rho) at rho = 1/2, where two samples are averaged with equal weight.
constexpr double kLargestBandLimit = 0.25;

/// Which processes, and which of them have a second parameter to be found.
struct Combination {
  std::vector<int> terms;  ///< ascending
  bool band_limited = false;

  bool has_second(int term) const {
    return term == kGaussMarkov || term == kSinusoid || (term == kWhite && band_limited);
  }
  std::size_t parameters() const {
    std::size_t n = terms.size();
    for (const int term : terms) n += has_second(term) ? 1 : 0;
    return n;
  }
};

/// The parameters are logarithms: of each term its coefficient, then its second if it has one.
/// One point: residual of the logarithm of the variance.
class LogVariance {
 public:
  LogVariance(const Combination& model, const DeviationPoint& point, int per_octave, double tolerance)
      : model_(model),
        tau_s_(point.tau_s),
        interval_s_(point.tau_s / static_cast<double>(point.m)),
        // The logarithm of a chi-square estimate lies low by 1 / edf on average.
        measured_(2.0 * std::log(point.deviation) + 1.0 / point.edf),
        weight_(1.0 / std::sqrt(per_octave * 2.0 / point.edf + 4.0 * tolerance * tolerance)) {}

  template <class T>
  bool operator()(T const* const* parameters, T* residual) const {
    using std::exp;
    using std::log;
    const T* p = parameters[0];
    T variance(0.0);
    for (const int term : model_.terms) {
      const T value = exp(*p++);
      const T second = model_.has_second(term) ? T(exp(*p++)) : T(0.0);
      variance += allan_variance(term, value, second, tau_s_, interval_s_);
    }
    residual[0] = weight_ * (log(variance) - measured_);
    return true;
  }

 private:
  const Combination& model_;
  double tau_s_, interval_s_, measured_, weight_;
};

struct Solution {
  Combination model;
  std::vector<double> logs, sigmas;
  double chi_square = kInfinity;
};

/// Where the search begins: each process alone explains the curve where it usually shows.
double first_guess(int term, std::span<const DeviationPoint> points) {
  const DeviationPoint& first = points.front();
  const DeviationPoint& last = points.back();
  double least = kInfinity, white = kInfinity;
  for (const DeviationPoint& p : points) {
    least = std::min(least, p.deviation);
    white = std::min(white, p.deviation * std::sqrt(p.tau_s));
  }
  switch (term) {
    case kQuantization:
      return first.deviation * first.tau_s / std::sqrt(3.0);
    case kWhite:
      return white;
    case kBiasInstability:
      return least / std::sqrt(2.0 * std::log(2.0) / kPi);
    case kRateRandomWalk:
      return last.deviation * std::sqrt(3.0 / last.tau_s);
    case kRamp:
      return last.deviation * std::sqrt(2.0) / last.tau_s;
    default:
      return least;
  }
}

/// Start values and limits of the second parameters.
struct Seconds {
  double correlation_s = 0.0;
  double frequency_hz = 0.0;
};
struct Limits {
  double low, high;
};
Limits second_limits(int term, std::span<const DeviationPoint> points) {
  const double interval_s = points.front().tau_s / static_cast<double>(points.front().m), last_s = points.back().tau_s;
  if (term == kWhite) return {1e-3, kLargestBandLimit};
  // A wave must turn once within the longest average and twice between samples.
  if (term == kSinusoid) return {0.5 / last_s, 0.45 / interval_s};
  const double least_s = kLeastCorrelationSamples * interval_s;
  return {least_s, 3.0 * std::max(last_s, 2.0 * least_s)};
}

std::vector<double> standard_deviations(ceres::Problem& problem, const std::vector<double>& logs) {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  options.null_space_rank = -1;
  options.num_threads = 1;
  ceres::Covariance covariance(options);
  const std::size_t n = logs.size();
  std::vector<double> sigmas(n, kInfinity), matrix(n * n);
  const std::vector<std::pair<const double*, const double*> > blocks = {{logs.data(), logs.data()}};
  if (covariance.Compute(blocks, &problem) && covariance.GetCovarianceBlock(logs.data(), logs.data(), matrix.data()))
    for (std::size_t i = 0; i < n; ++i) sigmas[i] = std::sqrt(std::max(0.0, matrix[i * n + i]));
  return sigmas;
}

Solution solve(const Combination& model, std::span<const DeviationPoint> points, int per_octave, double tolerance,
               Seconds start) {
  Solution out{model, {}, {}, kInfinity};
  std::vector<Limits> limits;
  for (const int term : model.terms) {
    const double guess = first_guess(term, points);
    out.logs.push_back(std::log(guess));
    // A process that the curve does not need runs off towards zero; it need not run on for ever.
    limits.push_back({guess * std::exp(-20.0), guess * std::exp(5.0)});
    if (!model.has_second(term)) continue;
    limits.push_back(second_limits(term, points));
    const double second = term == kWhite ? 0.1 : term == kSinusoid ? start.frequency_hz : start.correlation_s;
    out.logs.push_back(std::log(std::clamp(second, limits.back().low, limits.back().high)));
  }
  ceres::Problem problem;
  for (const DeviationPoint& point : points) {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<LogVariance, 10>(
        new LogVariance(out.model, point, per_octave, tolerance));
    cost->AddParameterBlock(static_cast<int>(out.logs.size()));
    cost->SetNumResiduals(1);
    problem.AddResidualBlock(cost, nullptr, out.logs.data());
  }
  for (std::size_t i = 0; i < limits.size(); ++i) {
    problem.SetParameterLowerBound(out.logs.data(), static_cast<int>(i), std::log(limits[i].low));
    problem.SetParameterUpperBound(out.logs.data(), static_cast<int>(i), std::log(limits[i].high));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  out.chi_square = 2.0 * summary.final_cost;
  out.sigmas = standard_deviations(problem, out.logs);
  return out;
}

/// The search for the combination with the least information criterion.
class Search {
 public:
  Search(std::span<const DeviationPoint> points, int per_octave, double tolerance,
         const std::vector<std::string>& allowed)
      : points_(points), per_octave_(per_octave), tolerance_(tolerance), allowed_(allowed) {}

  double chi_square_per_dof() const {
    return best_.chi_square / std::max(1.0, effective_points() - static_cast<double>(best_.logs.size()));
  }
  double effective_points() const { return std::max(2.0, static_cast<double>(points_.size()) / per_octave_); }

  Solution best() {
    try_all(0.0);
    if (!may_use("sinusoid")) return best_;
    // A line is looked for beside the best of the others; then all combinations are weighed with it.
    const Solution without = best_;
    Combination with = without.model;
    with.terms.push_back(kSinusoid);
    const Limits range = second_limits(kSinusoid, points_);
    const double before = least_;
    double frequency_hz = 0.0;
    for (double start = range.low; start < range.high; start *= std::sqrt(2.0)) {
      const double criterion = weigh(solve(with, points_, per_octave_, tolerance_, {seconds_of(without), start}));
      if (criterion < before && criterion == least_) frequency_hz = best_frequency();
    }
    if (frequency_hz > 0.0) try_all(frequency_hz);
    return best_;
  }

 private:
  bool may_use(const std::string& name) const {
    return allowed_.empty() || std::find(allowed_.begin(), allowed_.end(), name) != allowed_.end();
  }

  double weigh(Solution s) {
    const double criterion = s.chi_square + static_cast<double>(s.logs.size()) * std::log(effective_points());
    if (static_cast<double>(s.logs.size()) <= effective_points() && criterion < least_) {
      least_ = criterion;
      best_ = std::move(s);
    }
    return criterion;
  }

  /// The second parameter of a term in a solution; 0 if it is not there.
  static double second_of(const Solution& s, int wanted) {
    std::size_t i = 0;
    for (const int term : s.model.terms) {
      if (term == wanted && s.model.has_second(term)) return std::exp(s.logs[i + 1]);
      i += s.model.has_second(term) ? 2 : 1;
    }
    return 0.0;
  }
  static double seconds_of(const Solution& s) { return second_of(s, kGaussMarkov); }
  double best_frequency() const { return second_of(best_, kSinusoid); }

  /// Every combination; those with a sinusoid only if its frequency is known.
  void try_all(double frequency_hz) {
    for (int subset = 1; subset < 1 << kSinusoid; ++subset) {
      Combination model;
      bool allowed = true;
      for (int term = 0; term < kSinusoid; ++term) {
        if (!(subset & 1 << term)) continue;
        model.terms.push_back(term);
        allowed = allowed && may_use(kNoiseTermNames[term]);
      }
      if (!allowed) continue;
      if (frequency_hz > 0.0) model.terms.push_back(kSinusoid);
      try_starts(model, frequency_hz);
      // Quantization has the same shape with the other sign.
      if ((subset & 1 << kWhite) == 0 || (subset & 1 << kQuantization) != 0 || !may_use("band_limit")) continue;
      model.band_limited = true;
      try_starts(model, frequency_hz);
    }
  }

  /// A correlation time has several local minima: begin in each decade.
  void try_starts(const Combination& model, double frequency_hz) {
    if (static_cast<double>(model.parameters()) > effective_points()) return;
    const bool markov = std::find(model.terms.begin(), model.terms.end(), kGaussMarkov) != model.terms.end();
    if (!markov) {
      weigh(solve(model, points_, per_octave_, tolerance_, {0.0, frequency_hz}));
      return;
    }
    const Limits range = second_limits(kGaussMarkov, points_);
    for (double start = 1.5 * range.low; start <= std::max(points_.back().tau_s, 1.5 * range.low); start *= 10.0)
      weigh(solve(model, points_, per_octave_, tolerance_, {start, frequency_hz}));
  }

  std::span<const DeviationPoint> points_;
  int per_octave_;
  double tolerance_;
  const std::vector<std::string>& allowed_;
  Solution best_;
  double least_ = kInfinity;
};

}  // namespace

Result<NoiseFit> fit_noise(std::span<const DeviationPoint> points, int points_per_octave,
                           const std::vector<std::string>& allowed) {
  CANYON_CHECK(points_per_octave >= 1, "points_per_octave = ", points_per_octave);
  std::vector<DeviationPoint> used;
  for (const DeviationPoint& p : points)
    if (p.deviation > 0.0 && std::isfinite(p.deviation)) used.push_back(p);
  if (used.size() < 3)
    return Error{"", 0, "", std::to_string(used.size()) + " points of deviation above zero",
                 "three or more: a longer log"};
  NoiseFit fit;
  Solution best;
  for (const double tolerance : kModelTolerances) {
    Search search(used, points_per_octave, tolerance, allowed);
    best = search.best();
    fit.chi_square_per_dof = search.chi_square_per_dof();
    if (fit.chi_square_per_dof <= 1.0) break;
  }
  fit.interval_s = used.front().tau_s / static_cast<double>(used.front().m);
  // Where the processes describe the curve worse than its statistics, the sigmas grow with the misfit.
  const double inflation = std::sqrt(std::max(1.0, fit.chi_square_per_dof));
  for (const char* name : kNoiseTermNames) fit.terms.push_back({name, 0.0, kInfinity, false});
  std::size_t i = 0;
  for (const int term : best.model.terms) {
    const double value = std::exp(best.logs[i]), sigma = value * best.sigmas[i] * inflation;
    const bool has_second = best.model.has_second(term);
    if (value > kDeterminedSigmas * sigma) {
      fit.terms[static_cast<std::size_t>(term)] = {kNoiseTermNames[term], value, sigma, true};
      const double second = has_second ? std::exp(best.logs[i + 1]) : 0.0;
      if (term == kGaussMarkov) fit.correlation_time_s = second;
      if (term == kSinusoid) fit.frequency_hz = second;
      if (term == kWhite) fit.neighbour_correlation = second / (1.0 - 2.0 * second);
    }
    i += has_second ? 2 : 1;
  }
  return fit;
}

#endif  // CANYON_WITH_CERES

}  // namespace canyon::inertial
