#include <Eigen/SVD>

#include "gnss/solver/position_solver.h"

namespace canyon::gnss {

Dop dilution_of_precision(std::span<const Eigen::Vector3d> lines, const Eigen::Matrix3d& R_E_enu, bool clock) {
  const Eigen::Index unknowns = clock ? 4 : 3;
  const auto n = static_cast<Eigen::Index>(lines.size());
  Dop dop;
  if (n < unknowns) return dop;
  Eigen::MatrixXd H(n, unknowns);
  for (Eigen::Index i = 0; i < n; ++i) {
    H.block<1, 3>(i, 0) = -(R_E_enu.transpose() * lines[static_cast<std::size_t>(i)]).transpose();
    if (clock) H(i, 3) = 1.0;
  }
  // Singular values instead of the normal equations: these would lose half the digits, and coplanar geometries their
  // GDOP.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(H, Eigen::ComputeThinV);
  const Eigen::MatrixXd scaled = svd.matrixV() * svd.singularValues().cwiseInverse().asDiagonal();
  const Eigen::VectorXd variance = scaled.rowwise().squaredNorm();
  dop.hdop = std::sqrt(variance(0) + variance(1));
  dop.vdop = std::sqrt(variance(2));
  dop.pdop = std::sqrt(variance.head<3>().sum());
  dop.gdop = std::sqrt(variance.sum());
  if (clock) dop.tdop = std::sqrt(variance(3));
  return dop;
}

}  // namespace canyon::gnss
