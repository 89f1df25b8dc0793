#include "canyon/lidar/registration/engine/witnesses.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace canyon::lidar {
namespace {

struct Quantile {
  double degrees, t;
};
/// Two-sided 99.9 % of Student's t (Abramowitz and Stegun 1964, table 26.10).
constexpr Quantile kStudent[] = {{1, 636.619}, {2, 31.598}, {3, 12.924}, {4, 8.610},  {5, 6.869},
                                 {6, 5.959},   {7, 5.408},  {8, 5.041},  {10, 4.587}, {12, 4.318},
                                 {15, 4.073},  {20, 3.850}, {30, 3.646}, {60, 3.460}, {120, 3.373}};
constexpr double kNormal = 3.2905;  // the same of the normal distribution
constexpr double kWidest = 1e3;     // of a sigma of millimetres: open

}  // namespace

double witnesses(const CovarianceSums& sums, const Vector6d& t) {
  double sum = 0.0, squares = 0.0;
  for (const Matrix6d& H : sums.block_surfaces) {
    const double w = t.dot(H * t);
    sum += w;
    squares += w * w;
  }
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

double student_over_normal(double degrees) {
  if (!(degrees >= 1.0)) return std::numeric_limits<double>::infinity();
  // What is left above the normal's falls nearly as a power of the degrees between two lines of the table.
  const Quantile* above = std::find_if(std::begin(kStudent), std::end(kStudent),
                                       [degrees](const Quantile& q) { return q.degrees >= degrees; });
  if (above == std::begin(kStudent)) return above->t / kNormal;
  const Quantile& below = *(above - 1);
  if (above == std::end(kStudent)) return 1.0 + (below.t / kNormal - 1.0) * below.degrees / degrees;
  const double share = std::log(degrees / below.degrees) / std::log(above->degrees / below.degrees);
  return 1.0 + std::pow(below.t - kNormal, 1.0 - share) * std::pow(above->t - kNormal, share) / kNormal;
}

Matrix6d widened_by_witnesses(const Matrix6d& covariance, const CovarianceSums& sums, const OpenDirections& open) {
  const Eigen::MatrixXd C = open.closed_basis(), D = open.closed_dual();
  if (C.cols() == 0 || sums.block_surfaces.size() < kFewestBlocks) return covariance;
  const Eigen::MatrixXd S = D * covariance * D.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (S + S.transpose()));
  const Eigen::PartialPivLU<Eigen::MatrixXd> A(C.transpose() * sums.A * C);
  Eigen::MatrixXd more = Eigen::MatrixXd::Zero(S.rows(), S.cols());
  for (Eigen::Index k = 0; k < S.cols(); ++k) {
    const Eigen::VectorXd u = eigen.eigenvectors().col(k);
    const double wider = std::min(student_over_normal(witnesses(sums, C * A.solve(u)) - 1.0), kWidest);
    more += (wider * wider - 1.0) * std::max(0.0, eigen.eigenvalues()[k]) * u * u.transpose();
  }
  return covariance + C * more * C.transpose();
}

}  // namespace canyon::lidar
