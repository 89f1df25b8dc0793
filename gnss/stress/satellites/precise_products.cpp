// Constellations that are made of precise products.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/products/clock_datum.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/glonass_channels.h"
#include "canyon/gnss/satellites/sun.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/satellites/tabulated_orbits.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::Looks;

/// A constellation of precise products: orbits as they were tabulated, clocks with their relativity, delays of bands
/// against the combination that precise clocks refer to, frequency numbers and antennas by what they are completed
/// with; nothing where a clock jumped, is not known, or an epoch is missing.
StressFigure precise_products() {
  Looks looks;
  const GpsTime start = GpsTime::from_week_sow(2000, 7200.0);
  const auto sky = make_nominal("GREC");
  PreciseOrbits orbits = tabulated(*sky, start, 25);
  const SatelliteId jumps{GnssSystem::kGps, 3}, unknown{GnssSystem::kGps, 4}, gap{GnssSystem::kGps, 5};
  orbits.satellites[jumps][12].clock_event = true;
  orbits.satellites[unknown][12].clock_s = kNaN;
  orbits.satellites[gap].erase(orbits.satellites[gap].begin() + 12);
  NavigationData broadcast;
  const auto record = [&](GnssSystem system, NavigationMessage message) {
    KeplerEphemeris r;
    r.sv = {system, 20}, r.message = message, r.tgd_s = 5e-9, r.tgd2_s = -3e-9, r.toe = start;
    broadcast.kepler.push_back(r);
  };
  record(GnssSystem::kGps, NavigationMessage::kLnav), record(GnssSystem::kGalileo, NavigationMessage::kFnav);
  record(GnssSystem::kBeidou, NavigationMessage::kD1);
  KeplerEphemeris inav = broadcast.kepler[1];
  inav.sv.prn = 21, inav.message = NavigationMessage::kInav;
  broadcast.kepler.push_back(inav);
  GlonassEphemeris glonass;
  glonass.sv = {GnssSystem::kGlonass, 7}, glonass.frequency_channel = -5;
  broadcast.glonass.push_back(glonass);
  glonass.sv.prn = 8, broadcast.glonass.push_back(glonass);
  AntexFile antennas;
  for (const bool later : {false, true}) {
    Antenna antenna;
    antenna.sv = SatelliteId{GnssSystem::kGps, 9};
    (later ? antenna.valid_from : antenna.valid_to) = start + 3000.0 + (later ? 1e-9 : 0.0);
    antenna.patterns["G01"].offset_m = {0.2, -0.1, later ? 2.5 : 1.1};
    antenna.patterns["G02"].offset_m = {0.1, 0.3, later ? 2.0 : 0.9};
    antennas.antennas.push_back(antenna);
  }
  PreciseOptions options;
  options.broadcast = &broadcast, options.antennas = &antennas, options.glonass_channels = {{8, 3}};
  const auto precise = make_precise(orbits, options);
  const auto plan = glonass_channel_plan();
  for (const SatelliteId sv : precise->satellites())
    for (const double s : {-140.0, 0.0, 1000.0, 3000.0, 3450.0, 3610.0, 5000.0, 7200.0, 7340.0}) {
      const GpsTime t = start + s;
      const auto found = precise->state(sv, t);
      const bool none = (sv == jumps && s > 3300.0 && s < 3600.0) || (sv == unknown && s > 3300.0 && s < 3900.0) ||
                        (sv == gap && s > 3450.0 && s < 3750.0);
      looks.right(found.has_value() == !none);
      if (!found) continue;
      const SatelliteState truth = *sky->state(sv, t);
      Vector3d p_E = truth.p_E;
      if (sv == SatelliteId{GnssSystem::kGps, 9}) {
        const bool later = s > 3000.0;
        const double f1 = 1575.42, f2 = 1227.6, w = f1 * f1 / (f1 * f1 - f2 * f2);
        const Vector3d one(0.2, -0.1, later ? 2.5 : 1.1), two(0.1, 0.3, later ? 2.0 : 0.9);
        const Vector3d body = w * one + (1.0 - w) * two;
        // z to the Earth, the panels' axis across Sun and z.
        const Vector3d z = -p_E.normalized(), y = z.cross(sun_direction_E(t)).normalized(), x = y.cross(z);
        p_E += body.x() * x + body.y() * y + body.z() * z;
      }
      // Degree 9 over 45 minutes within the table, where it is good to micrometres; half a step beside it to 2 cm.
      const double off_m = s < 0.0 || s > 7200.0 ? 0.02 : 1e-4;
      looks.near((found->p_E - p_E).norm(), 0.0, off_m);
      looks.near((found->v_E - truth.v_E).norm(), 0.0, 0.01 * off_m + 1e-6);
      const auto relativity = [&](double dt) {
        const SatelliteState at = *sky->state(sv, t + dt);
        return -2.0 * at.p_E.dot(at.v_E) / std::pow(kSpeedOfLight, 2);
      };
      // Waves of GLONASS make r . v of up to 1e7 m^2/s; circles none but for the table's own digits.
      const double clock = 1e-5 * sv.prn + 1e-10 * sv.prn * s;
      looks.near(found->clock_s, clock + relativity(0.0), 1e-14 + 2.0 * off_m * 4e3 / 9e16 * 10.0);
      // On Kepler's orbit the rate of r . v is v^2 - mu / r; the flattening's part is a thousandth of that.
      looks.near(found->clock_rate, 1e-10 * sv.prn + (relativity(1.0) - relativity(-1.0)) / 2.0, 3e-13);
      std::array<double, 10> delays{};
      const auto datum = [&](double f1, double d1, double f2, double d2) {
        const double w = f1 * f1 / (f1 * f1 - f2 * f2);
        return w * d1 + (1.0 - w) * d2;
      };
      if (sv.prn == 20 && sv.system == GnssSystem::kGps) {
        // Of LNAV the two bands' delays are in the proportion that the combination cancels.
        delays[1] = 5e-9, delays[2] = 5e-9 * std::pow(1575.42 / 1227.6, 2);
        looks.near(datum(1575.42, delays[1], 1227.6, delays[2]), 0.0, 1e-22);
      }
      if (sv.prn == 20 && sv.system == GnssSystem::kGalileo)
        delays[1] = 5e-9, delays[5] = 5e-9 * std::pow(1575.42 / 1176.45, 2);
      if (sv.prn == 21 && sv.system == GnssSystem::kGalileo) {
        const double e1 = -3e-9, e5a = -3e-9 + 5e-9 * (std::pow(1575.42 / 1176.45, 2) - 1.0),
                     d = datum(1575.42, e1, 1176.45, e5a);
        delays[1] = e1 - d, delays[5] = e5a - d, delays[7] = -3e-9 * std::pow(1575.42 / 1207.14, 2) - d;
      }
      if (sv.prn == 20 && sv.system == GnssSystem::kBeidou) {
        const double d = datum(1561.098, 5e-9, 1268.52, 0.0);
        delays[1] = delays[2] = 5e-9 - d, delays[6] = -d, delays[7] = -3e-9 - d;
        looks.right(found->borrowed_delay_bands == 2U);
      }
      for (std::size_t b = 0; b < 10; ++b) looks.near(found->group_delay_s[b], delays[b], 1e-20);
      const int channel = sv.system != GnssSystem::kGlonass ? 0 : sv.prn == 8 ? 3 : sv.prn == 7 ? -5 : plan.at(sv.prn);
      looks.right(found->frequency_channel == channel);
    }
  for (const double s : {-151.0, 7351.0}) looks.right(!precise->state({GnssSystem::kGps, 1}, start + s));
  // Clocks of a file in the place of the table's.
  ClockFile clocks;
  clocks.interval_s = 30.0;
  for (int k = 0; k <= 240; ++k) clocks.satellites[jumps].push_back({start + 30.0 * k, 3e-6 - 2e-11 * 30.0 * k});
  PreciseOptions with_file;
  with_file.clocks = &clocks, with_file.systems = "G";
  const auto other = make_precise(orbits, with_file);
  looks.right(!other->state({GnssSystem::kGps, 1}, start + 100.0) && other->satellites().size() == 24);
  for (const double s : {0.0, 3450.0, 7200.0}) {
    const auto found = other->state(jumps, start + s);
    looks.right(found.has_value());
    if (found) looks.near(found->clock_s, 3e-6 - 2e-11 * s, 1e-12), looks.near(found->clock_rate, -2e-11, 3e-13);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> precise_product_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "constellations made of precise products",
           "a delay against the other clock, a clock across its jump",
           "what was tabulated, with each option's part by itself", "of the bound"});
  rows.add("made/precise_products", precise_products);
  return rows.take();
}

}  // namespace canyon::gnss
