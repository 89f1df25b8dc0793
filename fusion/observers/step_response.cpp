#include "canyon/fusion/observers/step_response.h"

#include "canyon/core/check.h"

namespace canyon::fusion {

using Index = ErrorIndex;

void StepResponse::begin(const ErrorState& state) {
  errors_.setZero(state.padded_size(), state.padded_size());
  by_chance_.clear();
}

void StepResponse::predicted(ErrorPropagation& step) {
  CANYON_CHECK(static_cast<Eigen::Index>(moves_.size()) <= errors_.cols(), moves_.size(), " effects");
  step.move(errors_);
  by_chance_.resize(moves_.size(), ErrorMatrix::Zero(errors_.rows(), errors_.rows()));
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    Eigen::Matrix<double, 9, 1> move;
    move << moves_[i].theta_U, moves_[i].p_E, moves_[i].v_E;
    step.move(by_chance_[i]);
    by_chance_[i].transposeInPlace();
    step.move(by_chance_[i]);
    by_chance_[i].topLeftCorner<9, 9>() += move * move.transpose();
    auto error = errors_.col(static_cast<Eigen::Index>(i));
    error.segment<3>(Index::kTheta) += moves_[i].theta_U;
    error.segment<3>(Index::kPosition) += moves_[i].p_E;
    error.segment<3>(Index::kVelocity) += moves_[i].v_E;
  }
}

void StepResponse::corrected(const Correction& correction) {
  const ErrorMatrix by_what_is_measured = correction.measurement.H * errors_;
  errors_ -= correction.gain * by_what_is_measured;
  for (ErrorMatrix& C : by_chance_) {
    C -= correction.gain * (correction.measurement.H * C).eval();
    C -= (C * correction.measurement.H.transpose()).eval() * correction.gain.transpose();
  }
}

void StepResponse::renewed(std::span<const Renewal> states) {
  for (const auto [state, kept] : states) {
    errors_.row(state) *= kept;
    for (ErrorMatrix& C : by_chance_) {
      C.row(state) *= kept;
      C.col(state) *= kept;
    }
  }
}

void StepResponse::restarted(const Measurement& fix) {
  const auto restart = [&](ErrorMatrix& errors) {
    const ErrorMatrix theta = errors.topRows<3>();
    errors.middleRows<3>(Index::kPosition) = -fix.H.leftCols<3>() * theta;
    errors.middleRows<3>(Index::kVelocity).setZero();
  };
  restart(errors_);
  for (ErrorMatrix& C : by_chance_) {
    restart(C);
    C.transposeInPlace();
    restart(C);
  }
}

Eigen::Vector3d StepResponse::moved_E(std::size_t effect, const Eigen::Matrix<double, 3, 9>& J) const {
  return J * errors_.col(static_cast<Eigen::Index>(effect)).head<9>();
}

Eigen::Matrix3d StepResponse::by_chance_E(std::size_t effect, const Eigen::Matrix<double, 3, 9>& J) const {
  return J * by_chance_[effect].topLeftCorner<9, 9>() * J.transpose();
}

}  // namespace canyon::fusion
