#include "canyon/tests/lidar/registration/trials/judging.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/units.h"

namespace canyon::lidar::trials {
namespace {

/// Coordinates in which a rotation counts by what it moves at the radius: y = root xi. Columns: orthonormal directions
/// at right angles to the open ones.
struct Closed {
  Vector6d root;
  Eigen::MatrixXd basis;

  Closed(const std::vector<Vector6d>& open, double radius_m) {
    root << Eigen::Vector3d::Constant(radius_m), Eigen::Vector3d::Ones();
    Eigen::MatrixXd found(6, 0);
    const auto take = [&found](Vector6d v) {
      for (int again = 0; again < 2; ++again) v -= found * (found.transpose() * v);
      if (v.norm() < 1e-6) return false;
      found.conservativeResize(6, found.cols() + 1);
      found.col(found.cols() - 1) = v.normalized();
      return true;
    };
    for (const Vector6d& v : open) take(root.cwiseProduct(v).normalized());
    const auto opened = found.cols();
    // Of the axes, always the one that is left the most.
    while (found.cols() < 6) {
      const Matrix6d left = Matrix6d::Identity() - found * found.transpose();
      Eigen::Index most = 0;
      left.colwise().norm().maxCoeff(&most);
      take(left.col(most));
    }
    basis = found.rightCols(6 - opened);
  }
  Vector6d part(const Vector6d& xi) const {
    return root.cwiseInverse().cwiseProduct(basis * (basis.transpose() * root.cwiseProduct(xi)));
  }
  Eigen::MatrixXd coordinates() const { return basis.transpose() * root.asDiagonal(); }
};

bool within(const Vector6d& xi) {
  return xi.tail<3>().norm() <= kWrong_m && xi.head<3>().norm() <= kWrong_deg * kDegree;
}

}  // namespace

double rms_radius(std::span<const Eigen::Vector3f> points) {
  double sum = 0;
  for (const auto& p : points) sum += p.cast<double>().squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(points.size(), 1)));
}

Verdict judge(const Trial& trial, const RegistrationResult& result, double radius_m) {
  Verdict out;
  out.converged = result.status == RegistrationStatus::kConverged;
  out.undecided = result.status == RegistrationStatus::kAmbiguous || !result.open.empty();
  const Vector6d error = (result.X_TS.inverse() * trial.truth).log();
  out.error = error;
  out.sigma = result.covariance.diagonal().cwiseSqrt();
  const Closed closed(result.open, radius_m);
  const Vector6d known = closed.part(error);
  out.error_m = known.tail<3>().norm();
  out.error_deg = known.head<3>().norm() / kDegree;
  out.right = within(known);
  if (!result.covariance.allFinite()) return out;
  out.inside = error.dot(result.covariance.ldlt().solve(error)) < chi_square_threshold(1e-3, 6.0);
  const Eigen::MatrixXd C = closed.coordinates();
  const Eigen::MatrixXd S = C * result.covariance * C.transpose();
  const Eigen::VectorXd e = C * error;
  out.closed = static_cast<int>(closed.basis.cols());
  if (out.closed == 0) return out;
  out.nees = e.dot(S.ldlt().solve(e));
  out.within_95 = out.nees < chi_square_threshold(0.05, out.closed);
  const Eigen::MatrixXd back = closed.root.cwiseInverse().asDiagonal() * closed.basis;
  const Eigen::Matrix3d shift = (back * S * back.transpose()).bottomRightCorner<3, 3>();
  out.widest_3_sigma_m =
      3.0 * std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(shift, Eigen::EigenvaluesOnly).eigenvalues()[2]);
  return out;
}

bool right_where_determined(const Trial& trial, const Pose& X_TS, double radius_m) {
  return within(Closed(trial.open, radius_m).part((X_TS.inverse() * trial.truth).log()));
}

}  // namespace canyon::lidar::trials
