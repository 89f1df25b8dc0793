// What rounding may have grown to, part by part, and the errors that it leaves standing.
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/rounding_growth.h"
#include "canyon/fusion/stress/integrators/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// What rounding may have grown to, over steps of one length at one place and pushed by a constant force, as its
/// documentation says it: each part by its closed form, to what a sum of n terms of a growing series rounds; and the
/// errors that it leaves standing.
StressFigure rounding() {
  Looks looks;
  for (const double h : {0.01, 0.5, 4.0}) {
    NavState state;
    state.p_EU_E = Vector3d(6.4e6, 1e5, 2e4);
    const double r = state.p_EU_E.norm(), k = std::sqrt(2.0 * 3.986004418e14 / (r * r * r)), push = 3.0;
    RoundingGrowth bound(state);
    const int steps = h < 0.1 ? 3000 : 2000;
    double height = 2e-7, variance = 0.0, tilt = 0.0, walk = 0.0, horizontal = 0.0;
    for (int i = 1; i <= steps; ++i) {
      NavState next = state;
      next.t = GpsTime{} + h * i, next.v_EU_E = Vector3d(0.0, push * h * i, 0.0);
      bound.advance(next);
      // Every step tilts by an epsilon; drift of an epsilon a step; half a unit of the place, a second's alike.
      tilt = i * kEpsilon;
      const double half_ulp = 0.5 * kEpsilon * r, square = half_ulp * half_ulp * (h < 1.0 ? 1.0 / h : 1.0);
      walk += square;
      const double schuler = k / std::sqrt(2.0) * h * i;
      horizontal = r * kEpsilon / h * (1.0 - std::cos(schuler < kPi ? schuler : kPi));
      const double force = push * tilt + 2.0 * 7.292115e-5 * horizontal;
      height = std::exp(k * h) * (height + 0.5 * force / k * h);
      variance = std::exp(2.0 * k * h) * (variance + 0.25 * square);
      if (i % 97 != 0) continue;
      looks.near(bound.position_m() / (r * tilt + 3.0 * std::sqrt(walk) + height + 3.0 * std::sqrt(variance)), 1.0,
                 1e-6);
      looks.near(bound.velocity_m_s() / (horizontal + k * (height + 3.0 * std::sqrt(variance))), 1.0, 1e-12);
    }
    const double before = bound.position_m();
    NavState same = state;
    same.t = GpsTime{} + h * steps;
    bound.advance(same);
    looks.right(bound.position_m() == before);
  }
  // Held until rounding exceeds the largest error and a centimetre: at 10 s a step for hours it passes through both.
  std::vector<NavState> states;
  std::vector<NavError> errors;
  NavState state;
  state.p_EU_E = Vector3d(6.4e6, 0.0, 0.0);
  RoundingGrowth alone(state);
  std::size_t first_beyond = 0;
  double at_end = 0.0, largest = 0.01;
  for (int i = 0; i <= 3000; ++i) {
    state.t = GpsTime{} + 10.0 * i;
    states.push_back(state);
    alone.advance(state);
    NavError e;
    e.t = state.t, e.position_enu_m = Vector3d(i < 800 ? 1e-4 * i : 0.0, 0.0, 0.0);
    e.velocity_enu_m_s = e.attitude_rad = Vector3d::Zero();
    errors.push_back(e);
    largest = worse(largest, e.position_enu_m.norm());
    if (first_beyond == 0 && alone.position_m() > largest) first_beyond = static_cast<std::size_t>(i);
    at_end = alone.position_m();
  }
  const HeldErrors held = held_errors(states, errors);
  looks.right(first_beyond > 100 && held.count == first_beyond && held.until &&
              *held.until == errors[first_beyond - 1].t);
  looks.near(held.rounding_m / at_end, 1.0, 1e-12);
  const HeldErrors all = held_errors(states, std::span(errors).first(50)), none = held_errors(states, {});
  looks.right(all.count == 50 && !all.until && none.count == 0 && !none.until &&
              held_errors({}, errors).count == errors.size());
  looks.near(none.rounding_m / at_end, 1.0, 1e-12);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> rounding_growth_cases() {
  StressRows rows;
  rows.of({StressGroup::kLong, "the parts of what rounding may grow to",
           "a part of another power of the step, or half of it", "each by its documented law, step by step",
           "of the bound"});
  rows.add("integrators/rounding_by_parts", rounding);
  return rows.take();
}

}  // namespace canyon::fusion
