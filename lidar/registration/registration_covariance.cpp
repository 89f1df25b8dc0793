#include "canyon/lidar/registration/registration_covariance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/check.h"
#include "canyon/lidar/voxels/voxel_index.h"

namespace canyon::lidar {
namespace {

using Matrix36d = Eigen::Matrix<double, 3, 6>;

constexpr double kAlongSurface = 0.5;  // eigenvalue of M in the plane of two unit-variance patches
// Independent error per match that is always added: about what sensors resolve; keeps the covariance positive.
constexpr double kResolution_m = 1e-3;
// Curvature must exceed what errors of the normals alone would show by this factor. In a corridor the ratio is 0.5
// to 3.5, in the open outskirts of a city 8 or more.
constexpr double kSignificance = 4.0;

CovarianceSums sum_up(std::span<const Correspondence> matches, const Eigen::Matrix3d& R_TS, double block_m) {
  CovarianceSums sums;
  VoxelIndex blocks(block_m);
  for (const Correspondence& match : matches) {
    Matrix36d J;
    J << -R_TS * skew(match.p_S), R_TS;
    const Eigen::Matrix3d across = match.information - kAlongSurface * Eigen::Matrix3d::Identity();
    const double weight = across.trace();
    const Matrix6d JtJ = J.transpose() * J;
    const Matrix6d curvature = J.transpose() * across * J;
    sums.A += curvature + kAlongSurface * JtJ;
    sums.H += curvature;
    sums.N += match.tilt_variance * (weight * JtJ - curvature);
    sums.cost += match.residual.dot(across * match.residual);
    sums.weight += weight;
    if (weight > 0) {
      const Eigen::Vector3d d_along = match.residual - across * match.residual / weight;
      sums.along += J.transpose() * (kAlongSurface * d_along);
    }
    sums.radius2 += match.p_S.squaredNorm();
    ++sums.matched;
    const auto place = blocks.coordinates(match.p_S.cast<float>());
    CANYON_CHECK(place, "match at ", match.p_S.transpose());
    const std::uint32_t block = blocks.insert(*place);
    if (block == sums.block_gradients.size()) sums.block_gradients.push_back(Vector6d::Zero());
    sums.block_gradients[block] += J.transpose() * (match.information * match.residual);
  }
  return sums;
}

}  // namespace

bool determines_pose(const Matrix6d& A, double radius_m) {
  constexpr double kSingular = 1e-10;
  if (!(radius_m > 0)) return false;
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(1.0 / radius_m), Eigen::Vector3d::Ones();
  const Matrix6d scaled = scale.asDiagonal() * A * scale.asDiagonal();
  if (!scaled.allFinite()) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scaled, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] > kSingular * eigen.eigenvalues()[5];
}

Matrix6d gradient_scatter(const CovarianceSums& sums) {
  const auto n = static_cast<double>(sums.matched);
  const auto b = static_cast<double>(sums.block_gradients.size());
  Matrix6d B = kResolution_m * kResolution_m * sums.weight / n * sums.A + sums.along * sums.along.transpose();
  if (sums.block_gradients.size() < kFewestBlocks) return B + sums.cost / (n - 6.0) * (n / b) * sums.A;
  for (const Vector6d& g : sums.block_gradients) B += b / (b - 6.0) * g * g.transpose();
  return B;
}

RegistrationPrecision registration_precision(std::span<const Correspondence> matches, const Eigen::Matrix3d& R_TS,
                                             double block_m) {
  CANYON_CHECK(matches.size() > 6, "matches = ", matches.size());
  const CovarianceSums sums = sum_up(matches, R_TS, block_m);
  return registration_precision(sums, gradient_scatter(sums));
}

RegistrationPrecision registration_precision(const CovarianceSums& sums, const Matrix6d& B) {
  const auto n = static_cast<double>(sums.matched);
  RegistrationPrecision precision;
  precision.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (!determines_pose(sums.A, std::sqrt(sums.radius2 / n))) return precision;
  precision.rms_m = sums.weight > 0 ? std::sqrt(std::max(0.0, sums.cost) / sums.weight) : 0.0;

  // Metres and radians made comparable at the cloud's rms radius; a trace of it keeps N definite when normals are
  // perfect.
  Matrix6d metric = Matrix6d::Identity();
  metric.topLeftCorner<3, 3>() *= sums.radius2 / n;
  const Matrix6d N = sums.N + 1e-9 * (sums.weight + kAlongSurface * n) * metric;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> eigen(sums.H, N);
  const Matrix6d& V = eigen.eigenvectors();  // V^T N V = I
  Vector6d gain = Vector6d::Zero();
  Matrix6d open = Matrix6d::Zero();
  for (int k = 0; k < 6; ++k) {
    const double ratio = eigen.eigenvalues()[k];
    if (ratio > kSignificance) {
      gain[k] = ratio / (ratio - kSignificance);
      continue;
    }
    const Vector6d v = V.col(k);
    open += kUnconstrainedSigma_m * kUnconstrainedSigma_m / v.dot(metric * v) * v * v.transpose();
    ++precision.unconstrained;
    Vector6d direction = v;
    for (const Vector6d& before : precision.open) direction -= before.dot(metric * direction) * before;
    precision.open.push_back(direction / std::sqrt(direction.dot(metric * direction)));
  }
  const Matrix6d T = V * gain.asDiagonal() * V.transpose() * N * sums.A.inverse();
  precision.covariance = T * B * T.transpose() + open;
  precision.covariance = 0.5 * (precision.covariance + precision.covariance.transpose()).eval();
  return precision;
}

}  // namespace canyon::lidar
