#pragma once

#include "canyon/core/motion/adjoint.h"

namespace canyon::fusion {

/// Right Jacobian of SE(3): Exp(xi + d) = Exp(xi) Exp(Jr(xi) d) to first order in d. By its series in the little
/// adjoint to the tenth order: to 1e-9 of 1 and of the translation where the rotation is below half a radian.
Matrix6d se3_right_jacobian(const Vector6d& xi);
/// Its inverse: log(Exp(xi) Exp(d)) = xi + Jr(xi)^-1 d; to 1e-9 where the rotation is below half a radian.
Matrix6d se3_right_jacobian_inverse(const Vector6d& xi);

}  // namespace canyon::fusion
