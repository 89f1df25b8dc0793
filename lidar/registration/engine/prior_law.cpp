#include "canyon/lidar/registration/engine/prior_law.h"

#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/motion/se3_jacobian.h"

namespace canyon::lidar {
namespace {

constexpr double kMost = 1e12;             // as large as the grids are, so that sums of it stay finite
constexpr double kCertainSquared = 1e-12;  // variance of what is known to be so

/// With eigenvalues of at least 0 and at most so much.
std::optional<Matrix6d> bounded(const Matrix6d& covariance, double most) {
  const Matrix6d even = 0.5 * (covariance + covariance.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(even);
  if (eigen.info() != Eigen::Success) return std::nullopt;
  const Vector6d& values = eigen.eigenvalues();
  if (values[0] >= 0.0 && values[5] <= most) return even;
  return eigen.eigenvectors() * values.cwiseMax(0.0).cwiseMin(most).asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

std::optional<PriorLaw> PriorLaw::of(const PosePrior& prior) {
  if (!prior.covariance.allFinite()) return std::nullopt;
  const auto P = bounded(prior.covariance, kMost);
  return P ? std::optional(PriorLaw(prior.X_TS, *P)) : std::nullopt;
}

Matrix6d PriorLaw::covariance_at(const Pose& X) const {
  const Matrix6d J = se3_right_jacobian(off(X)), out = J * P_ * J.transpose();
  return 0.5 * (out + out.transpose());
}

double PriorLaw::distance_squared(const Pose& X) const {
  const Vector6d xi = off(X);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(P_);
  double sum = 0;
  for (int k = 0; k < 6; ++k) {
    const double along = eigen.eigenvectors().col(k).dot(xi), variance = eigen.eigenvalues()[k];
    if (variance > kCertainSquared) sum += along * along / variance;
  }
  return sum;
}

Matrix6d PriorLaw::with(const Pose& X, const Matrix6d& by_surfaces) const {
  const Matrix6d P = covariance_at(X);
  const Matrix6d K = (P + by_surfaces).transpose().partialPivLu().solve(by_surfaces.transpose()).transpose();
  const Matrix6d left = Matrix6d::Identity() - K;
  const Matrix6d both = left * by_surfaces * left.transpose() + K * P * K.transpose();
  // Of what is unknown roundings may be below 0.
  return both.allFinite() ? bounded(both, std::numeric_limits<double>::infinity()).value_or(both) : both;
}

}  // namespace canyon::lidar
