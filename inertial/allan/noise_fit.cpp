#include "inertial/allan/noise_fit.h"

#include <cmath>
#include <limits>

#include "core/check.h"
#include "inertial/allan/noise_terms.h"

#ifdef CANYON_WITH_CERES
#include <ceres/ceres.h>
#endif

namespace canyon::inertial {

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
    if (value > 0.0) variance += allan_variance(k, value, correlation_time_s, tau_s);
  }
  return std::sqrt(variance);
}

#ifndef CANYON_WITH_CERES

Result<NoiseFit> fit_noise(std::span<const DeviationPoint>, int) {
  return Error{"", 0, "", "this build has no noise fit", "a build with CANYON_WITH_CERES=ON"};
}

#else

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Real sensors are not exactly a sum of these processes: filters and rounding bend the curve by some per cent where
// long logs would tell it to a tenth of one. 1-sigma of a point's deviation beyond statistics.
constexpr double kModelTolerance = 0.02;
constexpr double kDeterminedSigmas = 2.0;
// A process that forgets within a hundred samples is white noise as the sensor's bandwidth shapes it, not a bias.
constexpr double kLeastCorrelationSamples = 100.0;

/// One point: residual of the logarithm of the variance.
class LogVariance {
 public:
  LogVariance(const std::vector<int>& terms, const DeviationPoint& point, int per_octave)
      : terms_(terms),
        tau_s_(point.tau_s),
        // The logarithm of a chi-square estimate lies low by 1 / edf on average.
        measured_(2.0 * std::log(point.deviation) + 1.0 / point.edf),
        weight_(1.0 / std::sqrt(per_octave * 2.0 / point.edf + 4.0 * kModelTolerance * kModelTolerance)) {}

  template <class T>
  bool operator()(T const* const* parameters, T* residual) const {
    using std::exp;
    using std::log;
    const T* p = parameters[0];
    T variance(0.0);
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const bool last = i + 1 == terms_.size();
      const T correlation = terms_[i] == kGaussMarkov && last ? exp(p[i + 1]) : T(1.0);
      variance += allan_variance(terms_[i], T(exp(p[i])), correlation, tau_s_);
    }
    residual[0] = weight_ * (log(variance) - measured_);
    return true;
  }

 private:
  const std::vector<int>& terms_;
  double tau_s_, measured_, weight_;
};

