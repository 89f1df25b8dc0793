#include "gnss/receiver/receiver_fix.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/units.h"
#include "gnss/satellites/transmission.h"
#include "gnss/signal.h"
#include "gnss/solver/velocity.h"

namespace canyon::gnss {
namespace {

constexpr double kLowestElevationRad =
    5.0 * kDegree;  // models and weights are held there, wherever a poor guess puts the horizon

/// Satellites as told by the pseudoranges; what has no valid ephemeris there stays NaN.
std::vector<RangeMeasurement> satellites_from_pseudoranges(GnssEpoch& epoch, const Constellation& constellation,
                                                           std::span<CorrectionInput> inputs,
                                                           std::vector<RateMeasurement>& rates) {
  std::vector<RangeMeasurement> ranges;
  for (std::size_t i = 0; i < epoch.observations.size(); ++i) {
    auto& o = epoch.observations[i];
    const auto view = transmission_from_pseudorange(constellation, o.sv, epoch.t, o.pseudorange_m);
    CANYON_CHECK(view.has_value(), "no ephemeris for ", o.sv.str(), " that was just simulated at ", epoch.t.iso());
    o.clock_m = kSpeedOfLight * view->state.clock_of_band_s(o.band);
    o.v_E = view->state.v_E;
    if (o.second.band > 0)
      inputs[i].two.measured_m = o.second.pseudorange_m + kSpeedOfLight * view->state.clock_of_band_s(o.second.band) -
                                 o.pseudorange_m - o.clock_m;
    ranges.push_back({view->state.p_E, o.pseudorange_m + o.clock_m, 1.0, o.sv.system});
    const double carrier = carrier_hz(o.sv.system, o.band, view->state.frequency_channel);
    rates.push_back({view->state.p_E, view->state.v_E,
                     pseudorange_rate_m_s(o.doppler_hz, carrier) + kSpeedOfLight * view->state.clock_rate, 1.0});
  }
  return ranges;
}

/// Everything that depends on where the receiver believes to be.
void correct(const ReceiverParts& receiver, GpsTime t, const Eigen::Vector3d& at_E, GnssEpoch& epoch,
             std::span<CorrectionInput> inputs, std::vector<Correction>& corrections,
             std::vector<RangeMeasurement>& ranges) {
  const Horizon horizon(at_E);
  for (std::size_t i = 0; i < epoch.observations.size(); ++i) {
    auto& o = epoch.observations[i];
    o.p_E = turned_by_earth(ranges[i].p_E, (ranges[i].p_E - at_E).norm() / kSpeedOfLight);
    SkyView& view = inputs[i].receivers_view;
    view = horizon.view(t, o.p_E);
    view.elevation_rad = std::max(view.elevation_rad, kLowestElevationRad);
    corrections[i] = receiver.mode.correction(inputs[i]);
    o.correction_m = corrections[i].total_m();
    // The difference of two frequencies tells the ionosphere, but not without their noise.
    const bool two = receiver.mode.dual_frequency();
    const double gain = inputs[i].two.gain;
    o.sigma_m = receiver.weighting.sigma_m({.system = o.sv.system,
                                            .elevation_rad = view.elevation_rad,
                                            .cn0_dbhz = o.cn0_dbhz,
                                            .ionosphere_m = two ? 0.0 : corrections[i].modelled.ionosphere_m,
                                            .code_factor = two ? std::hypot(1.0 + gain, gain) : 1.0});
    ranges[i].range_m = o.corrected_m();
    ranges[i].sigma_m = o.sigma_m;
  }
}

/// Velocity from the Dopplers of the satellites in the fix. Carriers are trusted in proportion to codes: what weakens
/// or bends one does so to the other.
void fill_velocity(const GnssEpoch& epoch, std::vector<RateMeasurement> rates, double max_gdop, GnssFix& fix) {
  constexpr double kPerCodeSigma = 0.1;  // 5 cm/s where the code is trusted to 0.5 m
  constexpr double kOutlierSigmas = 5.0;
  std::vector<RateMeasurement> used;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    if (!epoch.observations[i].used) continue;
    rates[i].sigma_m_s = kPerCodeSigma * epoch.observations[i].sigma_m;
    used.push_back(rates[i]);
  }
  const VelocitySolution velocity = solve_velocity(used, fix.p_A_E, {max_gdop, kOutlierSigmas});
  if (!velocity.ok) return;
  fix.v_A_E = velocity.v_E;
  fix.velocity_covariance_E = velocity.covariance_E;
}

}  // namespace

GnssFix compute_fix(const ReceiverParts& receiver, GpsTime t, GnssEpoch& epoch, std::span<CorrectionInput> inputs,
                    std::vector<Correction>& corrections) {
  auto& observations = epoch.observations;
  CANYON_CHECK(inputs.size() == observations.size(), inputs.size(), " inputs for ", observations.size(),
               " observations");
  std::vector<RateMeasurement> rates;
  std::vector<RangeMeasurement> ranges = satellites_from_pseudoranges(epoch, receiver.constellation, inputs, rates);
  corrections.assign(observations.size(), {});

  // Uncorrected ranges tell the position to some tens of metres; corrected for elevations and heights there, to metres;
  // a third pass would change corrections by less than a millimetre.
  Eigen::Vector3d at_E = receiver.guess_E;
  if (const auto rough = receiver.solver.solve(ranges, receiver.guess_E); rough.ok) at_E = rough.p_E;
  PositionSolution solution;
  constexpr int kPasses = 2;
  for (int pass = 0; pass < kPasses; ++pass) {
    correct(receiver, t, at_E, epoch, inputs, corrections, ranges);
    solution = receiver.solver.solve(ranges, at_E);
    if (solution.ok) at_E = solution.p_E;
  }

  for (std::size_t i = 0; i < observations.size(); ++i)
    observations[i].v_E = turned_by_earth(observations[i].v_E, (ranges[i].p_E - at_E).norm() / kSpeedOfLight);

  GnssFix fix;
  fix.t = t;
  fix.dop = solution.dop;
  fix.reason = solution.reason;
  if (!solution.ok) return fix;
  fix.status = receiver.mode.status();
  fix.p_A_E = solution.p_E;
  fix.covariance_E = solution.covariance_E;
  fix.clock_m = solution.clock_m;
  fix.satellites = solution.satellites_used();
  for (std::size_t i = 0; i < observations.size(); ++i) observations[i].used = solution.used[i];
  fill_velocity(epoch, std::move(rates), receiver.max_gdop, fix);
  return fix;
}

}  // namespace canyon::gnss
