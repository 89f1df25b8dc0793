#pragma once

#include "canyon/core/motion/rotation.h"

namespace canyon {

/// Right Jacobian of SE(3), xi = [rotation; translation]: Exp(xi + d) = Exp(xi) Exp(Jr(xi) d) to first order in d
/// (Barfoot 2017, State Estimation for Robotics, section 7.1.5). By its series in the little adjoint; for rotations up
/// to pi exact to rounding.
Matrix6d se3_right_jacobian(const Vector6d& xi);
/// Its inverse, for rotations below 2 pi: log(Exp(xi) Exp(d)) = xi + Jr(xi)^-1 d.
Matrix6d se3_right_jacobian_inverse(const Vector6d& xi);

}  // namespace canyon
