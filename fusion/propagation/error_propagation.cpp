#include "canyon/fusion/propagation/error_propagation.h"

#include <algorithm>
#include <limits>

#include "canyon/core/check.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;
constexpr int kMoving = Index::kMoving;
constexpr int kMovingPadded = 12;

void copy(const StepJacobian::Matrix& from, double* to) {
  std::copy(from.data(), from.data() + 9, to);
}

}  // namespace

ErrorPropagation::ErrorPropagation(const ErrorState& state, const ImuNoise& noise)
    : size_(state.size()), padded_(state.padded_size()), noise_(noise), integrals_of_(state.integrals()) {
  CANYON_CHECK(padded_ <= kMostStates, "a filter of ", size_, " states; at most ", kMostStates);
  decay_.setOnes(padded_);
  mean_share_.setOnes(padded_);
  density_.setZero(padded_);
  group_of_.assign(static_cast<std::size_t>(size_), -1);
  for (const ErrorState::Member& member : state.members()) {
    for (int i = 0; i < member.block->size(); ++i) {
      const StateProcess process = member.block->process(i);
      const auto same = std::find_if(groups_.begin(), groups_.end(),
                                     [&](const Group& group) { return group.tau_s == process.tau_s; });
      const auto at = same - groups_.begin();
      if (same == groups_.end()) groups_.emplace_back().tau_s = process.tau_s;
      groups_[static_cast<std::size_t>(at)].states.push_back(member.offset + i);
      group_of_[static_cast<std::size_t>(member.offset + i)] = static_cast<int>(at);
      density_[member.offset + i] = process.density;
    }
  }
  integrals_.setZero(kIntegralRows, padded_);
  half_.setZero(kMoving, padded_);
  half_transposed_.setZero(padded_, kMovingPadded);
  twice_.setZero(kMoving, kMovingPadded);
}

void ErrorPropagation::set_interval(double dt_s) {
  if (dt_s == dt_s_) return;
  dt_s_ = dt_s;
  fades_ = false;
  Eigen::Matrix4d white = Eigen::Matrix4d::Zero();
  white.topLeftCorner<3, 3>() = white_moments(dt_s);
  for (int triad = 0; triad < 2; ++triad) {
    const double per_sqrt_hz = (triad == 0 ? noise_.gyro : noise_.accel).white_per_sqrt_hz;
    white_[triad] = {};
    white_[triad].add(white, per_sqrt_hz * per_sqrt_hz);
  }
  for (Group& group : groups_) {
    group.moments = MarkovMoments(dt_s, group.tau_s);
    for (const int state : group.states) {
      decay_[state] = group.moments.decay;
      mean_share_[state] = group.moments.carried[0] / dt_s;
    }
    fades_ = fades_ || group.moments.decay != 1.0;
  }
}

void ErrorPropagation::AxisNoise::add(const Eigen::Matrix4d& moments, double density) {
  m11 += density * moments(0, 0);
  m12 += density * moments(0, 1);
  m13 += density * moments(0, 2);
  m22 += density * moments(1, 1);
  m23 += density * moments(1, 2);
  m33 += density * moments(2, 2);
}

void ErrorPropagation::set_step(ErrorState& state, const Increments& in, const Calibration& imu,
                                const Eigen::Matrix3d& gravity_gradient) {
  set_step(state, in, StepJacobian(state.nav, in, imu, gravity_gradient));
}

void ErrorPropagation::set_step(ErrorState& state, const Increments& in, const StepJacobian& jacobian) {
  step_.dt_s = dt_s_;
  copy(jacobian.theta_theta, step_.theta_theta);
  copy(jacobian.theta_gyro, step_.theta_gyro);
  copy(jacobian.v_theta, step_.v_theta);
  copy(jacobian.v_p, step_.v_p);
  copy(jacobian.v_v, step_.v_v);
  copy(jacobian.v_accel, step_.v_accel);
  copy(jacobian.v_gyro, step_.v_gyro);

  for (int axis = 0; axis < 6; ++axis) axes_[axis] = white_[axis < 3 ? 0 : 1];
  for (Group& group : groups_) group.terms.clear();
  for (const Feed& feed : state.feeds(in)) {
    Group& group = groups_[static_cast<std::size_t>(group_of_[static_cast<std::size_t>(feed.state)])];
    group.terms.push_back({feed.axis, feed.state, feed.rate});
    const double density = density_[feed.state];
    if (density > 0.0) axes_[feed.axis].add(group.moments.driven, feed.rate * feed.rate * density);
  }
}

void ErrorPropagation::integrate(const double* errors, int stride, int width) {
  std::fill(integrals_.data(), integrals_.data() + kIntegralRows * width, 0.0);
  for (const Group& group : groups_)
    add_integrals(group.terms.data(), static_cast<int>(group.terms.size()), group.moments.carried.data(), dt_s_, errors,
                  stride, integrals_.data(), width);
}

void ErrorPropagation::move(ErrorMatrix& errors) {
  for (const ErrorState::Integral& i : integrals_of_) errors.row(i.integral) += dt_s_ * errors.row(i.of);
  integrate(errors.data(), padded_, padded_);
  move_rows(step_, errors.data(), padded_, integrals_.data(), half_.data(), padded_);
  errors.topRows<kMoving>() = half_;
  if (!fades_) return;
  for (int i = kMoving; i < size_; ++i) errors.row(i) *= decay_[i];
}

