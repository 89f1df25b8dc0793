#pragma once

#include "canyon/core/model_table.h"
#include "canyon/inertial/mems/linear_plant.h"

namespace canyon::inertial {

/// How a plant is carried over a step: one row of the table of integrators. A linear plant makes each of them a matrix,
/// so that what a scheme does to resonance and noise can be read off.
using DiscretizePlant = DiscretePlant(const LinearPlant& plant, double step_s);
ModelTable<DiscretizePlant> integrators();

/// Models, each in its own file.
DiscretePlant exact_step(const LinearPlant& plant, double step_s);
DiscretePlant implicit_midpoint_step(const LinearPlant& plant, double step_s);
DiscretePlant backward_euler_step(const LinearPlant& plant, double step_s);
DiscretePlant runge_kutta_4_step(const LinearPlant& plant, double step_s);

/// What the schemes that are not exact do with white noise: a draw of intensity / step is held over the step as if it
/// were an input. `input_gain`: the matrix that the scheme applies to held inputs.
Eigen::MatrixXd held_noise(const Eigen::MatrixXd& input_gain, const LinearPlant& plant, double step_s);

}  // namespace canyon::inertial
