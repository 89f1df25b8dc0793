#include "canyon/gnss/sensor/signal_tracker.h"

#include <cmath>
#include <optional>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/gnss/receiver/carrier_noise.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

/// Which signal's peak is tracked, as a number that stays the same from epoch to epoch.
std::uint64_t identity(const SignalPaths& paths, int source) {
  if (source < 0) return 1;
  const SignalPath& p = paths.echoes[static_cast<std::size_t>(source)];
  std::uint64_t hash = 14695981039346656037u;
  const auto mix = [&hash](std::uint64_t value) { hash = (hash ^ value) * 1099511628211u; };
  mix(static_cast<std::uint64_t>(p.reflections));
  mix(static_cast<std::uint64_t>(p.diffractions));
  for (const std::uint32_t facet : p.facets) mix(facet);
  return hash;
}

}  // namespace

SignalTracker::SignalTracker(const std::string& prefix, const GnssConfig& config, const PseudorangeParts& parts)
    : config_(config.tracking),
      parts_(parts),
      code_(parts.noise_seed, prefix + "code_noise", config_.code_loop_hz, parts.locks.interval_s),
      carrier_(parts.noise_seed, prefix + "carrier_noise"),
      doppler_(parts.noise_seed, prefix + "doppler_noise"),
      cn0_(parts.noise_seed, prefix + "cn0_noise", config.cn0_report, parts.locks.integration_s,
           parts.locks.interval_s),
      memory_{SignalLocks(parts.locks), CodeLoopMemory(config_.code_loop_hz, parts.locks.interval_s)} {}

const Channel& SignalTracker::channel(GnssSystem system, int band) const {
  return parts_.channels[static_cast<std::size_t>(config_.modulation.value_or(modulation_of(system, band)))];
}

Reception SignalTracker::receive_signals(const ReceivingAntenna& antenna, const Sight& sight, const SignalPaths& paths,
                                         const Channel& channel, double wavelength_m) const {
  std::vector<ReceivedSignal> echoes;
  for (const auto& p : paths.echoes)
    echoes.push_back(receive(p, parts_.link, antenna.up_W, sight.direction_W, antenna.v_A_W, wavelength_m));
  std::optional<ReceivedSignal> direct;
  if (paths.line_of_sight) {
    direct.emplace();
    direct->cn0_dbhz = parts_.link.direct_cn0_dbhz(sight.view.elevation_rad, paths.foliage_m, std::abs(paths.direct));
    direct->phase_rad = std::arg(paths.direct);
  }
  return channel.multipath->receive(direct, echoes, wavelength_m);
}

Reception SignalTracker::with_cuts(Reception r, const Sight& sight, const SignalPaths& paths) const {
  if (config_.hidden_signals == HiddenSignals::kDropped && !paths.line_of_sight) return {};
  if (config_.hidden_signals == HiddenSignals::kInSight && !r.tracked) {
    r = {};
    r.tracked = true;
    r.cn0_dbhz = parts_.link.direct_cn0_dbhz(sight.view.elevation_rad, 0.0, 1.0);
  }
  r.error_m *= config_.multipath_scale;
  r.carrier_error_m *= config_.multipath_scale;
  r.range_rate_error_m_s *= config_.multipath_scale;
  return r;
}

SignalMeasurement SignalTracker::measure(const ReceivingAntenna& antenna, const Sight& sight, const SignalPaths& paths,
                                         int band, const ArrivingRange& range) {
  const SatelliteState& state = sight.signal.state;
  const double carrier = sight.carrier_hz(band);
  const double wavelength_m = kSpeedOfLight / carrier;
  const Channel& own = channel(sight.sv.system, band);
  SignalMeasurement m;
  m.reception = with_cuts(receive_signals(antenna, sight, paths, own, wavelength_m), sight, paths);
  Reception& r = m.reception;
  const auto lock = memory_.locks.update(sight.sv, r.tracked ? r.cn0_dbhz : kNaN, identity(paths, r.source));
  if (!lock.tracked) return m;
  if (config_.code_loop_memory) r.error_m = memory_.code.follow(sight.sv, antenna.index, r.error_m);

  m.tracked = true;
  m.cn0_dbhz = cn0_.reported_dbhz(r.cn0_dbhz, sight.sv.entity(), antenna.index);
  m.slipped = lock.slipped;
  m.ambiguity_cycles = lock.ambiguity_cycles;
  const std::uint32_t entity = sight.sv.entity();
  const auto sample = static_cast<std::uint64_t>(antenna.index);
  const double scale = config_.thermal_noise_scale, T = 1e-3 * config_.integration_ms;
  m.noise_m = scale * own.tracking->noise_m(r.cn0_dbhz) * code_.at(entity, antenna.index);

  const double ratio = sight.carrier_hz(first_band(sight.sv.system)) / carrier;
  const double ionosphere_m = range.delays.ionosphere_m * ratio * ratio;
  const double common_m = sight.signal.range_m + antenna.clock_m - kSpeedOfLight * state.clock_of_band_s(band) +
                          range.delays.troposphere_m + range.delays.ephemeris_m + range.phase_centre_m;
  m.pseudorange_m = common_m + ionosphere_m + r.error_m + m.noise_m;
  const double phase_noise = scale * carrier_phase_noise_rad(r.cn0_dbhz, config_.carrier_loop_hz, T) / (2.0 * kPi) *
                             carrier_.normal(entity, sample);
  m.carrier_phase_cycles =
      (common_m - ionosphere_m + r.carrier_error_m) / wavelength_m + phase_noise + lock.ambiguity_cycles;
  const double rate_m_s = range.rate_m_s + antenna.clock_rate_m_s -
                          kSpeedOfLight * state.clock_rate * (1.0 - range.rate_m_s / kSpeedOfLight) +
                          r.range_rate_error_m_s;
  m.doppler_hz = -rate_m_s / wavelength_m +
                 scale * doppler_noise_hz(r.cn0_dbhz, config_.carrier_loop_hz, T) * doppler_.normal(entity, sample);
  CANYON_CHECK(std::isfinite(m.pseudorange_m) && std::isfinite(m.cn0_dbhz) && std::isfinite(m.carrier_phase_cycles) &&
                   std::isfinite(m.doppler_hz),
               "pseudorange sensor, ", sight.sv.str(), ": pseudorange_m = ", m.pseudorange_m,
               ", carrier_phase_cycles = ", m.carrier_phase_cycles, ", doppler_hz = ", m.doppler_hz,
               ", cn0_dbhz = ", m.cn0_dbhz);
  return m;
}

}  // namespace canyon::gnss