void ErrorPropagation::propagate(ErrorMatrix& P) {
  const int others = size_ - kMoving;
  // What is integrated is neither fed into the IMU nor fades, so that the rest of the step may follow.
  for (const ErrorState::Integral& i : integrals_of_) {
    P.row(i.integral) += dt_s_ * P.row(i.of);
    P.col(i.integral) += dt_s_ * P.col(i.of);
  }
  // cov(x+, [x, y]) from cov([x, e], [x, y]), e being the part of the IMU's error that the states y make.
  integrate(P.data(), padded_, padded_);
  move_rows(step_, P.data(), padded_, integrals_.data(), half_.data(), padded_);
  // Then cov(x+, x+) from cov([x, e], x+).
  half_transposed_.leftCols<kMoving>() = half_.transpose();
  integrate(half_transposed_.data(), kMovingPadded, kMovingPadded);
  move_rows(step_, half_transposed_.data(), kMovingPadded, integrals_.data(), twice_.data(), kMovingPadded);

  // Symmetric but for rounding: to the bit from here on.
  for (int i = 0; i < kMoving; ++i) {
    for (int j = 0; j < i; ++j) P(i, j) = P(j, i) = 0.5 * (twice_(i, j) + twice_(j, i));
    P(i, i) = twice_(i, i);
  }
  for (int i = 0; i < kMoving; ++i) {
    const double* from = half_.data() + i * padded_;
    double* to = P.data() + i * padded_;
    for (int j = kMoving; j < size_; ++j) to[j] = decay_[j] * from[j];
  }
  if (fades_) scale_both(P.data() + kMoving * padded_ + kMoving, padded_, others, decay_.data() + kMoving);
  add_noise(P);
  P.block(kMoving, 0, others, kMoving) = P.block(0, kMoving, kMoving, others).transpose();
}

void ErrorPropagation::add_noise(ErrorMatrix& P) {
  // Of theta, v and p each axis of the gyroscopes moves gyro I_1, push I_2 and push I_3; the accelerometers' force I_1
  // of v and force I_2 of p.
  const double *t = step_.theta_gyro, *u = step_.v_gyro, *f = step_.v_accel;
  for (int i = 0; i < 3; ++i) {
    double* theta = P.data() + (Index::kTheta + i) * padded_;
    double* p = P.data() + (Index::kPosition + i) * padded_;
    double* v = P.data() + (Index::kVelocity + i) * padded_;
    for (int j = 0; j < 3; ++j) {
      double tt = 0.0, tv = 0.0, tp = 0.0, vt = 0.0, pt = 0.0, vv = 0.0, pv = 0.0, pp = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        const AxisNoise &g = axes_[axis], &a = axes_[3 + axis];
        const int ti = 3 * i + axis, tj = 3 * j + axis;
        const double tu = t[ti] * u[tj], ut = u[ti] * t[tj], uu = u[ti] * u[tj], ff = f[ti] * f[tj];
        tt += g.m11 * (t[ti] * t[tj]);
        tv += g.m12 * tu;
        tp += g.m13 * tu;
        vt += g.m12 * ut;
        pt += g.m13 * ut;
        vv += g.m22 * uu + a.m11 * ff;
        pv += g.m23 * uu + a.m12 * ff;
        pp += g.m33 * uu + a.m22 * ff;
      }
      theta[Index::kTheta + j] += tt;
      theta[Index::kPosition + j] += tp;
      theta[Index::kVelocity + j] += tv;
      p[Index::kTheta + j] += pt;
      p[Index::kPosition + j] += pp;
      p[Index::kVelocity + j] += pv;
      v[Index::kTheta + j] += vt;
      v[Index::kPosition + j] += pv;
      v[Index::kVelocity + j] += vv;
    }
  }
  for (const Group& group : groups_) add_driven(P, group);
  add_drift(P);
}

/// What drives a random walk within the step, in its integral.
void ErrorPropagation::add_drift(ErrorMatrix& P) {
  for (const ErrorState::Integral& i : integrals_of_) {
    const double density = density_[i.of], once = density * dt_s_ * dt_s_ / 2.0;
    P(i.integral, i.integral) += density * dt_s_ * dt_s_ * dt_s_ / 3.0;
    P(i.integral, i.of) += once;
    P(i.of, i.integral) += once;
  }
}

/// What drives the states of a group moves them, and x with them through what they feed.
void ErrorPropagation::add_driven(ErrorMatrix& P, const Group& group) {
  const Eigen::Matrix4d& m = group.moments.driven;
  for (const int state : group.states) P(state, state) += density_[state] * m(3, 3);
  for (const FeedTerm& term : group.terms) {
    const double driven = term.rate * density_[term.state];
    if (driven == 0.0) continue;
    const bool of_gyro = term.axis < 3;
    const double* turns = step_.theta_gyro + term.axis % 3;
    const double* pushes = (of_gyro ? step_.v_gyro : step_.v_accel) + term.axis % 3;
    // Of a gyroscope the velocity takes the second integral, of an accelerometer the first.
    const int of_v = of_gyro ? 1 : 0;
    double* theta = P.data() + Index::kTheta * padded_ + term.state;
    double* p = P.data() + Index::kPosition * padded_ + term.state;
    double* v = P.data() + Index::kVelocity * padded_ + term.state;
    for (int i = 0; i < 3; ++i) {
      if (of_gyro) theta[i * padded_] += driven * m(0, 3) * turns[3 * i];
      v[i * padded_] += driven * m(of_v, 3) * pushes[3 * i];
      p[i * padded_] += driven * m(of_v + 1, 3) * pushes[3 * i];
    }
  }
}

}  // namespace canyon::fusion
