#include "canyon/lidar/registration/engine/open_directions.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "canyon/lidar/registration/registration_covariance.h"

namespace canyon::lidar {
namespace {

constexpr int kMostMoves = 30;  // each leaves a share of 1 - cos(turn / 2) and less
constexpr double kHeld = 1e-9;
// Quantile 0.999 of chi-square with 1 to 3 degrees of freedom, over their number, times chi-square with 1 to 5, over
// the quantile of the latter alone: 32.70 over 10.83 and so on (the tail integrated over the first factor's density).
constexpr double kProductOverNormal[3][5] = {
    {3.020, 3.454, 3.749, 3.980, 4.172}, {2.204, 2.452, 2.621, 2.753, 2.864}, {1.877, 2.057, 2.180, 2.276, 2.356}};

/// Of a covariance that may be singular: what is certain has no part in a regression.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& covariance) {
  constexpr double kCertain = 1e-12;
  if (covariance.cols() == 0) return covariance;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (covariance + covariance.transpose()));
  const double least = kCertain * eigen.eigenvalues()[covariance.cols() - 1];
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(covariance.cols());
  for (Eigen::Index k = 0; k < covariance.cols(); ++k) {
    if (eigen.eigenvalues()[k] > least && eigen.eigenvalues()[k] > 0) inverse[k] = 1.0 / eigen.eigenvalues()[k];
  }
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

double product_over_normal(double open, int closed) {
  const int of = std::clamp(closed, 1, 5) - 1, below = std::clamp(static_cast<int>(open), 1, 2) - 1;
  const double beyond = std::clamp(open - (below + 1), 0.0, 1.0);
  return (1.0 - beyond) * kProductOverNormal[below][of] + beyond * kProductOverNormal[below + 1][of];
}

OpenDirections::OpenDirections(double radius_m, std::vector<Vector6d> open) : open_(std::move(open)) {
  root_ << Eigen::Vector3d::Constant(radius_m), Eigen::Vector3d::Ones();
}

bool OpenDirections::add(const Vector6d& v) {
  Vector6d y = root_.cwiseProduct(v).normalized();
  for (int again = 0; again < 2; ++again) {
    for (const Vector6d& before : open_) {
      const Vector6d b = root_.cwiseProduct(before);
      y -= b.dot(y) * b;
    }
  }
  if (!(y.norm() > 0.1)) return false;
  open_.push_back(y.normalized().cwiseQuotient(root_));
  return true;
}

Vector6d OpenDirections::closed_part(const Vector6d& xi) const {
  Vector6d y = root_.cwiseProduct(xi);
  for (const Vector6d& v : open_) {
    const Vector6d u = root_.cwiseProduct(v);
    y -= u.dot(y) / u.squaredNorm() * u;
  }
  return y.cwiseQuotient(root_);
}

Pose OpenDirections::held_at(const PriorLaw& prior, Pose X) const {
  if (open_.empty()) return X;
  const Eigen::MatrixXd U = open_scaled(), C = closed_scaled();
  for (int k = 0; k < kMostMoves; ++k) {
    const Vector6d y = root_.cwiseProduct(prior.off(X));
    const Matrix6d law = root_.asDiagonal() * prior.covariance_at(X) * root_.asDiagonal();
    const Eigen::VectorXd there = U.transpose() * law * C * inverse_of(C.transpose() * law * C) * (C.transpose() * y);
    const Eigen::VectorXd move = there - U.transpose() * y;
    if (!move.allFinite()) break;
    X = X * Pose::exp((U * move).cwiseQuotient(root_));
    if (move.norm() < kHeld) break;
  }
  return X;
}

Eigen::MatrixXd OpenDirections::open_scaled() const {
  Eigen::MatrixXd U(6, static_cast<Eigen::Index>(open_.size()));
  for (std::size_t k = 0; k < open_.size(); ++k)
    U.col(static_cast<Eigen::Index>(k)) = root_.cwiseProduct(open_[k]).normalized();
  return U;
}

Eigen::MatrixXd OpenDirections::closed_scaled() const {
  Matrix6d held = Matrix6d::Zero();
  for (const Vector6d& v : open_) {
    const Vector6d u = root_.cwiseProduct(v);
    held += u * u.transpose() / u.squaredNorm();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(held);
  return eigen.eigenvectors().leftCols(static_cast<Eigen::Index>(6 - std::min<std::size_t>(6, open_.size())));
}

Eigen::MatrixXd OpenDirections::closed_basis() const {
  return root_.cwiseInverse().asDiagonal() * closed_scaled();
}

Eigen::MatrixXd OpenDirections::closed_dual() const {
  return closed_scaled().transpose() * root_.asDiagonal();
}

void OpenDirections::open_wide(const Matrix6d& covariance, double sigma_m, double sigma_rad) {
  const Eigen::MatrixXd C = closed_scaled();
  if (C.cols() == 0) return;
  const Matrix6d scaled = root_.asDiagonal() * covariance * root_.asDiagonal();
  const Eigen::MatrixXd S = C.transpose() * scaled * C;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(S);
  for (Eigen::Index k = 0; k < S.cols(); ++k) {
    const Vector6d v = (C * eigen.eigenvectors().col(k)).cwiseQuotient(root_);
    const double sigma = std::sqrt(std::max(0.0, eigen.eigenvalues()[k]));
    if (sigma * v.tail<3>().norm() > sigma_m || sigma * v.head<3>().norm() > sigma_rad) add(v);
  }
}

Matrix6d OpenDirections::with_open(const Matrix6d& covariance, double sigma_m) const {
  if (open_.empty()) return covariance;
  const Eigen::MatrixXd C = closed_scaled();
  const Matrix6d scaled = root_.asDiagonal() * covariance * root_.asDiagonal();
  Matrix6d out = C * (C.transpose() * scaled * C) * C.transpose();
  for (const Vector6d& v : open_) {
    const Vector6d u = root_.cwiseProduct(v).normalized();
    out += sigma_m * sigma_m * u * u.transpose();
  }
  return root_.cwiseInverse().asDiagonal() * out * root_.cwiseInverse().asDiagonal();
}

Leaning OpenDirections::leaning(std::span<const Matrix6d> curvatures, const Matrix6d& prior) const {
  Leaning out;
  if (open_.empty() || open_.size() >= 6 || curvatures.empty()) return out;
  const Eigen::MatrixXd C = closed_scaled(), U = open_scaled();
  const auto scaled = [this](const Matrix6d& H) -> Matrix6d {
    return root_.cwiseInverse().asDiagonal() * H * root_.cwiseInverse().asDiagonal();
  };
  Matrix6d H = Matrix6d::Zero();
  for (const Matrix6d& one : curvatures) H += scaled(one);
  const Eigen::MatrixXd closed = (C.transpose() * H * C).ldlt().solve(Eigen::MatrixXd::Identity(C.cols(), C.cols()));
  if (!closed.allFinite()) return out;
  // Along the open directions, given the others.
  const Matrix6d law = root_.asDiagonal() * prior * root_.asDiagonal();
  const Eigen::MatrixXd across = U.transpose() * law * C;
  const Eigen::MatrixXd along =
      U.transpose() * law * U - across * inverse_of(C.transpose() * law * C) * across.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(along);
  const auto blocks = static_cast<double>(curvatures.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(C.cols(), C.cols());
  double squares = 0.0;
  const auto add = [&](const Eigen::MatrixXd& one) {
    sum += one;
    squares += one.trace() * one.trace();
  };
  for (Eigen::Index k = 0; k < along.cols(); ++k) {
    const Vector6d v = U * eigen.eigenvectors().col(k);
    const double variance = std::max(0.0, eigen.eigenvalues()[k]);
    if (curvatures.size() < kFewestBlocks) {
      add(variance * std::max(0.0, v.dot(H * v)) / blocks * closed);
      continue;
    }
    Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(C.cols(), C.cols());
    for (const Matrix6d& one : curvatures) {
      const Eigen::VectorXd h = C.transpose() * (scaled(one) * v);
      scatter += blocks / (blocks - 6.0) * h * h.transpose();
    }
    add(variance * closed * scatter * closed);
  }
  if (squares > 0.0) out.directions = sum.trace() * sum.trace() / squares;
  out.covariance = root_.cwiseInverse().asDiagonal() * (C * sum * C.transpose()) * root_.cwiseInverse().asDiagonal();
  return out;
}

}  // namespace canyon::lidar
