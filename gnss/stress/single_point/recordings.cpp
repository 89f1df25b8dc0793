// Whole recordings, written as files and read again, whose errors are just those that are modelled.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/rinex/observation/observation_writer.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/single_point/single_point.h"
#include "canyon/gnss/sky_view.h"
#include "canyon/gnss/stress/single_point/stated_variance.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kInfinity;
using stress::Looks;

const GpsTime kRecordingNoon = GpsTime::from_calendar(2020, 6, 25, 12, 0, 0);

NavigationData day_of_four_systems() {
  NavigationData data;
  data.files.push_back({"stress", 3.04});
  const struct {
    GnssSystem system;
    NavigationMessage message;
    int satellites, planes;
    double a_m, inclination_deg;
  } shells[] = {{GnssSystem::kGps, NavigationMessage::kLnav, 24, 6, 26559.7e3, 55.0},
                {GnssSystem::kGalileo, NavigationMessage::kInav, 18, 3, 29600.0e3, 56.0},
                {GnssSystem::kBeidou, NavigationMessage::kD1, 18, 3, 27906.0e3, 55.0}};
  for (const auto& shell : shells)
    for (int k = 0; k < shell.satellites; ++k) {
      KeplerEphemeris r;
      r.sv = {shell.system, static_cast<std::uint8_t>(shell.system == GnssSystem::kBeidou ? 19 + k : 1 + k)};
      r.message = shell.message;
      r.toe = r.toc = kRecordingNoon;
      r.transmitted = r.toe - 3600.0;
      r.af0_s = 1e-4 * std::sin(1.0 + k);
      r.af1 = 1e-12 * std::cos(2.0 * k);
      r.sqrt_a = std::sqrt(shell.a_m);
      r.e = 0.012;
      r.i0_rad = shell.inclination_deg * kDegree;
      r.omega0_rad = 2.0 * kPi * (k % shell.planes) / shell.planes + 0.3 * static_cast<double>(shell.system);
      r.omega_dot_rad_s = -8e-9;
      r.argument_of_perigee_rad = 0.4;
      r.m0_rad = 2.0 * kPi * (k / shell.planes) * shell.planes / shell.satellites + 0.7 * (k % shell.planes);
      r.accuracy_m = 2.0;
      r.tgd_s = 1e-9 * (k % 7 - 3);
      r.tgd2_s = shell.system == GnssSystem::kGps ? 0.0 : 1.3e-9 * (k % 5 - 2);
      r.iode = 10 + k;
      const Validity valid = default_validity(shell.system, shell.message);
      r.valid_before_s = valid.before_s;
      r.valid_after_s = valid.after_s;
      data.kepler.push_back(r);
    }
  data.klobuchar.push_back({GnssSystem::kGps, kRecordingNoon, kBuiltInKlobuchar});
  return data;
}

/// Ten epochs of a receiver on two bands whose ranges have this ionosphere (m at L1), and a troposphere, on them, and a
/// clock that runs; moved with v. Written as a file and read again.
ObservationFile recorded(const NavigationData& navigation, const Vector3d& from_E, const Vector3d& v_E,
                         const std::function<double(GnssSystem, const SkyView&)>& ionosphere_m,
                         const std::function<double(const SkyView&)>& troposphere_m) {
  const auto constellation = make_broadcast(navigation);
  const GpsTime first = kRecordingNoon + 30.0;
  ObservationWriter writer(
      {.first = first,
       .bands = {{GnssSystem::kGps, {1, 2}}, {GnssSystem::kGalileo, {1, 5}}, {GnssSystem::kBeidou, {2, 6}}}});
  std::string text = writer.header();
  for (int k = 0; k < 10; ++k) {
    const double clock_s = 2e-7 + 1e-9 * k, drift = 1e-9 / 30.0;
    const GpsTime t = first + 30.0 * k;
    const Vector3d p_E = from_E + 30.0 * k * v_E;
    const Horizon horizon(p_E);
    GnssEpoch epoch;
    epoch.t = t + clock_s;
    for (const SatelliteId sv : constellation->satellites()) {
      const auto signal = transmission_to(*constellation, sv, t, p_E);
      if (!signal) continue;
      const SkyView view = horizon.view(t, signal->p_E());
      if (view.elevation_rad < 8.0 * kDegree) continue;
      const auto before = transmission_to(*constellation, sv, t - 0.5, p_E - 0.5 * v_E);
      const auto after = transmission_to(*constellation, sv, t + 0.5, p_E + 0.5 * v_E);
      const double rate_m_s =
          after->range_m - before->range_m + kSpeedOfLight * (drift - (after->state.clock_s - before->state.clock_s));
      GnssObservation o;
      o.sv = sv;
      o.band = first_band(sv.system);
      o.second.band = sv.system == GnssSystem::kGps ? 2 : sv.system == GnssSystem::kGalileo ? 5 : 6;
      const auto fill = [&](int band, double& code_m, double& phase, double& doppler_hz, double& cn0_dbhz) {
        const double hz = carrier_hz(sv.system, band), scale = kL1Hz / hz;
        const double delay_m = scale * scale * ionosphere_m(sv.system, view);
        const double clear_m =
            signal->range_m + kSpeedOfLight * (clock_s - signal->state.clock_of_band_s(band)) + troposphere_m(view);
        code_m = clear_m + delay_m;
        phase = (clear_m - delay_m) * hz / kSpeedOfLight + 1000.0 * band;
        doppler_hz = -rate_m_s * hz / kSpeedOfLight;
        cn0_dbhz = 45.0;
      };
      fill(o.band, o.pseudorange_m, o.carrier_phase_cycles, o.doppler_hz, o.cn0_dbhz);
      fill(o.second.band, o.second.pseudorange_m, o.second.carrier_phase_cycles, o.second.doppler_hz,
           o.second.cn0_dbhz);
      epoch.observations.push_back(o);
    }
    text += writer.epoch(epoch);
  }
  return *parse_observation_file(text, "stress.rnx");
}

