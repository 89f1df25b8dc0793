#include "canyon/gnss/receiver/modes/receiver_fix.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/solver/velocity.h"

namespace canyon::gnss {
namespace {

constexpr double kLowestElevationRad =
    5.0 * kDegree;  // models and weights are held there, wherever a poor guess puts the horizon

/// Raw pseudorange less the smoothed one. With `gain`, that of the combination (1 + gain) P1 - gain P2: both bands are
/// smoothed, each by its own carrier.
double raw_less_smoothed_m(BandSmoothing& smoothing, GpsTime t, const GnssObservation& o, int frequency_channel,
                           std::optional<double> gain) {
  const auto of_band = [&](CarrierSmoothing& band_smoothing, int band, double code_m, double phase_cycles,
                           bool slipped) {
    const double wavelength_m = kSpeedOfLight / carrier_hz(o.sv.system, band, frequency_channel);
    const CarrierSmoothing::Input in{code_m, phase_cycles * wavelength_m, 0.0, slipped};
    return code_m - band_smoothing.smooth(o.sv, t, in).code_m;
  };
  const double first_m = of_band(smoothing.first, o.band, o.pseudorange_m, o.carrier_phase_cycles, o.slipped);
  if (!gain) return first_m;
  const GnssSecondSignal& s = o.second;
  const double second_m = of_band(smoothing.second, s.band, s.pseudorange_m, s.carrier_phase_cycles, s.slipped);
  return first_m - *gain * (second_m - first_m);
}

/// Satellites as told by the pseudoranges; what has no valid ephemeris there stays NaN.
std::vector<RangeMeasurement> satellites_from_pseudoranges(GnssEpoch& epoch, const Constellation& constellation,
                                                           std::span<CorrectionInput> inputs, BandSmoothing* smoothing,
                                                           std::vector<double>& smoothed_m,
                                                           std::vector<RateMeasurement>& rates) {
  std::vector<RangeMeasurement> ranges;
  for (std::size_t i = 0; i < epoch.observations.size(); ++i) {
    auto& o = epoch.observations[i];
    const auto view = transmission_from_pseudorange(constellation, o.sv, epoch.t, o.pseudorange_m);
    CANYON_CHECK(view.has_value(), "no ephemeris for ", o.sv.str(), " that was just simulated at ", epoch.t.iso());
    o.clock_m = kSpeedOfLight * view->state.clock_of_band_s(o.band);
    o.v_E = view->state.v_E;
    if (inputs[i].two)
      inputs[i].two->measured_m = o.second.pseudorange_m + kSpeedOfLight * view->state.clock_of_band_s(o.second.band) -
                                  o.pseudorange_m - o.clock_m;
    ranges.push_back({view->state.p_E, o.pseudorange_m + o.clock_m, 1.0, o.sv.system});
    const double carrier = carrier_hz(o.sv.system, o.band, view->state.frequency_channel);
    o.rate_m_s = pseudorange_rate_m_s(o.doppler_hz, carrier) + kSpeedOfLight * view->state.clock_rate;
    rates.push_back({view->state.p_E, view->state.v_E, o.rate_m_s, 1.0});
    smoothed_m.push_back(smoothing != nullptr
                             ? raw_less_smoothed_m(*smoothing, epoch.t, o, view->state.frequency_channel,
                                                   inputs[i].two ? std::optional(inputs[i].two->gain) : std::nullopt)
                             : 0.0);
  }
  return ranges;
}

/// Everything that depends on where the receiver believes to be.
void correct(const ReceiverParts& receiver, GpsTime t, const Eigen::Vector3d& at_E, GnssEpoch& epoch,
             std::span<CorrectionInput> inputs, const std::vector<double>& smoothed_m,
             std::vector<Correction>& corrections, std::vector<RangeMeasurement>& ranges) {
  const Horizon horizon(at_E);
  for (std::size_t i = 0; i < epoch.observations.size(); ++i) {
    auto& o = epoch.observations[i];
    o.p_E = turned_by_earth(ranges[i].p_E, (ranges[i].p_E - at_E).norm() / kSpeedOfLight);
    SkyView& view = inputs[i].receivers_view;
    view = horizon.view(t, o.p_E);
    view.elevation_rad = std::max(view.elevation_rad, kLowestElevationRad);
    corrections[i] = receiver.mode.correction(inputs[i]);
    corrections[i].smoothing_m = smoothed_m[i];
    o.correction_m = corrections[i].total_m();
    // The difference of two frequencies tells the ionosphere, but not without their noise.
    const bool two = inputs[i].two.has_value(), lost = receiver.mode.dual_frequency() && !two;
    const double gain = two ? inputs[i].two->gain : 0.0, modelled_m = corrections[i].modelled.ionosphere_m;
    const std::optional<BaseCorrection>& base = inputs[i].base;
    o.sigma_m = receiver.weighting.sigma_m({.system = o.sv.system,
                                            .elevation_rad = view.elevation_rad,
                                            .cn0_dbhz = o.cn0_dbhz,
                                            .ionosphere_m = two || lost || base ? 0.0 : modelled_m,
                                            .code_factor = two ? std::hypot(1.0 + gain, gain) : 1.0,
                                            .differential = base.has_value()});
    if (base) o.sigma_m = std::hypot(o.sigma_m, base->sigma_m);
    // Among satellites that measure their ionosphere, one that models it must not count for more: models remove about
    // half (IS-GPS-200N 20.3.3.5.2.5), so as much as is subtracted is left.
    if (lost) o.sigma_m = std::hypot(o.sigma_m, modelled_m);
    ranges[i].range_m = o.corrected_m();
    ranges[i].sigma_m = o.sigma_m;
  }
}

/// Velocity from the Dopplers of the satellites in the fix.
void fill_velocity(const GnssEpoch& epoch, std::span<const RateMeasurement> all, double max_gdop, GnssFix& fix) {
  constexpr double kOutlierSigmas = 5.0;
  std::vector<RateMeasurement> used;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (epoch.observations[i].used) used.push_back(all[i]);
  const VelocitySolution velocity = solve_velocity(used, fix.p_A_E, {max_gdop, kOutlierSigmas});
  if (!velocity.ok) return;
  fix.v_A_E = velocity.v_E;
  fix.velocity_covariance_E = velocity.covariance_E;
}

/// The filter's fix, from all satellites that there are: what it expects tells a fault better than one epoch's
/// residuals, which need redundancy. Says why where there is none.
void filtered_fix(PvtFilter& filter, FixStatus status, std::span<const RangeMeasurement> ranges,
                  std::span<const RateMeasurement> rates, const Eigen::Vector3d& at_E, const PvtFilter::Report* report,
                  GnssEpoch& epoch, GnssFix& fix) {
  const PvtFilter::Estimate estimate = filter.update(fix.t, ranges, rates, at_E, report);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    epoch.observations[i].used = estimate.ranges_used[i];
    fix.satellites += estimate.ranges_used[i] ? 1 : 0;
  }
  if (!estimate.ok || fix.satellites == 0) {
    if (!estimate.ok) fix.reason = estimate.reason;
    if (fix.reason.empty()) fix.reason = "no satellite that the filter's prediction agrees with";
    return;
  }
  fix.status = status;
  fix.reason.clear();
  estimate.fill(fix);
}

std::vector<RangeSignal> signals_of(const GnssEpoch& epoch, std::span<const CorrectionInput> inputs) {
  std::vector<RangeSignal> out;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double gain = inputs[i].two ? inputs[i].two->gain : 0.0;
    const GnssObservation& o = epoch.observations[i];
    out.push_back({o.sv.entity(), o.cn0_dbhz, std::hypot(1.0 + gain, gain)});
  }
  return out;
}

