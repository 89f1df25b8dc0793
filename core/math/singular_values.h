#pragma once

#include <Eigen/Core>

namespace canyon {

/// Thin singular value decomposition A = U diag(values) V^T of a matrix with at least as many rows as columns; values
/// descend. In a file of its own because Eigen's takes the compiler ten seconds.
struct SingularValues {
  Eigen::MatrixXd U, V;
  Eigen::VectorXd values;

  explicit SingularValues(const Eigen::MatrixXd& A);

  /// Least-squares solution of A x = b; directions weaker than `threshold` times the strongest are left alone.
  Eigen::VectorXd solve(const Eigen::VectorXd& b, double threshold) const;
};

}  // namespace canyon
