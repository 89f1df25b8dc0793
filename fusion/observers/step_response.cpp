#include "canyon/fusion/observers/step_response.h"

#include "canyon/core/check.h"

namespace canyon::fusion {

using Index = ErrorIndex;

void StepResponse::begin(const ErrorState& state) {
  errors_.setZero(state.padded_size(), state.padded_size());
}

void StepResponse::predicted(ErrorPropagation& step) {
  CANYON_CHECK(static_cast<Eigen::Index>(moves_.size()) <= errors_.cols(), moves_.size(), " effects");
  step.move(errors_);
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    auto error = errors_.col(static_cast<Eigen::Index>(i));
    error.segment<3>(Index::kTheta) += moves_[i].theta_U;
    error.segment<3>(Index::kPosition) += moves_[i].p_E;
    error.segment<3>(Index::kVelocity) += moves_[i].v_E;
  }
}

void StepResponse::corrected(const Correction& correction) {
  const ErrorMatrix by_what_is_measured = correction.measurement.H * errors_;
  errors_ -= correction.gain * by_what_is_measured;
}

void StepResponse::renewed(std::span<const Renewal> states) {
  for (const auto [state, kept] : states) errors_.row(state) *= kept;
}

void StepResponse::restarted(const Measurement& fix) {
  const ErrorMatrix theta = errors_.topRows<3>();
  errors_.middleRows<3>(Index::kPosition) = -fix.H.leftCols<3>() * theta;
  errors_.middleRows<3>(Index::kVelocity).setZero();
}

Eigen::Vector3d StepResponse::moved_E(std::size_t effect, const Eigen::Matrix<double, 3, 9>& J) const {
  return J * errors_.col(static_cast<Eigen::Index>(effect)).head<9>();
}

}  // namespace canyon::fusion
