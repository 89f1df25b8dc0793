#pragma once

#include <cmath>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/single_point/group_delay.h"

namespace canyon::gnss {

inline const GpsTime kSyntheticNoon = GpsTime::from_calendar(2020, 6, 25, 12, 0, 0);

/// Ephemerides of four systems around noon, each with clocks, group delays and eccentric orbits: 24 GPS, 18 GLONASS, 18
/// Galileo, 18 BeiDou in MEO, as if transmitted.
inline NavigationData synthetic_navigation() {
  NavigationData data;
  data.files.push_back({"synthetic", 3.04});
  struct Shell {
    GnssSystem system;
    NavigationMessage message;
    int satellites, planes;
    double a_m, inclination_deg;
  };
  for (const Shell& shell : {Shell{GnssSystem::kGps, NavigationMessage::kLnav, 24, 6, 26559.7e3, 55.0},
                             Shell{GnssSystem::kGlonass, NavigationMessage::kFdma, 18, 3, 25510.0e3, 64.8},
                             Shell{GnssSystem::kGalileo, NavigationMessage::kInav, 18, 3, 29600.0e3, 56.0},
                             Shell{GnssSystem::kBeidou, NavigationMessage::kD1, 18, 3, 27906.0e3, 55.0}}) {
    for (int k = 0; k < shell.satellites; ++k) {
      const int plane = k % shell.planes, slot = k / shell.planes;
      KeplerEphemeris r;
      r.sv = {shell.system, static_cast<std::uint8_t>(shell.system == GnssSystem::kBeidou ? 19 + k : 1 + k)};
      r.message = shell.message;
      r.toe = r.toc = kSyntheticNoon;
      r.transmitted = r.toe - 3600.0;
      r.af0_s = 1e-4 * std::sin(1.0 + k);
      r.af1 = 1e-12 * std::cos(2.0 * k);
      r.sqrt_a = std::sqrt(shell.a_m);
      r.e = shell.system == GnssSystem::kGlonass ? 0.0 : 0.012;
      r.i0_rad = shell.inclination_deg * kDegree;
      r.omega0_rad = 2.0 * kPi * plane / shell.planes + 0.3 * static_cast<double>(shell.system);
      r.omega_dot_rad_s = -8e-9;
      r.argument_of_perigee_rad = 0.4;
      r.m0_rad = 2.0 * kPi * slot * shell.planes / shell.satellites + 0.7 * plane;
      r.crs_m = 30.0;
      r.cuc_rad = 1e-6;
      r.accuracy_m = 2.0;
      r.tgd_s = 1e-9 * (k % 7 - 3);
      r.tgd2_s = shell.system == GnssSystem::kGps ? 0.0 : 1.3e-9 * (k % 5 - 2);
      r.iode = 10 + k;
      const Validity valid = default_validity(shell.system, shell.message);
      r.valid_before_s = valid.before_s;
      r.valid_after_s = valid.after_s;
      if (shell.system != GnssSystem::kGlonass) {
        data.kepler.push_back(r);
        continue;
      }
      KeplerEphemeris orbit = r;
      orbit.sv.system = GnssSystem::kGps;
      orbit.message = NavigationMessage::kLnav;
      GlonassEphemeris g;
      g.sv = r.sv;
      g.toe = kSyntheticNoon + static_cast<double>(kSyntheticNoon.leap_seconds());  // noon of UTC
      const SatelliteState s = orbit.at(g.toe);
      g.p_E = s.p_E;
      g.v_E = s.v_E;
      g.clock_s = r.af0_s;
      g.clock_rate = r.af1;
      g.frequency_channel = k % 12 - 6;
      data.glonass.push_back(g);
    }
  }
  data.klobuchar.push_back({GnssSystem::kGps, kSyntheticNoon, kBuiltInKlobuchar});
  return data;
}

/// What a receiver at p_E with clock error `clock_s` measures at true time t, but for atmosphere and noise: all
/// satellites above the mask, on the systems' first band and on the second one given.
struct SyntheticReceiver {
  const Constellation& constellation;
  double mask_deg = 5.0;
  double clock_s = 0.0, drift = 0.0;

  static int second_band(GnssSystem system) {
    return system == GnssSystem::kGalileo ? 5 : system == GnssSystem::kBeidou ? 6 : 2;
  }

  GnssEpoch at(GpsTime t, const Eigen::Vector3d& p_E, const Eigen::Vector3d& v_E) const {
    GnssEpoch out;
    out.t = t + clock_s;
    const Eigen::Vector3d up = rotation_E_from_enu(geodetic_from_ecef(p_E)).col(2);
    for (const SatelliteId sv : constellation.satellites()) {
      const auto signal = transmission_to(constellation, sv, t, p_E);
      if (!signal || (signal->p_E() - p_E).normalized().dot(up) < std::sin(mask_deg * kDegree)) continue;
      // Range rate by differences of the whole transmission, so that nothing of the model under test is in it.
      const double h_s = 0.5;
      const auto before = transmission_to(constellation, sv, t - h_s, p_E - h_s * v_E);
      const auto after = transmission_to(constellation, sv, t + h_s, p_E + h_s * v_E);
      const double rate_m_s = (after->range_m - before->range_m) / (2.0 * h_s) +
                              kSpeedOfLight * (drift - (after->state.clock_s - before->state.clock_s) / (2.0 * h_s));
      GnssObservation o;
      o.sv = sv;
      o.band = first_band(sv.system);
      const auto fill = [&](int band, double& code_m, double& phase, double& doppler_hz, double& cn0_dbhz) {
        const double hz = carrier_hz(sv.system, band, signal->state.frequency_channel);
        code_m = signal->range_m + kSpeedOfLight * (clock_s - signal->state.clock_of_band_s(band));
        phase = code_m * hz / kSpeedOfLight + 1000.0 * band;
        doppler_hz = -rate_m_s * hz / kSpeedOfLight;
        cn0_dbhz = 45.0;
      };
      fill(o.band, o.pseudorange_m, o.carrier_phase_cycles, o.doppler_hz, o.cn0_dbhz);
      o.second.band = second_band(sv.system);
      fill(o.second.band, o.second.pseudorange_m, o.second.carrier_phase_cycles, o.second.doppler_hz,
           o.second.cn0_dbhz);
      out.observations.push_back(o);
    }
    return out;
  }
};

}  // namespace canyon::gnss