/// A fix that the receiver does not give out is none, and says why.
void withhold(const FixOutput& output, GnssEpoch& epoch, GnssFix& fix) {
  if (fix.status == FixStatus::kNone) return;
  char text[128] = "";
  const double sigma_m = std::sqrt(fix.covariance_E.trace());
  if (fix.satellites < output.fewest_satellites)
    std::snprintf(text, sizeof text, "too few satellites are used: %d, a fix needs %d", fix.satellites,
                  output.fewest_satellites);
  else if (output.accuracy_limit_m > 0.0 && !(sigma_m <= output.accuracy_limit_m))
    std::snprintf(text, sizeof text, "the fix is too uncertain: 1-sigma %.0f m exceeds %g m", sigma_m,
                  output.accuracy_limit_m);
  if (text[0] == '\0') return;
  GnssFix none;
  none.t = fix.t;
  none.dop = fix.dop;
  none.reason = text;
  fix = none;
  for (auto& o : epoch.observations) o.used = false;
}

/// The epoch by itself.
void snapshot_fix(const PositionSolution& solution, FixStatus status, double max_gdop,
                  std::span<const RateMeasurement> rates, GnssEpoch& epoch, GnssFix& fix) {
  fix.status = status;
  fix.p_A_E = solution.p_E;
  fix.covariance_E = solution.covariance_E;
  fix.clock_m = solution.clock_m;
  fix.satellites = solution.satellites_used();
  for (std::size_t i = 0; i < epoch.observations.size(); ++i) epoch.observations[i].used = solution.used[i];
  fill_velocity(epoch, rates, max_gdop, fix);
}

