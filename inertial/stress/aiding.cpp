#include <array>
#include <vector>

#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/core/stress_rows.h"
#include "canyon/inertial/aiding/barometer.h"
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
  rows.of(count).add("aiding/odometer_slower_than_a_tick", [] { return ticks(0.0123, 100.0); });
  rows.of(count).add("aiding/odometer_1e7_ticks_a_sample", [] { return ticks(-1000.0 / 3.0, 1e-6); });
  return rows.take();
}

}  // namespace canyon::inertial
