// Figures that stand where nobody gives any: each as its documentation and the sheets behind it have it; and the
// further errors of aiding sensors by their size and time.
#include <array>
#include <cmath>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/aiding/barometer.h"
#include "canyon/inertial/aiding/magnetometer.h"
#include "canyon/inertial/aiding/odometer.h"
#include "canyon/inertial/catalogue.h"
#include "canyon/inertial/imu_config.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// Number by number; the figure counts those that differ.
class Given {
 public:
  Given& is(double found, double expected) {
    wrong_ += found == expected ? 0 : 1;
    return *this;
  }
  StressFigure figure() const { return {1.0 * wrong_, 0.0}; }

 private:
  int wrong_ = 0;
};

/// A rover's barometer, magnetometer and encoder.
StressFigure of_aiding() {
  const BarometerConfig b;
  const MagnetometerConfig m;
  const OdometerConfig o;
  return Given()
      .is(b.rate_hz, 10.0)
      .is(b.turn_on_bias_pa, 50.0)
      .is(b.drift_pa, 100.0)
      .is(b.drift_tau_s, 2.0 * 3600.0)
      .is(b.noise_pa_per_sqrt_hz, 0.4)
      .is(b.lag_s, 0.1)
      .is(b.resolution_pa, 0.0)
      .is(b.undulation_m.has_value() ? 1.0 : 0.0, 0.0)
      .is(m.rate_hz, 20.0)
      .is(m.declination_deg, 0.0)
      .is(m.inclination_deg, 60.0)
      .is(m.strength_ut, 50.0)
      .is(m.hard_iron_ut, 3.0)
      .is(m.soft_iron_percent, 2.0)
      .is(m.noise_ut_per_sqrt_hz, 0.05)
      .is(m.resolution_ut, 0.0)
      .is(o.rate_hz, 50.0)
      .is(o.wheel_m.x(), 0.0)
      .is(o.wheel_m.y(), 0.8)
      .is(o.wheel_m.z(), 0.0)
      .is(o.metres_per_tick, 0.02)
      .is(o.scale_percent, 0.5)
      .is(o.slip_percent, 0.2)
      .is(o.slip_tau_s, 5.0)
      .is(o.slip_percent_per_m_s2, 0.5)
      .figure();
}

