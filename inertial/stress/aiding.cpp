#include <array>
#include <vector>

#include <Eigen/QR>

#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/inertial/aiding/barometer.h"
#include "canyon/inertial/aiding/magnetometer.h"
#include "canyon/inertial/aiding/odometer.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using stress::kEpsilon;

/// The pressure goes evenly from one height to another within a sample and stays: behind by lag / dt (1 - e^(-dt /
/// lag)) of the change after it, then e^(-dt / lag) of that a sample. Terms are as large as lag / dt of the change.
StressFigure lagging(double lag_s, double rate_hz) {
  BarometerConfig config;
  config.rate_hz = rate_hz;
  config.turn_on_bias_pa = config.drift_pa = config.noise_pa_per_sqrt_hz = 0.0;
  config.lag_s = lag_s;
  Barometer barometer(config, 1);
  const double low_pa = standard_pressure_pa(0.0), high_pa = standard_pressure_pa(100.0), change = high_pa - low_pa;
  const double x = 1.0 / (rate_hz * lag_s);
  double behind = change * -std::expm1(-x) / x;
  stress::Worst worst;
  const double bound_pa = 8.0 * kEpsilon * (low_pa + std::abs(change) / x);
  for (std::int64_t k = 0; k < 200; ++k) {
    const double found_pa = barometer.sample(k, {k}, k == 0 ? 0.0 : 100.0).message.pressure_pa;
    if (k > 1) behind *= std::exp(-x);
    // Each sample's rounding is kept as long as the lag remembers.
    worst.look(found_pa - (k == 0 ? low_pa : high_pa - behind),
               bound_pa * std::min(1.0 + static_cast<double>(k), 1.0 + 1.0 / x));
  }
  return worst.figure();
}

/// Ticks of 20 000 samples at constant speed: the distance over the length of a tick, and never a tick more or less
/// than the part of one that has not been counted yet; roundings of the sum are 1e-9 of a tick.
StressFigure ticks(double speed_m_s, double metres_per_tick) {
  OdometerConfig config;
  config.metres_per_tick = metres_per_tick;
  config.scale_percent = config.slip_percent = config.slip_percent_per_m_s2 = 0.0;
  Odometer odometer(config, 1);
  std::array<KinematicState, 3> nodes;
  for (KinematicState& node : nodes) node.v_WB_W = {speed_m_s, 0.0, 0.0};
  std::int64_t counted = 0;
  constexpr std::int64_t kCount = 20'000;
  for (std::int64_t k = 0; k < kCount; ++k) {
    for (std::size_t i = 0; i < 3; ++i) nodes[i].t.ns = k * 20'000'000 + static_cast<std::int64_t>(i) * 10'000'000;
    counted += odometer.sample(k, nodes).message.ticks;
  }
  const double exact = speed_m_s * 0.02 * kCount / metres_per_tick;
  return {std::abs(static_cast<double>(counted) - exact), 1.0 + 1e-9 + kEpsilon * kCount * std::abs(exact)};
}

/// A barometer without errors above and below the geoid: the pressure of the standard atmosphere at the height above
/// it, to the bit, in whole steps of the output where it has such; and never below none.
StressFigure heights(double undulation_m, double resolution_pa) {
  BarometerConfig config;
  config.turn_on_bias_pa = config.drift_pa = config.noise_pa_per_sqrt_hz = config.lag_s = 0.0;
  config.undulation_m = undulation_m;
  config.resolution_pa = resolution_pa;
  Barometer barometer(config, 1);
  stress::Worst worst;
  for (std::int64_t k = 0; k < 30; ++k) {  // below 11 km, to which the formula for heights holds
    const double h_m = -400.0 + 350.0 * static_cast<double>(k);
    const auto [message, truth] = barometer.sample(k, {k}, h_m);
    const double pressure_pa = standard_pressure_pa(h_m - undulation_m);
    worst.look(truth.pressure_pa - pressure_pa, 1e-300);
    worst.look(message.pressure_pa - pressure_pa, 0.5 * resolution_pa + 4.0 * kEpsilon * pressure_pa);
    if (resolution_pa > 0.0)
      worst.look(std::remainder(message.pressure_pa, resolution_pa), 4.0 * kEpsilon * pressure_pa);
    worst.look(standard_height_m(truth.pressure_pa) - (h_m - undulation_m), 32.0 * kEpsilon * 44330.0);
  }
  return worst.figure();
}