/// As seen from an antenna at `at_E`, once corrections are done: v_E in E of the time of reception.
void turn_velocities(const Eigen::Vector3d& at_E, std::span<const RangeMeasurement> ranges, GnssEpoch& epoch) {
  for (std::size_t i = 0; i < ranges.size(); ++i)
    epoch.observations[i].v_E =
        turned_by_earth(epoch.observations[i].v_E, (ranges[i].p_E - at_E).norm() / kSpeedOfLight);
}

/// Completes observations that no fix may use; their sigma is not known.
void complete_unused(const ReceiverParts& receiver, GpsTime t, const Eigen::Vector3d& at_E, GnssEpoch& epoch,
                     std::span<CorrectionInput> inputs, std::vector<Correction>& corrections) {
  std::vector<RateMeasurement> rates;
  std::vector<double> smoothed_m;
  std::vector<RangeMeasurement> ranges =
      satellites_from_pseudoranges(epoch, receiver.constellation, inputs, receiver.smoothing, smoothed_m, rates);
  corrections.assign(epoch.observations.size(), {});
  correct(receiver, t, at_E, epoch, inputs, smoothed_m, corrections, ranges);
  turn_velocities(at_E, ranges, epoch);
  for (GnssObservation& o : epoch.observations) o.sigma_m = kNaN;
}

/// The fix of ranges all of which may be used.
GnssFix fix_of_all(const ReceiverParts& receiver, GpsTime t, GnssEpoch& epoch, std::span<CorrectionInput> inputs,
                   std::vector<Correction>& corrections, PositionSolution* last) {
  auto& observations = epoch.observations;
  CANYON_CHECK(inputs.size() == observations.size(), inputs.size(), " inputs for ", observations.size(),
               " observations");
  std::vector<RateMeasurement> rates;
  std::vector<double> smoothed_m;
  std::vector<RangeMeasurement> ranges =
      satellites_from_pseudoranges(epoch, receiver.constellation, inputs, receiver.smoothing, smoothed_m, rates);
  corrections.assign(observations.size(), {});

  // Uncorrected ranges tell the position to some tens of metres; corrected for elevations and heights there, to metres;
  // a third pass would change corrections by less than a millimetre.
  Eigen::Vector3d at_E = receiver.guess_E;
  const auto expected_E = receiver.filter != nullptr ? receiver.filter->predicted_p_E(t) : std::nullopt;
  if (const auto rough = receiver.solver.solve(ranges, receiver.guess_E); rough.ok)
    at_E = rough.p_E;
  else if (expected_E)
    at_E = *expected_E;
  PositionSolution solution;
  constexpr int kPasses = 2;
  for (int pass = 0; pass < kPasses; ++pass) {
    correct(receiver, t, at_E, epoch, inputs, smoothed_m, corrections, ranges);
    solution = receiver.solver.solve(ranges, at_E);
    if (solution.ok) at_E = solution.p_E;
  }

  turn_velocities(at_E, ranges, epoch);

  // Carriers are trusted in proportion to codes, 5 cm/s where the code is trusted to 0.5 m: what weakens or bends one
  // does so to the other.
  for (std::size_t i = 0; i < observations.size(); ++i) rates[i].sigma_m_s = 0.1 * observations[i].sigma_m;

  GnssFix fix;
  fix.t = t;
  fix.dop = solution.dop;
  fix.reason = solution.reason;
  const RangeErrorReport* errors = receiver.output.errors;
  if (errors != nullptr && errors->as_assumed()) errors = nullptr;
  const std::vector<RangeSignal> signals = errors != nullptr ? signals_of(epoch, inputs) : std::vector<RangeSignal>();
  if (receiver.filter != nullptr) {
    std::optional<PvtFilter::Report> report;
    if (errors != nullptr) report.emplace(PvtFilter::Report{*errors, signals});
    filtered_fix(*receiver.filter, receiver.mode.status(), ranges, rates, at_E, report ? &*report : nullptr, epoch,
                 fix);
  } else if (solution.ok) {
    snapshot_fix(solution, receiver.mode.status(), receiver.max_gdop, rates, epoch, fix);
    if (errors != nullptr)
      fix.covariance_E = covariance_of_fit(ranges, errors->sigma_m(evidence_of(ranges, signals, solution)), solution);
  }
  withhold(receiver.output, epoch, fix);
  if (last != nullptr) *last = std::move(solution);
  return fix;
}

