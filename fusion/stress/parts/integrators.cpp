// The rows of integrators: what each makes of one step, to the order that its formula has, and of a path, to the order
// that its table says; what each may leave out; and how a log is gone through and compared with a reference.
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/earth/earth.h"
#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/dead_reckoning.h"
#include "canyon/fusion/divided_sample.h"
#include "canyon/fusion/rounding_growth.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/fusion/strapdown/models.h"
#include "canyon/fusion/stress/parts/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

Vector3d no_gravity(const Vector3d&) {
  return Vector3d::Zero();
}

/// A rate or force over time: a polynomial of second degree.
struct Quadratic {
  Vector3d c0, c1, c2;
  Vector3d at(double t) const { return c0 + t * (c1 + t * c2); }
  Vector3d integral(double from, double to) const {
    const auto upto = [&](double t) -> Vector3d { return t * (c0 + t * (c1 / 2.0 + t * c2 / 3.0)); };
    return upto(to) - upto(from);
  }
};

/// Rotation over [0, h] and the integral of the turned force, by 400 steps of Magnus' fourth order: of |w| h up to 1
/// that leaves (1 / 400)^4.
InertialStep exactly(const Quadratic& rate, const Quadratic& force, double h) {
  constexpr int kSteps = 400;
  const double s = h / kSteps, root = std::sqrt(3.0) / 6.0;
  Quaterniond R = Quaterniond::Identity();
  InertialStep out;
  const auto turn = [&](double from, double length) {
    const Vector3d a = rate.at(from + (0.5 - root) * length), b = rate.at(from + (0.5 + root) * length);
    return so3_exp(0.5 * length * (a + b) + std::sqrt(3.0) / 12.0 * length * length * a.cross(b));
  };
  for (int k = 0; k < kSteps; ++k) {
    const double t = s * k;
    const Quaterniond middle = R * turn(t, 0.5 * s), end = R * turn(t, s);
    out.dv_start_U += s / 6.0 * (R * force.at(t) + 4.0 * (middle * force.at(t + 0.5 * s)) + end * force.at(t + s));
    R = end;
  }
  out.rotation_U = so3_log(R);
  return out;
}

Quadratic drawn(const RandomStream& draws, std::uint64_t k, std::uint32_t first, int degree, double size) {
  return {size * draws.normal3(k, first), degree > 0 ? Vector3d(size * draws.normal3(k, first + 1)) : Vector3d::Zero(),
          degree > 1 ? Vector3d(size * draws.normal3(k, first + 2)) : Vector3d::Zero()};
}

struct StepErrors {
  double rotation = 0.0, dv = 0.0;
};
/// Of the last of `count` steps of unlike lengths, or all alike, the last one h long, that the row has gone through.
StepErrors step_errors(const std::string& row, int degree, int count, double h, bool even) {
  const RandomStream draws(3, "stress.integrators");
  StepErrors out;
  for (std::uint64_t k = 0; k < 12; ++k) {
    const Quadratic rate = drawn(draws, k, 0, degree, 1.0), force = drawn(draws, k, 4, degree, 10.0);
    const auto strapdown = make_strapdown(row, no_gravity);
    strapdown->reset();
    NavState state;
    InertialStep made;
    const double before = even ? 1.0 : 0.8;
    double from = -h * (count > 2 ? before + 1.3 : count > 1 ? before : 0.0);
    for (int i = count; i > 0; --i) {
      const double length = i == 1 ? h : i == 2 ? before * h : 1.3 * h;
      made = strapdown->advance(state, {.dt_s = length,
                                        .dtheta_U = rate.integral(from, from + length),
                                        .dv_U = force.integral(from, from + length)});
      from += length;
    }
    const InertialStep truth = exactly(rate, force, h);
    out.rotation += so3_log(so3_exp(truth.rotation_U).conjugate() * so3_exp(made.rotation_U)).norm();
    out.dv += (made.dv_start_U - truth.dv_start_U).norm();
  }
  return out;
}