struct Solution {
  std::vector<int> terms;  ///< ascending, so that Gauss-Markov is last
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

Solution solve(const std::vector<int>& terms, std::span<const DeviationPoint> points, int per_octave,
               double correlation_s) {
  Solution out{terms, {}, {}, kInfinity};
  for (const int term : terms) out.logs.push_back(std::log(first_guess(term, points)));
  const bool markov = terms.back() == kGaussMarkov;
  if (markov) out.logs.push_back(std::log(correlation_s));
  ceres::Problem problem;
  for (const DeviationPoint& point : points) {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<LogVariance, 8>(new LogVariance(out.terms, point, per_octave));
    cost->AddParameterBlock(static_cast<int>(out.logs.size()));
    cost->SetNumResiduals(1);
    problem.AddResidualBlock(cost, nullptr, out.logs.data());
  }
  // A process that the curve does not need runs off towards zero; it need not run on for ever.
  for (std::size_t i = 0; i < terms.size(); ++i) {
    problem.SetParameterLowerBound(out.logs.data(), static_cast<int>(i), out.logs[i] - 20.0);
    problem.SetParameterUpperBound(out.logs.data(), static_cast<int>(i), out.logs[i] + 5.0);
  }
  if (markov) {
    const int i = static_cast<int>(terms.size());
    problem.SetParameterLowerBound(out.logs.data(), i, std::log(kLeastCorrelationSamples * points.front().tau_s));
    problem.SetParameterUpperBound(
        out.logs.data(), i,
        std::log(3.0 * std::max(points.back().tau_s, 2.0 * kLeastCorrelationSamples * points.front().tau_s)));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  out.chi_square = 2.0 * summary.final_cost;

  ceres::Covariance::Options covariance_options;
  covariance_options.algorithm_type = ceres::DENSE_SVD;
  covariance_options.null_space_rank = -1;
  covariance_options.num_threads = 1;
  ceres::Covariance covariance(covariance_options);
  const std::size_t n = out.logs.size();
  out.sigmas.assign(n, kInfinity);
  std::vector<double> matrix(n * n);
  const std::vector<std::pair<const double*, const double*> > blocks = {{out.logs.data(), out.logs.data()}};
  if (covariance.Compute(blocks, &problem) &&
      covariance.GetCovarianceBlock(out.logs.data(), out.logs.data(), matrix.data()))
    for (std::size_t i = 0; i < n; ++i) out.sigmas[i] = std::sqrt(std::max(0.0, matrix[i * n + i]));
  return out;
}

double effective_points(std::span<const DeviationPoint> points, int per_octave) {
  return std::max(2.0, static_cast<double>(points.size()) / per_octave);
}

double information_criterion(const Solution& s, double n) {
  return s.chi_square + static_cast<double>(s.logs.size()) * std::log(n);
}

Solution best_combination(std::span<const DeviationPoint> points, int per_octave) {
  const double n = effective_points(points, per_octave);
  Solution best;
  double least = kInfinity;
  for (int subset = 1; subset < 1 << kNoiseTerms; ++subset) {
    std::vector<int> terms;
    for (int term = 0; term < kNoiseTerms; ++term)
      if (subset & 1 << term) terms.push_back(term);
    const bool markov = terms.back() == kGaussMarkov;
    if (static_cast<double>(terms.size() + (markov ? 1 : 0)) > n) continue;
    // A correlation time has several local minima: begin in each decade.
    for (double tc = markov ? 1.5 * kLeastCorrelationSamples * points.front().tau_s : 1.0;
         tc <= (markov ? points.back().tau_s : 1.0); tc *= 10.0) {
      Solution s = solve(terms, points, per_octave, tc);
      const double criterion = information_criterion(s, n);
      if (criterion < least) {
        least = criterion;
        best = std::move(s);
      }
    }
  }
  return best;
}

}  // namespace

Result<NoiseFit> fit_noise(std::span<const DeviationPoint> points, int points_per_octave) {
  CANYON_CHECK(points_per_octave >= 1, "points_per_octave = ", points_per_octave);
  std::vector<DeviationPoint> used;
  for (const DeviationPoint& p : points)
    if (p.deviation > 0.0 && std::isfinite(p.deviation)) used.push_back(p);
  if (used.size() < 3)
    return Error{"", 0, "", std::to_string(used.size()) + " points of deviation above zero",
                 "three or more: a longer log"};
  const Solution best = best_combination(used, points_per_octave);
  const double dof = std::max(1.0, effective_points(used, points_per_octave) - static_cast<double>(best.logs.size()));
  NoiseFit fit;
  fit.chi_square_per_dof = best.chi_square / dof;
  // Where the processes describe the curve worse than its statistics, the sigmas grow with the misfit.
  const double inflation = std::sqrt(std::max(1.0, fit.chi_square_per_dof));
  for (int term = 0; term < kNoiseTerms; ++term) {
    FittedTerm out{kNoiseTermNames[term], 0.0, kInfinity, false};
    for (std::size_t i = 0; i < best.terms.size(); ++i) {
      if (best.terms[i] != term) continue;
      const double value = std::exp(best.logs[i]), sigma = value * best.sigmas[i] * inflation;
      if (!(value > kDeterminedSigmas * sigma)) continue;
      out = {kNoiseTermNames[term], value, sigma, true};
      if (term == kGaussMarkov) fit.correlation_time_s = std::exp(best.logs.back());
    }
    fit.terms.push_back(out);
  }
  return fit;
}

#endif  // CANYON_WITH_CERES

}  // namespace canyon::inertial
