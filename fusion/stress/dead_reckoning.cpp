#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/fusion/rounding_growth.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Worst;

/// Half an hour of rest in steps of a second, at places and attitudes where angles are undefined: nothing but rounding,
/// which is followed beside it; the state in E knows of no pole.
StressFigure rest(double lat_deg, double lon_deg, double height_m, const Vector3d& force_U) {
  const NavState truth = resting_at(lat_deg, lon_deg, height_m, force_U);
  const auto strapdown = make_strapdown("three_sample");
  const Increments in = rest_increments(truth, 1.0);
  NavState state = truth;
  RoundingGrowth growth(truth);
  Worst worst;
  for (int k = 0; k < 1800; ++k) {
    strapdown->advance(state, in);
    growth.advance(state);
    worst.look((state.p_EU_E - truth.p_EU_E).norm(), growth.position_m());
  }
  return worst.figure();
}

/// Levelled with a force in any direction, gravity is where the force says: to ten roundings.
StressFigure levelling() {
  Worst worst;
  for (const double lat : {-90.0, -45.0, 0.0, 89.9999999, 90.0})
    for (const Vector3d& force : {Vector3d(0, 0, 1), Vector3d(0, 0, -9.8), Vector3d(1, 0, 0), Vector3d(-1e-6, 0, 0),
                                  Vector3d(0, 1e6, 0), Vector3d(1e-12, -1, 1e-12), Vector3d(1, 1e-16, -1e-16)}) {
      const NavState s = levelled({lat * kDegree, kPi, -400.0}, 1.0, force);
      const Vector3d up = -gravity_E(s.p_EU_E).normalized();
      worst.look((s.R_EU * force.normalized() - up).norm(), 10.0 * kEpsilon);
      worst.look(s.R_EU.norm() - 1.0, 4.0 * kEpsilon);
    }
  return worst.figure();
}

/// 2000 deg/s about z and 50 g along x of the body, both constant, for a second in steps of `dt_s`: the velocity is f /
/// w times the turn's sine and cosine, beside what gravity makes of a free body. Within a step the velocity bends by f
/// w dt^3 / 12, of which Coriolis' 2 w_e is not seen; over the turns those add up to no more than one over half a
/// step's angle of them. Attitude: two epsilons a step.
StressFigure spin(double dt_s) {
  const double w = 2000.0 * kDegree, f = 50.0 * kStandardGravity;
  const NavState start = resting_at(45.0, 7.0, 200.0);
  const auto steps = static_cast<int>(std::llround(1.0 / dt_s));
  const auto spun = make_strapdown("constant_rate"), fallen = make_strapdown("three_sample");
  NavState state = start, falling = start;
  for (int k = 0; k < steps; ++k) {
    // Against inertial space the body turns about its own z alone.
    spun->advance(state, {.dt_s = dt_s, .dtheta_U = {0.0, 0.0, w * dt_s}, .dv_U = {f * dt_s, 0.0, 0.0}});
    fallen->advance(falling, {.dt_s = dt_s, .dtheta_U = {0.0, 0.0, w * dt_s}, .dv_U = Vector3d::Zero()});
  }
  // In the axes of U at the start, which stand still in inertial space while E turns by w_e t.
  const Eigen::Quaterniond turned = so3_exp(-1.0 * earth_rate_E());
  const Vector3d gained = start.R_EU.conjugate() * (turned.conjugate() * (state.v_EU_E - falling.v_EU_E));
  const Vector3d exact = f / w * Vector3d(std::sin(w), 1.0 - std::cos(w), 0.0);
  // Ground speed is the inertial one less w_e x the way that was gained.
  const Vector3d way = f / (w * w) * Vector3d(1.0 - std::cos(w), w - std::sin(w), 0.0);
  const Vector3d over_ground = exact - (start.R_EU.conjugate() * earth_rate_E()).cross(way);
  const double seen = 2.0 * Wgs84::rate_rad_s * f * w * dt_s * dt_s * dt_s / 12.0 / std::sin(0.5 * w * dt_s);
  // Gravity differs by 3e-6 a metre over the 14 m of the way.
  const double gradient = 3.1e-6 * way.norm();
  Worst worst;
  worst.look((gained - over_ground).norm(), seen + gradient + kEpsilon * steps * f / w);
  const Eigen::Quaterniond truth = turned * start.R_EU * so3_exp({0.0, 0.0, std::remainder(w, 2.0 * kPi)});
  worst.look(so3_log(truth.conjugate() * state.R_EU).norm(), 2.0 * kEpsilon * steps + 4.0 * kEpsilon * w);
  return worst.figure();
}

