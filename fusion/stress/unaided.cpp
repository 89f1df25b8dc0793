#include <array>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/fusion/rounding_growth.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;

/// The state moved by constant increments, `each` called after every step.
template <class Each>
void go_on(NavState state, const Increments& in, int steps, const Each& each) {
  const auto strapdown = make_strapdown("three_sample");
  for (int k = 1; k <= steps; ++k) {
    strapdown->advance(state, in);
    each(k, state);
  }
}

/// An error of a centimetre of height, 90 minutes long: it grows as cosh(k t), whose logarithm rises by k a second once
/// e^(-2 k t) is gone. 2 g / R leaves out the Earth's flattening and turn, below 0.4 % of k together.
StressFigure vertical_growth(double lat_deg) {
  const NavState truth = resting_at(lat_deg, 7.0, 0.0);
  const Vector3d up = rotation_E_from_enu(geodetic_from_ecef(truth.p_EU_E)).col(2);
  NavState start = truth;
  start.p_EU_E += 0.01 * up;
  double early_m = 0.0, late_m = 0.0;
  go_on(start, rest_increments(truth, 1.0), 5400, [&](int k, const NavState& s) {
    if (k == 3600) early_m = up.dot(s.p_EU_E - truth.p_EU_E);
    if (k == 5400) late_m = up.dot(s.p_EU_E - truth.p_EU_E);
  });
  const double found = std::log(late_m / early_m) / 1800.0;
  const double expected = std::sqrt(2.0 * gravity_E(truth.p_EU_E).norm() / truth.p_EU_E.norm());
  return {std::abs(found / expected - 1.0), 0.01};
}

/// East and north of the place at rest, the height held: one state a step.
constexpr double kStep_s = 2.0;
std::vector<Eigen::Vector2d> swing(double lat_deg, double hours) {
  const NavState truth = resting_at(lat_deg, 7.0, 0.0);
  const Eigen::Matrix3d R_E_enu = rotation_E_from_enu(geodetic_from_ecef(truth.p_EU_E));
  const Increments in = rest_increments(truth, kStep_s);
  NavState state = truth;
  state.v_EU_E = R_E_enu.col(1);  // 1 m/s north
  const auto strapdown = make_strapdown("three_sample");
  std::vector<Eigen::Vector2d> out = {Eigen::Vector2d::Zero()};
  for (int k = 0; k < static_cast<int>(hours * 3600.0 / kStep_s); ++k) {
    strapdown->advance(state, in);
    const Geodetic g = geodetic_from_ecef(state.p_EU_E);
    const Vector3d up = rotation_E_from_enu(g).col(2);
    state.p_EU_E -= g.h_m * up;
    state.v_EU_E -= state.v_EU_E.dot(up) * up;
    out.emplace_back((R_E_enu.transpose() * (state.p_EU_E - truth.p_EU_E)).head<2>());
  }
  return out;
}

/// Times at which the northward swing changes sign, by a straight line between steps.
StressFigure schuler_period(double lat_deg) {
  const auto path = swing(lat_deg, 4.5);
  std::vector<double> crossings_s;
  for (std::size_t k = 1; k + 1 < path.size(); ++k)
    if (path[k].y() * path[k + 1].y() < 0.0)
      crossings_s.push_back(kStep_s * (static_cast<double>(k) + path[k].y() / (path[k].y() - path[k + 1].y())));
  if (crossings_s.size() < 3) return {stress::kInfinity, 0.01};
  const double period_s =
      2.0 * (crossings_s.back() - crossings_s.front()) / static_cast<double>(crossings_s.size() - 1);
  return {std::abs(period_s / (84.4 * 60.0) - 1.0), 0.01};
}

/// The swing's plane turns clockwise, from the north eastward, by w_e sin(latitude) a second. Where it is after six
/// hours and some: the bearing of the farthest point, over that angle.
StressFigure foucault_beat(double lat_deg) {
  const auto path = swing(lat_deg, 7.0);
  const auto from = static_cast<std::size_t>(5.5 * 3600.0 / kStep_s);
  std::size_t farthest = from;
  for (std::size_t k = from; k < path.size(); ++k)
    if (path[k].norm() > path[farthest].norm()) farthest = k;
  const double bearing = std::atan2(path[farthest].x(), path[farthest].y());
  const double turned = Wgs84::rate_rad_s * std::sin(lat_deg * kDegree) * kStep_s * static_cast<double>(farthest);
  return {std::abs(std::remainder(bearing - turned, kPi) / turned), 0.01};
}

