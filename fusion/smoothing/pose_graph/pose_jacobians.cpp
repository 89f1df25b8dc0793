#include "canyon/fusion/smoothing/pose_graph/pose_jacobians.h"

#include <array>

namespace canyon::fusion {
namespace {

/// ad(xi), of which Ad(Exp(xi)) is the exponential.
Matrix6d little_adjoint(const Vector6d& xi) {
  Matrix6d out = Matrix6d::Zero();
  out.topLeftCorner<3, 3>() = out.bottomRightCorner<3, 3>() = skew(xi.head<3>());
  out.bottomLeftCorner<3, 3>() = skew(xi.tail<3>());
  return out;
}

/// Sum of coefficients[n] a^n, by Horner.
template <std::size_t kTerms>
Matrix6d series(const std::array<double, kTerms>& coefficients, const Matrix6d& a) {
  Matrix6d out = coefficients.back() * Matrix6d::Identity();
  for (std::size_t n = kTerms - 1; n-- > 0;) out = coefficients[n] * Matrix6d::Identity() + a * out;
  return out;
}

}  // namespace

Matrix6d se3_right_jacobian(const Vector6d& xi) {
  // (-1)^n / (n + 1)!
  return series<11>({1.0, -1.0 / 2, 1.0 / 6, -1.0 / 24, 1.0 / 120, -1.0 / 720, 1.0 / 5040, -1.0 / 40320, 1.0 / 362880,
                     -1.0 / 3628800, 1.0 / 39916800},
                    little_adjoint(xi));
}

Matrix6d se3_right_jacobian_inverse(const Vector6d& xi) {
  // (-1)^n B_n / n! with Bernoulli's numbers, B_1 = -1/2
  return series<11>({1.0, 0.5, 1.0 / 12, 0.0, -1.0 / 720, 0.0, 1.0 / 30240, 0.0, -1.0 / 1209600, 0.0, 1.0 / 47900160},
                    little_adjoint(xi));
}

}  // namespace canyon::fusion