/// What was put on is taken off again: the place to the millimetre that a file's ranges have, over the geometry, and
/// velocity to the file's millihertz.
StressFigure whole(const std::string& how) {
  const NavigationData navigation = day_of_four_systems();
  const auto constellation = make_broadcast(navigation);
  const Vector3d place_E = ecef_from_geodetic({48.0 * kDegree, 11.0 * kDegree, 520.0});
  const Vector3d v_E = how == "moving" ? Vector3d(9.0, -14.0, 3.0) : Vector3d::Zero();
  SinglePointConfig c;
  c.systems = "GEC";
  c.smoothing_s = how == "smoothed" ? 300.0 : 0.0;
  c.shared_ionosphere = 0.0;
  c.ionosphere = IonosphereCorrection::kKlobuchar;
  const bool dual = how == "dual";
  if (dual) c.frequencies = Frequencies::kDual;
  const auto ionosphere_m = [&](GnssSystem system, const SkyView& v) {
    // Any at all for two frequencies; GPS's model for one.
    if (dual) return 20.0 + 5.0 * std::cos(v.azimuth_rad);
    static_cast<void>(system);
    return klobuchar_delay_m(kBuiltInKlobuchar, v.t, v.receiver.lat_rad, v.receiver.lon_rad, v.azimuth_rad,
                             v.elevation_rad);
  };
  const ObservationFile file = recorded(navigation, place_E, v_E, ionosphere_m, standard_troposphere_m);
  std::optional<BaseRecording> base;
  if (how == "differential") {
    // A base 300 m off, whose errors, of whatever size, are those of the rover.
    const auto strange = [](GnssSystem, const SkyView& v) { return 30.0 * std::sin(v.azimuth_rad); };
    const Vector3d base_E = place_E + Vector3d(200.0, 200.0, 100.0);
    base = BaseRecording{recorded(navigation, base_E, Vector3d::Zero(), strange, standard_troposphere_m), base_E};
  }
  const ObservationFile at_rover =
      base ? recorded(
                 navigation, place_E, v_E, [](GnssSystem, const SkyView& v) { return 30.0 * std::sin(v.azimuth_rad); },
                 standard_troposphere_m)
           : file;
  if (how == "filtered") c.estimator = Estimator::kKalman;
  const auto r = solve_observations(at_rover, {*constellation, navigation, nullptr, base ? &*base : nullptr}, c);
  if (!r.ok()) return {kInfinity, 1.0};
  Looks looks;
  looks.right(r->solved() == 10 && r->epochs.size() == 10);
  for (std::size_t k = 0; k < r->epochs.size(); ++k) {
    const SinglePointEpoch& e = r->epochs[k];
    const Vector3d truth_E = place_E + 30.0 * static_cast<double>(k) * v_E;
    // Combinations have three times the error of a range, a base's azimuths differ by 1e-5 rad of 30 m.
    const double range_m = dual ? 4e-3 : base ? 4e-3 : 1.5e-3;
    looks.near((e.fix.p_A_E - truth_E).norm(), 0.0, range_m * e.fix.dop.pdop);
    looks.near((e.fix.v_A_E - v_E).norm(), 0.0, 1e-3 * e.fix.dop.pdop);
    if (how != "filtered") {
      // Ranges and the clock: 200 ns and what it runs.
      looks.near(e.fix.clock_m, kSpeedOfLight * (2e-7 + 1e-9 * static_cast<double>(k)),
                 2.0 * range_m * e.fix.dop.gdop + (base ? 1e3 : 0.0));  // a base's own clock is in its ranges
      for (const double residual : e.residuals_m) looks.near(residual, 0.0, 3.0 * range_m);
    }
    looks.right(e.fix.status == (base ? FixStatus::kDifferential : FixStatus::kSingle) && e.excluded == 0);
    const Horizon horizon(truth_E);
    for (const GnssObservation& o : e.epoch.observations) {
      const SkyView view = horizon.view(e.fix.t, o.p_E);
      looks.right(view.elevation_rad >= 10.0 * kDegree - 1e-6 && o.used);
      // Sigma as the budget has it.
      RangeQuality q;
      q.system = o.sv.system;
      q.elevation_rad = view.elevation_rad;
      q.cn0_dbhz = 45.0;
      const double scale = kL1Hz / carrier_hz(o.sv.system, o.band);
      q.ionosphere_m = dual ? 0.0 : scale * scale * ionosphere_m(o.sv.system, view);
      const double f1 = carrier_hz(o.sv.system, o.band),
                   f2 = carrier_hz(o.sv.system, o.sv.system == GnssSystem::kGps       ? 2
                                                : o.sv.system == GnssSystem::kGalileo ? 5
                                                                                      : 6);
      const double w1 = f1 * f1 / (f1 * f1 - f2 * f2);
      q.code_factor = dual ? std::hypot(w1, 1.0 - w1) : 1.0;
      q.differential = base.has_value();
      const double own = std::sqrt(stated_variance("budget", q, 0.5));
      const double expected =
          base ? std::hypot(own, 0.16 + 1.07 * std::exp(-view.elevation_rad / (15.5 * kDegree))) : own;
      // Elevations of the fix and of the truth, mm over 2e7 m, and of a base 300 m off.
      looks.near(o.sigma_m / expected, 1.0, base ? 2e-4 : 1e-6);
    }
  }
  return looks.figure();
}

