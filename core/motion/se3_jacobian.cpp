#include "canyon/core/motion/se3_jacobian.h"

#include <Eigen/LU>

namespace canyon {
namespace {

constexpr int kMostTerms = 30;  // pi^30 / 31! = 1e-19
constexpr double kNothing = 1e-17;

/// ad(xi), of which Ad(Exp(xi)) is the exponential.
Matrix6d little_adjoint(const Vector6d& xi) {
  Matrix6d out = Matrix6d::Zero();
  out.topLeftCorner<3, 3>() = out.bottomRightCorner<3, 3>() = skew(xi.head<3>());
  out.bottomLeftCorner<3, 3>() = skew(xi.tail<3>());
  return out;
}

}  // namespace

Matrix6d se3_right_jacobian(const Vector6d& xi) {
  const Matrix6d ad = little_adjoint(xi);
  Matrix6d sum = Matrix6d::Identity(), term = Matrix6d::Identity();
  for (int n = 1; n <= kMostTerms; ++n) {
    term = (-1.0 / (n + 1.0) * ad * term).eval();
    sum += term;
    if (!(term.squaredNorm() > kNothing * kNothing)) break;
  }
  return sum;
}

Matrix6d se3_right_jacobian_inverse(const Vector6d& xi) {
  return se3_right_jacobian(xi).inverse();
}

}  // namespace canyon