/// Units of which a sheet says nothing: an hour's correlation, flicker from 1e-5 to 0.1 Hz, room temperature; masses of
/// the usual size; and the IMU of a mission that names none.
StressFigure of_units() {
  const CatalogueEntry e;
  const UnitFigures si = e.figures(), bare;
  const ImuConfig c;
  Given given;
  given.is(c.rate_hz, 100.0)
      .is(c.lever_arm_m.x(), 0.0)
      .is(c.lever_arm_m.y(), 0.0)
      .is(c.lever_arm_m.z(), 0.4)
      .is(c.mounting_error_deg, 0.0);
  given.is(c.vibration_m_s2.norm(), 0.0);
  for (const UnitFigures* u : {&si, &bare}) {
    for (const TriadFigures* f : {&u->gyro, &u->accel}) {
      given.is(f->in_run_bias_tau_s, 3600.0).is(f->flicker_low_hz, 1e-5).is(f->flicker_high_hz, 0.1);
      for (const double TriadFigures::*none : {&TriadFigures::white_per_sqrt_hz,
                                               &TriadFigures::neighbour_correlation,
                                               &TriadFigures::turn_on_bias,
                                               &TriadFigures::in_run_bias,
                                               &TriadFigures::bias_instability,
                                               &TriadFigures::rate_random_walk,
                                               &TriadFigures::ramp,
                                               &TriadFigures::quantization_noise,
                                               &TriadFigures::scale,
                                               &TriadFigures::scale_asymmetry,
                                               &TriadFigures::nonlinearity,
                                               &TriadFigures::misalignment_rad,
                                               &TriadFigures::package_rad,
                                               &TriadFigures::cross_talk,
                                               &TriadFigures::g_sensitivity,
                                               &TriadFigures::bias_temperature,
                                               &TriadFigures::scale_temperature,
                                               &TriadFigures::vibration_rectification,
                                               &TriadFigures::dead_band,
                                               &TriadFigures::range,
                                               &TriadFigures::resolution})
        given.is(f->*none, 0.0);
    }
    given.is(u->reference_temperature_c, 25.0).is(u->latency_s, 0.0).is(u->clock_skew, 0.0).is(u->clock_jitter_s, 0.0);
    given.is(u->loss_share, 0.0).is(u->loss_length, 1.0);
  }
  const PaperParameters& p = e.paper;
  given.is(p.temperature_k, 285.0).is(p.correlation_time_s, 10.0).is(p.run_time_hr, 0.5);
  for (const PaperTriad* t : {&p.gyro, &p.accel})
    given.is(t->quality_factor, 1.0)
        .is(t->mass_kg, 1e-8)
        .is(t->resonance_hz, 5000.0)
        .is(t->bandwidth_hz, 100.0)
        .is(t->drive_amplitude_m, 0.0);
  given.is(e.mems.temperature_k, 298.15);
  const ElementFigures &a = e.mems.accel, &g = e.mems.gyro;
  given.is(a.mass_kg, 1e-9)
      .is(a.resonance_hz, 5000.0)
      .is(a.quality_factor, 1.0)
      .is(g.mass_kg, 1e-8)
      .is(g.resonance_hz, 10000.0)
      .is(g.quality_factor, 1000.0);
  for (const ElementFigures* f : {&a, &g}) {
    given.is(f->travel_m, 1e-6)
        .is(f->drive_amplitude_m, 5e-6)
        .is(f->split_hz, 0.0)
        .is(f->range, 0.0)
        .is(f->bandwidth_hz, 0.0);
    given.is(static_cast<double>(f->filter_order), 2.0);
    const PickOffFigures& o = f->pick_off_figures;
    given.is(o.gap_m, 2e-6)
        .is(o.bias_v, 0.5)
        .is(o.capacitance_f, 1e-13)
        .is(o.parasitic_f, 2e-12)
        .is(o.amplifier_v_sqrt_hz, 5e-9);
    given.is(o.bridge_ohm, 5000.0).is(o.gauge_factor, 100.0).is(o.strain_per_m, 100.0).is(o.strain_cubic, 0.01);
    given.is(o.charge_c_per_m, 1e-6).is(o.leak_hz, 0.1).is(o.loss_tangent, 0.002);
  }
  return given.figure();
}

/// Paths that are named and not told anything else: at Vicksburg, as its documentation says.
StressFigure of_paths() {
  const MotionConfig c;
  const Sinusoid s;
  return Given()
      .is(c.lat_deg, 32.35)
      .is(c.lon_deg, -90.88)
      .is(c.height_m, 60.0)
      .is(c.heading_deg, 0.0)
      .is(c.pitch_deg, 0.0)
      .is(c.roll_deg, 0.0)
      .is(c.speed_m_s, 10.0)
      .is(c.radius_m, 50.0)
      .is(c.length_m, 100.0)
      .is(c.width_m, 60.0)
      .is(c.period_s, 60.0)
      .is(c.climb_m, 0.0)
      .is(c.sway_deg, 0.0)
      .is(c.cone_deg, 1.0)
      .is(c.cone_hz, 10.0)
      .is(c.smoothing_s, 0.0)
      .is(c.file_rate_hz, 10.0)
      .is(static_cast<double>(c.vibration.psd_lines), 50.0)
      .is(s.frequency_hz, 50.0)
      .is(s.phase_deg, 0.0)
      .is(s.acceleration_m_s2.norm() + s.angle_deg.norm(), 0.0)
      .figure();
}

KinematicState rolling(std::int64_t ns, double speed_m_s) {
  KinematicState s;
  s.t.ns = ns;
  s.v_WB_W = Vector3d(speed_m_s, 0.0, 0.0);
  return s;
}

