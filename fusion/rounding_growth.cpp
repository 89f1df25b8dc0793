#include "canyon/fusion/rounding_growth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/earth/earth.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"

namespace canyon::fusion {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kSameWay_s = 1.0;
constexpr double kSigmas = 3.0;
constexpr std::size_t kStepsPerLook = 4096;  // at whether the user wants to stop

}  // namespace

void RoundingGrowth::advance(const NavState& next) {
  const double h = next.t - last_.t;
  if (h <= 0.0) return;
  const double r = next.p_EU_E.norm();
  k_per_s_ = std::sqrt(2.0 * Wgs84::gm_m3_s2 / (r * r * r));
  tilt_rad_ += kEpsilon;
  drift_rad_s_ = std::max(drift_rad_s_, kEpsilon / h);
  const double half_ulp_m = 0.5 * kEpsilon * r;
  const double rounding_m2 = half_ulp_m * half_ulp_m * std::max(1.0, kSameWay_s / h);
  walk_m2_ += rounding_m2;
  elapsed_s_ += h;
  // r d (1 - cos w t), the velocity that a drift d makes under Schuler's w; from its crest on the crest.
  const double half_turn = std::min(0.5 * k_per_s_ / std::sqrt(2.0) * elapsed_s_, 0.5 * kPi);
  horizontal_m_s_ = 2.0 * r * drift_rad_s_ * std::sin(half_turn) * std::sin(half_turn);
  const double acceleration =
      (next.v_EU_E - last_.v_EU_E).norm() / h * tilt_rad_ + 2.0 * Wgs84::rate_rad_s * horizontal_m_s_;
  // Of a disturbance, the half of it that grows: of a position 1/2, of an acceleration a: a / (2 k) each second.
  const double growth = std::exp(k_per_s_ * h);
  height_m_ = growth * (height_m_ + 0.5 * acceleration / k_per_s_ * h);
  height_variance_m2_ = growth * growth * (height_variance_m2_ + 0.25 * rounding_m2);
  last_ = next;
}

double RoundingGrowth::position_m() const {
  return last_.p_EU_E.norm() * tilt_rad_ + kSigmas * std::sqrt(walk_m2_) + height_m_ +
         kSigmas * std::sqrt(height_variance_m2_);
}

double RoundingGrowth::velocity_m_s() const {
  return horizontal_m_s_ + k_per_s_ * (height_m_ + kSigmas * std::sqrt(height_variance_m2_));
}

HeldErrors held_errors(std::span<const NavState> states, std::span<const NavError> errors) {
  HeldErrors out{errors.size(), std::nullopt, 0.0};
  if (states.empty()) return out;
  RoundingGrowth growth(states.front());
  double largest_m = kReferenceTells_m;
  std::size_t next = 1;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (i % kStepsPerLook == 0) throw_if_cancelled();
    for (; next < states.size() && states[next].t <= errors[i].t; ++next) {
      if (next % kStepsPerLook == 0) throw_if_cancelled();
      growth.advance(states[next]);
    }
    out.rounding_m = growth.position_m();
    largest_m = std::max(largest_m, errors[i].position_enu_m.norm());
    if (out.until || growth.position_m() <= largest_m) continue;
    out.count = i;
    out.until = errors[i > 0 ? i - 1 : 0].t;
  }
  if (!errors.empty()) return out;
  for (; next < states.size(); ++next) {
    if (next % kStepsPerLook == 0) throw_if_cancelled();
    growth.advance(states[next]);
  }
  out.rounding_m = growth.position_m();
  return out;
}

}  // namespace canyon::fusion
