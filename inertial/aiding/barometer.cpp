#include "canyon/inertial/aiding/barometer.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/earth/standard_atmosphere.h"

namespace canyon::inertial {

void visit(FieldVisitor& f, BarometerConfig& c) {
  f.number("rate_hz", c.rate_hz, {0.1, 1000}, "samples per second");
  f.optional_number("undulation_m", c.undulation_m, -1000.0, {-200, 200},
                    "geoid above the ellipsoid; -1000: as of the scene's heights, else of the geoid at the scene");
  f.number("turn_on_bias_pa", c.turn_on_bias_pa, {0, 1e5}, "constant over a run, 1-sigma");
  f.number("drift_pa", c.drift_pa, {0, 1e5}, "weather and sensor, stationary 1-sigma");
  f.number("drift_tau_s", c.drift_tau_s, {1e-3, 1e9}, "correlation time of the drift");
  f.number("noise_pa_per_sqrt_hz", c.noise_pa_per_sqrt_hz, {0, 1e4},
           "white noise: N of IEEE Std 952, a sheet's one-sided density over sqrt(2)");
  f.number("lag_s", c.lag_s, {0, 1e3}, "time constant of sensor and tubing; 0 = none");
  f.number("resolution_pa", c.resolution_pa, {0, 1e4}, "step of the output; 0 = none");
}

Barometer::Barometer(const BarometerConfig& config, std::uint64_t seed)
    : config_(config),
      bias_pa_(config.turn_on_bias_pa * RandomStream(seed, "barometer.turn_on").normal(0, 0)),
      drift_(MarkovProcess::gauss_markov(seed, "barometer.drift", 0, config.drift_pa, config.drift_tau_s,
                                         1.0 / config.rate_hz)),
      noise_(seed, "barometer.noise") {}

Barometer::Reading Barometer::sample(std::int64_t k, GpsTime t, double h_m) {
  CANYON_CHECK(k >= 0 && std::isfinite(h_m), "sample number = ", k, ", h_m = ", h_m);
  const double dt_s = 1.0 / config_.rate_hz;
  const double pressure_pa = standard_pressure_pa(h_m - config_.undulation_m.value_or(0.0));
  if (k != last_ + 1 || config_.lag_s == 0.0) {
    lagging_pa_ = pressure_pa;
  } else {
    // lag y' + y = x with x linear over the interval, solved exactly.
    const double behind_pa = config_.lag_s * (pressure_pa - last_pressure_pa_) / dt_s;
    lagging_pa_ =
        pressure_pa - behind_pa + (lagging_pa_ - last_pressure_pa_ + behind_pa) * std::exp(-dt_s / config_.lag_s);
  }
  last_ = k;
  last_pressure_pa_ = pressure_pa;

  Reading r;
  r.truth = {.t = t, .pressure_pa = pressure_pa, .drift_pa = bias_pa_ + drift_.at(k).x()};
  const double noise_pa =
      config_.noise_pa_per_sqrt_hz * std::sqrt(config_.rate_hz) * noise_.normal(0, static_cast<std::uint64_t>(k));
  r.message = {.t = t, .pressure_pa = lagging_pa_ + r.truth.drift_pa + noise_pa};
  if (config_.resolution_pa > 0.0) {
    r.message.pressure_pa = config_.resolution_pa * std::round(r.message.pressure_pa / config_.resolution_pa);
  }
  r.message.pressure_pa = std::max(r.message.pressure_pa, 0.0);
  return r;
}

}  // namespace canyon::inertial
