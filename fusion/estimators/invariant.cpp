#include <cmath>

#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/estimators/joseph_form.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Adjoint of xi = [theta, rho, nu] in the Lie algebra of SE_2(3).
Matrix9d small_adjoint(const Eigen::Matrix<double, 9, 1>& xi) {
  Matrix9d out = Matrix9d::Zero();
  const Eigen::Matrix3d turn = skew(xi.head<3>());
  for (int i = 0; i < 9; i += 3) out.block<3, 3>(i, i) = turn;
  out.block<3, 3>(Index::kPosition, 0) = skew(xi.segment<3>(Index::kPosition));
  out.block<3, 3>(Index::kVelocity, 0) = skew(xi.segment<3>(Index::kVelocity));
  return out;
}

/// Right Jacobian of SE_2(3): the sum of (-ad)^k / (k + 1)!, to rounding.
Matrix9d right_jacobian(const Eigen::Matrix<double, 9, 1>& xi) {
  const Matrix9d ad = small_adjoint(xi);
  Matrix9d term = Matrix9d::Identity(), sum = term;
  for (int k = 1; k < 60; ++k) {
    term = term * ad / -(k + 1.0);
    sum += term;
    if (term.cwiseAbs().maxCoeff() < 1e-18 * sum.cwiseAbs().maxCoeff()) break;
  }
  return sum;
}

/// Attitude, position and velocity are one element of SE_2(3), and their error a right perturbation of it: X = X_hat
/// Exp([theta, rho, nu]), the left-invariant error of Barrau & Bonnabel (2017, IEEE Trans. Automatic Control 62(4)).
/// To first order it is the usual error with position and velocity turned into the unit's axes; the two differ in what
/// a correction does: a turned estimate takes the errors that it keeps with it, so that a start with the heading far
/// off is no inconsistency.
class Invariant final : public Copied<Estimator, Invariant> {
 public:
  void set(const ErrorMatrix& P) override { form_.set(P); }
  const ErrorMatrix& covariance() override { return form_.covariance(); }
  void propagate(ErrorPropagation& step) override { form_.propagate(step); }
  void correct(const Measurement& m, const Gain& K, const Measurement::Rows& HP) override { form_.correct(m, K, HP); }

  void inject(ErrorState& state, const ErrorVector& error) override {
    const Eigen::Matrix3d R = state.nav.R_EU.toRotationMatrix();
    Eigen::Matrix<double, 9, 1> xi = error.head<9>();
    xi.segment<3>(Index::kPosition) = R.transpose() * xi.segment<3>(Index::kPosition);
    xi.segment<3>(Index::kVelocity) = R.transpose() * xi.segment<3>(Index::kVelocity);
    // Exp moves by the left Jacobian of SO(3), which is the right one of the opposite turn.
    const Eigen::Matrix3d along = R * so3_right_jacobian(-xi.head<3>());
    ErrorVector moved = error;
    moved.segment<3>(Index::kPosition) = along * xi.segment<3>(Index::kPosition);
    moved.segment<3>(Index::kVelocity) = along * xi.segment<3>(Index::kVelocity);
    state.inject(moved);

    Matrix9d into = Matrix9d::Identity(), out_of = Matrix9d::Identity();
    const Eigen::Matrix3d turned = state.nav.R_EU.toRotationMatrix();
    for (const int at : {Index::kPosition, Index::kVelocity}) {
      into.block<3, 3>(at, at) = R.transpose();
      out_of.block<3, 3>(at, at) = turned;
    }
    form_.transform(out_of * right_jacobian(xi) * into);
  }

 private:
  JosephForm form_;
};

}  // namespace

std::unique_ptr<Estimator> make_invariant() {
  return std::make_unique<Invariant>();
}

}  // namespace canyon::fusion