/// Halving a step divides its error by 2^order: of the formula, for rates and forces that are polynomials. Within 0.3,
/// what the next order still has at half a radian; where the formula is exact the error is what the reference leaves.
StressFigure orders_of_a_step() {
  Looks looks;
  const struct {
    const char* row;
    int degree, count;
    double rotation, dv;  // infinite: exact
    bool even = false;
  } orders[] = {{"euler", 2, 2, 3.0, 2.0},
                {"trapezoid", 2, 2, 3.0, 3.0},
                {"constant_rate", 2, 2, 3.0, 3.0},
                {"constant_rate", 0, 2, kInfinity, kInfinity},
                {"two_sample", 0, 2, kInfinity, 4.0},
                {"two_sample", 1, 2, 5.0, 4.0, true},
                {"two_sample", 1, 2, 3.0, 3.0},
                {"two_sample", 2, 1, 3.0, 3.0},
                {"three_sample", 0, 1, kInfinity, 7.0},
                {"three_sample", 1, 2, 5.0, 5.0},
                {"three_sample", 2, 3, 5.0, 5.0},
                {"three_sample", 2, 1, 3.0, 3.0}};
  for (const auto& o : orders) {
    const double h = 0.25;
    const StepErrors whole = step_errors(o.row, o.degree, o.count, h, o.even),
                     half = step_errors(o.row, o.degree, o.count, 0.5 * h, o.even);
    const auto look = [&](double error, double halved, double order, double exact) {
      if (std::isinf(order)) return looks.near(error, 0.0, exact);
      // More than the order is no fault: terms that cancel.
      looks.near(beyond(order, std::log2(error / halved)), 0.0, 0.3);
    };
    look(whole.rotation, half.rotation, o.rotation, 12.0 * 1e-10), look(whole.dv, half.dv, o.dv, 12.0 * 1e-9);
  }
  return looks.figure();
}

/// What the definitions of the simple rows say, and constant rates and forces at any angle up to almost three radians:
/// closed forms, places too.
StressFigure constant_steps() {
  Looks looks;
  const RandomStream draws(5, "stress.integrators");
  for (std::uint64_t k = 0; k < 60; ++k) {
    const double angle = std::pow(10.0, draws.uniform(-9.0, 0.47, 0, k)), dt = draws.uniform(0.001, 2.0, 1, k);
    const Vector3d axis = draws.direction(2, k), dv = 5.0 * draws.normal3(k, 5), v = draws.normal3(k, 6);
    const Increments in{.dt_s = dt, .dtheta_U = angle * axis, .dv_U = dv};
    // Rodrigues' rotation averaged once and twice: by 12-point rules it would be numbers; here its three parts.
    const Vector3d along = axis * axis.dot(dv), across = dv - along, beside = axis.cross(dv);
    const double a2 = angle * angle;
    const double sine = angle > 1e-3 ? std::sin(angle) / angle : 1.0 - a2 / 6.0,
                 versine =
                     angle > 1e-3 ? 2.0 * std::pow(std::sin(0.5 * angle), 2) / angle : 0.5 * angle - a2 * angle / 24.0;
    const Vector3d dv_start = along + sine * across + versine * beside;
    for (const char* row : {"euler", "trapezoid", "constant_rate"}) {
      const std::string name = row;
      const auto strapdown = make_strapdown(name, no_gravity);
      strapdown->leave_out({.earth_rate = true});
      NavState state;
      state.R_EU = so3_exp(draws.normal3(k, 7)), state.v_EU_E = v;
      const Quaterniond R = state.R_EU;
      const InertialStep step = strapdown->advance(state, in);
      looks.near((step.rotation_U - in.dtheta_U).norm(), 0.0, 1e-300);
      const Vector3d expected = name == "euler"       ? dv
                                : name == "trapezoid" ? Vector3d(0.5 * (dv + Eigen::AngleAxisd(angle, axis) * dv))
                                                      : dv_start;
      looks.near((step.dv_start_U - expected).norm(), 0.0,
                 64.0 * kEpsilon * dv.norm() + (angle > 1e-3 ? 0.0 : 1e-13 * dv.norm()));
      looks.near((state.v_EU_E - v - R * step.dv_start_U).norm(), 0.0, 64.0 * kEpsilon * (dv.norm() + v.norm()));
      looks.near(so3_log((R * so3_exp(in.dtheta_U)).conjugate() * state.R_EU).norm(), 0.0, 16.0 * kEpsilon);
      looks.near(state.t - GpsTime{}, dt, 1e-9);
      Vector3d place = 0.5 * dt * (v + state.v_EU_E);
      if (name == "constant_rate") {
        // The double integral: of the turning parts (1 - cos a) / a^2 and (a - sin a) / a^2.
        const double second = angle > 0.03 ? versine / angle : 0.5 - a2 / 24.0 + a2 * a2 / 720.0,
                     third = angle > 0.03 ? (angle - std::sin(angle)) / a2
                                          : angle / 6.0 - a2 * angle / 120.0 + a2 * a2 * angle / 5040.0;
        place = dt * v + dt * (R * (0.5 * along + second * across + third * beside));
      }
      looks.near((state.p_EU_E - place).norm(), 0.0, 1e-11 * dt * (dv.norm() + v.norm()));
    }
  }
  return looks.figure();
}

