#include "canyon/fusion/smoothing/later_evidence.h"

namespace canyon::fusion {
namespace {

constexpr Eigen::Index kMoving = 9;

void symmetrize(Eigen::MatrixXd& m) {
  m = (0.5 * (m + m.transpose())).eval();
}

}  // namespace

void LaterEvidence::forget(Eigen::Index states) {
  lambda_.setZero(states);
  information_.setZero(states, states);
}

void LaterEvidence::before_reset(const Eigen::Matrix3d& J) {
  lambda_.head<3>() = (J.transpose() * lambda_.head<3>()).eval();
  information_.topRows<3>() = (J.transpose() * information_.topRows<3>()).eval();
  information_.leftCols<3>() = (information_.leftCols<3>() * J).eval();
  symmetrize(information_);
}

void LaterEvidence::before_correction(const Eigen::MatrixXd& K, const Eigen::MatrixXd& H,
                                      const Eigen::MatrixXd& S_inverse, const Eigen::VectorXd& residual) {
  lambda_ += H.transpose() * (S_inverse * residual - K.transpose() * lambda_);
  // (I - K H)' Lambda (I - K H) + H' S^-1 H, the product as two corrections of the rank of the measurement.
  information_ -= (information_ * K) * H;
  information_ -= H.transpose() * (K.transpose() * information_).eval();
  information_ += H.transpose() * S_inverse * H;
  symmetrize(information_);
}

void LaterEvidence::before(const Transition& step) {
  const Eigen::Index others = lambda_.size() - kMoving;
  const auto through = [&](const Eigen::MatrixXd& rows) {  // Phi' rows
    Eigen::MatrixXd out = step.moving.transpose() * rows.topRows(kMoving);
    out.bottomRows(others) += step.kept.asDiagonal() * rows.bottomRows(others);
    return out;
  };
  lambda_ = through(lambda_);
  information_ = through(through(information_).transpose());
  symmetrize(information_);
}

Eigen::MatrixXd LaterEvidence::covariance(const Eigen::MatrixXd& P) const {
  Eigen::MatrixXd out = P - P * information_ * P;
  symmetrize(out);
  return out;
}

}  // namespace canyon::fusion