/// Wheels of 200 units: their radius errs by the stated part, drawn once; slip is a Gauss-Markov process of stated size
/// and time; the first edge lies anywhere in a tick. Mean squares over units: five standard deviations. Slip beyond
/// what rolls is held, whichever way the vehicle goes, and what is pushed slips the way it is pushed.
StressFigure wheels() {
  Looks looks;
  OdometerConfig config;
  config.rate_hz = 10.0, config.scale_percent = 2.0, config.slip_percent = 1.5, config.slip_tau_s = 0.3;
  config.slip_percent_per_m_s2 = 0.0, config.metres_per_tick = 1.0, config.wheel_m = Vector3d::Zero();
  constexpr int kUnits = 200;
  double scale = 0.0, slip = 0.0, lag = 0.0, early = 0.0;
  for (std::uint64_t seed = 1; seed <= kUnits; ++seed) {
    Odometer odometer(config, seed);
    std::array<double, 40> slips{};
    for (std::int64_t k = 0; k < 40; ++k) {
      const std::array<KinematicState, 3> nodes = {rolling(k * 100'000'000, 5.0),
                                                   rolling(k * 100'000'000 + 50'000'000, 5.0),
                                                   rolling((k + 1) * 100'000'000, 5.0)};
      const auto [message, truth] = odometer.sample(k, nodes);
      slips[static_cast<std::size_t>(k)] = truth.slip;
      looks.near(truth.distance_m, 0.5, 16.0 * kEpsilon);
      // Half a tick on: of the first edges half come by then.
      if (k == 0)
        scale += std::pow(truth.scale_error / 0.02, 2) / kUnits, early += static_cast<double>(message.ticks) / kUnits;
    }
    for (std::size_t k = 0; k < 40; k += 13) slip += std::pow(slips[k] / 0.015, 2) / (4.0 * kUnits);
    for (std::size_t k = 0; k + 3 < 40; k += 12) lag += slips[k] * slips[k + 3] / std::pow(0.015, 2) / (4.0 * kUnits);
  }
  looks.near(scale, 1.0, 5.0 * std::sqrt(2.0 / kUnits)), looks.near(slip, 1.0, 5.0 * std::sqrt(2.0 / (4.0 * kUnits)));
  looks.near(lag, std::exp(-1.0), 5.0 * std::sqrt(1.2 / (4.0 * kUnits)));
  looks.near(early, 0.5, 5.0 * 0.5 / std::sqrt(1.0 * kUnits) + 0.02);  // and of the radius a hundredth
  config.scale_percent = config.slip_percent = 0.0, config.slip_percent_per_m_s2 = 20.0, config.metres_per_tick = 1e-5;
  for (const double speed : {4.0, -4.0})
    for (const double push : {0.5, -0.5, 30.0, -30.0}) {
      Odometer odometer(config, 1);
      std::array<KinematicState, 5> nodes;
      for (std::size_t i = 0; i < 5; ++i) {
        nodes[i] = rolling(static_cast<std::int64_t>(i) * 25'000'000, speed);
        nodes[i].a_WB_W = Vector3d(push, 0.0, 0.0);
      }
      const auto [message, truth] = odometer.sample(0, nodes);
      const double expected = 0.2 * push * (speed > 0.0 ? 1.0 : -1.0);
      looks.near(truth.slip, expected > 0.9 ? 0.9 : expected < -0.9 ? -0.9 : expected, 16.0 * kEpsilon);
      looks.near(static_cast<double>(message.ticks) * 1e-5, speed * 0.1 / (1.0 - truth.slip), 1e-5 + 1e-9);
      looks.right(stress::not_refused([&] { odometer.sample(0, nodes); }) == 0);
      looks.right(stress::not_refused([&] { odometer.sample(1, std::span(nodes).first(4)); }) == 0);
      looks.right(stress::not_refused([&] { odometer.sample(1, std::span(nodes).first(1)); }) == 0);
    }
  // Simpson's rule over five nodes: speeds of the third degree exactly.
  config.slip_percent_per_m_s2 = 0.0;
  Odometer odometer(config, 1);
  std::array<KinematicState, 5> nodes;
  for (std::size_t i = 0; i < 5; ++i) {
    const double x = 0.25 * static_cast<double>(i);
    nodes[i] = rolling(static_cast<std::int64_t>(i) * 250'000'000, 1.0 - x + 2.0 * x * x + 4.0 * x * x * x);
  }
  looks.near(odometer.sample(0, nodes).truth.distance_m, 1.0 - 0.5 + 2.0 / 3.0 + 1.0, 32.0 * kEpsilon);
  return looks.figure();
}

