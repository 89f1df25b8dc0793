#include <Eigen/LU>

#include "canyon/inertial/mems/integrator.h"

namespace canyon::inertial {

/// (I - A h / 2) s+ = (I + A h / 2) s + h B u. |R| of a resonance tends to 1 for large steps: not damped, but aliased.
DiscretePlant implicit_midpoint_step(const LinearPlant& plant, double step_s) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(plant.size(), plant.size());
  const Eigen::MatrixXd inverse = (one - 0.5 * step_s * plant.A).inverse(), gain = step_s * inverse;
  return {inverse * (one + 0.5 * step_s * plant.A), gain * plant.B, held_noise(gain, plant, step_s)};
}

}  // namespace canyon::inertial
