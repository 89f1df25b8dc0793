#include "canyon/fusion/observers/predicted_motion.h"

#include "canyon/core/check.h"
#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {

bool is_of_motion(const AidingMessage& message) {
  return !std::holds_alternative<GnssFix>(message) && !std::holds_alternative<GnssEpoch>(message) &&
         !std::holds_alternative<PoseInMap>(message) && !std::holds_alternative<RelativePose>(message);
}

PredictedMotion::PredictedMotion(const ErrorStateFilter& filter)
    : filter_(filter), start_(filter.nav_state().t), start_pose_(filter.body_pose()), P_start_(filter.covariance()) {
  filter_.watch(&tracker_);
}

void PredictedMotion::update(const AidingMessage& message) {
  CANYON_CHECK(is_of_motion(message), "a place at ", time_of(message).iso(), " is not motion");
  filter_.update(message);
}

RelativePose PredictedMotion::motion() const {
  const BodyPose now = filter_.body_pose();
  const Eigen::Index n = P_start_.rows();
  RelativePose out;
  out.source = filter_.nav_state().t;
  out.target = start_;
  out.X_TS = start_pose_.X_EB.inverse() * now.X_EB;
  const Eigen::MatrixXd at_now = now.H.leftCols(n), at_start = adjoint(out.X_TS.inverse()) * start_pose_.H.leftCols(n);
  const Eigen::MatrixXd of_start = at_now * tracker_.Phi.topLeftCorner(n, n) - at_start;
  const Matrix6d covariance =
      of_start * P_start_ * of_start.transpose() + at_now * tracker_.Q.topLeftCorner(n, n) * at_now.transpose();
  out.covariance = 0.5 * (covariance + covariance.transpose());
  return out;
}

void PredictedMotion::Tracker::begin(const ErrorState& state) {
  Phi.setIdentity(state.padded_size(), state.padded_size());
  Q.setZero(state.padded_size(), state.padded_size());
}

void PredictedMotion::Tracker::predicted(ErrorPropagation& step) {
  step.move(Phi);
  step.propagate(Q);
}

void PredictedMotion::Tracker::corrected(const Correction& correction) {
  const Eigen::MatrixXd H = correction.measurement.H, K = correction.gain;
  Phi -= K * (H * Phi);
  const Eigen::MatrixXd kept = Q - K * (H * Q);
  Q = kept - (kept * H.transpose()) * K.transpose() + K * correction.measurement.R * K.transpose();
  Q = 0.5 * (Q + Q.transpose()).eval();
}

void PredictedMotion::Tracker::renewed(std::span<const Renewal> states) {
  CANYON_CHECK(false, "no epoch reaches a prediction: ", states.size(), " states");
}

void PredictedMotion::Tracker::restarted(const Measurement& fix) {
  CANYON_CHECK(false, "no fix reaches a prediction: residual ", fix.residual.transpose());
}

}  // namespace canyon::fusion