/// A body on a tight eight with waves of height, that turns about all of its axes on the way: nine seconds a round, in
/// closed form, on the turning Earth.
struct Eight {
  static constexpr double kRate = 2.0 * kPi / 9.0;
  LocalFrame frame{Geodetic{50.0 * kDegree, 7.0 * kDegree, 200.0}};
  Vector3d earth_W = frame.R_EW().transpose() * earth_rate_E();
  GpsTime start = GpsTime::from_week_sow(1590, 1000.0);

  static Vector3d way(double t, int derivative) {
    const double u = kRate * t, r = std::pow(kRate, derivative), r2 = std::pow(2.0 * kRate, derivative);
    const double turned = 0.5 * kPi * derivative;  // each derivative of a sine is a quarter further
    return {30.0 * r * std::sin(u + turned), 15.0 * r2 * std::sin(2.0 * u + turned),
            3.0 * r2 * std::sin(2.0 * u + 0.7 + turned)};
  }
  /// Yaw, pitch and roll, or their rates.
  static Vector3d angles(double t) {
    const double u = kRate * t;
    return {0.8 * u + 0.3 * std::sin(2.0 * u), 0.2 * std::sin(3.0 * u + 0.4), 0.6 * std::sin(2.0 * u)};
  }
  static Vector3d angle_rates(double t) {
    const double u = kRate * t;
    return kRate * Vector3d(0.8 + 0.6 * std::cos(2.0 * u), 0.6 * std::cos(3.0 * u + 0.4), 1.2 * std::cos(2.0 * u));
  }
  static Quaterniond attitude(double t) {
    const Vector3d a = angles(t);
    return rotation_from({.yaw_rad = a.x(), .pitch_rad = a.y(), .roll_rad = a.z()});
  }
  Vector3d rate_U(double t) const {
    const Vector3d a = angles(t), d = angle_rates(t);
    const double sp = std::sin(a.y()), cp = std::cos(a.y()), sr = std::sin(a.z()), cr = std::cos(a.z());
    return Vector3d(d.z() - d.x() * sp, d.y() * cr + d.x() * cp * sr, -d.y() * sr + d.x() * cp * cr) +
           attitude(t).conjugate() * earth_W;
  }
  Vector3d force_U(double t) const {
    const Vector3d gravity_W = frame.R_EW().transpose() * gravity_E(frame.to_E(way(t, 0)));
    return attitude(t).conjugate() * (way(t, 2) + 2.0 * earth_W.cross(way(t, 1)) - gravity_W);
  }
  NavState at(double t) const {
    NavState out;
    out.t = start + t;
    out.R_EU = (Quaterniond(frame.R_EW()) * attitude(t)).normalized();
    out.p_EU_E = frame.to_E(way(t, 0)), out.v_EU_E = frame.R_EW() * way(t, 1);
    return out;
  }
  /// Integrals by Simpson's rule over 64 parts of at most 0.1 s: (w h / 64)^4, 1e-13.
  ImuSample sample(double from, double to) const {
    ImuSample out;
    out.t = start + to, out.dt_s = to - from;
    constexpr int kParts = 64;
    for (int i = 0; i <= 2 * kParts; ++i) {
      const double t = from + (to - from) * i / (2.0 * kParts);
      const double weight = (i == 0 || i == 2 * kParts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * (to - from) / (6.0 * kParts);
      out.dtheta_U += weight * rate_U(t), out.dv_U += weight * force_U(t);
    }
    return out;
  }
};

/// An eight over ten seconds, exact increments, the integrator looking back beyond the start: errors of place, velocity
/// and attitude at its end fall with the interval to the power that the table says of them, but for 0.35 that the next
/// power still has.
StressFigure order_on_a_path(const StrapdownRow& row) {
  Looks looks;
  const Eight motion;
  struct Off {
    double place, speed, turn;
  };
  const auto off = [&](double dt_s) -> Off {
    std::vector<ImuSample> samples;
    const int before = 4, steps = static_cast<int>(std::lround(9.6 / dt_s));
    for (int k = 0; k < steps + before; ++k)
      samples.push_back(motion.sample(0.8 + (k - before) * dt_s, 0.8 + (k + 1 - before) * dt_s));
    const auto states = dead_reckon(samples, motion.at(0.8), *make_strapdown(row.name));
    const NavState end = motion.at(0.8 + 9.6), &found = states.back();
    looks.right(states.size() == static_cast<std::size_t>(steps) + 1);
    return {(found.p_EU_E - end.p_EU_E).norm(), (found.v_EU_E - end.v_EU_E).norm(),
            so3_log(end.R_EU.conjugate() * found.R_EU).norm()};
  };
  const Off whole = off(0.1), half = off(0.05);
  if (!row.order) return {kInfinity, 1.0};
  const auto fell = [](double a, double b) { return std::log2(a / b); };
  looks.near(beyond(*row.order, fell(whole.place, half.place)), 0.0, 0.35);
  looks.near(beyond(row.make.velocity_order, fell(whole.speed, half.speed)), 0.0, 0.35);
  looks.near(beyond(row.make.attitude_order, fell(whole.turn, half.turn)), 0.0, 0.35);
  return looks.figure();
}

/// What a row leaves out is what its effect says of the step, to second order of the turns, w_e dt beside |dtheta|; the
/// Earth's turn left out leaves a body in axes that stand still.
StressFigure left_out() {
  Looks looks;
  const RandomStream draws(8, "stress.integrators");
  int told = 0;
  for (const StrapdownRow& row : strapdown_models()) {
    if (row.make.effects == nullptr) {
      looks.right(stress::not_refused([&] { make_strapdown(row.name)->leave_out({.earth_rate = true}); }) == 0);
      continue;
    }
    for (const StrapdownEffect& effect : row.make.effects()) {
      ++told;
      const bool coning = std::string(effect.name) == kConing;
      for (std::uint64_t k = 0; k < 20; ++k) {
        const double dt = draws.uniform(0.004, 0.02, 0, k), dt_before = draws.uniform(0.004, 0.02, 1, k);
        NavState start;
        start.R_EU = so3_exp(draws.normal3(k, 2)), start.v_EU_E = 20.0 * draws.normal3(k, 3);
        start.p_EU_E = ecef_from_geodetic({0.7, 0.2, 100.0});
        const Increments before{
            .dt_s = dt_before, .dtheta_U = 0.01 * draws.normal3(k, 4), .dv_U = 0.1 * draws.normal3(k, 5)},
            in{.dt_s = dt, .dtheta_U = 0.01 * draws.normal3(k, 6), .dv_U = 0.1 * draws.normal3(k, 7)};
        const auto with = make_strapdown(row.name), without = make_strapdown(row.name);
        without->leave_out({.coning = coning, .earth_rate = !coning});
        NavState scratch = start, a = start, b = start;
        with->advance(scratch, before), without->advance(scratch = start, before);
        with->advance(a, in), without->advance(b, in);
        const StepMove move = effect.of_step({.dt_s = dt,
                                              .dt_before_s = dt_before,
                                              .dtheta_U = in.dtheta_U,
                                              .dv_U = in.dv_U,
                                              .dtheta_before_U = before.dtheta_U,
                                              .dv_before_U = before.dv_U,
                                              .R_EU = start.R_EU.toRotationMatrix(),
                                              .v_EU_E = start.v_EU_E});
        // Second order: the effect times the turn of the step, and an epsilon of attitude and of the Earth's radius.
        const double second = in.dtheta_U.norm() + before.dtheta_U.norm();
        looks.near((so3_log(b.R_EU.conjugate() * a.R_EU) - move.theta_U).norm(), 0.0,
                   2.0 * move.theta_U.norm() * second + 4.0 * kEpsilon);
        looks.near((a.v_EU_E - b.v_EU_E - move.v_E).norm(), 0.0,
                   2.0 * move.v_E.norm() * second + 64.0 * kEpsilon * 50.0);
        looks.near((a.p_EU_E - b.p_EU_E - move.p_E).norm(), 0.0, move.p_E.norm() * second + 2.0 * kEpsilon * 6.4e6);
        looks.right(a.t == b.t);
        if (coning)
          looks.near(effect.of_step({.dt_s = dt, .dtheta_U = in.dtheta_U, .dv_U = in.dv_U}).theta_U.norm(), 0.0,
                     1e-300);
      }
      const ImuNoise noise{.gyro = {.white_per_sqrt_hz = 3e-5}, .accel = {}};
      const Need need = strapdown_need(effect, 0.02, 500.0, noise);
      looks.near(need.bound / ((0.02 + 1e-9) / 500.0 * 3600.0 * 180.0 / kPi), 1.0, 1e-12);
      looks.right(need.effect == effect.name && need.verdict == Verdict::kNotNeeded && need.bound_unit == "deg/h");
      char noise_text[40];
      std::snprintf(noise_text, sizeof noise_text, "noise by %.2g", 3e-5 / std::sqrt(500.0) * 3600.0 * 180.0 / kPi);
      looks.right(need.reason.find(noise_text) != std::string::npos);
      const StrapdownOmissions out = strapdown_omissions_of({need});
      looks.right(out.coning == coning && out.earth_rate == !coning && out.any());
      Need needed = need;
      needed.verdict = Verdict::kNeeded;
      looks.right(!strapdown_omissions_of({needed}).any());
    }
    if (std::string(row.name) != "two_sample")
      looks.right(stress::not_refused([&] { make_strapdown(row.name)->leave_out({.coning = true}); }) == 0);
  }
  looks.right(told == 5);
  return looks.figure();
}

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

std::vector<StressCase> integrator_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "one step of each integrator",
           "a term of the increments before with another factor, a series cut off",
           "closed forms where rates are constant; else errors that fall by the formula's own order, to 0.3",
           "of the bound"});
  rows.add("integrators/orders_of_a_step", orders_of_a_step).add("integrators/constant_steps", constant_steps);
  rows.of({StressGroup::kStiff, "a path by each integrator",
           "gravity, Coriolis or place to a lower order than the table says",
           "errors at the end of a tight eight fall by the table's orders, to 0.35", "of the bound"});
  for (const StrapdownRow& row : strapdown_models())
    rows.add(std::string("integrators/path_by_") + row.name, [&row] { return order_on_a_path(row); });
  rows.of({StressGroup::kStiff, "what an integrator leaves out", "an effect of the other sign, or of half the step",
           "what the effect says of the step, to second order", "of the bound"});
  rows.add("integrators/left_out", left_out);
  rows.of({StressGroup::kData, "a log from within a sample, with gaps, beside a reference",
           "a share of the wrong part, a mean that counts the start, axes of another place",
           "by hand; stamps of a nanosecond, and a vertical that turns by 1e-5", "of the bound"});
  rows.add("integrators/shares_of_a_log", shares_of_a_log).add("integrators/compared_with_a_reference", compared);
  rows.of({StressGroup::kLong, "the parts of what rounding may grow to",
           "a part of another power of the step, or half of it", "each by its documented law, step by step",
           "of the bound"});
  rows.add("integrators/rounding_by_parts", rounding);
  return rows.take();
}

}  // namespace canyon::fusion