/// Errors of 40 barometers over 200 samples 1000 times as long apart as their drift lasts: of turn-on bias and drift
/// the stated variances between units and within them, of white noise the density times half the sample rate's width; 5
/// sigma of a variance, sqrt(2 / n).
StressFigure pressure_noise() {
  BarometerConfig config;
  config.rate_hz = 2.0;
  config.undulation_m = 0.0;
  config.turn_on_bias_pa = 40.0, config.drift_pa = 15.0, config.drift_tau_s = 5e-4, config.noise_pa_per_sqrt_hz = 7.0;
  config.lag_s = config.resolution_pa = 0.0;
  constexpr int kUnits = 200, kSamples = 100;
  double between = 0.0, within = 0.0, white = 0.0;
  for (int unit = 0; unit < kUnits; ++unit) {
    Barometer barometer(config, static_cast<std::uint64_t>(unit) + 1);
    double mean = 0.0, square = 0.0;
    for (std::int64_t k = 0; k < kSamples; ++k) {
      const auto [message, truth] = barometer.sample(k, {k}, 100.0);
      const double noise = message.pressure_pa - truth.pressure_pa - truth.drift_pa;
      white += noise * noise / (kUnits * kSamples);
      mean += truth.drift_pa / kSamples;
      square += truth.drift_pa * truth.drift_pa / kSamples;
    }
    between += mean * mean / kUnits;
    within += (square - mean * mean) / kUnits;
  }
  stress::Worst worst;
  worst.look(white / (7.0 * 7.0 * 2.0) - 1.0, 5.0 * std::sqrt(2.0 / (kUnits * kSamples)));
  worst.look(within / (15.0 * 15.0 * (1.0 - 1.0 / kSamples)) - 1.0, 5.0 * std::sqrt(2.0 / (kUnits * (kSamples - 1.0))));
  worst.look(between / (40.0 * 40.0 + 15.0 * 15.0 / kSamples) - 1.0, 5.0 * std::sqrt(2.0 / kUnits));
  return worst.figure();
}

/// A magnetometer that turns through 24 attitudes: the Earth's field in its axes to roundings; a vehicle's own field
/// and iron in one unit are what a fit of twelve numbers finds, the same at each attitude, symmetric, and of the stated
/// size over 100 units: 5 sigma.
StressFigure field() {
  MagnetometerConfig config;
  config.declination_deg = 20.0, config.inclination_deg = -50.0, config.strength_ut = 40.0;
  config.noise_ut_per_sqrt_hz = config.hard_iron_ut = config.soft_iron_percent = 0.0;
  const Magnetometer ideal(config, 1);
  const double down = -50.0 * kDegree, east = 20.0 * kDegree;
  const Eigen::Vector3d field_W =
      40e-6 * Eigen::Vector3d(std::cos(down) * std::sin(east), std::cos(down) * std::cos(east), -std::sin(down));
  config.hard_iron_ut = 5.0, config.soft_iron_percent = 10.0;
  constexpr int kUnits = 100, kTurns = 24;
  stress::Worst worst;
  double hard = 0.0, soft = 0.0;
  for (int unit = 0; unit < kUnits; ++unit) {
    const Magnetometer disturbed(config, static_cast<std::uint64_t>(unit) + 1);
    Eigen::Matrix<double, kTurns, 4> seen;
    Eigen::Matrix<double, kTurns, 3> said;
    for (int k = 0; k < kTurns; ++k) {
      const Eigen::Quaterniond R = rotation_from({.yaw_rad = 1.1 * k, .pitch_rad = std::sin(k), .roll_rad = 2.3 * k});
      const auto [message, truth] = ideal.sample(k, {k}, R);
      worst.look((R * truth.field_U_t - field_W).norm() / 40e-6, 32.0 * kEpsilon);
      worst.look((message.field_U_t - truth.field_U_t).norm() / 40e-6, 8.0 * kEpsilon);
      seen.row(k) << truth.field_U_t.transpose(), 40e-6;
      said.row(k) = disturbed.sample(k, {k}, R).message.field_U_t.transpose();
    }
    const Eigen::Matrix<double, 4, 3> fit = seen.colPivHouseholderQr().solve(said);
    worst.look((seen * fit - said).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / 40e-6, 64.0 * kEpsilon);
    const Eigen::Matrix3d iron = fit.topRows<3>() - Eigen::Matrix3d::Identity();
    worst.look((iron - iron.transpose()).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 256.0 * kEpsilon);
    hard += (40.0 * fit.row(3)).squaredNorm() / (3.0 * kUnits);
    soft +=
        (iron.diagonal().squaredNorm() + iron(0, 1) * iron(0, 1) + iron(0, 2) * iron(0, 2) + iron(1, 2) * iron(1, 2)) /
        (6.0 * kUnits);
  }
  worst.look(hard / 25.0 - 1.0, 5.0 * std::sqrt(2.0 / (3.0 * kUnits)));
  worst.look(soft / 0.01 - 1.0, 5.0 * std::sqrt(2.0 / (6.0 * kUnits)));
  return worst.figure();
}

