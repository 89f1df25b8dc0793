#include <Eigen/LU>

#include "canyon/inertial/mems/integrator.h"

namespace canyon::inertial {

/// (I - A h) s+ = s + h B u.
DiscretePlant backward_euler_step(const LinearPlant& plant, double step_s) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(plant.size(), plant.size());
  const Eigen::MatrixXd inverse = (one - step_s * plant.A).inverse(), gain = step_s * inverse;
  return {inverse, gain * plant.B, held_noise(gain, plant, step_s)};
}

}  // namespace canyon::inertial
