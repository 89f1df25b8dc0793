#pragma once

#include <cstdint>
#include <optional>

#include "canyon/core/config/config.h"
#include "canyon/core/messages.h"
#include "canyon/core/random/random.h"
#include "canyon/core/truth.h"
#include "canyon/inertial/errors/markov_process.h"

namespace canyon::inertial {

/// A barometer: the static pressure at its height, late, drifting and noisy.
struct BarometerConfig {
  double rate_hz = 10.0;
  /// Of the geoid: height above sea level = ellipsoidal height - undulation. None: of the place where it is used, and 0
  /// where nobody says.
  std::optional<double> undulation_m;
  double turn_on_bias_pa = 50.0;      ///< constant over a run, 1-sigma
  double drift_pa = 100.0;            ///< weather and sensor, stationary 1-sigma of a Gauss-Markov process
  double drift_tau_s = 7200.0;        ///< its correlation time
  double noise_pa_per_sqrt_hz = 0.4;  ///< white, N of IEEE Std 952
  double lag_s = 0.1;                 ///< time constant of the first-order lag of sensor and tubing; 0 = none
  double resolution_pa = 0.0;         ///< step of the output; 0 = none
};
void visit(FieldVisitor& f, BarometerConfig& c);

class Barometer {
 public:
  Barometer(const BarometerConfig& config, std::uint64_t seed);

  struct Reading {
    BarometerSample message;
    BarometerTruth truth;
  };
  /// Sample k >= 0 at ellipsoidal height `h_m`. Drift and noise depend on (seed, k) alone; the lag takes the pressure
  /// as linear in time since sample k - 1, and starts settled where that was not the sample asked for last. No reading
  /// is below 0.
  Reading sample(std::int64_t k, GpsTime t, double h_m);

  /// From the next sample on the white noise is another draw; drift and turn-on bias stay.
  void draw_anew(std::uint64_t noise_seed) { noise_ = RandomStream(noise_seed, "barometer.noise"); }

 private:
  BarometerConfig config_;
  double bias_pa_;
  MarkovProcess drift_;
  RandomStream noise_;
  std::int64_t last_ = -2;
  double last_pressure_pa_ = 0.0, lagging_pa_ = 0.0;
};

}  // namespace canyon::inertial
