#include "canyon/fusion/states/triad_biases.h"

namespace canyon::fusion {
namespace {

TriadBiases::Triad wandering(const TriadNoise& noise) {
  const double variance = noise.in_run_bias_sigma * noise.in_run_bias_sigma;
  return {variance, StateProcess::gauss_markov(variance, noise.in_run_bias_tau_s)};
}

}  // namespace

/// The biases' wandering during a run, first-order Gauss-Markov processes.
std::unique_ptr<StateBlock> make_in_run_biases(const StateSetup& setup) {
  return std::make_unique<TriadBiases>(wandering(setup.noise.gyro), wandering(setup.noise.accel));
}

}  // namespace canyon::fusion
