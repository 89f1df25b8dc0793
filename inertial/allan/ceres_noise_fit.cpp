#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <ceres/ceres.h>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "canyon/core/check.h"
#include "canyon/core/math/chi_square.h"
#include "canyon/core/process/progress.h"
#include "canyon/inertial/allan/degrees_of_freedom.h"
#include "canyon/inertial/allan/noise_terms.h"
#include "canyon/inertial/ceres_cancel_callback.h"
#include "canyon/inertial/ceres_part.h"

namespace canyon::inertial {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Real sensors are not exactly a sum of these processes: filters and rounding bend the curve by some per cent where
// long logs would tell it to a tenth of one. 1-sigma of a point's deviation beyond statistics: the smallest of these
// with which statistics and it explain the misfit.
constexpr double kModelTolerances[] = {0.001, 0.002, 0.005, 0.01, 0.02};
constexpr double kMisfitByChance = 0.05;  // that a right model misfits more
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
    return term == kGaussMarkov || term >= kSinusoid || (term == kWhite && band_limited);
  }
  bool has(int term) const { return std::find(terms.begin(), terms.end(), term) != terms.end(); }
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

  double weight() const { return weight_; }

 private:
  const Combination& model_;
  double tau_s_, interval_s_, measured_, weight_;
};

/// What is not one of the standard's slopes.
constexpr int kLines[] = {kSinusoid, kSecondSinusoid, kThirdSinusoid};

struct Solution {
  Combination model;
  std::vector<double> logs;
  double chi_square = kInfinity;

  /// Where a term's logarithms begin; the number of parameters where it is not there.
  std::size_t place_of(int wanted) const {
    std::size_t i = 0;
    for (const int term : model.terms) {
      if (term == wanted) break;
      i += model.has_second(term) ? 2 : 1;
    }
    return i;
  }
  /// The second parameter of a term; 0 if there is none.
  double second_of(int term) const {
    return model.has(term) && model.has_second(term) ? std::exp(logs[place_of(term) + 1]) : 0.0;
  }
  double degrees_of_freedom(double effective_points) const {
    return std::max(1.0, effective_points - static_cast<double>(logs.size()));
  }
  double chi_square_per_dof(double effective_points) const { return chi_square / degrees_of_freedom(effective_points); }
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

/// Start values of the second parameters.
struct Seconds {
  double correlation_s = 0.0;
  double frequencies_hz[3] = {0.0, 0.0, 0.0};

