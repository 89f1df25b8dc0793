#include "canyon/fusion/states/triad_biases.h"

namespace canyon::fusion {
namespace {

TriadBiases::Triad constant(const TriadNoise& noise) {
  return {noise.turn_on_bias_sigma * noise.turn_on_bias_sigma, {}};
}

}  // namespace

/// The biases with which a unit starts, random constants.
std::unique_ptr<StateBlock> make_turn_on_biases(const StateSetup& setup) {
  return std::make_unique<TriadBiases>(constant(setup.noise.gyro), constant(setup.noise.accel));
}

}  // namespace canyon::fusion
