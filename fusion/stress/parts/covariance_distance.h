#pragma once

#include <cmath>

#include <Eigen/Core>

#include "canyon/core/stress_rows.h"

/// How far two covariances are apart.
namespace canyon::fusion {

/// Largest difference of two matrices, each element by the roots of its two diagonal ones.
inline double apart_by_sigma(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  double out = 0.0;
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < A.cols(); ++j)
      out = worse(out, std::abs(A(i, j) - B(i, j)) / std::sqrt(A(i, i) * A(j, j)));
  return out;
}

}  // namespace canyon::fusion
