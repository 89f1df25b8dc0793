#include "canyon/inertial/mems/integrator.h"

namespace canyon::inertial {

/// The classical scheme on a linear plant is the exponential's series up to the fourth power: (w h)^4 / 24 per step for
/// a resonance w far above 1 / h.
DiscretePlant runge_kutta_4_step(const LinearPlant& plant, double step_s) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(plant.size(), plant.size()), z = plant.A * step_s;
  const Eigen::MatrixXd gain = step_s * (one + z / 2.0 * (one + z / 3.0 * (one + z / 4.0)));
  return {one + plant.A * gain, gain * plant.B, held_noise(gain, plant, step_s)};
}

}  // namespace canyon::inertial
