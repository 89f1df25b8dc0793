#include "canyon/core/math/singular_values.h"

#include <Eigen/SVD>

#include "canyon/core/check.h"

namespace canyon {

SingularValues::SingularValues(const Eigen::MatrixXd& A) {
  CANYON_CHECK(A.rows() >= A.cols(), A.rows(), " rows, ", A.cols(), " columns");
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  U = svd.matrixU();
  V = svd.matrixV();
  values = svd.singularValues();
}

Eigen::VectorXd SingularValues::solve(const Eigen::VectorXd& b, double threshold) const {
  Eigen::VectorXd along = U.transpose() * b;
  for (Eigen::Index i = 0; i < values.size(); ++i)
    along[i] = values[i] > threshold * values[0] ? along[i] / values[i] : 0.0;
  return V * along;
}

}  // namespace canyon
