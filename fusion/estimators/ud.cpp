#include <algorithm>

#include <Eigen/Cholesky>

#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/estimators/estimator.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;

/// Of P = U D U', U unit upper triangular: from the last row up. What rounding has made of a variance of nothing is
/// nothing.
template <class Matrix, class Vector>
void factorize(Matrix P, Matrix& U, Vector& D) {
  constexpr double kEpsilon = 2.2e-16;
  const Eigen::Index n = P.rows();
  const Vector scale = P.diagonal();
  U.setIdentity(n, n);
  D.setZero(n);
  for (Eigen::Index j = n - 1; j >= 0; --j) {
    if (!(P(j, j) > static_cast<double>(n) * kEpsilon * scale[j])) continue;
    D[j] = P(j, j);
    for (Eigen::Index i = 0; i < j; ++i) U(i, j) = P(i, j) / D[j];
    for (Eigen::Index i = 0; i < j; ++i) {
      const double by = U(i, j) * D[j];
      for (Eigen::Index k = 0; k <= i; ++k) {
        P(k, i) -= U(k, j) * by;
        P(i, k) = P(k, i);
      }
    }
  }
}

/// U D U' with U unit upper triangular and D not below zero, which no sequence of corrections can leave (Bierman 1977,
/// Factorization Methods for Discrete Sequential Estimation, V.3; Thornton 1976 for the step in time).
class Ud final : public Copied<Estimator, Ud> {
 public:
  void set(const ErrorMatrix& P) override {
    factorize(P, U_, D_);
    made_ = false;
  }

  const ErrorMatrix& covariance() override {
    if (!made_) P_ = U_ * D_.asDiagonal() * U_.transpose();
    if (!made_) P_ = 0.5 * (P_ + P_.transpose()).eval();
    made_ = true;
    return P_;
  }

  void propagate(ErrorPropagation& step) override {
    const Eigen::Index n = U_.rows();
    ErrorMatrix noise = ErrorMatrix::Zero(n, n), U_noise;
    Eigen::VectorXd D_noise;
    step.propagate(noise);
    factorize(noise, U_noise, D_noise);
    step.move(U_);
    ErrorMatrix W(n, 2 * n);
    W << U_, U_noise;
    Eigen::VectorXd weights(2 * n);
    weights << D_, D_noise;
    orthogonalize(W, weights);
  }

  void correct(const Measurement& m, const Gain&, const Measurement::Rows&) override {
    // Rows whose noises are independent; what is measured without noise has none.
    const Eigen::LDLT<Eigen::MatrixXd> R{Eigen::MatrixXd(m.R)};
    const Eigen::MatrixXd H = R.matrixL().solve(R.transpositionsP() * Eigen::MatrixXd(m.H));
    const Eigen::VectorXd noise = R.vectorD();
    for (Eigen::Index i = 0; i < H.rows(); ++i) correct(Eigen::VectorXd(H.row(i).transpose()), std::max(noise[i], 0.0));
    made_ = false;
  }

  void inject(ErrorState& state, const ErrorVector& error) override {
    state.inject(error);
    // Exp(theta + e) = Exp(theta) Exp(Jr(theta) e): the rows of attitude, whose own corner is then factorized anew.
    U_.topRows<3>() = (so3_right_jacobian(error.segment<3>(Index::kTheta)) * U_.topRows<3>()).eval();
    const Eigen::Matrix3d corner =
        U_.topLeftCorner<3, 3>() * D_.head<3>().asDiagonal() * U_.topLeftCorner<3, 3>().transpose();
    Eigen::Matrix3d U;
    Eigen::Vector3d D;
    factorize(Eigen::Matrix3d(0.5 * (corner + corner.transpose())), U, D);
    U_.topLeftCorner<3, 3>() = U;
    D_.head<3>() = D;
    made_ = false;
  }

 private:
  /// U D U' = W diag(weights) W' by weighted Gram-Schmidt, from the last row up.
  void orthogonalize(ErrorMatrix& W, const Eigen::VectorXd& weights) {
    const Eigen::Index n = W.rows();
    U_.setIdentity(n, n);
    D_.setZero(n);
    for (Eigen::Index j = n - 1; j >= 0; --j) {
      const Eigen::VectorXd weighted = W.row(j).transpose().cwiseProduct(weights);
      D_[j] = W.row(j).dot(weighted);
      if (D_[j] == 0.0) continue;
      for (Eigen::Index i = 0; i < j; ++i) {
        U_(i, j) = W.row(i).dot(weighted) / D_[j];
        W.row(i) -= U_(i, j) * W.row(j);
      }
    }
    made_ = false;
  }

  /// By a scalar measurement of this variance (Bierman's algorithm); of none, the first variance that it meets is gone.
  void correct(const Eigen::VectorXd& h, double variance) {
    const Eigen::Index n = D_.size();
    const Eigen::VectorXd f = U_.transpose() * h;
    Eigen::VectorXd gain = Eigen::VectorXd::Zero(n);
    double alpha = variance;
    for (Eigen::Index j = 0; j < n; ++j) {
      const double v = D_[j] * f[j], before = alpha;
      alpha += v * f[j];
      const double lambda = before > 0.0 ? -f[j] / before : 0.0;
      if (alpha > 0.0) D_[j] *= before / alpha;
      for (Eigen::Index i = 0; i < j; ++i) {
        const double u = U_(i, j);
        U_(i, j) = u + lambda * gain[i];
        gain[i] += v * u;
      }
      gain[j] += v;
    }
  }

  ErrorMatrix U_, P_;
  Eigen::VectorXd D_;
  bool made_ = false;
};

}  // namespace

std::unique_ptr<Estimator> make_ud() {
  return std::make_unique<Ud>();
}

}  // namespace canyon::fusion
