#include "lidar/registration_covariance.h"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "core/check.h"

namespace canyon::lidar {
namespace {

using Matrix36d = Eigen::Matrix<double, 3, 6>;

// Below 1 mm the residuals of noise-free test data say more about rounding than about the sensor.
constexpr double kSmallestRms_m = 1e-3;
// Curvature must exceed what errors of the normals alone would show by this factor.
constexpr double kSignificance = 2.0;

}  // namespace

RegistrationPrecision registration_precision(std::span<const Correspondence> matches, const Eigen::Matrix3d& R_TS) {
  CANYON_CHECK(matches.size() > 6, "matches = ", matches.size());
  Matrix6d H = Matrix6d::Zero();
  Matrix6d N = Matrix6d::Zero();
  double cost = 0, weight_sum = 0, radius2 = 0;
  for (const Correspondence& match : matches) {
    Matrix36d J;
    J << -R_TS * skew(match.p_S), R_TS;
    const Eigen::Matrix3d across = match.information - 0.5 * Eigen::Matrix3d::Identity();
    const double weight = across.trace();
    H += J.transpose() * across * J;
    N += match.tilt_variance * (weight * (J.transpose() * J) - J.transpose() * across * J);
    cost += match.residual.dot(across * match.residual);
    weight_sum += weight;
    radius2 += match.p_S.squaredNorm();
  }
  const auto n = static_cast<double>(matches.size());
  RegistrationPrecision precision;
  precision.rms_m = std::sqrt(cost / weight_sum);
  const double variance = std::max(cost, kSmallestRms_m * kSmallestRms_m * weight_sum) / (n - 6.0);

  // A trace of isotropic noise keeps N positive definite when the normals are perfect.
  Matrix6d metric = Matrix6d::Identity();
  metric.topLeftCorner<3, 3>() *= radius2 / n;
  N += 1e-9 * weight_sum * metric;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> eigen(H, N);
  precision.covariance.setZero();
  for (int k = 0; k < 6; ++k) {
    const Vector6d v = eigen.eigenvectors().col(k);  // v^T N v = 1
    const double curvature = eigen.eigenvalues()[k] - kSignificance;
    const double open = kUnconstrainedSigma_m * kUnconstrainedSigma_m / v.dot(metric * v);
    const double along = curvature > 0 ? variance / curvature : open;
    precision.unconstrained += !(along < open);
    precision.covariance += std::min(along, open) * v * v.transpose();
  }
  return precision;
}

}  // namespace canyon::lidar
