// One signal of a satellite as it is measured, part by part; and which satellites are looked for.
#include <cmath>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/carrier_noise.h"
#include "canyon/gnss/receiver/loop_noise.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/pseudorange_parts.h"
#include "canyon/gnss/sensor/satellites_in_view.h"
#include "canyon/gnss/sensor/sensor_models.h"
#include "canyon/gnss/sensor/signal_tracker.h"
#include "canyon/gnss/stress/counted_sky.h"
#include "canyon/gnss/stress/level_ground.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

const GpsTime kMeasured = GpsTime::from_week_sow(1700, 40000.0);

/// Pseudorange, carrier and Doppler of a signal as the sensor's own description has them (pseudorange_sensor.cpp):
/// range, clocks, delays with their signs, what the multipath rule says and noise of the streams by their names; with
/// its scales, and with each cut of what hides. 1e-6 m of 2e7 m by its wavelength, and 1e-6 Hz.
StressFigure parts_of_signals() {
  Looks looks;
  const scene::Scene place(level_ground("signals", 50.0, 0.0));
  const RandomStream draws(1, "stress.signals");
  int followed = 0, dropped = 0;
  for (std::uint64_t k = 0; k < 90; ++k) {
    GnssConfig config;
    config.rate_hz = 4.0;
    config.reception.multipath_rule = ModelChoice<multipath_rules>(k % 3 == 0 ? "correlator" : "paper_first_return");
    config.tracking.thermal_noise_scale = k % 4 == 1 ? 0.0 : 0.7,
    config.tracking.multipath_scale = k % 2 == 0 ? 1.0 : 0.6;
    config.tracking.integration_ms = 10.0, config.tracking.code_loop_hz = 0.4, config.tracking.carrier_loop_hz = 12.0;
    config.tracking.hidden_signals = k % 5 == 0   ? HiddenSignals::kDropped
                                     : k % 5 == 1 ? HiddenSignals::kInSight
                                                  : HiddenSignals::kAsReceived;
    config.satellites.systems = "GREC";
    auto parts = make_pseudorange_parts({config, 3, kMeasured, kMeasured + 60.0, place, 8});
    if (!parts.ok()) return {stress::kInfinity, 1.0};
    looks.near(parts->locks.interval_s, 0.25, 1e-15), looks.near(parts->locks.integration_s, 0.01, 1e-15);
    looks.right(parts->locks.slips == (config.tracking.thermal_noise_scale > 0.0) && parts->noise_seed == 8 &&
                parts->path_limits.seed == 3);
    SignalTracker tracker("stress.", config, *parts);
    const std::vector<SatelliteId> all = parts->constellation->satellites();
    Sight sight;
    sight.sv = all[(7 * k) % all.size()];
    sight.signal.state = *parts->constellation->state(sight.sv, kMeasured);
    sight.signal.state.clock_s = 1e-5, sight.signal.state.clock_rate = 3e-11;
    for (std::size_t b = 0; b < 10; ++b) sight.signal.state.group_delay_s[b] = 1e-9 * static_cast<double>(b);
    sight.signal.range_m = 2.1e7 + 1e5 * draws.uniform(0, k);
    sight.view.elevation_rad = draws.uniform(0.2, 1.5, 1, k);
    sight.direction_W = Vector3d(std::cos(sight.view.elevation_rad), 0.0, std::sin(sight.view.elevation_rad));
    const int first = first_band(sight.sv.system), other = second_band(sight.sv.system, SecondFrequency::kL2);
    const int band = k % 2 == 0 ? first : other;
    const double carrier = carrier_hz(sight.sv.system, band, sight.signal.state.frequency_channel),
                 wave_m = kSpeedOfLight / carrier;
    looks.right(sight.carrier_hz(band) == carrier);
    const ReceivingAntenna antenna{
        17 + static_cast<std::int64_t>(k), Vector3d::UnitZ(), {3.0, -2.0, 0.5}, 1234.5, -0.7};
    const ArrivingRange range{draws.uniform(-800.0, 800.0, 2, k), {8.0, 3.0, -1.5}, 0.06};
    SignalPaths paths;
    paths.line_of_sight = k % 7 < 4;
    paths.direct = paths.line_of_sight ? std::polar(0.9, 0.3) : std::complex<double>(0.0);
    paths.foliage_m = k % 4 == 2 ? 6.0 : 0.0;
    if (k % 7 != 6) {
      SignalPath echo;
      echo.excess_m = draws.uniform(3.0, 40.0, 3, k), echo.copolar = std::polar(0.35, 1.1),
      echo.crosspolar = std::polar(0.2, -2.0);
      echo.arrival_W = Vector3d(-0.6, 0.5, 0.62).normalized(), echo.reflections = 1, echo.facets[0] = 4;
      paths.echoes.push_back(echo);
    }
    // What the channel's own rule makes of its direct signal and echoes.
    const Modulation modulation = modulation_of(sight.sv.system, band);
    const Channel& channel = parts->channels[static_cast<std::size_t>(modulation)];
    looks.right(channel.tracking->design().modulation == modulation &&
                channel.tracking->design().integration_s == 0.01);
    std::vector<ReceivedSignal> echoes;
    for (const SignalPath& echo : paths.echoes)
      echoes.push_back(receive(echo, parts->link, antenna.up_W, sight.direction_W, antenna.v_A_W, wave_m));
    std::optional<ReceivedSignal> direct;
    const double clear_dbhz = 45.0 - 7.0 * (1.0 - std::sin(sight.view.elevation_rad));
    if (paths.line_of_sight)
      direct = ReceivedSignal{
          0.0, clear_dbhz - 28.0 * -std::expm1(-paths.foliage_m * 0.25 / 28.0) + 20.0 * std::log10(0.9), 0.3, 0.0};
    Reception expected = channel.multipath->receive(direct, echoes, wave_m);
    bool tracked = expected.tracked;
    const HiddenSignals hidden = config.tracking.hidden_signals;
    if (hidden == HiddenSignals::kDropped && !paths.line_of_sight) tracked = false;
    if (hidden == HiddenSignals::kInSight && !tracked) {
      tracked = true;
      expected = {};
      expected.cn0_dbhz = clear_dbhz;
    }
    (tracked ? followed : dropped) += 1;
    tracker.begin_epoch(antenna.index);
    const SignalMeasurement m = tracker.measure(antenna, sight, paths, band, range);
    looks.right(m.tracked == tracked);
    if (!m.tracked || !tracked) {
      looks.right(std::isnan(m.pseudorange_m) && std::isnan(m.doppler_hz) && m.noise_m == 0.0);
      continue;
    }
    const double scale = config.tracking.thermal_noise_scale, echo_scale = config.tracking.multipath_scale;
    const std::uint32_t entity = sight.sv.entity();
    const auto sample = static_cast<std::uint64_t>(antenna.index);
    const double noise_m = scale * channel.tracking->noise_m(expected.cn0_dbhz) *
                           LoopNoise(8, "stress.code_noise", 0.4, 0.25).at(entity, antenna.index);
    looks.near(m.noise_m, noise_m, 1e-9), looks.near(m.cn0_dbhz, expected.cn0_dbhz, 1e-9);
    looks.near(m.reception.error_m, echo_scale * expected.error_m, 1e-9);
    const double clock_s = 1e-5 - 1e-9 * band,
                 ratio = carrier_hz(sight.sv.system, first, sight.signal.state.frequency_channel) / carrier;
    const double common_m = sight.signal.range_m + 1234.5 - kSpeedOfLight * clock_s + 3.0 - 1.5 + 0.06;
    looks.near(m.pseudorange_m, common_m + 8.0 * ratio * ratio + echo_scale * expected.error_m + noise_m, 1e-6);
    const double phase = scale * carrier_phase_noise_rad(expected.cn0_dbhz, 12.0, 0.01) *
                         RandomStream(8, "stress.carrier_noise").normal(entity, sample);
    looks.near((m.carrier_phase_cycles - m.ambiguity_cycles) * wave_m,
               common_m - 8.0 * ratio * ratio + echo_scale * expected.carrier_error_m + wave_m * phase / (2.0 * kPi),
               1e-6);
    looks.right(m.slipped && m.ambiguity_cycles == std::round(m.ambiguity_cycles));  // the first epoch of its lock
    const double rate_m_s = range.rate_m_s - 0.7 - kSpeedOfLight * 3e-11 * (1.0 - range.rate_m_s / kSpeedOfLight) +
                            echo_scale * expected.range_rate_error_m_s;
    looks.near(m.doppler_hz,
               -rate_m_s / wave_m + scale * doppler_noise_hz(expected.cn0_dbhz, 12.0, 0.01) *
                                        RandomStream(8, "stress.doppler_noise").normal(entity, sample),
               1e-6);
    // The same peak in the next epoch is followed on, another one is not.
    if (scale > 0.0) continue;
    tracker.begin_epoch(antenna.index + 1);
    ReceivingAntenna later = antenna;
    ++later.index;
    if (!paths.echoes.empty()) paths.echoes[0].facets[0] = k % 8 < 4 ? 4 : 5;
    const SignalMeasurement next = tracker.measure(later, sight, paths, band, range);
    if (next.tracked && m.reception.source == next.reception.source)
      looks.right(next.slipped == (next.reception.source >= 0 && k % 8 >= 4));
  }
  looks.right(followed > 40 && dropped > 5);
  return looks.figure();
}

