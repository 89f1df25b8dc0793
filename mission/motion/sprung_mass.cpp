#include "canyon/mission/motion/sprung_mass.h"

#include <cmath>

#include "canyon/core/check.h"

namespace canyon::mission {

namespace {

/// cos sqrt(q) and sin sqrt(q) / sqrt(q) for q of any sign, times e^-decay: decay >= sqrt(-q), so nothing overflows.
struct DampedWave {
  double cosine, sine;
  DampedWave(double q, double decay) {
    const double root = std::sqrt(std::abs(q));
    if (root < 1e-4) {  // series; the terms left out are below 1e-18
      cosine = std::exp(-decay) * (1.0 - 0.5 * q);
      sine = std::exp(-decay) * (1.0 - q / 6.0);
    } else if (q > 0.0) {
      cosine = std::exp(-decay) * std::cos(root);
      sine = std::exp(-decay) * std::sin(root) / root;
    } else {
      const double slow = std::exp(root - decay), fast = std::exp(-root - decay);
      cosine = 0.5 * (slow + fast);
      sine = 0.5 * (slow - fast) / root;
    }
  }
};

}  // namespace

SprungMass::SprungMass(double w_rad_s, double damping, double u) : w_rad_s_(w_rad_s), damping_(damping), u_(u) {
  CANYON_CHECK(w_rad_s > 0.0 && damping >= 0.0, "w_rad_s = ", w_rad_s, ", damping = ", damping);
  state_.x = u;
}

const SprungMass::State& SprungMass::advance(double u_begin, double u_end, double dt_s) {
  CANYON_CHECK(dt_s > 0.0, "dt_s = ", dt_s);
  const double decay_rate = damping_ * w_rad_s_, slope = (u_end - u_begin) / dt_s;
  const double y0 = state_.x - u_begin;
  const double v0 = state_.v + 2.0 * decay_rate * (u_begin - u_) - slope;
  // y'' + 2 zeta w y' + w^2 y = 0.
  const double q = w_rad_s_ * w_rad_s_ * (1.0 - damping_ * damping_) * dt_s * dt_s;
  const DampedWave wave(q, decay_rate * dt_s);
  const double y = wave.cosine * y0 + wave.sine * dt_s * (v0 + decay_rate * y0);
  const double v = wave.cosine * v0 - wave.sine * dt_s * (w_rad_s_ * w_rad_s_ * y0 + decay_rate * v0);
  state_ = {u_end + y, slope + v, -w_rad_s_ * w_rad_s_ * y - 2.0 * decay_rate * v};
  u_ = u_end;
  return state_;
}

}  // namespace canyon::mission
