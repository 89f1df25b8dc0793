#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/inertial/allan/deviation.h"

namespace canyon::inertial {

/// One noise process as a fit finds it.
struct FittedTerm {
  std::string name;    ///< one of noise_process_names()
  double value = 0.0;  ///< coefficient in the unit of its row; 0 where the log does not determine it
  double sigma = 0.0;  ///< 1-sigma of the value; infinite where it is not determined
  bool determined = false;
  /// The second parameter of those that have one, and its 1-sigma: rho of the white noise, 0 to 0.5 (0 where the curve
  /// does not ask for it); Tc of Gauss-Markov, at least 100 samples; f of a sinusoid, below half the sample rate.
  double second = 0.0, second_sigma = 0.0;
};

/// The processes whose sum a log shows. Overlapping Allan variance of each (IEEE Std 952-1997 annex C), r = unit of the
/// rate:
///   quantization Q [r s]             3 Q^2 / tau^2
///   white N [r sqrt(s)]              N^2 / tau (1 - 3 b dt / tau)   (angle / velocity random walk)
///   bias_instability B [r]           (2 ln 2 / pi) B^2           (flicker, long of its lower corner)
///   rate_random_walk K [r / sqrt(s)] K^2 tau / 3
///   ramp R [r / s]                   R^2 tau^2 / 2
///   gauss_markov sigma [r], Tc [s]   2 sigma^2 Tc / tau (1 - Tc / (2 tau) (3 - 4 e^(-tau/Tc) + e^(-2 tau/Tc)))
///   sinusoid A [r], f [Hz]           A^2 (sin^2(pi f tau) / (m sin(pi f dt)))^2, m = tau / dt; also a second_
///                                    and a third_sinusoid
/// b is the band limit of the sensor: a low-pass that reaches a little beyond one sample interval dt correlates
/// neighbouring samples by rho, b = rho / (1 + 2 rho), and pulls the curve's first points below its slope of -1/2. N is
/// the density below the low-pass, what an integration over a longer time sees. The formula is exact for a low-pass no
/// longer than two samples, and then for every tau.
struct NoiseFit {
  std::vector<FittedTerm> terms;    ///< one per process, in the order above; Gauss-Markov's value is its sigma
  double interval_s = 0.0;          ///< dt
  double chi_square_per_dof = 0.0;  ///< of the chosen model; near 1 if the processes describe the curve
  /// Model's deviation at tau, a multiple of the sample interval.
  double deviation_at(double tau_s) const;
  const FittedTerm& term(const std::string& name) const;
};

/// The processes in the order above, then "band_limit".
std::vector<std::string> noise_process_names();

/// Weighted least squares of the logarithm of the variance (Ceres), each point with the weight that its degrees of
/// freedom give it, over every combination of processes; the combination with the least Bayesian information criterion
/// (Schwarz 1978) is taken. Sinusoids are looked for one after the other, each kept only if the criterion falls. A
/// process outside the combination is reported as not determined; so is one whose value is below twice its sigma, and
/// the others are fitted again without it. `points`: overlapping Allan deviation with about `points_per_octave` points
/// to the octave. `allowed`: names of the processes that may be used; all if empty. An Error if this build has no
/// Ceres.
Result<NoiseFit> fit_noise(std::span<const DeviationPoint> points, int points_per_octave,
                           const std::vector<std::string>& allowed = {});
/// Whether this build can fit (CANYON_WITH_CERES), and what is said where it cannot.
bool can_fit_noise();
inline constexpr const char* kNoNoiseFit = "this build has no noise fit";

}  // namespace canyon::inertial
