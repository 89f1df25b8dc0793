// What a vehicle says of its own motion: speeds of wheels, axles that do not slip, stands.
#include <cmath>
#include <optional>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/stress/measurement_models/seen_state.h"
#include "canyon/fusion/stress/measurement_models/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// Speeds of a wheel, sample by sample: their mean over the interval, as far as that has come; slip and ticks in its
/// noise, and the wheel's own scale where that is estimated.
StressFigure wheel_speeds() {
  Looks looks;
  for (const bool usual : {true, false}) {
    SeenState seen({"wheel_scale"}, usual ? ""
                                          : "odometer_wheel_m = [0.5, -0.4, 0.1]\nodometer_interval_s = "
                                            "0.5\nodometer_tick_m = 0.1\nodometer_slip_percent = 2");
    const Vector3d wheel = usual ? Vector3d(0.0, 0.8, 0.0) : Vector3d(0.5, -0.4, 0.1);
    const double tick = usual ? 0.02 : 0.1, slip = usual ? 0.003 : 0.02;
    const int count = usual ? 4 : 10;  // of 50 ms
    seen.lever_U = Vector3d(0.2, 0.1, 0.9), seen.w = Vector3d(0.02, -0.05, 0.3);
    seen.set("wheel_scale", Eigen::VectorXd::Constant(1, 0.04));
    const auto model = seen.model("odometer");
    const double true_m_s = 8.0 + seen.w.cross(wheel - seen.lever_U).x();
    const NavState& nav = seen.state.nav;
    const Vector3d v = nav.R_EU.conjugate() * nav.v_EU_E, earth = nav.R_EU.conjugate() * earth_rate_E();
    const double a =
        (seen.f + nav.R_EU.conjugate() * gravity_E(nav.p_EU_E) - 2.0 * earth.cross(v) - seen.w.cross(v)).x();
    const auto round = [&](int begun) {
      double sum = 0.0;
      for (int k = begun; k < count; ++k) {
        const double speed = 7.0 + 0.3 * k;
        sum += speed / count;
        const auto m =
            model->received(seen.view(), OdometerSample{.t = kThen, .dt_s = 0.05, .ticks = 1, .speed_m_s = speed}, 0);
        looks.right(m.has_value() == (k == count - 1));
        if (!m) continue;
        looks.near(m->residual[0], sum - 1.04 * (true_m_s - 0.5 * 0.05 * count * a), 1e-12);
        looks.close(m->R(0, 0), tick * tick / (6.0 * std::pow(0.05 * count, 2)) + std::pow(slip * sum, 2), 32.0);
        looks.near(m->H(0, seen.state.offset("wheel_scale")), true_m_s - 0.5 * 0.05 * count * a, 1e-12);
        looks.right(m->dimension() == 1 && m->about == ErrorIndex::kVelocity);
      }
    };
    round(0), round(0);
    // Half counted, and begun anew.
    model->received(seen.view(), OdometerSample{.t = kThen, .dt_s = 0.05, .ticks = 1, .speed_m_s = 100.0}, 0);
    model->start();
    round(0);
  }
  return looks.figure();
}

/// A vehicle's own constraint: as often as its rate says, whatever the samples, of the axle's speed sideways and up,
/// with a tyre's slip in the sideways noise.
StressFigure axle() {
  Looks looks;
  for (const bool usual : {true, false}) {
    SeenState seen(
        {}, usual ? "" : "non_holonomic_rate_hz = 4\nnon_holonomic_sigma_m_s = 0.3\nnon_holonomic_sideslip = 0.5");
    const double rate = usual ? 10.0 : 4.0, sigma = usual ? 0.1 : 0.3, slip = usual ? 0.02 : 0.5;
    seen.lever_U = Vector3d(0.3, 0.4, 0.5), seen.w = Vector3d(0.1, -0.2, 0.5);
    seen.state.nav.v_EU_E = seen.state.nav.R_EU * Vector3d(8.0, 0.4, -0.3);
    for (const double dt : {0.01, 0.005, 0.07}) {
      const auto model = seen.model("non_holonomic");
      int made = 0;
      for (int k = 1; k <= 400; ++k) {
        const auto m =
            model->stepped(seen.view(), {.dt_s = dt, .dtheta_U = Vector3d::Zero(), .dv_U = Vector3d::Zero()});
        made += m.has_value() ? 1 : 0;
        looks.right(made == static_cast<int>(std::floor(k * dt * rate + 1e-6)));
        if (!m) continue;
        const Vector3d v = Vector3d(8.0, 0.4, -0.3) + seen.w.cross(-seen.lever_U);
        looks.near((m->residual + v.tail<2>()).norm(), 0.0, 1e-13);
        looks.close(m->R(0, 0), sigma * sigma + std::pow(slip * 0.5 * v.x(), 2), 32.0),
            looks.close(m->R(1, 1), sigma * sigma, 8.0);
        looks.right(m->R(0, 1) == 0.0 && m->R(1, 0) == 0.0 && m->about == ErrorIndex::kVelocity);
      }
    }
  }
  return looks.figure();
}

