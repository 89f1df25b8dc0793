#pragma once

#include <cmath>
#include <span>

#include "core/units.h"

namespace canyon::inertial {

/// Terms of noise_fit.h by their index; Gauss-Markov takes a second parameter, its correlation time.
enum NoiseTerm { kQuantization, kWhite, kBiasInstability, kRateRandomWalk, kRamp, kGaussMarkov, kNoiseTerms };
inline constexpr const char* kNoiseTermNames[kNoiseTerms] = {"quantization",     "white", "bias_instability",
                                                             "rate_random_walk", "ramp",  "gauss_markov"};

/// Allan variance at tau of one process with coefficient c (noise_fit.h has the formulas). `T`: double, or a number
/// that carries derivatives. `correlation_s` only matters for Gauss-Markov.
template <class T>
T allan_variance(int term, const T& c, const T& correlation_s, double tau) {
  using std::exp;
  switch (term) {
    case kQuantization:
      return 3.0 * c * c / (tau * tau);
    case kWhite:
      return c * c / tau;
    case kBiasInstability:
      return c * c * (2.0 * std::log(2.0) / kPi);
    case kRateRandomWalk:
      return c * c * tau / 3.0;
    case kRamp:
      return c * c * tau * tau / 2.0;
    default:
      break;
  }
  const T x = tau / correlation_s;
  // The closed form loses all digits for tau far below Tc, where it tends to a random walk: sigma^2 2 tau / (3 Tc).
  if (x < T(1e-3)) return c * c * x * (2.0 / 3.0 - 0.5 * x);
  return 2.0 * c * c / x * (1.0 - (3.0 - 4.0 * exp(-x) + exp(-2.0 * x)) / (2.0 * x));
}

}  // namespace canyon::inertial
