#include <cmath>

#include "canyon/fusion/states/triad_biases.h"

namespace canyon::fusion {
namespace {

/// Turn-on constant and in-run process in one state per axis.
///
/// A random constant c (sigma_c) plus a Gauss-Markov process (sigma_r, tau) would need two states per axis. One state
/// driven like the Gauss-Markov part but of the total variance stands for both:
///   sigma^2 = sigma_c^2 + sigma_r^2,   tau' = tau sigma^2 / sigma_r^2,
/// whose driving density 2 sigma^2 / tau' = 2 sigma_r^2 / tau is that of the in-run part, and whose variance never
/// exceeds the total. With sigma_c = 0 it is the Gauss-Markov process itself; with sigma_c >> sigma_r it forgets over
/// tau' >> tau. Using tau itself would make the filter forget the turn-on bias within tau and believe it had not. What
/// the merging costs: the wandering part is remembered over tau' and not over tau, so that a bias seems to wander
/// further than it does.
TriadBiases::Triad merged(const TriadNoise& noise) {
  const double constant = noise.turn_on_bias_sigma * noise.turn_on_bias_sigma;
  const double in_run = noise.in_run_bias_sigma * noise.in_run_bias_sigma;
  const double variance = constant + in_run;
  if (in_run == 0.0) return {variance, {}};
  return {variance, StateProcess::gauss_markov(variance, noise.in_run_bias_tau_s * variance / in_run)};
}

}  // namespace

std::unique_ptr<StateBlock> make_biases(const StateSetup& setup) {
  return std::make_unique<TriadBiases>(merged(setup.noise.gyro), merged(setup.noise.accel));
}

}  // namespace canyon::fusion
