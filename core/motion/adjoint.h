#pragma once

#include "canyon/core/motion/rotation.h"

namespace canyon {

/// Adjoint of X for xi = [rotation; translation]: X Exp(xi) = Exp(Ad xi) X. A covariance of xi in frame B is, in a
/// frame A that B is rigidly attached to, Ad(X_AB) P Ad(X_AB)'.
inline Matrix6d adjoint(const Pose& X) {
  const Eigen::Matrix3d R = X.R.toRotationMatrix();
  Matrix6d out = Matrix6d::Zero();
  out.topLeftCorner<3, 3>() = out.bottomRightCorner<3, 3>() = R;
  out.bottomLeftCorner<3, 3>() = skew(X.p) * R;
  return out;
}

}  // namespace canyon