/// States near 2^31 s and 2^62 ns, and steps of a nanosecond: the time is the sum of the steps, and interpolation
/// between two of them is at its ends what they are.
StressFigure late_instants() {
  Worst worst;
  for (const std::int64_t base_ns : {std::int64_t{0}, (std::int64_t{1} << 31) * kNsPerSecond, std::int64_t{1} << 62}) {
    NavState a = resting_at(10.0, 20.0, 30.0);
    a.t.ns = base_ns;
    a.v_EU_E = {30.0, -20.0, 10.0};
    NavState b = a;
    const auto strapdown = make_strapdown("constant_rate");
    for (int k = 0; k < 1000; ++k) strapdown->advance(b, rest_increments(a, 1e-9));
    worst.look(static_cast<double>(b.t.ns - base_ns - 1000), 1e-12);
    worst.look((b.p_EU_E - a.p_EU_E - 1e-6 * a.v_EU_E).norm(), 1000.0 * kEpsilon * 6.4e6);
    const NavState middle = interpolate(a, b, {base_ns + 500});
    worst.look((middle.p_EU_E - 0.5 * (a.p_EU_E + b.p_EU_E)).norm(), 8.0 * kEpsilon * 6.4e6);
    worst.look((interpolate(a, b, a.t).p_EU_E - a.p_EU_E).norm() + (interpolate(a, b, b.t).p_EU_E - b.p_EU_E).norm(),
               8.0 * kEpsilon * 6.4e6);
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> dead_reckoning_cases() {
  const auto group = StressGroup::kGeometry;
  StressMechanism place{group, "navigation where latitude, longitude or heading end",
                        "a wander angle or transport rate of v tan(latitude) / R is infinite at a pole",
                        "rest for half an hour: nothing but rounding, below what is said of it", "of the bound"};
  place.loose = "the bound holds at any attitude; where axes fall together most roundings cancel or are none";
  const StressMechanism level{group, "a level from any force",
                              "roll and pitch from a force along x, upside down, or far from 1 g long",
                              "the force points up, to ten roundings", "of the bound"};
  const StressMechanism fast{StressGroup::kStiff, "a third of a radian and half a g within a step",
                             "series of the rotation's powers are cut off: 1e-3 of the velocity at 0.35 rad",
                             "the closed form of a constant rate and force, to what Coriolis does not see of a step",
                             "of the bound"};
  const StressMechanism late{StressGroup::kLong, "steps of a nanosecond at late instants",
                             "the time is added up in double seconds, and stands still",
                             "whole nanoseconds, and positions to an epsilon of Earth's radius a step", "of the bound"};
  StressRows rows;
  rows.of(place).add("dead_reckoning/rest_at_the_north_pole", [] { return rest(90, 0, 0, {0, 0, 1}); });
  rows.of(place).add("dead_reckoning/rest_at_the_south_pole", [] { return rest(-90, 30, -400, {0.1, 0, 1}); });
  rows.of(place).add("dead_reckoning/rest_at_the_antimeridian", [] { return rest(0, 180, 20000, {0, 0, -1}); });
  rows.of(place).add("dead_reckoning/rest_nose_up", [] { return rest(51, 7, 100, {1, 0, 0}); });
  rows.of(place).add("dead_reckoning/rest_nose_down", [] { return rest(51, 7, 100, {-1, 1e-9, 0}); });
  rows.of(level).add("dead_reckoning/level_from_any_force", levelling);
  for (const double dt_s : {0.01, 0.001})
    rows.of(fast).add("dead_reckoning/2000_deg_s_50_g_step_" + stress::text(dt_s) + "_s", [=] { return spin(dt_s); });
  rows.of(late).add("dead_reckoning/steps_of_1_ns_at_late_instants", late_instants);
  return rows.take();
}

}  // namespace canyon::fusion
