// How many parameters a sum of noise processes may have: each one has to lower the misfit by as much as the information
// criterion asks for it, and there may be no more of them than independent points.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/inertial/allan/deviation.h"
#include "canyon/inertial/allan/noise_fit.h"
#include "canyon/inertial/allan/noise_terms.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

constexpr double kSampleTime_s = 0.01;
constexpr int kToTheOctave = 4;

/// Points without statistical error whose variance is this.
std::vector<DeviationPoint> points_without_error(int count, double step, double samples,
                                                 const std::function<double(double)>& variance) {
  std::vector<DeviationPoint> out;
  double m = 1.0;
  for (int k = 0; k < count; ++k) {
    DeviationPoint p;
    p.m = static_cast<std::int64_t>(std::round(m)), p.tau_s = kSampleTime_s * static_cast<double>(p.m);
    p.edf = 1.5 * samples / static_cast<double>(p.m);
    // The logarithm of a chi-square estimate lies low by 1 / edf on average, which the fit makes good.
    p.deviation = std::sqrt(variance(p.tau_s) * std::exp(-1.0 / p.edf));
    out.push_back(p);
    do m *= step;
    while (std::round(m) == static_cast<double>(p.m));
  }
  return out;
}

/// What a white noise alone leaves: its logarithm is a mean of the others', each by its weight, that is by 2 / edf for
/// each point of an octave and a model good to 1e-3, the best that is tried.
double misfit_of_white(const std::vector<DeviationPoint>& points) {
  double weights = 0.0, sum = 0.0, squares = 0.0;
  for (const DeviationPoint& p : points) {
    const double w = 1.0 / (kToTheOctave * 2.0 / p.edf + 4e-6),
                 x = 2.0 * std::log(p.deviation) + 1.0 / p.edf + std::log(p.tau_s);
    weights += w, sum += w * x, squares += w * x * x;
  }
  return squares - sum * sum / weights;
}

/// White noise and a little of something else, as much as leaves white noise alone with `times` the misfit that the
/// criterion asks for: ln n for each parameter more, n independent points. Below it is left out, above it is found. A
/// figure counts.
StressFigure parameters_that_pay(int term, double second, int parameters, const char* other) {
  if (!can_fit_noise()) return {0.0, 0.0};
  constexpr int kCount = 48;
  const auto curve_with = [&](double much) {
    return points_without_error(kCount, std::pow(2.0, 0.25), 2e6, [&](double tau_s) {
      if (term == kWhite) return allan_variance(kWhite, 0.05, much, tau_s, kSampleTime_s);
      return allan_variance(kWhite, 0.05, 0.0, tau_s, kSampleTime_s) +
             allan_variance(term, much, second, tau_s, kSampleTime_s);
    });
  };
  int wrong = 0;
  for (const double times : {0.85, 1.15}) {
    const double asked = times * parameters * std::log(kCount / static_cast<double>(kToTheOctave));
    double low = 1e-9, high = term == kWhite ? 0.25 : 1.0;
    for (int k = 0; k < 100; ++k) {
      const double middle = std::sqrt(low * high);
      (misfit_of_white(curve_with(middle)) < asked ? low : high) = middle;
    }
    const auto points = curve_with(low);
    wrong += std::abs(misfit_of_white(points) / asked - 1.0) < 1e-6 ? 0 : 1;
    const auto fit = fit_noise(points, kToTheOctave, {"white", other});
    if (!fit.ok()) return {1e9, 0.0};
    const FittedTerm& white = fit->term("white");
    wrong += white.determined ? 0 : 1;
    const bool found = term == kWhite ? white.second > 0.0 : fit->term(other).determined;
    wrong += found == (times > 1.0) ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// White noise and a Gauss-Markov process have three parameters: of twelve points, four to the octave, they are found,
/// of eleven not both. A figure counts.
StressFigure parameters_and_points() {
  if (!can_fit_noise()) return {0.0, 0.0};
  int wrong = 0;
  for (const int count : {12, 11}) {
    const auto points = points_without_error(count, 2.0, 1e8, [](double tau_s) {
      return allan_variance(kWhite, 0.01, 0.0, tau_s, kSampleTime_s) +
             allan_variance(kGaussMarkov, 0.02, 2.0, tau_s, kSampleTime_s);
    });
    const auto fit = fit_noise(points, kToTheOctave, {"white", "gauss_markov"});
    if (!fit.ok()) return {1e9, 0.0};
    const bool both = fit->term("white").determined && fit->term("gauss_markov").determined;
    wrong += both == (count == 12) ? 0 : 1;
    if (!both || count != 12) continue;
    wrong += std::abs(fit->term("white").value / 0.01 - 1.0) < 1e-4 ? 0 : 1;
    wrong += std::abs(fit->term("gauss_markov").second / 2.0 - 1.0) < 1e-3 ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> noise_parameter_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "as many parameters of noise as pay",
           "a second parameter that is not counted, a logarithm of all points in place of the independent ones",
           "the misfit of white noise in closed form against ln n a parameter: 15 % below left out, 15 % above found",
           "wrong"});
  const double lowest_hz = 0.5 / (kSampleTime_s * std::round(std::pow(2.0, 13.0)));
  rows.add("noise_parameters/random_walk",
           [] { return parameters_that_pay(kRateRandomWalk, 0.0, 1, "rate_random_walk"); })
      .add("noise_parameters/flicker", [] { return parameters_that_pay(kBiasInstability, 0.0, 1, "bias_instability"); })
      .add("noise_parameters/ramp", [] { return parameters_that_pay(kRamp, 0.0, 1, "ramp"); })
      .add("noise_parameters/band_limit", [] { return parameters_that_pay(kWhite, 0.0, 1, "band_limit"); })
      .add("noise_parameters/gauss_markov", [] { return parameters_that_pay(kGaussMarkov, 15.0, 2, "gauss_markov"); })
      .add("noise_parameters/sinusoid",
           [f = 16.0 * lowest_hz] { return parameters_that_pay(kSinusoid, f, 2, "sinusoid"); })
      .add("noise_parameters/and_points", parameters_and_points);
  return rows.take();
}

}  // namespace canyon::inertial
