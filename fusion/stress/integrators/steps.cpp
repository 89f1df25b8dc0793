// What each integrator makes of one step, to the order that its formula has.
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/fusion/stress/integrators/free_space.h"
#include "canyon/fusion/stress/integrators/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

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

}  // namespace

std::vector<StressCase> integrator_step_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "one step of each integrator",
           "a term of the increments before with another factor, a series cut off",
           "closed forms where rates are constant; else errors that fall by the formula's own order, to 0.3",
           "of the bound"});
  rows.add("integrators/orders_of_a_step", orders_of_a_step).add("integrators/constant_steps", constant_steps);
  return rows.take();
}

}  // namespace canyon::fusion
