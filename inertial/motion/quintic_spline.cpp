#include "canyon/inertial/motion/quintic_spline.h"

#include <algorithm>
#include <numbers>

#include <Eigen/LU>

#include "canyon/core/check.h"

namespace canyon::inertial {
namespace {

using Eigen::Matrix3d;

/// Over an interval of length h, the least integral of (s''')^2 from state x to state y is (y - F x)' Q^-1 (y - F x),
/// with state = (s, s', s''): that of three integrators in a row driven by white noise.
Matrix3d transition(double h) {
  Matrix3d F;
  F << 1.0, h, 0.5 * h * h, 0.0, 1.0, h, 0.0, 0.0, 1.0;
  return F;
}
Matrix3d information(double h) {
  const double h2 = h * h, h3 = h2 * h;
  Matrix3d Q_inverse;
  Q_inverse << 720.0 / (h3 * h2), -360.0 / (h2 * h2), 60.0 / h3, -360.0 / (h2 * h2), 192.0 / h3, -36.0 / h2, 60.0 / h3,
      -36.0 / h2, 9.0 / h;
  return Q_inverse;
}

/// The normal equations: block tridiagonal, three unknowns per time, time in units of the mean interval.
struct System {
  std::vector<Matrix3d> diagonal, upper;
  Eigen::MatrixXd right;

  System(const std::vector<double>& t, const Eigen::MatrixXd& values, double unit_s)
      : diagonal(t.size(), Matrix3d::Zero()),
        upper(t.size() - 1),
        right(Eigen::MatrixXd::Zero(3 * values.rows(), values.cols())) {
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
      const double h = (t[i + 1] - t[i]) / unit_s;
      const Matrix3d F = transition(h), W = information(h);
      diagonal[i] += F.transpose() * W * F;
      diagonal[i + 1] += W;
      upper[i] = -F.transpose() * W;
    }
  }

  /// Values pulled with that weight.
  void pull(const Eigen::MatrixXd& values, double weight) {
    for (std::size_t i = 0; i < diagonal.size(); ++i) {
      diagonal[i](0, 0) += weight;
      right.row(3 * static_cast<Eigen::Index>(i)) = weight * values.row(static_cast<Eigen::Index>(i));
    }
  }

  /// Values held exactly: they are unknowns no longer.
  void hold(const Eigen::MatrixXd& values) {
    for (std::size_t i = 0; i < diagonal.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      auto rest = right.middleRows(3 * row + 1, 2);
      rest -= diagonal[i].bottomLeftCorner<2, 1>() * values.row(row);
      if (i > 0) rest -= upper[i - 1].topRightCorner<1, 2>().transpose() * values.row(row - 1);
      if (i + 1 < diagonal.size()) rest -= upper[i].bottomLeftCorner<2, 1>() * values.row(row + 1);
      right.row(3 * row) = values.row(row);
    }
    for (Matrix3d& D : diagonal) {
      D.row(0).setZero();
      D.col(0).setZero();
      D(0, 0) = 1.0;
    }
    for (Matrix3d& E : upper) {
      E.row(0).setZero();
      E.col(0).setZero();
    }
  }

  Eigen::MatrixXd solve() {
    const std::size_t n = diagonal.size();
    for (std::size_t i = 1; i < n; ++i) {
      const Matrix3d factor = upper[i - 1].transpose() * diagonal[i - 1].inverse();
      diagonal[i] -= factor * upper[i - 1];
      const auto row = 3 * static_cast<Eigen::Index>(i);
      right.middleRows<3>(row) -= factor * right.middleRows<3>(row - 3);
    }
    for (std::size_t i = n; i-- > 0;) {
      const auto row = 3 * static_cast<Eigen::Index>(i);
      if (i + 1 < n) right.middleRows<3>(row) -= upper[i] * right.middleRows<3>(row + 3);
      right.middleRows<3>(row) = (diagonal[i].inverse() * right.middleRows<3>(row)).eval();
    }
    return std::move(right);
  }
};

}  // namespace

QuinticSpline::QuinticSpline(std::vector<double> t_s, const Eigen::MatrixXd& values, double smoothing_s)
    : t_s_(std::move(t_s)) {
  CANYON_CHECK(t_s_.size() >= 3 && values.rows() == static_cast<Eigen::Index>(t_s_.size()), t_s_.size(), " times, ",
               values.rows(), " values");
  CANYON_CHECK(std::is_sorted(t_s_.begin(), t_s_.end(), std::less_equal<>()), "times do not increase");
  const double unit_s = (t_s_.back() - t_s_.front()) / static_cast<double>(t_s_.size() - 1);
  System system(t_s_, values, unit_s);
  if (smoothing_s > 0.0) {
    system.pull(values, std::pow(2.0 * std::numbers::pi * unit_s / smoothing_s, 6));
  } else {
    system.hold(values);
  }
  states_ = system.solve();
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    states_.row(3 * i + 1) /= unit_s;
    states_.row(3 * i + 2) /= unit_s * unit_s;
  }
}

Series QuinticSpline::at(double t_s, Eigen::Index j) const {
  const auto next = std::upper_bound(t_s_.begin() + 1, t_s_.end() - 1, t_s);
  const Eigen::Index i = next - t_s_.begin() - 1;
  const double h = *next - *(next - 1), u = t_s - *(next - 1);
  // The polynomial of fifth degree that has value and two derivatives at both ends.
  const Eigen::Vector3d a = states_.block<3, 1>(3 * i, j), b = states_.block<3, 1>(3 * i + 3, j);
  const Eigen::Vector3d jump = b - transition(h) * a;
  const double h2 = h * h, h3 = h2 * h;
  const double k3 = (10.0 * jump[0] - 4.0 * h * jump[1] + 0.5 * h2 * jump[2]) / h3;
  const double k4 = (-15.0 * jump[0] + 7.0 * h * jump[1] - h2 * jump[2]) / (h3 * h);
  const double k5 = (6.0 * jump[0] - 3.0 * h * jump[1] + 0.5 * h2 * jump[2]) / (h3 * h2);
  return {a[0] + u * (a[1] + u * (0.5 * a[2] + u * (k3 + u * (k4 + u * k5)))),
          a[1] + u * (a[2] + u * (3.0 * k3 + u * (4.0 * k4 + u * 5.0 * k5))),
          0.5 * a[2] + u * (3.0 * k3 + u * (6.0 * k4 + u * 10.0 * k5)), k3 + u * (4.0 * k4 + u * 10.0 * k5)};
}

}  // namespace canyon::inertial
