#pragma once

#include <span>
#include <string>
#include <vector>

#include "canyon/inertial/mems/linear_plant.h"

namespace canyon::inertial {

/// How a plant is carried over a step: one row of the table of integrators. A linear plant makes each of them a matrix,
/// so that what a scheme does to resonance and noise can be read off.
struct IntegratorRow {
  const char* name;
  DiscretePlant (*discretize)(const LinearPlant& plant, double step_s);
  int order;  ///< of the error over a fixed time in the step; 0: no error
  const char* doc;
};

std::span<const IntegratorRow> integrators();
std::vector<std::string> integrator_names();
/// The row of a name that is in the table.
const IntegratorRow& integrator_row(const std::string& name);

/// Models, each in its own file.
DiscretePlant exact_step(const LinearPlant& plant, double step_s);
DiscretePlant implicit_midpoint_step(const LinearPlant& plant, double step_s);
DiscretePlant backward_euler_step(const LinearPlant& plant, double step_s);
DiscretePlant runge_kutta_4_step(const LinearPlant& plant, double step_s);

/// What the schemes that are not exact do with white noise: a draw of intensity / step is held over the step as if it
/// were an input. `input_gain`: the matrix that the scheme applies to held inputs.
Eigen::MatrixXd held_noise(const Eigen::MatrixXd& input_gain, const LinearPlant& plant, double step_s);

}  // namespace canyon::inertial
