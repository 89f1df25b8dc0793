#include "canyon/fusion/estimators/joseph_form.h"

#include <algorithm>

#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;
constexpr int kAtOnce = 3;  // rows of the kernel
using Columns3 = Eigen::Matrix<double, Eigen::Dynamic, kAtOnce, Eigen::RowMajor, kMostStates, kAtOnce>;
using Rows3 = Eigen::Matrix<double, kAtOnce, Eigen::Dynamic, Eigen::RowMajor, kAtOnce, kMostStates>;

/// P += left right.
void add_outer(ErrorMatrix& P, const Gain& left, const Measurement::Rows& right) {
  const Eigen::Index m = right.rows();
  if (m == kAtOnce)  // as the kernel takes it
    return add_products(P.data(), static_cast<int>(P.rows()), static_cast<int>(P.cols()), left.data(), right.data());
  Columns3 a(P.rows(), kAtOnce);
  Rows3 b(kAtOnce, P.cols());
  for (Eigen::Index from = 0; from < m; from += kAtOnce) {
    const Eigen::Index n = std::min<Eigen::Index>(kAtOnce, m - from);
    if (n < kAtOnce) {
      a.setZero();
      b.setZero();
    }
    a.leftCols(n) = left.middleCols(from, n);
    b.topRows(n) = right.middleRows(from, n);
    add_products(P.data(), static_cast<int>(P.rows()), static_cast<int>(P.cols()), a.data(), b.data());
  }
}

void symmetrize(ErrorMatrix& P) {
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) P(i, j) = P(j, i) = 0.5 * (P(i, j) + P(j, i));
  }
}

}  // namespace

void JosephForm::correct(const Measurement& m, const Gain& K, const Measurement::Rows& HP) {
  // As two corrections of the rank of the measurement, from the left and from the right.
  add_outer(P_, -K, HP);
  Gain right = K.lazyProduct(m.R);
  for (Eigen::Index k = 0; k < P_.cols(); ++k) {
    for (Eigen::Index i = 0; i < m.H.rows(); ++i)
      if (m.H(i, k) != 0.0) right.col(i) -= m.H(i, k) * P_.col(k);
  }
  add_outer(P_, right, K.transpose());
  symmetrize(P_);
}

void JosephForm::reset_attitude(const Eigen::Vector3d& theta) {
  const Eigen::Matrix3d reset = so3_right_jacobian(theta);
  Rows3 rows = reset.lazyProduct(P_.topRows<3>());
  const Eigen::Matrix3d P_theta = rows.leftCols<3>() * reset.transpose();
  rows.leftCols<3>() = 0.5 * (P_theta + P_theta.transpose());
  P_.topRows<3>() = rows;
  P_.leftCols<3>() = rows.transpose();
}

void JosephForm::transform(const Eigen::Matrix<double, 9, 9>& T) {
  Eigen::Matrix<double, 9, Eigen::Dynamic, Eigen::RowMajor, 9, kMostStates> rows =
      T.lazyProduct(P_.topRows<Index::kMoving>());
  const Eigen::Matrix<double, 9, 9> moving = rows.leftCols<Index::kMoving>() * T.transpose();
  rows.leftCols<Index::kMoving>() = 0.5 * (moving + moving.transpose());
  P_.topRows<Index::kMoving>() = rows;
  P_.leftCols<Index::kMoving>() = rows.transpose();
}

}  // namespace canyon::fusion
