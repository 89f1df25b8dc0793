#include "canyon/gnss/sensor/pseudorange_parts.h"

#include "canyon/gnss/sensor/satellite_source.h"
#include "canyon/gnss/sensor/sensor_need.h"

namespace canyon::gnss {
namespace {

SignalLockParameters lock_parameters(const GnssConfig& c, std::uint64_t seed) {
  return {.seed = seed,
          .interval_s = 1.0 / c.rate_hz,
          .threshold_dbhz = c.locks.tracking_threshold_dbhz,
          .reacquisition_margin_db = c.locks.reacquisition_margin_db,
          .reacquisition_s = c.locks.reacquisition_s,
          .carrier_loop_hz = c.tracking.carrier_loop_hz,
          .integration_s = 1e-3 * c.tracking.integration_ms,
          .slips = c.tracking.thermal_noise_scale > 0.0};
}

/// Satellites, and what acts on their signals outside the scene.
Result<KlobucharCoefficients> add_sky(const SensorSetup& at, PseudorangeParts& parts) {
  const GnssConfig& c = at.config;
  CANYON_TRY(const SatelliteSource source, make_satellite_source(c.satellites, at.start, at.end));
  parts.constellation = source.constellation;
  parts.warnings = source.warnings;
  CANYON_TRY(parts.ionosphere, c.ionosphere.make("gnss.ionosphere",
                                                 IonosphereSetup{source.klobuchar, at.start, at.end, &parts.warnings}));
  CANYON_TRY(parts.troposphere, c.troposphere.make("gnss.troposphere"));
  CANYON_TRY(parts.ephemeris_error,
             c.ephemeris_error.make("gnss.ephemeris_error",
                                    EphemerisErrorSetup{at.seed, source.constellation, c.satellites.systems,
                                                        source.navigation.has_ephemeris(), &parts.warnings}));
  return source.klobuchar;
}

}  // namespace

Status add_tracking(const GnssConfig& c, std::uint64_t seed, std::uint64_t noise_seed, PseudorangeParts& parts) {
  for (std::size_t i = 0; i < kModulations; ++i) {
    const CorrelatorDesign design = c.tracking.channel(static_cast<Modulation>(i));
    CANYON_TRY(parts.channels[i].multipath,
               c.reception.multipath_rule.make(
                   "gnss.multipath_rule",
                   MultipathParameters{c.reception.cutoff_m(), c.locks.tracking_threshold_dbhz, design}));
    parts.channels[i].tracking = std::make_unique<CodeTracking>(design);
  }
  CANYON_TRY(parts.clock, c.receiver_clock.make("gnss.receiver_clock", ReceiverClockParameters{seed, 1.0 / c.rate_hz}));
  CANYON_TRY(parts.link, c.link.budget());
  parts.locks = lock_parameters(c, seed);
  parts.noise_seed = noise_seed;
  return Ok{};
}

Result<PseudorangeParts> make_pseudorange_parts(const SensorSetup& at) {
  const GnssConfig& c = at.config;
  PseudorangeParts parts;
  CANYON_TRY(const KlobucharCoefficients klobuchar, add_sky(at, parts));
  CANYON_TRY_STATUS(add_tracking(c, at.seed, at.noise_seed, parts));
  parts.path_limits = path_limits(c);
  parts.path_limits.seed = at.seed;
  parts.path_limits.cutoff_m = parts.channels[0].multipath->reach_m();
  CANYON_TRY(parts.paths, make_propagation(c.propagation, parts.path_limits));
  CANYON_TRY(parts.mode, c.mode.make("gnss.mode", ReceiverModeSetup{at.seed, parts.ionosphere->acts(),
                                                                    parts.troposphere->acts(), klobuchar}));
  CANYON_TRY(parts.solver, c.position.solver.make("gnss.solver", c.position.parameters()));
  CANYON_TRY(parts.weighting,
             c.position.weighting.make("gnss.weighting", RangeWeightingParameters{c.position.solver_sigma_m}));
  CANYON_TRY(parts.reported_covariance, c.position.reported_covariance.make("gnss.reported_covariance"));
  if (!parts.solver->solves_clock() && !parts.clock->perfect())
    return Error{"", 0, "gnss.receiver_clock, gnss.solver",
                 "solver \"" + c.position.solver.name + "\" has no unknown for the receiver clock \"" +
                     c.receiver_clock.name + "\"",
                 "gnss.receiver_clock = \"none\", or another gnss.solver"};
  if (!parts.solver->solves_clock() && c.position.estimator == Estimator::kKalman)
    return Error{
        "", 0, "gnss.estimator, gnss.solver",
        "estimator \"kalman\" needs a receiver clock, which solver \"" + c.position.solver.name + "\" does not have",
        "gnss.solver = \"least_squares\", or another gnss.estimator"};
  if (!parts.solver->solves_clock() && parts.mode->base() != nullptr)
    return Error{"", 0, "gnss.mode, gnss.solver",
                 "solver \"" + c.position.solver.name + "\" has no unknown for what a base's clock leaves in mode \"" +
                     c.mode.name + "\"",
                 "gnss.solver = \"least_squares\", or another gnss.mode"};
  return parts;
}

}  // namespace canyon::gnss
