#include "canyon/fusion/measurements/innovation_covariance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace canyon::fusion {
namespace {

/// What rounding may take off an eigenvalue of H P H': an epsilon of each of the n x n terms of an element, and of the
/// elements of a row.
double rounding_of_HPHt(const Measurement::Rows& H, const ErrorMatrix& P) {
  double terms = 0.0, known = 0.0;
  for (Eigen::Index k = 0; k < H.cols(); ++k) {
    const double h = H.col(k).cwiseAbs().maxCoeff();
    if (h == 0.0) continue;
    ++known;
    for (Eigen::Index l = 0; l < H.cols(); ++l) terms += h * std::abs(P(k, l)) * H.col(l).cwiseAbs().maxCoeff();
  }
  return known * known * std::numeric_limits<double>::epsilon() * static_cast<double>(H.rows()) * terms;
}

}  // namespace

Measurement::Rows rows_of(const Measurement::Rows& H, const ErrorMatrix& P) {
  Measurement::Rows out = Measurement::Rows::Zero(H.rows(), P.cols());
  for (Eigen::Index i = 0; i < H.rows(); ++i) {
    for (Eigen::Index k = 0; k < H.cols(); ++k)
      if (H(i, k) != 0.0) out.row(i) += H(i, k) * P.row(k);
  }
  return out;
}

Measurement::Square times_transposed(const Measurement::Rows& HP, const Measurement::Rows& H) {
  const Eigen::Index m = H.rows();
  Measurement::Square out = Measurement::Square::Zero(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    for (Eigen::Index k = 0; k < H.cols(); ++k) {
      if (H(j, k) == 0.0) continue;
      for (Eigen::Index i = 0; i < m; ++i) out(i, j) += HP(i, k) * H(j, k);
    }
  }
  return 0.5 * (out + out.transpose());
}

bool nearly_exact(const Measurement& m, const Measurement::Square& predicted) {
  return (m.R.diagonal().array() <= 1e-12 * predicted.diagonal().array().abs()).any();
}

void count_rounding(Measurement& m, const Measurement::Rows& HP, const Measurement::Square& predicted,
                    const ErrorMatrix& P) {
  m.R.diagonal().array() += rounding_of_HPHt(m.H, P);
  for (Eigen::Index i = 0; i < HP.rows(); ++i) {
    double least = 0.0;
    for (Eigen::Index j = 0; j < HP.cols(); ++j)
      if (P(j, j) > 0.0) least = std::max(least, HP(i, j) * HP(i, j) / P(j, j));
    constexpr double kRounded = 1.0 + 1e-6;
    if (least > kRounded * predicted(i, i)) m.R(i, i) += least + predicted.row(i).cwiseAbs().sum();
  }
}

}  // namespace canyon::fusion
