#include "canyon/gnss/single_point/observed_ranges.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/ionosphere_map.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/solver/gauss_newton.h"

namespace canyon::gnss {

RangeObserver::RangeObserver(const ObservationFile& file, const SinglePointInputs& inputs,
                             const SinglePointConfig& config, bool differential)
    : file_(file),
      inputs_(inputs),
      config_(config),
      differential_(differential),
      weighting_(model_row(range_weightings(), config.weighting).make({}, {config.sigma_m})),
      troposphere_m_(model_row(troposphere_corrections(), config.troposphere).make),
      group_delays_(config.group_delay, inputs.navigation),
      smoothing_(config.smoothing_s),
      missing_(file.name),
      without_channel_(file.name, "no one tells the GLONASS channel; phase and Doppler are not used"),
      lent_delay_(file.name,
                  "the navigation message does not tell this band's group delay; that of the band beside it is used, "
                  "and its ranges count for less") {}

std::vector<std::string> RangeObserver::warnings() const {
  std::vector<std::string> out = missing_.list();
  without_channel_.append_to(out);
  lent_delay_.append_to(out);
  return out;
}

Status RangeObserver::anything_usable() const {
  if (observed_ == 0)
    return Error{file_.name, 0, "systems", "no pseudorange of the systems " + config_.systems + " in it",
                 "systems that were observed"};
  if (with_ephemeris_ == 0)
    return Error{file_.name, file_.epochs.front().line, "",
                 "no satellite observed from " + file_.epochs.front().t.iso(0) + " to " + file_.epochs.back().t.iso(0) +
                     " has a valid ephemeris in " + inputs_.navigation.names(),
                 "navigation files of the same day and systems"};
  return Ok{};
}

std::vector<ObservedRange> RangeObserver::usable(const ObservationEpoch& epoch) {
  std::vector<ObservedRange> out;
  for (const auto& s : epoch.satellites) {
    if (config_.systems.find(system_letter(s.sv.system)) == std::string::npos) continue;
    const auto& codes = file_.codes(epoch, s.sv.system);
    std::optional<SignalPair> pair;
    std::optional<SignalObservation> signal;
    if (config_.frequencies == Frequencies::kDual) {
      pair = dual_frequency_signals(codes, s);
      if (pair) signal = pair->first;
    } else {
      signal = single_frequency_signal(codes, s);
    }
    if (!signal) continue;
    ++observed_;
    const auto view = transmission_from_pseudorange(inputs_.constellation, s.sv, epoch.t, signal->pseudorange_m);
    if (!view) {
      missing_.add(s.sv, epoch.line, epoch.t);
      continue;
    }
    ++with_ephemeris_;
    ObservedRange c;
    c.sv = s.sv;
    c.signal = *signal;
    c.loss_of_lock = signal->loss_of_lock || (pair && pair->second.loss_of_lock);
    c.state = view->state;
    const int channel = c.state.frequency_channel;
    c.code = pair ? ionosphere_free_measurement(*pair, s.sv, channel) : single_measurement(*signal, s.sv, channel);
    if (std::isnan(c.code.hz)) without_channel_.add(s.sv, epoch.line);
    const int band = signal->code.band - '0';
    const auto second = pair ? std::optional(pair->second.code.band - '0') : std::nullopt;
    c.group_delay_s = group_delays_.delay_s(c.state, s.sv, band, second);
    c.group_delay_sigma_m = group_delays_.sigma_m(c.state, s.sv, band, second);
    if (c.group_delay_sigma_m > 0.0) lent_delay_.add(s.sv, epoch.line);
    if (uses_klobuchar()) c.klobuchar = coefficients(s.sv.system, epoch.t);
    if (std::isfinite(c.code.pseudorange_m)) out.push_back(c);
  }
  return out;
}

bool RangeObserver::uses_klobuchar() const {
  return config_.frequencies == Frequencies::kSingle && is_klobuchar(config_.ionosphere);
}

BroadcastKlobuchar RangeObserver::coefficients(GnssSystem system, GpsTime t) const {
  if (config_.ionosphere == IonosphereCorrection::kKlobucharOwn)
    if (const auto own = inputs_.navigation.klobuchar_at(system, t)) return {system, t, *own};
  return {GnssSystem::kGps, t, inputs_.navigation.klobuchar_at(GnssSystem::kGps, t).value_or(KlobucharCoefficients{})};
}

double RangeObserver::ionosphere_m(const ObservedRange& c, const SkyView& view) const {
  if (config_.frequencies != Frequencies::kSingle || config_.ionosphere == IonosphereCorrection::kNone) return 0.0;
  // A GLONASS channel that nobody tells changes the delay by less than 1 %.
  const double hz = std::isnan(c.code.hz) ? carrier_hz(c.sv.system, c.signal.code.band - '0') : c.code.hz;
  const double scale = kL1Hz / hz;
  if (config_.ionosphere == IonosphereCorrection::kIonex) {
    SkyView held = view;
    held.elevation_rad = std::max(held.elevation_rad, 5.0 * kDegree);
    const double delay_m = ionosphere_map_delay_m(*inputs_.ionosphere_maps, held);
    return std::isfinite(delay_m) ? scale * scale * delay_m : 0.0;  // holes of a map; its time was checked
  }
  return scale * scale * klobuchar_correction_m(c.klobuchar.system, c.klobuchar.coefficients, view);
}

void RangeObserver::smooth(std::vector<ObservedRange>& candidates, const ObservationEpoch& epoch,
                           const Eigen::Vector3d& at_E) {
  if (config_.smoothing_s <= 0.0) return;
  const Horizon horizon(at_E);
  for (auto& c : candidates) {
    CarrierSmoothing::Input in{c.code.pseudorange_m, c.code.phase_m, 0.0, c.loss_of_lock || epoch.after_power_failure};
    in.ionosphere_m = ionosphere_m(c, horizon.view(epoch.t, c.state.p_E));
    c.code.pseudorange_m = smoothing_.smooth(c.sv, epoch.t, in).code_m;
  }
}

void RangeObserver::correct(const std::vector<ObservedRange>& candidates, GpsTime t, const Eigen::Vector3d& at_E,
                            GnssEpoch& epoch, std::vector<RangeMeasurement>& ranges) const {
  const Horizon horizon(at_E);
  epoch.observations.clear();
  ranges.clear();
  for (const auto& c : candidates) {
    const double travel_s = (c.state.p_E - at_E).norm() / kSpeedOfLight;
    GnssObservation o;
    o.sv = c.sv;
    o.band = c.signal.code.band - '0';
    o.p_E = turned_by_earth(c.state.p_E, travel_s);
    const SkyView view = horizon.view(t, o.p_E);
    if (view.elevation_rad < config_.mask_deg * kDegree) continue;
    const double delay_m = ionosphere_m(c, view);
    o.v_E = turned_by_earth(c.state.v_E, travel_s);
    o.pseudorange_m = c.code.pseudorange_m;
    const bool carrier_known = std::isfinite(c.code.hz);
    o.carrier_phase_cycles = carrier_known ? c.signal.phase_cycles : kNaN;
    o.doppler_hz = carrier_known ? c.signal.doppler_hz : kNaN;
    o.rate_m_s = pseudorange_rate_m_s(o.doppler_hz, c.code.hz) + kSpeedOfLight * c.state.clock_rate;
    o.cn0_dbhz = c.signal.cn0_dbhz;
    o.clock_m = kSpeedOfLight * (c.state.clock_s - c.group_delay_s);
    o.correction_m = delay_m + troposphere_m_(view) + c.base_m;
    o.sigma_m = std::hypot(weighting_->sigma_m({.system = c.sv.system,
                                                .elevation_rad = view.elevation_rad,
                                                .cn0_dbhz = o.cn0_dbhz,
                                                .ionosphere_m = differential_ ? 0.0 : delay_m,
                                                .code_factor = c.code.noise_factor,
                                                .accuracy_m = c.state.accuracy_m,
                                                .differential = differential_}),
                           differential_ ? c.base_sigma_m : c.group_delay_sigma_m);
    if (!std::isfinite(o.sigma_m)) continue;  // a signal strength of -6000 dB-Hz, as files may have it
    epoch.observations.push_back(o);
    const double shared_m = differential_ ? 0.0 : config_.shared_ionosphere * delay_m;
    ranges.push_back({c.state.p_E, o.corrected_m(), o.sigma_m, c.sv.system, shared_m});
  }
}

BaseDifferences base_differences(RangeObserver& base, const ObservationFile& observed, const Eigen::Vector3d& p_E) {
  BaseDifferences out;
  for (const auto& epoch : observed.epochs) {
    throw_if_cancelled();
    std::vector<ObservedRange> candidates = base.usable(epoch);
    base.smooth(candidates, epoch, p_E);
    GnssEpoch corrected;
    std::vector<RangeMeasurement> ranges;
    base.correct(candidates, epoch.t, p_E, corrected, ranges);
    const Horizon horizon(p_E);
    BaseDifferences::Epoch& now = out.epochs.emplace_back(BaseDifferences::Epoch{epoch.t, {}});
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const GnssObservation& o = corrected.observations[i];
      now.satellites[o.sv] = {ranges[i].range_m - line_of_sight(ranges[i].p_E, p_E).range_m, o.band,
                              horizon.view(epoch.t, o.p_E).elevation_rad};
    }
    take_out_clock(now);
  }
  return out;
}

}  // namespace canyon::gnss
