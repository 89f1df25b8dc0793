#include "canyon/fusion/smoothing/rts_smoother.h"

#include <algorithm>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/process/progress.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;

Eigen::VectorXd packed(const Eigen::MatrixXd& P) {
  const Eigen::Index n = P.rows();
  Eigen::VectorXd out(n * (n + 1) / 2);
  Eigen::Index at = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    out.segment(at, n - j) = P.col(j).tail(n - j);
    at += n - j;
  }
  return out;
}

Eigen::MatrixXd unpacked(const Eigen::VectorXd& numbers, Eigen::Index n) {
  Eigen::MatrixXd P(n, n);
  Eigen::Index at = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    P.col(j).tail(n - j) = numbers.segment(at, n - j);
    P.row(j).tail(n - j) = numbers.segment(at, n - j).transpose();
    at += n - j;
  }
  return P;
}

}  // namespace

void RtsSmoother::begin(const ErrorState& state) {
  state_ = &state;
  states_ = state.size();
  since_.setIdentity(state.padded_size(), state.padded_size());
  records_.clear();
  bias_blocks_.clear();
  for (const char* block : {"biases", "turn_on_biases", "in_run_biases"})
    if (const int at = state.offset(block); at >= 0) bias_blocks_.push_back(at);
}

void RtsSmoother::predicted(ErrorPropagation& step) {
  step.move(since_);
}

RtsSmoother::Record& RtsSmoother::add_record() {
  Record& record = records_.emplace_back();
  record.since.moving = since_.topLeftCorner(Index::kMoving, states_);
  record.since.kept = since_.diagonal().segment(Index::kMoving, states_ - Index::kMoving);
  since_.setIdentity();
  return record;
}

void RtsSmoother::corrected(const Correction& correction) {
  add_record().taken = Taken{.K = correction.gain.topRows(states_),
                             .H = correction.measurement.H.leftCols(states_),
                             .S_inverse = correction.S_inverse,
                             .residual = correction.measurement.residual};
}

void RtsSmoother::renewed(std::span<const Renewal> states) {
  for (const auto [state, kept] : states) since_.row(state) *= kept;
}

void RtsSmoother::restarted(const Measurement&) {
  add_record().restart = true;
}

SmoothedState RtsSmoother::filtered(const ErrorStateFilter& filter) {
  const Calibration imu = filter.calibration();
  return {.nav = filter.nav_state(),
          .w_EU_U = filter.angular_rate(),
          .gyro_bias_U = imu.gyro_bias,
          .accel_bias_U = imu.accel_bias,
          .covariance = filter.covariance().topLeftCorner<9, 9>()};
}

void RtsSmoother::keep(const ErrorStateFilter& filter) {
  add_record().instant = Instant{.filtered = filtered(filter),
                                 .values = state_->values(Index::kMoving, state_->size() - Index::kMoving),
                                 .packed_P = packed(filter.covariance())};
}

SmoothedState RtsSmoother::corrected_by(const Instant& instant, const Eigen::VectorXd& error) const {
  SmoothedState out = instant.filtered;
  out.nav.R_EU = (out.nav.R_EU * so3_exp(error.segment<3>(Index::kTheta))).normalized();
  out.nav.p_EU_E += error.segment<3>(Index::kPosition);
  out.nav.v_EU_E += error.segment<3>(Index::kVelocity);
  for (const int at : bias_blocks_) {
    out.w_EU_U -= error.segment<3>(at);
    out.gyro_bias_U += error.segment<3>(at);
    out.accel_bias_U += error.segment<3>(at + 3);
  }
  return out;
}

void RtsSmoother::smooth(const Take& take) const {
  LaterEvidence later(states_);
  for (auto record = records_.rbegin(); record != records_.rend(); ++record) {
    throw_if_cancelled();
    if (record->instant) {
      const Eigen::MatrixXd filtered = unpacked(record->instant->packed_P, states_);
      const Eigen::MatrixXd P = later.covariance(filtered);
      const Eigen::VectorXd error = later.mean(filtered);
      SmoothedState state = corrected_by(*record->instant, error);
      state.covariance = P.topLeftCorner<9, 9>();
      take(state, record->instant->values + error.tail(states_ - Index::kMoving), P);
    }
    if (record->taken) {
      const Taken& taken = *record->taken;
      const Eigen::Vector3d turned = (taken.K * taken.residual).segment<3>(Index::kTheta);
      later.before_reset(so3_right_jacobian(turned));
      later.before_correction(taken.K, taken.H, taken.S_inverse, taken.residual);
    }
    if (record->restart) later.forget(states_);
    later.before(record->since);
  }
}

std::vector<SmoothedState> RtsSmoother::smooth() const {
  std::vector<SmoothedState> out;
  smooth([&](const SmoothedState& state, const auto&, const auto&) { out.push_back(state); });
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace canyon::fusion
