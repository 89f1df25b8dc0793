#include "canyon/inertial/mems/integrator.h"

namespace canyon::inertial {
namespace {

constexpr ModelRow<DiscretizePlant> kRows[] = {
    {"exact", exact_step, "matrix exponential, noise by Van Loan's integral: right at any step"},
    {"implicit_midpoint", implicit_midpoint_step,
     "stable at any step, but a resonance above the sample rate rings on for thousands of samples", nullptr, 2},
    {"backward_euler", backward_euler_step, "stable at any step; swallows the resonance and its noise", nullptr, 1},
    {"rk4", runge_kutta_4_step, "explicit Runge-Kutta; diverges above 2.8 / (2 pi resonance)", nullptr, 4},
};

}  // namespace

ModelTable<DiscretizePlant> integrators() {
  return kRows;
}

Eigen::MatrixXd held_noise(const Eigen::MatrixXd& input_gain, const LinearPlant& plant, double step_s) {
  return input_gain * (plant.intensity / step_s) * input_gain.transpose();
}

}  // namespace canyon::inertial
