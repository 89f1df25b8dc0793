#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

constexpr ModelRow<MakeErrorLink> kRows[] = {
    // What reaches the elements.
    {"latency", make_latency, "the motion of a fixed time before the stamp"},
    // The elements: errors of the true input, added up.
    {"misalignment", make_misalignment, "each sensitive axis tilted by itself: not orthogonal"},
    {"package_misalignment", make_package_misalignment, "the triad as a whole turned against the frame"},
    {"scale_factor", make_scale_factor, "constant error of the gain"},
    {"scale_asymmetry", make_scale_asymmetry, "the gain differs between positive and negative input"},
    {"nonlinearity", make_nonlinearity, "second and third order, against the best straight line"},
    {"g_sensitivity", make_g_sensitivity, "specific force seen by the gyroscope"},
    {"turn_on_bias", make_turn_on_bias, "constant over a run"},
    {"in_run_bias", make_in_run_bias, "first-order Gauss-Markov"},
    {"flicker", make_flicker, "bias instability: 1/f between two corners"},
    {"rate_random_walk", make_rate_random_walk, "integrated white noise"},
    {"ramp", make_ramp, "constant slope"},
    {"temperature", make_temperature, "bias and gain follow the temperature"},
    {"vibration_rectification", make_vibration_rectification, "bias from the mean square of vibration"},
    {"white_noise", make_white_noise, "angle or velocity random walk"},
    {"quantization_noise", make_quantization_noise, "white noise of the integrated output, Q of IEEE Std 952"},
    // The output stage: what comes out of the elements, transformed.
    {"cross_talk", make_cross_talk, "channels leak into one another"},
    {"dead_band", make_dead_band, "a small output is zero"},
    {"saturation", make_saturation, "the output stops at the range"},
    {"quantization", make_quantization, "the output is a whole number of steps"},
    {"losses", make_losses, "samples that do not arrive: the last one is repeated"},
    {"clock", make_clock, "skew and jitter of the stamps"},
};

}  // namespace

ModelTable<MakeErrorLink> error_links() {
  return kRows;
}

}  // namespace canyon::inertial