  double of(int term) const {
    if (term == kWhite) return 0.1;
    return term >= kSinusoid ? frequencies_hz[term - kSinusoid] : correlation_s;
  }
};
struct Limits {
  double low, high;
};
Limits second_limits(int term, std::span<const DeviationPoint> points) {
  const double interval_s = points.front().tau_s / static_cast<double>(points.front().m), last_s = points.back().tau_s;
  if (term == kWhite) return {1e-3, kLargestBandLimit};
  // A wave must turn once within the longest average and twice between samples.
  if (term >= kSinusoid) return {0.5 / last_s, 0.45 / interval_s};
  const double least_s = kLeastCorrelationSamples * interval_s;
  return {least_s, 3.0 * std::max(last_s, 2.0 * least_s)};
}

Solution solve(const Combination& model, std::span<const DeviationPoint> points, int per_octave, double tolerance,
               const Seconds& start) {
  Solution out{model, {}, kInfinity};
  std::vector<Limits> limits;
  for (const int term : model.terms) {
    const double guess = first_guess(term, points);
    out.logs.push_back(std::log(guess));
    // A process that the curve does not need runs off towards zero; it need not run on for ever.
    limits.push_back({guess * std::exp(-20.0), guess * std::exp(5.0)});
    if (!model.has_second(term)) continue;
    limits.push_back(second_limits(term, points));
    out.logs.push_back(std::log(std::clamp(start.of(term), limits.back().low, limits.back().high)));
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
  const auto cancel = make_cancel_callback();
  options.callbacks.push_back(cancel.get());
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  throw_if_cancelled();
  out.chi_square = 2.0 * summary.final_cost;
  return out;
}

/// The search for the combination with the least information criterion.
class Search {
 public:
  Search(std::span<const DeviationPoint> points, int per_octave, double tolerance,
         const std::vector<std::string>& allowed)
      : points_(points), per_octave_(per_octave), tolerance_(tolerance), allowed_(allowed) {}

  double effective_points() const { return std::max(2.0, static_cast<double>(points_.size()) / per_octave_); }

  /// Lines are looked for one after the other beside the best of the slopes, which are then weighed again.
  Solution best() {
    try_all();
    for (const int line : kLines) {
      if (!may_use(std::string(kNoiseTermNames[line])) || !find_line(line)) break;
      try_neighbours();
    }
    return best_;
  }

  /// The best without a term, begun where it stands.
  Solution without(int term, const Solution& all) const {
    Combination fewer = all.model;
    fewer.terms.erase(std::remove(fewer.terms.begin(), fewer.terms.end(), term), fewer.terms.end());
    if (term == kWhite) fewer.band_limited = false;
    return solve(fewer, points_, per_octave_, tolerance_, seconds_of(all));
  }

 private:
  bool may_use(const std::string& name) const {
    return allowed_.empty() || std::find(allowed_.begin(), allowed_.end(), name) != allowed_.end();
  }
  bool may_use(const Combination& model) const {
    if (model.terms.empty()) return false;
    for (const int term : model.terms)
      if (!may_use(std::string(kNoiseTermNames[term]))) return false;
    // Quantization has the same shape as the band limit, with the other sign.
    return !model.band_limited || (model.has(kWhite) && !model.has(kQuantization) && may_use("band_limit"));
  }

  double weigh(Solution s) {
    const double criterion = s.chi_square + static_cast<double>(s.logs.size()) * std::log(effective_points());
    if (static_cast<double>(s.logs.size()) <= effective_points() && criterion < least_) {
      least_ = criterion;
      best_ = std::move(s);
    }
    return criterion;
  }

  static Seconds seconds_of(const Solution& s) {
    return {s.second_of(kGaussMarkov),
            {s.second_of(kSinusoid), s.second_of(kSecondSinusoid), s.second_of(kThirdSinusoid)}};
  }

  /// Adds a line to the best solution if that lowers the criterion at some frequency.
  bool find_line(int line) {
    Combination with = best_.model;
    with.terms.push_back(line);
    Seconds start = seconds_of(best_);
    const double before = least_;
    const Limits range = second_limits(line, points_);
    for (double f = range.low; f < range.high; f *= std::sqrt(2.0)) {
      start.frequencies_hz[line - kSinusoid] = f;
      weigh(solve(with, points_, per_octave_, tolerance_, start));
    }
    return least_ < before;
  }

  /// Every combination of the standard's slopes, without lines.
  void try_all() {
    for (int subset = 1; subset < 1 << kSinusoid; ++subset) {
      Combination model;
      for (int term = 0; term < kSinusoid; ++term)
        if (subset & 1 << term) model.terms.push_back(term);
      for (const bool band_limited : {false, true}) {
        model.band_limited = band_limited;
        if (may_use(model)) try_starts(model, {});
      }
    }
  }

  /// From the best on: each of the slopes put in or left out, as long as that lowers the criterion.
  void try_neighbours() {
    for (double before = kInfinity; least_ < before;) {
      before = least_;
      const Combination centre = best_.model;
      const Seconds start = seconds_of(best_);
      for (int term = 0; term < kSinusoid; ++term)
        for (const bool band_limited : {false, true}) {
          Combination model = centre;
          if (model.has(term))
            model.terms.erase(std::remove(model.terms.begin(), model.terms.end(), term), model.terms.end());
          else
            model.terms.insert(std::lower_bound(model.terms.begin(), model.terms.end(), term), term);
          model.band_limited = band_limited;
          if (may_use(model)) try_starts(model, start);
        }
    }
  }

  /// A correlation time has several local minima: begin in each decade.
  void try_starts(const Combination& model, Seconds start) {
    if (static_cast<double>(model.parameters()) > effective_points()) return;
    if (!model.has(kGaussMarkov)) {
      weigh(solve(model, points_, per_octave_, tolerance_, start));
      return;
    }
    const Limits range = second_limits(kGaussMarkov, points_);
    for (double t = 1.5 * range.low; t <= std::max(points_.back().tau_s, 1.5 * range.low); t *= 10.0) {
      start.correlation_s = t;
      weigh(solve(model, points_, per_octave_, tolerance_, start));
    }
  }

  std::span<const DeviationPoint> points_;
  int per_octave_;
  double tolerance_;
  const std::vector<std::string>& allowed_;
  Solution best_;
  double least_ = kInfinity;
};

/// 1-sigma of a solution's logarithms. The weights of the fit count the points of an octave as one and octaves as
/// independent; here it is their true covariance that goes through the same weights (the sandwich of Huber 1967).
/// Infinite for what the curve does not depend on.
std::vector<double> standard_deviations(const Solution& s, std::span<const DeviationPoint> points, int per_octave,
                                        double tolerance) {
  const auto n = static_cast<Eigen::Index>(points.size()), p = static_cast<Eigen::Index>(s.logs.size());
  Eigen::MatrixXd jacobian(n, p), covariance(n, n);
  constexpr double kStep = 1e-5;
  for (Eigen::Index i = 0; i < n; ++i) {
    const DeviationPoint& point = points[static_cast<std::size_t>(i)];
    const LogVariance residual(s.model, point, per_octave, tolerance);
    for (Eigen::Index k = 0; k < p; ++k) {
      std::vector<double> logs = s.logs;
      double ahead = 0.0, behind = 0.0;
      const double* at = logs.data();
      logs[static_cast<std::size_t>(k)] += kStep;
      residual(&at, &ahead);
      logs[static_cast<std::size_t>(k)] -= 2.0 * kStep;
      residual(&at, &behind);
      jacobian(i, k) = (ahead - behind) / (2.0 * kStep);
    }
    for (Eigen::Index j = 0; j <= i; ++j) {
      throw_if_cancelled();  // the correlation at long averages is a long sum
      const DeviationPoint& other = points[static_cast<std::size_t>(j)];
      const double together = 2.0 / std::sqrt(point.edf * other.edf) *
                              overlapping_correlation(static_cast<double>(point.m), static_cast<double>(other.m));
      covariance(i, j) = covariance(j, i) = residual.weight() *
                                            LogVariance(s.model, other, per_octave, tolerance).weight() *
                                            (together + (i == j ? 4.0 * tolerance * tolerance : 0.0));
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(jacobian.transpose() * jacobian);
  const double least = 1e-12 * eigen.eigenvalues().maxCoeff();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(p, p);
  Eigen::VectorXd open = Eigen::VectorXd::Zero(p);
  for (Eigen::Index k = 0; k < p; ++k) {
    const Eigen::VectorXd v = eigen.eigenvectors().col(k);
    if (eigen.eigenvalues()(k) > least)
      inverse += v * v.transpose() / eigen.eigenvalues()(k);
    else
      open += v.cwiseAbs2();
  }
  const Eigen::MatrixXd of_logs = inverse * jacobian.transpose() * covariance * jacobian * inverse;
  std::vector<double> sigmas;
  for (Eigen::Index k = 0; k < p; ++k)
    sigmas.push_back(open(k) > 1e-6 ? kInfinity : std::sqrt(std::max(0.0, of_logs(k, k))));
  return sigmas;
}

/// The term furthest below what counts as determined, if there is one beside others. Where the processes describe the
/// curve worse than its statistics, the sigmas grow with the misfit.
std::optional<int> least_determined(const Solution& s, const std::vector<double>& sigmas, double effective_points) {
  const double inflation = std::sqrt(std::max(1.0, s.chi_square_per_dof(effective_points)));
  std::optional<int> out;
  double widest = 1.0 / kDeterminedSigmas;
  if (s.model.terms.size() < 2) return out;
  for (const int term : s.model.terms) {
    const double relative = sigmas[s.place_of(term)] * inflation;
    if (relative < widest) continue;
    widest = relative;
    out = term;
  }
  return out;
}

}  // namespace

Result<NoiseFit> fit_noise_with_ceres(std::span<const DeviationPoint> points, int points_per_octave,
                                      const std::vector<std::string>& allowed) {
  CANYON_CHECK(points_per_octave >= 1, "points_per_octave = ", points_per_octave);
  std::vector<DeviationPoint> used;
  for (const DeviationPoint& p : points)
    if (p.deviation > 0.0 && std::isfinite(p.deviation)) used.push_back(p);
  if (used.size() < 3)
    return Error{"", 0, "", std::to_string(used.size()) + " points of deviation above zero",
                 "three or more: a longer log"};
  NoiseFit fit;
  fit.interval_s = used.front().tau_s / static_cast<double>(used.front().m);
  for (const char* name : kNoiseTermNames) fit.terms.push_back({name, 0.0, kInfinity, false});
  Solution best;
  std::vector<double> sigmas;
  for (const double tolerance : kModelTolerances) {
    Search search(used, points_per_octave, tolerance, allowed);
    best = search.best();
    sigmas = standard_deviations(best, used, points_per_octave, tolerance);
    while (const auto open = least_determined(best, sigmas, search.effective_points())) {
      best = search.without(*open, best);
      sigmas = standard_deviations(best, used, points_per_octave, tolerance);
    }
    fit.chi_square_per_dof = best.chi_square_per_dof(search.effective_points());
    if (best.chi_square <= chi_square_threshold(kMisfitByChance, best.degrees_of_freedom(search.effective_points())))
      break;
  }
  const double inflation = std::sqrt(std::max(1.0, fit.chi_square_per_dof));
  for (const int term : best.model.terms) {
    const std::size_t i = best.place_of(term);
    const double value = std::exp(best.logs[i]), sigma = value * sigmas[i] * inflation;
    if (value <= kDeterminedSigmas * sigma) continue;
    FittedTerm& t = fit.terms[static_cast<std::size_t>(term)];
    t = {kNoiseTermNames[term], value, sigma, true};
    if (!best.model.has_second(term)) continue;
    t.second = std::exp(best.logs[i + 1]);
    t.second_sigma = t.second * sigmas[i + 1] * inflation;
    if (term != kWhite) continue;
    const double shortened = 1.0 - 2.0 * t.second;  // rho = b / (1 - 2 b)
    t.second /= shortened;
    t.second_sigma /= shortened * shortened;
  }
  return fit;
}

}  // namespace canyon::inertial