/// What cannot be solved is said, and what just can is not: maps that end with the recording or a second sooner, models
/// without coefficients, a base of another time, systems that were not observed, no ephemeris at all. And with maps of
/// one value, ranges come out as without them where that value is none.
StressFigure what_cannot_be_solved() {
  int wrong = 0;
  const NavigationData navigation = day_of_four_systems();
  const auto constellation = make_broadcast(navigation);
  const Vector3d place_E = ecef_from_geodetic({48.0 * kDegree, 11.0 * kDegree, 520.0});
  const auto none_m = [](GnssSystem, const SkyView&) { return 0.0; };
  const ObservationFile file = recorded(navigation, place_E, Vector3d::Zero(), none_m, standard_troposphere_m);
  const GpsTime first = file.epochs.front().t, last = file.epochs.back().t;
  SinglePointConfig c;
  c.systems = "GEC", c.ionosphere = IonosphereCorrection::kNone, c.shared_ionosphere = 0.0;
  const auto solves = [&](const SinglePointInputs& inputs) {
    const auto r = solve_observations(file, inputs, c);
    return r.ok() && r->solved() == 10 && (r->epochs[3].fix.p_A_E - place_E).norm() < 0.1;
  };
  wrong += solves({*constellation, navigation}) ? 0 : 1;
  c.ionosphere = IonosphereCorrection::kIonex;
  wrong += solves({*constellation, navigation}) ? 1 : 0;
  for (const auto& [sooner_s, later_s, good] :
       {std::tuple{0.0, 0.0, true}, {-100.0, 100.0, true}, {1.0, 100.0, false}, {-100.0, -1.0, false}}) {
    IonexMaps maps;
    maps.lat_first_deg = 87.5, maps.lat_step_deg = -87.5, maps.lon_first_deg = -180.0, maps.lon_step_deg = 180.0;
    maps.latitudes = 3, maps.longitudes = 3;
    for (const GpsTime t : {first + sooner_s, last + later_s}) maps.maps.push_back({t, std::vector<double>(9, 0.0)});
    wrong += solves({*constellation, navigation, &maps}) == good ? 0 : 1;
  }
  c.ionosphere = IonosphereCorrection::kKlobuchar;
  NavigationData bare = navigation;
  bare.klobuchar.clear();
  wrong += solve_observations(file, {*constellation, bare}, c).ok() ? 1 : 0;
  c.ionosphere = IonosphereCorrection::kNone;
  for (const double off_s : {-29.0, 29.0, 400.0}) {
    BaseRecording base{file, place_E};
    for (ObservationEpoch& epoch : base.observations.epochs) epoch.t = epoch.t + off_s;
    const auto r = solve_observations(file, {*constellation, navigation, nullptr, &base}, c);
    // Within 30 s of some epoch of the base's, which come every 30 s.
    wrong += r.ok() == (off_s < 300.0) ? 0 : 1;
  }
  const auto nothing = make_broadcast({});
  wrong += solve_observations(file, {*nothing, navigation}, c).ok() ? 1 : 0;
  for (const char* systems : {"", "X", "GG", "J"}) {
    c.systems = systems;
    wrong += solve_observations(file, {*constellation, navigation}, c).ok() ? 1 : 0;
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> recording_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "a recording whose errors are just those that are modelled",
           .why = "a delay that is added, the clock of another band, a velocity by the wrong carrier",
           .expected = "place and velocity of the receiver to what a file's digits leave over the geometry",
           .unit = "of the bound"});
  for (const char* how : {"single", "smoothed", "dual", "moving", "filtered", "differential"})
    rows.add(std::string("recordings/whole_") + how, [name = std::string(how)] { return whole(name); });
  rows.of({StressGroup::kData, "recordings that cannot be solved",
           "maps that end a second too soon, a base of another hour",
           "each is said, and what just can be solved is: exact", "wrong"});
  rows.add("recordings/what_cannot_be_solved", what_cannot_be_solved);
  return rows.take();
}

}  // namespace canyon::gnss