/// Readings of a magnetometer's noise and steps, of a barometer after a pause and near no pressure: sizes to five
/// deviations, whole steps, and a lag that begins anew.
StressFigure readings() {
  Looks looks;
  MagnetometerConfig m;
  m.rate_hz = 25.0, m.noise_ut_per_sqrt_hz = 0.3, m.hard_iron_ut = m.soft_iron_percent = 0.0;
  const Magnetometer noisy(m, 3);
  double square[3] = {0.0, 0.0, 0.0}, lag = 0.0;
  Vector3d before = Vector3d::Zero();
  constexpr int kCount = 2000;
  for (std::int64_t k = 0; k < kCount; ++k) {
    const auto [message, truth] = noisy.sample(k, {k}, Eigen::Quaterniond::Identity());
    const Vector3d e = (message.field_U_t - truth.field_U_t) / (0.3e-6 * 5.0);
    for (int axis = 0; axis < 3; ++axis) square[axis] += e[axis] * e[axis] / kCount;
    lag += (e.dot(before) + e.x() * e.y()) / (4.0 * kCount);
    before = e;
    looks.right(message.t.ns == k && truth.t.ns == k);
  }
  for (const double s : square) looks.near(s, 1.0, 5.0 * std::sqrt(2.0 / kCount));
  looks.near(lag, 0.0, 5.0 / std::sqrt(4.0 * kCount));
  m.noise_ut_per_sqrt_hz = 0.0, m.resolution_ut = 0.7;
  const Magnetometer stepped(m, 3);
  for (std::int64_t k = 0; k < 50; ++k) {
    const auto [message, truth] = stepped.sample(
        k, {k}, Eigen::Quaterniond(Eigen::AngleAxisd(0.13 * static_cast<double>(k), Vector3d(0.6, 0.0, 0.8))));
    for (int axis = 0; axis < 3; ++axis) {
      looks.near(message.field_U_t[axis], truth.field_U_t[axis], 0.5 * 0.7e-6 * (1.0 + 1e-12));
      looks.near(std::remainder(message.field_U_t[axis], 0.7e-6), 0.0, 64.0 * kEpsilon * 5e-5);
    }
  }
  looks.right(stress::not_refused([&] { stepped.sample(-1, {0}, Eigen::Quaterniond::Identity()); }) == 0);
  BarometerConfig b;
  b.turn_on_bias_pa = b.drift_pa = b.noise_pa_per_sqrt_hz = 0.0, b.lag_s = 100.0;
  Barometer slow(b, 1);
  slow.sample(0, {0}, 0.0);
  const auto late = slow.sample(1, {1}, 500.0);
  looks.right(late.message.pressure_pa > late.truth.pressure_pa + 5000.0);  // five thousandths of the way only
  const auto after = slow.sample(7, {7}, 500.0);
  looks.close(after.message.pressure_pa, after.truth.pressure_pa, 4.0);
  b.lag_s = 0.0, b.turn_on_bias_pa = 1e5;
  double least = 1e9;
  for (std::uint64_t seed = 1; seed < 40; ++seed) {
    const double pa = Barometer(b, seed).sample(0, {0}, 10000.0).message.pressure_pa;
    looks.right(pa >= 0.0);
    least = pa < least ? pa : least;
  }
  looks.right(least == 0.0);
  looks.right(stress::not_refused([&] { slow.sample(-1, {0}, 0.0); }) == 0 &&
              stress::not_refused([&] { slow.sample(8, {0}, std::nan("")); }) == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> given_figure_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "figures where none are given", "a figure of another unit, or ten times itself",
           "as the documentation has them: exact", "figures"});
  rows.add("given_figures/aiding", of_aiding).add("given_figures/units", of_units).add("given_figures/paths", of_paths);
  rows.of({StressGroup::kData, "further errors of aiding sensors",
           "a variance of the other unit, a slip of the other way, a lag over a pause",
           "sizes and times to five deviations, steps and sums to roundings", "of the bound"});
  rows.add("aiding/wheels_of_many_units", wheels).add("aiding/readings", readings);
  return rows.take();
}

}  // namespace canyon::inertial