/// Satellites that are in view, epoch after epoch, by one that remembers what stands low and by one that does not: the
/// same, wherever the antenna goes, and asked for half as often at least.
StressFigure rising_satellites() {
  int wrong = 0;
  const LocalFrame frame(Geodetic{0.6, 0.2, 100.0});
  for (const double mask_rad : {0.0, 0.2, 0.5})
    for (const double speed_m_s : {0.0, 20.0, 300.0}) {
      const auto sky = std::make_shared<CountedSky>(make_nominal("GREC")),
                 plain = std::make_shared<CountedSky>(make_nominal("GREC"));
      SatellitesInView remembers(sky, frame, mask_rad);
      for (int k = 0; k < 120; ++k) {
        const double t_s = 7.0 * k + (k > 60 ? 5000.0 : 0.0);
        const GpsTime t = kMeasured + t_s;
        const Vector3d p_E = frame.to_E({speed_m_s * t_s, 0.3 * speed_m_s * t_s, 0.0});
        const Horizon horizon(p_E);
        const auto found = remembers.at(t, t, p_E, horizon),
                   all = SatellitesInView(plain, frame, mask_rad).at(t, t, p_E, horizon);
        wrong += found.size() == all.size() ? 0 : 1;
        for (std::size_t i = 0; i < found.size() && i < all.size(); ++i) {
          wrong += found[i].sv == all[i].sv && found[i].signal.range_m == all[i].signal.range_m ? 0 : 1;
          wrong += found[i].view.elevation_rad >= mask_rad ? 0 : 1;
          // Towards where it stood, in W, at its elevation over the antenna's own horizon.
          const Vector3d way_W = frame.R_EW().transpose() * (found[i].signal.p_E() - p_E);
          wrong += (found[i].direction_W - way_W.normalized()).norm() < 1e-14 ? 0 : 1;
        }
      }
      wrong += 2 * sky->asked < plain->asked ? 0 : 1;
    }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> signal_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "a signal as it is measured, part by part",
           .why = "the ionosphere of the other band, a clock's rate with its sign turned, noise in radians for cycles",
           .expected = "the sum that the sensor states, with the noise of its streams: roundings of ranges",
           .unit = "of the bound"});
  rows.add("signals/parts", parts_of_signals);
  rows.of({StressGroup::kGeometry, "satellites that are not looked for", "one that rises sooner than a bound allows",
           "the same as where all are looked for: exact, with half of the questions", "wrong"});
  rows.add("signals/rising_satellites", rising_satellites);
  return rows.take();
}

}  // namespace canyon::gnss
