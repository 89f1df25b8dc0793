#pragma once

#include <cmath>
#include <span>

#include "canyon/core/units.h"

namespace canyon::inertial {

/// Terms of noise_fit.h by their index.
enum NoiseTerm {
  kQuantization,
  kWhite,
  kBiasInstability,
  kRateRandomWalk,
  kRamp,
  kGaussMarkov,
  kSinusoid,
  kSecondSinusoid,
  kThirdSinusoid,
  kNoiseTerms
};
inline constexpr const char* kNoiseTermNames[kNoiseTerms] = {
    "quantization", "white",    "bias_instability", "rate_random_walk", "ramp",
    "gauss_markov", "sinusoid", "second_sinusoid",  "third_sinusoid"};

/// The second parameter of a term: correlation time of Gauss-Markov, s; frequency of a sinusoid, Hz; band limit of
/// the white noise, in sample intervals (noise_fit.h). The others have none.
template <class T>
T allan_variance(int term, const T& c, const T& second, double tau_s, double interval_s) {
  using std::exp;
  using std::sin;
  switch (term) {
    case kQuantization:
      return 3.0 * c * c / (tau_s * tau_s);
    case kWhite:
      return c * c / tau_s * (1.0 - 3.0 * second * (interval_s / tau_s));
    case kBiasInstability:
      return c * c * (2.0 * std::log(2.0) / kPi);
    case kRateRandomWalk:
      return c * c * tau_s / 3.0;
    case kRamp:
      return c * c * tau_s * tau_s / 2.0;
    case kSinusoid:
    case kSecondSinusoid:
    case kThirdSinusoid: {
      const T wave = sin(kPi * tau_s * second);
      const T ratio = wave * wave * (interval_s / tau_s) / sin(kPi * interval_s * second);
      return c * c * ratio * ratio;
    }
    default:
      break;
  }
  const T x = tau_s / second;
  // The closed form loses all digits for tau far below Tc, where it tends to a random walk: sigma^2 2 tau / (3 Tc).
  if (x < T(1e-3)) return c * c * x * (2.0 / 3.0 - 0.5 * x);
  return 2.0 * c * c / x * (1.0 - (3.0 - 4.0 * exp(-x) + exp(-2.0 * x)) / (2.0 * x));
}

}  // namespace canyon::inertial
