#include "canyon/inertial/mems/integrator.h"

#include "canyon/core/check.h"

namespace canyon::inertial {
namespace {

constexpr IntegratorRow kRows[] = {
    {"exact", exact_step, 0, "matrix exponential, noise by Van Loan's integral: right at any step"},
    {"implicit_midpoint", implicit_midpoint_step, 2,
     "stable at any step, but a resonance above the sample rate rings on for thousands of samples"},
    {"backward_euler", backward_euler_step, 1, "stable at any step; swallows the resonance and its noise"},
    {"rk4", runge_kutta_4_step, 4, "explicit Runge-Kutta; diverges above 2.8 / (2 pi resonance)"},
};

}  // namespace

std::span<const IntegratorRow> integrators() {
  return kRows;
}

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const IntegratorRow& row : kRows) names.emplace_back(row.name);
  return names;
}

const IntegratorRow& integrator_row(const std::string& name) {
  for (const IntegratorRow& row : kRows)
    if (name == row.name) return row;
  CANYON_CHECK(false, "no integrator of that name: ", name);
  return kRows[0];
}

Eigen::MatrixXd held_noise(const Eigen::MatrixXd& input_gain, const LinearPlant& plant, double step_s) {
  return input_gain * (plant.intensity / step_s) * input_gain.transpose();
}

}  // namespace canyon::inertial