/// Six hours of rest at 1 Hz, all increments exact: what the integrator goes astray is rounding, and may at no time be
/// more than what is said of it. That is itself no more, as long as it is small against Earth's radius, than if all of
/// it had grown from the beginning on, as e^(k t) with k^2 = 2 g / R: 2e-7 m of the start's text, four epsilons of the
/// radius at random each step; and two each step of the tilt, which does not grow. Velocities are k of it.
StressFigure rounding_below_its_bound() {
  const NavState truth = resting_at(45.0, 7.0, 200.0);
  RoundingGrowth growth(truth);
  stress::Worst worst;
  const double radius_m = truth.p_EU_E.norm(), k = std::sqrt(2.0 * gravity_E(truth.p_EU_E).norm() / radius_m);
  go_on(truth, rest_increments(truth, 1.0), 6 * 3600, [&](int step, const NavState& s) {
    growth.advance(s);
    worst.look((s.p_EU_E - truth.p_EU_E).norm(), growth.position_m());
    worst.look(s.v_EU_E.norm(), growth.velocity_m_s());
    const double steps = step, round_m = stress::kEpsilon * radius_m;
    const double most_m = (2e-7 + 4.0 * round_m * std::sqrt(steps)) * std::exp(k * steps) + 2.0 * round_m * steps;
    if (growth.position_m() > 0.01 * radius_m) return;
    worst.look(growth.position_m(), most_m);
    worst.look(growth.velocity_m_s(), 2.0 * k * most_m);
  });
  return worst.figure();
}

/// The same compared with its reference: that rounding has overtaken is told, with the time up to which it had not, and
/// not for an error that a reference tells.
StressFigure rounding_is_told() {
  const NavState truth = resting_at(45.0, 7.0, 200.0);
  std::vector<NavState> states = {truth}, reference = {truth};
  go_on(truth, rest_increments(truth, 1.0), 5 * 3600, [&](int k, const NavState& s) {
    states.push_back(s);
    reference.push_back(truth);
    states.back().t = reference.back().t = {truth.t.ns + k * kNsPerSecond};
  });
  auto errors = navigation_errors(states, reference);
  const HeldErrors held = held_errors(states, errors);
  int wrong = held.until && held.count < errors.size() && *held.until == errors[held.count - 1].t ? 0 : 1;
  wrong += held.until && *held.until - truth.t > 1800.0 ? 0 : 1;
  wrong += std::isfinite(held.rounding_m) ? 0 : 1;
  for (NavError& e : errors) e.position_enu_m.x() += 1e9;  // rounding grows to 1e7 m
  wrong += held_errors(states, errors).until ? 1 : 0;
  return {1.0 * wrong, 0.0};
}

/// Attitude over a day of steps of 10 s: each rounds by two epsilons at most.
StressFigure attitude_of_a_day() {
  const NavState truth = resting_at(45.0, 7.0, 200.0);
  const Increments in = rest_increments(truth, 10.0);
  const auto strapdown = make_strapdown("constant_rate");
  NavState state = truth;
  constexpr int kSteps = 8640;
  for (int k = 0; k < kSteps; ++k) {
    strapdown->advance(state, in);
    state.p_EU_E = truth.p_EU_E;
    state.v_EU_E.setZero();
  }
  return {so3_log(truth.R_EU.conjugate() * state.R_EU).norm(), 2.0 * stress::kEpsilon * kSteps};
}

}  // namespace

std::vector<StressCase> unaided_cases() {
  const auto group = StressGroup::kLong;
  const StressMechanism vertical{
      group, "the unstable height of unaided navigation",
      "gravity of a constant size leaves the height neutral, one that grows with height makes it swing",
      "grows by sqrt(2 g / R) a second, within 1 %: flattening and the Earth's turn are 0.4 %", ""};
  const StressMechanism horizontal{group, "Schuler's swing of the horizontal",
                                   "gravity that does not turn with the place lets the error run away",
                                   "a period of 84.4 min, within 1 %: the ellipsoid's radii differ by 0.7 %", ""};
  const StressMechanism beat{group, "Foucault's beat of the swing",
                             "a Coriolis term of the wrong sign, half or twice its size, or left out",
                             "the plane turns by w_e sin(latitude), within 1 % after six hours", ""};
  const StressMechanism overtaken{
      group, "a figure that rounding has overtaken",
      "rounding grows as e^(t / 570 s): after some hours it is 10^9 m and says nothing of sensor or integrator "
      "(2026-11-22: it was printed as the integrator's error)",
      "never more than what is said of it, and told from where on", "of the bound"};
  const StressMechanism attitude{group, "attitude over a day",
                                 "a quaternion that is not normalised, or an Earth rate by halves",
                                 "8640 steps round by two epsilons each at most", "rad"};
  StressRows rows;
  for (const double lat_deg : {0.0, 45.0, 90.0})
    rows.of(vertical).add("unaided/vertical_channel_at_" + stress::text(lat_deg) + "_deg",
                          [=] { return vertical_growth(lat_deg); });
  for (const double lat_deg : {0.0, 45.0, -70.0})
    rows.of(horizontal).add("unaided/schuler_period_at_" + stress::text(lat_deg) + "_deg", [=] {
      return schuler_period(lat_deg);
    });
  for (const double lat_deg : {60.0, -60.0})
    rows.of(beat).add("unaided/foucault_beat_at_" + stress::text(lat_deg) + "_deg",
                      [=] { return foucault_beat(lat_deg); });
  rows.of(overtaken).add("unaided/rounding_below_its_bound", rounding_below_its_bound);
  rows.of(overtaken).add("unaided/rounding_is_told", rounding_is_told);
  rows.of(attitude).add("unaided/attitude_of_a_day", attitude_of_a_day);
  return rows.take();
}

}  // namespace canyon::fusion