/// The contact point of a wheel of a body that turns on the spot and drives at the same time: v - w y of it over each
/// interval, with the radius's error; the slip is what the acceleration needs, per cent per m/s^2 of it. To the bit of
/// the tick that is not counted yet, over all.
StressFigure wheel(double turn_rad_s, double acceleration_m_s2) {
  OdometerConfig config;
  config.wheel_m = {0.3, 0.8, -0.2};
  config.metres_per_tick = 1e-4;
  config.scale_percent = config.slip_percent = 0.0;
  config.slip_percent_per_m_s2 = 2.0;
  Odometer odometer(config, 1);
  stress::Worst worst;
  double counted_m = 0.0, way_m = 0.0;
  for (std::int64_t k = 0; k < 500; ++k) {
    std::array<KinematicState, 3> nodes;
    double middle_m_s = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double t = 0.02 * static_cast<double>(k) + 0.01 * static_cast<double>(i);
      nodes[i].t.ns = k * 20'000'000 + static_cast<std::int64_t>(i) * 10'000'000;
      nodes[i].X_WB.R = rotation_from({.yaw_rad = 0.4, .pitch_rad = 0.0, .roll_rad = 0.0});
      nodes[i].v_WB_W = nodes[i].X_WB.R * Eigen::Vector3d(3.0 + acceleration_m_s2 * t, 0.0, 0.0);
      nodes[i].a_WB_W = nodes[i].X_WB.R * Eigen::Vector3d(acceleration_m_s2, 0.0, 0.0);
      nodes[i].w_WB_B = {0.0, 0.0, turn_rad_s};
      if (i == 1) middle_m_s = 3.0 + acceleration_m_s2 * t - turn_rad_s * 0.8;
    }
    const auto [message, truth] = odometer.sample(k, nodes);
    worst.look(truth.distance_m - 0.02 * middle_m_s, 64.0 * kEpsilon * 20.0);
    worst.look(message.speed_m_s - static_cast<double>(message.ticks) * 1e-4 / 0.02, 64.0 * kEpsilon * 20.0);
    counted_m += 1e-4 * static_cast<double>(message.ticks);
    way_m += 0.02 * middle_m_s;
    worst.look(truth.scale_error, 1e-300);
  }
  // A wheel that pushes turns further than it moves: what moves is its turning less the slip.
  const double slip = 0.02 * acceleration_m_s2;
  worst.look(counted_m * (1.0 - slip) / way_m - 1.0, (1e-4 + 500.0 * 64.0 * kEpsilon) / std::abs(way_m));
  return worst.figure();
}

}  // namespace

std::vector<StressCase> aiding_cases() {
  const StressMechanism lag{
      StressGroup::kStiff, "a lag far shorter or longer than the samples",
      "an explicit step overshoots where dt > lag; where dt << lag the difference of two large terms has no digits",
      "the closed form of a first-order lag behind a ramp and a rest, to eight roundings of its terms", "of the bound"};
  const StressMechanism count{
      StressGroup::kLong, "fractions that a count leaves over", "each sample rounds its own ticks, and the sum drifts",
      "the distance over a tick's length, less than one tick off after 20 000 samples", "ticks"};
  StressRows rows;
  for (const auto& [lag_s, rate_hz] : {std::pair{1e-6, 0.1}, {1e-3, 10.0}, {1e3, 1000.0}})
    rows.of(lag).add("aiding/barometer_lag_" + stress::text(lag_s) + "_s_at_" + stress::text(rate_hz) + "_hz",
                     [lag_s = lag_s, rate_hz = rate_hz] { return lagging(lag_s, rate_hz); });
  const StressMechanism closed{StressGroup::kGeometry, "aiding sensors without errors, and of stated ones",
                               "a height above the wrong surface, a field of the other hand, a variance per sample",
                               "closed forms to roundings, and variances over units: 5 sigma", "of the bound"};
  for (const auto& [undulation_m, step_pa] : {std::pair{0.0, 0.0}, {48.5, 0.0}, {-100.0, 12.0}})
    rows.of(closed).add("aiding/barometer_over_a_geoid_of_" + stress::text(undulation_m) + "_m",
                        [u = undulation_m, r = step_pa] { return heights(u, r); });
  rows.add("aiding/barometer_noise", pressure_noise).add("aiding/magnetometer_that_turns", field);
  for (const auto& [turn, push] : {std::pair{0.0, 0.0}, {0.5, 0.0}, {-2.0, 1.5}})
    rows.add("aiding/wheel_at_" + stress::text(turn) + "_rad_s", [t = turn, a = push] { return wheel(t, a); });
  rows.of(count).add("aiding/odometer_slower_than_a_tick", [] { return ticks(0.0123, 100.0); });
  rows.of(count).add("aiding/odometer_1e7_ticks_a_sample", [] { return ticks(-1000.0 / 3.0, 1e-6); });
  return rows.take();
}

}  // namespace canyon::inertial
