#include "canyon/lidar/registration/engine/open_directions.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace canyon::lidar {
namespace {

constexpr int kMostMoves = 30;  // each leaves a share of 1 - cos(turn / 2) and less
constexpr double kHeld = 1e-9;

}  // namespace

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

Pose OpenDirections::held_at(const Pose& X_prior, Pose X) const {
  for (int k = 0; k < kMostMoves && !open_.empty(); ++k) {
    const Vector6d xi = (X_prior.inverse() * X).log();
    const Vector6d along = xi - closed_part(xi);
    if (!along.allFinite()) break;
    X = X * Pose::exp(-along);
    if (root_.cwiseProduct(along).norm() < kHeld) break;
  }
  return X;
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

void OpenDirections::open_wide(const Matrix6d& covariance, double sigma_m) {
  const Eigen::MatrixXd C = closed_scaled();
  if (C.cols() == 0) return;
  const Matrix6d scaled = root_.asDiagonal() * covariance * root_.asDiagonal();
  const Eigen::MatrixXd S = C.transpose() * scaled * C;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(S);
  for (Eigen::Index k = 0; k < S.cols(); ++k) {
    if (eigen.eigenvalues()[k] > sigma_m * sigma_m) add((C * eigen.eigenvectors().col(k)).cwiseQuotient(root_));
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

Matrix6d OpenDirections::leaning(const Matrix6d& H, double pieces, const Matrix6d& P) const {
  Matrix6d out = Matrix6d::Zero();
  if (open_.empty() || open_.size() >= 6) return out;
  const Eigen::MatrixXd C = closed_basis();
  const Eigen::MatrixXd curvature = C.transpose() * H * C;
  const Eigen::MatrixXd inverse = curvature.ldlt().solve(Eigen::MatrixXd::Identity(C.cols(), C.cols()));
  if (!inverse.allFinite()) return out;
  const Matrix6d closed = C * inverse * C.transpose();
  for (const Vector6d& v : open_) {
    const Vector6d dual = root_.cwiseProduct(root_.cwiseProduct(v));
    out += dual.dot(P * dual) * std::max(0.0, v.dot(H * v)) / pieces * closed;
  }
  return out;
}

}  // namespace canyon::lidar
