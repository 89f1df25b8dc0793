#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "inertial/allan/deviation.h"

namespace canyon::inertial {

/// One noise process as a fit finds it.
struct FittedTerm {
  std::string name;    ///< a row of noise_terms()
  double value = 0.0;  ///< coefficient in the unit of its row; 0 where the log does not determine it
  double sigma = 0.0;  ///< 1-sigma of the value; infinite where it is not determined
  bool determined = false;
};

/// The processes whose sum a log shows. Overlapping Allan variance of each (IEEE Std 952-1997 annex C), r = unit of the
/// rate:
///   quantization Q [r s]             3 Q^2 / tau^2
///   white N [r sqrt(s)]              N^2 / tau                   (angle / velocity random walk)
///   bias_instability B [r]           (2 ln 2 / pi) B^2           (flicker, long of its lower corner)
///   rate_random_walk K [r / sqrt(s)] K^2 tau / 3
///   ramp R [r / s]                   R^2 tau^2 / 2
///   gauss_markov sigma [r], Tc [s]   2 sigma^2 Tc / tau (1 - Tc / (2 tau) (3 - 4 e^(-tau/Tc) + e^(-2 tau/Tc)))
struct NoiseFit {
  std::vector<FittedTerm> terms;    ///< one per process, in the order above; Gauss-Markov's value is its sigma,
                                    ///< its correlation time at least 100 samples
  double correlation_time_s = 0.0;  ///< of the Gauss-Markov process, if determined
  double chi_square_per_dof = 0.0;  ///< of the chosen model; near 1 if the processes describe the curve
  /// Model's deviation at tau.
  double deviation_at(double tau_s) const;
  const FittedTerm& term(const std::string& name) const;
};

/// Weighted least squares of the logarithm of the variance (Ceres), each point with the weight that its degrees of
/// freedom give it, over every combination of processes; the combination with the least Bayesian information criterion
/// (Schwarz 1978) is taken. A process outside it, or whose value is below twice its sigma, is reported as not
/// determined. `points`: overlapping Allan deviation with about `points_per_octave` points to the octave. An Error if
/// this build has no Ceres (CANYON_WITH_CERES).
Result<NoiseFit> fit_noise(std::span<const DeviationPoint> points, int points_per_octave);

}  // namespace canyon::inertial
