#pragma once

#include <cmath>

#include <Eigen/Core>

namespace canyon::fusion {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// e^M by its series, the argument halved until it is small and the result squared as often.
inline LongMatrix exponential(LongMatrix M) {
  int halvings = 0;
  while (M.cwiseAbs().rowwise().sum().maxCoeff() > 0.25L) {
    M *= 0.5L;
    ++halvings;
  }
  LongMatrix sum = LongMatrix::Identity(M.rows(), M.cols()), term = sum;
  for (int k = 1; k < 24; ++k) {
    term = term * M / static_cast<long double>(k);
    sum += term;
  }
  for (int k = 0; k < halvings; ++k) sum = sum * sum;
  return sum;
}

/// Transition and noise covariance over dt_s of x' = F x + w, E w w' = Q, after Van Loan (1978): the exponential of
/// [-F, Q; 0, F'] dt, in parts so short that nothing in it overflows.
struct VanLoan {
  LongMatrix transition, noise;

  VanLoan(const LongMatrix& F, const LongMatrix& Q, double dt_s) {
    const auto n = F.rows();
    const long double fastest = F.cwiseAbs().rowwise().sum().maxCoeff();
    int doublings = 0;
    long double part = dt_s;
    for (; part * fastest > 1.0L; part *= 0.5L) ++doublings;
    LongMatrix M = LongMatrix::Zero(2 * n, 2 * n);
    M.topLeftCorner(n, n) = -F;
    M.topRightCorner(n, n) = Q;
    M.bottomRightCorner(n, n) = F.transpose();
    const LongMatrix e = exponential(M * part);
    transition = e.bottomRightCorner(n, n).transpose();
    noise = transition * e.topRightCorner(n, n);
    for (int k = 0; k < doublings; ++k) {
      noise = (transition * noise * transition.transpose() + noise).eval();
      transition = (transition * transition).eval();
    }
  }
};

}  // namespace canyon::fusion
