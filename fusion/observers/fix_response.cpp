#include "canyon/fusion/observers/fix_response.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace canyon::fusion {

void FixResponse::begin(const ErrorState& state) {
  since_.setIdentity(state.padded_size(), state.padded_size());
  responses_.clear();
}

void FixResponse::predicted(ErrorPropagation& step) {
  step.move(since_);
}

void FixResponse::corrected(const Correction& correction) {
  const Eigen::MatrixXd& K = correction.gain;
  const Eigen::MatrixXd H = correction.measurement.H;
  for (Columns3& response : responses_) {
    const Columns3 before = since_ * response;
    response = before - K * (H * before);
  }
  if (correction.of_position) responses_.push_back(moved_m_ * K);
  since_.setIdentity();
}

void FixResponse::renewed(std::span<const Renewal> states) {
  for (const auto [state, kept] : states) since_.row(state) *= kept;
}

void FixResponse::restarted(const Measurement& fix) {
  using Index = ErrorIndex;
  const Eigen::Matrix3d H_theta = fix.H.leftCols<3>();
  for (Columns3& response : responses_) {
    response = since_ * response;
    response.middleRows<3>(Index::kPosition) = -H_theta * response.middleRows<3>(Index::kTheta);
    response.middleRows<3>(Index::kVelocity).setZero();
  }
  Columns3 placed = Columns3::Zero(since_.rows(), 3);
  placed.middleRows<3>(Index::kPosition) = moved_m_ * Eigen::Matrix3d::Identity();
  responses_.push_back(placed);
  since_.setIdentity();
}

FixResponse::Moved FixResponse::moved(const Eigen::Matrix<double, 3, 9>& J, const Eigen::Vector3d& up_E) const {
  const Eigen::Matrix<double, 3, Eigen::Dynamic> now = J * since_.topRows<9>();
  Moved out;
  for (const Columns3& response : responses_) {
    const Eigen::Matrix3d by_fix = now * response;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> square;
    square.computeDirect(by_fix * by_fix.transpose(), Eigen::EigenvaluesOnly);
    out.any_m += std::sqrt(std::max(square.eigenvalues()[2], 0.0));
    out.up_m += (up_E.transpose() * by_fix).norm();
  }
  return out;
}

}  // namespace canyon::fusion