/// Some of an epoch's observations, and which.
struct Part {
  std::vector<std::size_t> index;
  GnssEpoch epoch;
  std::vector<CorrectionInput> inputs;
  std::vector<Correction> corrections;

  void add(std::size_t i, const GnssObservation& o, const CorrectionInput& input) {
    index.push_back(i);
    epoch.observations.push_back(o);
    inputs.push_back(input);
  }
  void put_back(GnssEpoch& all, std::span<CorrectionInput> all_inputs, std::vector<Correction>& all_corrections) const {
    for (std::size_t k = 0; k < index.size(); ++k) {
      all.observations[index[k]] = epoch.observations[k];
      all_inputs[index[k]] = inputs[k];
      all_corrections[index[k]] = corrections[k];
    }
  }
};

}  // namespace

GnssFix compute_fix(const ReceiverParts& receiver, GpsTime t, GnssEpoch& epoch, std::span<CorrectionInput> inputs,
                    std::vector<Correction>& corrections, PositionSolution* last) {
  const auto usable = [&](const CorrectionInput& in) { return receiver.mode.base() == nullptr || in.base.has_value(); };
  if (std::all_of(inputs.begin(), inputs.end(), usable))
    return fix_of_all(receiver, t, epoch, inputs, corrections, last);
  Part with, without;
  with.epoch.t = without.epoch.t = epoch.t;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    (usable(inputs[i]) ? with : without).add(i, epoch.observations[i], inputs[i]);
  const GnssFix fix = fix_of_all(receiver, t, with.epoch, with.inputs, with.corrections, last);
  const Eigen::Vector3d at_E = fix.status == FixStatus::kNone ? receiver.guess_E : fix.p_A_E;
  complete_unused(receiver, t, at_E, without.epoch, without.inputs, without.corrections);
  corrections.assign(inputs.size(), {});
  with.put_back(epoch, inputs, corrections);
  without.put_back(epoch, inputs, corrections);
  return fix;
}

bool decisions_hold(const PositionSolution& solution, const GnssEpoch& epoch, double bound_m, double max_gdop) {
  if (!solution.ok || !(1.01 * solution.dop.gdop < max_gdop)) return false;
  const IntegrityTest& test = solution.integrity;
  if (test.status == IntegrityTest::Status::kNotTested) return true;
  if (test.status != IntegrityTest::Status::kPassed) return false;
  double weights = 0.0;
  for (const GnssObservation& o : epoch.observations) weights += 1.0 / (o.sigma_m * o.sigma_m);
  return std::sqrt(test.statistic) + bound_m * std::sqrt(weights) < 0.99 * std::sqrt(test.threshold);
}

}  // namespace canyon::gnss
