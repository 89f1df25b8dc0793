// How a log is gone through from within a sample, and compared with a reference.
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/dead_reckoning.h"
#include "canyon/fusion/divided_sample.h"
#include "canyon/fusion/strapdown/models.h"
#include "canyon/fusion/stress/integrators/free_space.h"
#include "canyon/fusion/stress/integrators/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// A log whose samples end before the start, over it, and across gaps: only what lies after the start counts, by its
/// share, and what comes after a gap stands for it. By a body that turns and is pushed evenly, whose rows of constant
/// rate are exact.
StressFigure shares_of_a_log() {
  Looks looks;
  const Vector3d w(0.3, -0.2, 0.5), f(1.0, 2.0, -3.0);
  const auto in = [&](double dt) { return Increments{.dt_s = dt, .dtheta_U = dt * w, .dv_U = dt * f}; };
  const auto sample = [&](double end, double dt) {
    ImuSample s;
    s.t = GpsTime{} + end, s.dt_s = dt, s.dtheta_U = dt * w, s.dv_U = dt * f;
    return s;
  };
  NavState start;
  start.t = GpsTime{} + 1.03, start.v_EU_E = Vector3d(3.0, 0.0, 1.0);
  // Before it, over it (0.07 of 0.1 s after), whole, with a gap of 0.4 s, whole, and one that overlaps a little.
  const std::vector<ImuSample> log = {sample(0.9, 0.1), sample(1.0, 0.1), sample(1.1, 0.1),
                                      sample(1.2, 0.1), sample(1.7, 0.1), sample(1.8, 0.1)};
  const auto rows = make_strapdown("constant_rate", no_gravity);
  rows->leave_out({.earth_rate = true});
  const auto states = dead_reckon(log, start, *rows);
  looks.right(states.size() == 5);
  if (states.size() != 5) return looks.figure();
  NavState by_hand = start;
  const double spans[] = {0.07, 0.1, 0.5, 0.1};
  for (std::size_t k = 0; k < 4; ++k) {
    make_constant_rate(no_gravity)->reset();
    const auto one = make_strapdown("constant_rate", no_gravity);
    one->leave_out({.earth_rate = true});
    one->advance(by_hand, in(spans[k]));
    by_hand.t = log[k + 2].t;
    looks.right(states[k + 1].t == log[k + 2].t);
    looks.near((states[k + 1].p_EU_E - by_hand.p_EU_E).norm(), 0.0, 1e-8);  // stamps of a nanosecond
    looks.near((states[k + 1].v_EU_E - by_hand.v_EU_E).norm(), 0.0, 1e-8);
    looks.near(so3_log(states[k + 1].R_EU.conjugate() * by_hand.R_EU).norm(), 0.0, 1e-8);
  }
  // A part of a sample, and what is left of it.
  ImuSample rest = sample(2.0, 0.5);
  const ImuSample first = take_share(rest, 0.3);
  looks.near(first.dt_s, 0.15, 1e-15), looks.near(rest.dt_s, 0.35, 1e-15);
  looks.near((first.dtheta_U - 0.15 * w).norm() + (rest.dtheta_U - 0.35 * w).norm() + (first.dv_U - 0.15 * f).norm() +
                 (rest.dv_U - 0.35 * f).norm(),
             0.0, 1e-14);
  looks.near(first.t - GpsTime{}, 1.65, 1e-9), looks.near(rest.t - GpsTime{}, 2.0, 1e-9);
  return looks.figure();
}

