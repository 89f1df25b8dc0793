#include "canyon/inertial/mems/sensing_element.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::inertial {
namespace {

constexpr double kShortStepsToAPeriod = 32.0;

/// Leak (high-pass), low-pass and the noise at their input. No states where there is neither.
LinearPlant electronics(const ElementModel& model, double noise_n) {
  if (model.filter_order == 0) return {Eigen::MatrixXd(0, 0), Eigen::VectorXd(0), Eigen::RowVectorXd(0), {}};
  LinearPlant low = butterworth(model.filter_order, model.bandwidth_hz);
  const Eigen::Index n = low.size();
  const double w = 2.0 * kPi * model.low_corner_hz;
  LinearPlant out = low;
  if (w > 0.0) {
    // State 0 follows the reading slowly and is taken off before the low-pass.
    out.A = Eigen::MatrixXd::Zero(n + 1, n + 1);
    out.A(0, 0) = -w;
    out.A.bottomRightCorner(n, n) = low.A;
    out.A.bottomLeftCorner(n, 1) = -low.B;
    out.B = Eigen::VectorXd::Zero(n + 1);
    out.B(0) = w;
    out.B.tail(n) = low.B;
    out.C = Eigen::RowVectorXd::Zero(n + 1);
    out.C.tail(n) = low.C;
  }
  out.intensity = noise_n * noise_n * out.B * out.B.transpose();
  return out;
}

LinearPlant joined(const ElementModel& model, const LinearPlant& filter) {
  return filter.size() == 0 ? model.mechanics : with_integral(in_series(model.mechanics, filter));
}

}  // namespace

SensingElement::SensingElement(ElementModel model, double electronics_n, const std::string& integrator, double step_s,
                               RandomStream stream, std::uint32_t axis)
    : model_(std::move(model)),
      step_s_(step_s),
      sample_noise_(std::hypot(electronics_n, model_.pick_off_n)),
      stream_(stream),
      axis_(axis),
      filter_(electronics(model_, sample_noise_)) {
  CANYON_CHECK(step_s > 0.0 && electronics_n >= 0.0, "step ", step_s, " s, electronics ", electronics_n);
  CANYON_CHECK(model_.filter_order > 0 || model_.low_corner_hz == 0.0, "a leaking pick-off needs a filter");
  const LinearPlant whole = joined(model_, filter_);
  whole_ = model_row(integrators(), integrator).make(whole, step_s);
  whole_root_ = noise_root(whole_.covariance);
  short_steps_ = std::max(32, static_cast<int>(std::ceil(kShortStepsToAPeriod * model_.fastest_hz * step_s)));
  const double short_s = step_s / short_steps_;
  short_mechanics_ = exact_step(model_.mechanics, short_s);
  mechanics_root_ = noise_root(short_mechanics_.covariance);
  if (filter_.size() > 0) {
    short_filter_ = exact_step(with_integral(filter_), short_s);
    filter_root_ = noise_root(short_filter_.covariance);
  }
  state_ = Eigen::VectorXd::Zero(whole.size());
}

void SensingElement::settle(double u) {
  const Eigen::Index mechanics = model_.mechanics.size(), filter = filter_.size();
  state_.setZero();
  state_.head(mechanics) = model_.mechanics.rest(u);
  if (std::isfinite(model_.stop)) state_(0) = std::clamp(state_(0), -model_.stop, model_.stop);
  if (filter > 0) state_.segment(mechanics, filter) = filter_.rest(limited(reading()));
}

double SensingElement::gain(double frequency_hz) const {
  return (filter_.size() > 0 ? in_series(model_.mechanics, filter_) : model_.mechanics).gain(frequency_hz);
}

double SensingElement::memory_per_step() const {
  // The integral of the output, the last state, begins anew with every sample.
  const Eigen::Index n = model_.mechanics.size() + filter_.size();
  return spectral_radius(whole_.phi.topLeftCorner(n, n));
}

double SensingElement::limited(double reading) const {
  return std::clamp(reading, -model_.clip, model_.clip);
}

double SensingElement::advance(std::int64_t k, double u) {
  CANYON_CHECK(k >= 0 && std::isfinite(u), "sample ", k, ", input ", u);
  if (!may_hit(u)) return advance_linear(k, u);
  ++overloads_;
  return advance_in_short_steps(k, u);
}

/// The distance from the place of rest in these states never grows, as both mechanics are damped turns: a bound on all
/// that the sample can hold but the thermal noise.
bool SensingElement::may_hit(double u) const {
  if (!std::isfinite(model_.stop) && !std::isfinite(model_.clip)) return false;
  const Eigen::VectorXd rest = model_.mechanics.rest(u);
  const double swing = (mechanics_state() - rest).norm();
  const double most = std::abs((model_.mechanics.C * rest)(0)) + model_.mechanics.C.norm() * swing;
  return std::abs(rest(0)) + swing > model_.stop || most > model_.clip;
}

double SensingElement::advance_linear(std::int64_t k, double u) {
  const Eigen::Index n = state_.size();
  Eigen::VectorXd draws(n);
  for (Eigen::Index i = 0; i < n; ++i)
    draws(i) = stream_.normal(axis_, static_cast<std::uint64_t>(k), static_cast<std::uint32_t>(i));
  if (filter_.size() > 0) state_(n - 1) = 0.0;
  state_ = whole_.phi * state_ + whole_.gamma * u + whole_root_ * draws;
  if (filter_.size() > 0) return model_.characteristic(state_(n - 1) / step_s_) * step_s_;
  const double noise =
      stream_.normal(axis_, static_cast<std::uint64_t>(k), static_cast<std::uint32_t>(n)) * std::sqrt(step_s_);
  return model_.characteristic(reading()) * step_s_ + sample_noise_ * noise;
}

double SensingElement::advance_in_short_steps(std::int64_t k, double u) {
  const Eigen::Index m = model_.mechanics.size(), f = filter_.size();
  Eigen::VectorXd mechanics = state_.head(m), electronic = Eigen::VectorXd::Zero(f + 1);
  if (f > 0) electronic.head(f) = state_.segment(m, f);
  // Draws of their own, behind those of a linear step.
  auto draw = [this, k, n = static_cast<std::uint32_t>(state_.size() + 1)](Eigen::Index count) mutable {
    Eigen::VectorXd out(count);
    for (double& x : out) x = stream_.normal(axis_, static_cast<std::uint64_t>(k), n++);
    return out;
  };
  double before = limited(reading());
  for (int step = 0; step < short_steps_; ++step) {
    mechanics = (short_mechanics_.phi * mechanics + short_mechanics_.gamma * u + mechanics_root_ * draw(m)).eval();
    if (std::abs(mechanics(0)) > model_.stop) {
      mechanics(0) = std::copysign(model_.stop, mechanics(0));
      if (mechanics(0) * mechanics(1) > 0.0) mechanics(1) *= -kRestitution;
    }
    const double after = limited((model_.mechanics.C * mechanics)(0));
    if (f > 0) {
      const double input = 0.5 * (before + after);
      electronic = (short_filter_.phi * electronic + short_filter_.gamma * input + filter_root_ * draw(f + 1)).eval();
    }
    before = after;
  }
  state_.head(m) = mechanics;
  if (f == 0) return model_.characteristic(before) * step_s_ + sample_noise_ * draw(1)(0) * std::sqrt(step_s_);
  state_.segment(m, f) = electronic.head(f);
  return model_.characteristic(electronic(f) / step_s_) * step_s_;
}

}  // namespace canyon::inertial