/// Windows in which a vehicle stood: forces that scatter up to the limit beside twice the unit's own noise, mean rates
/// up to theirs beside three times it, an estimate that is slow; and none beyond any of these, whatever has gone
/// before; as noise what is stated.
StressFigure standing() {
  Looks looks;
  for (const bool usual : {true, false})
    for (const bool noisy : {false, true}) {
      SeenState seen({}, usual ? ""
                               : "standstill_window_s = 0.25\nstandstill_force_m_s2 = 0.2\nstandstill_rate_deg_s = "
                                 "2\nstandstill_speed_m_s = "
                                 "3\nstandstill_sigma_m_s = 0.1");
      const double window = usual ? 0.5 : 0.25, force = usual ? 0.05 : 0.2, rate = (usual ? 0.5 : 2.0) * kPi / 180.0,
                   speed = usual ? 0.5 : 3.0, sigma = usual ? 0.02 : 0.1, dt = 0.0125;
      if (noisy) seen.noise.accel.white_per_sqrt_hz = 0.01, seen.noise.gyro.white_per_sqrt_hz = 0.004;
      const double per_s = 1.0 / dt, most_force = std::sqrt(force * force + (noisy ? 4.0 * 1e-4 * per_s : 0.0)),
                   most_rate = std::sqrt(rate * rate + (noisy ? 9.0 * 1.6e-5 / window : 0.0));
      const int count = static_cast<int>(std::lround(window / dt));
      const auto model = seen.model("standstill");
      const auto goes_on = [&](double scatter, const Vector3d& turn, double moves) {
        seen.state.nav.v_EU_E = seen.state.nav.R_EU * Vector3d(0.0, 0.6 * moves, 0.8 * moves);
        std::optional<Measurement> made;
        for (int k = 0; k < count; ++k) {
          // Half of the samples either side, on one axis: that is the standard deviation.
          Vector3d push(0.3, -0.2, 9.7);
          push.y() += k % 2 == 0 ? scatter : -scatter;
          seen.w = turn;
          const auto m = model->stepped(seen.view(), {.dt_s = dt, .dtheta_U = Vector3d::Zero(), .dv_U = dt * push});
          looks.right(k == count - 1 || !m);
          if (m) made = m;
        }
        return made;
      };
      const Vector3d axis(0.48, -0.6, 0.64);
      for (int round = 0; round < 2; ++round)
        for (const double part : {0.98, 1.02}) {
          const bool stands = part < 1.0;
          const auto scattered = goes_on(part * most_force, 0.1 * rate * axis, 0.1 * speed),
                     turned = goes_on(0.1 * force, part * most_rate * axis, 0.1 * speed),
                     moved = goes_on(0.1 * force, 0.1 * rate * axis, part * speed);
          for (const auto* m : {&scattered, &turned, &moved}) looks.right(m->has_value() == stands);
          if (!moved) continue;
          looks.near((moved->residual + Vector3d(0.0, 0.6, 0.8) * part * speed).norm(), 0.0, 1e-13);
          looks.near((moved->R - sigma * sigma * Measurement::Square::Identity(3, 3)).norm(), 0.0,
                     8.0 * kEpsilon * sigma * sigma);
        }
    }
  // Fewer than four samples tell nothing.
  SeenState seen({});
  seen.state.nav.v_EU_E.setZero();
  const auto model = seen.model("standstill");
  for (int k = 0; k < 12; ++k)
    looks.right(
        !model->stepped(seen.view(), {.dt_s = 0.2, .dtheta_U = Vector3d::Zero(), .dv_U = Vector3d(0.0, 0.0, 2.0)}));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> vehicle_motion_cases() {
  StressRows rows = measured_rows();
  rows.add("measurement_models/wheel_speeds", wheel_speeds)
      .add("measurement_models/axle", axle)
      .add("measurement_models/standing", standing);
  return rows.take();
}

}  // namespace canyon::fusion