/// Estimate and reference whose difference is known, at instants between: a cubic way is met exactly, velocity linear;
/// errors along east, north and up of the reference and about its own axes; and root mean squares of all but the first.
StressFigure compared() {
  Looks looks;
  const Geodetic at{0.4, -1.1, 300.0};
  const Matrix3d R_EN = rotation_E_from_enu(at);
  const Vector3d p0 = ecef_from_geodetic(at), c1(8.0, -3.0, 1.0), c2(0.5, 0.2, -0.4), c3(0.05, -0.03, 0.02),
                 axis(0.6, 0.0, 0.8);
  const auto moving = [&](double s) {
    NavState n;
    n.t = GpsTime::from_week_sow(1590, 100.0) + s;
    n.p_EU_E = p0 + s * (c1 + s * (c2 + s * c3)), n.v_EU_E = c1 + s * (2.0 * c2 + 3.0 * s * c3);
    n.R_EU = Quaterniond(R_EN) * so3_exp(0.3 * s * axis);
    return n;
  };
  const Vector3d off_enu(1.0, -2.0, 0.5), turn(0.01, -0.02, 0.03);
  std::vector<NavState> estimate, reference;
  for (int k = 0; k <= 8; ++k) {
    estimate.push_back(moving(0.5 * k));
    estimate.back().p_EU_E += R_EN * off_enu;
    estimate.back().R_EU = estimate.back().R_EU * so3_exp(turn);
  }
  for (const double s : {-0.3, 0.0, 0.2, 0.5, 1.35, 3.99, 4.0, 4.2}) reference.push_back(moving(s));
  const auto errors = navigation_errors(estimate, reference);
  looks.right(errors.size() == 6);
  if (errors.size() != 6) return looks.figure();
  Vector3d p2 = Vector3d::Zero(), a2 = Vector3d::Zero(), v2 = Vector3d::Zero();
  const double instants[] = {0.0, 0.2, 0.5, 1.35, 3.99, 4.0};
  for (std::size_t k = 0; k < 6; ++k) {
    const NavError& e = errors[k];
    looks.near(e.t - estimate.front().t, instants[k], 2e-9);
    // The place has moved by 60 m: its vertical by 1e-5 rad. A nanosecond of 10 m/s.
    looks.near((e.position_enu_m - off_enu).norm(), 0.0, 2.3 * 1e-5 + 1e-7);
    // Linear between half seconds: at most the third derivative's eighth of h^2.
    const double s = std::fmod(instants[k], 0.5), bent = 0.5 * s * (0.5 - s) * 6.0 * c3.norm();
    looks.near(e.velocity_enu_m_s.norm(), bent, 1e-7);
    looks.near((e.attitude_rad - turn).norm(), 0.0,
               0.003 * 0.15 + 1e-9);  // a turn of 0.15 between, beside one of 0.037
    if (k == 0) continue;
    p2 += e.position_enu_m.cwiseAbs2() / 5.0, a2 += e.attitude_rad.cwiseAbs2() / 5.0,
        v2 += e.velocity_enu_m_s.cwiseAbs2() / 5.0;
  }
  const NavErrorStatistics told = navigation_error_statistics(errors);
  looks.near((told.position_rms_enu_m - p2.cwiseSqrt()).norm(), 0.0, 1e-14),
      looks.near((told.attitude_rms_rad - a2.cwiseSqrt()).norm(), 0.0, 1e-15);
  looks.near((told.velocity_rms_enu_m_s - v2.cwiseSqrt()).norm(), 0.0, 1e-15);
  looks.near(told.position_rms_m, std::sqrt(p2.sum()), 1e-14);
  looks.near(told.final_error_m, errors.back().position_enu_m.norm(), 1e-15);
  looks.near(told.final_horizontal_m, errors.back().position_enu_m.head<2>().norm(), 1e-15);
  looks.right(std::isnan(navigation_error_statistics(std::span(errors).first(1)).position_rms_m));
  for (const double s : {0.1, 0.25, 0.4}) {
    const NavState between = interpolate(moving(0.0), moving(0.5), moving(s).t);
    looks.near((between.p_EU_E - moving(s).p_EU_E).norm(), 0.0, 8.0 * kEpsilon * 6.4e6 + 1e-8);
    looks.near(so3_log(between.R_EU.conjugate() * moving(s).R_EU).norm(), 0.0, 1e-9);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> integrator_log_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "a log from within a sample, with gaps, beside a reference",
           "a share of the wrong part, a mean that counts the start, axes of another place",
           "by hand; stamps of a nanosecond, and a vertical that turns by 1e-5", "of the bound"});
  rows.add("integrators/shares_of_a_log", shares_of_a_log).add("integrators/compared_with_a_reference", compared);
  return rows.take();
}

}  // namespace canyon::fusion
