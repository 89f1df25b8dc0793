// Constellations that are made of tables and of precise products, and figures of orbits against them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/orbit_error.h"
#include "canyon/gnss/products/clock_datum.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/csv_table.h"
#include "canyon/gnss/satellites/ephemerides/ephemeris_fit.h"
#include "canyon/gnss/satellites/glonass_channels.h"
#include "canyon/gnss/satellites/sun.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// SPS Performance Standard 2001, table 3-1: right ascension of the node and argument of latitude, degrees.
constexpr double kSlots[24][2] = {{272.847, 268.126}, {272.847, 161.786}, {272.847, 11.676},  {272.847, 41.806},
                                  {332.847, 80.956},  {332.847, 173.336}, {332.847, 309.976}, {332.847, 204.376},
                                  {32.847, 111.876},  {32.847, 11.796},   {32.847, 339.666},  {32.847, 241.556},
                                  {92.847, 135.226},  {92.847, 265.446},  {92.847, 35.156},   {92.847, 167.356},
                                  {152.847, 197.046}, {152.847, 302.596}, {152.847, 66.066},  {152.847, 333.686},
                                  {212.847, 238.886}, {212.847, 345.226}, {212.847, 105.206}, {212.847, 135.346}};

/// In the plane of its latitude, tilted, turned to its node: angles of a month round by eps of 400 rad, twice.
Vector3d on_circle(double radius_m, double latitude_rad, double inclination_rad, double node_rad) {
  return AngleAxisd(node_rad, Vector3d::UnitZ()) *
         (AngleAxisd(inclination_rad, Vector3d::UnitX()) *
          (AngleAxisd(latitude_rad, Vector3d::UnitZ()) * Vector3d(radius_m, 0.0, 0.0)));
}

StressFigure slots_of_gps() {
  Looks looks;
  const auto sky = make_nominal_gps();
  looks.right(sky->satellites().size() == 24);
  const GpsTime epoch = *GpsTime::parse("1993-07-01T00:00:00Z", "stress");
  const double drift = -4.4874e-7 * kDegree, node_rate = drift - 7.2921151467e-5;
  for (std::uint8_t prn = 1; prn <= 24; ++prn)
    for (const double s : {0.0, 5000.0, 86399.0, 120000.0, 30.0 * 86400.0}) {
      const auto& slot = kSlots[prn - 1];
      const auto found = sky->state({GnssSystem::kGps, prn}, epoch + s);
      const Vector3d exact = on_circle(26559.7e3, slot[1] * kDegree - 2.0 * node_rate * s, 55.0 * kDegree,
                                       (slot[0] - 279.060) * kDegree + node_rate * s);
      looks.near((found->p_E - exact).norm(), 0.0, 2.7e7 * 4.0 * kEpsilon * 500.0);
    }
  for (const int prn : {0, 25, 63}) looks.right(!sky->state({GnssSystem::kGps, static_cast<std::uint8_t>(prn)}, epoch));
  looks.right(!sky->state({GnssSystem::kGalileo, 1}, epoch));
  return looks.figure();
}

/// The other systems row by row of their table: planes and slots in order, nodes by their drift or the flattening's,
/// two latitudes' worth of turns, an ellipse where there is one; the waves of GLONASS in radius and latitude.
StressFigure rows_of_others() {
  Looks looks;
  const auto sky = make_nominal("RECJ");
  const GpsTime epoch = *GpsTime::parse("2010-03-21T00:00:00Z", "stress");
  const auto channels = glonass_channel_plan();
  std::size_t count = 0;
  for (const auto& row : table_rows("gnss/tables/nominal_orbits.csv")) {
    std::vector<SatelliteId> satellites;
    const std::string list(row[0]);
    const GnssSystem system = list[0] == 'E'   ? GnssSystem::kGalileo
                              : list[0] == 'R' ? GnssSystem::kGlonass
                              : list[0] == 'C' ? GnssSystem::kBeidou
                                               : GnssSystem::kQzss;
    for (std::size_t from = 0; from < list.size();) {
      const std::size_t end = std::min(list.find(' ', from), list.size());
      const std::string item = list.substr(from, end - from);
      const int first = std::stoi(item.substr(1, 2)), last = item.size() > 4 ? std::stoi(item.substr(5, 2)) : first;
      for (int prn = first; prn <= last; ++prn) satellites.push_back({system, static_cast<std::uint8_t>(prn)});
      from = end + 1;
    }
    const auto value = [&](std::size_t column) { return std::stod(std::string(row[column])); };
    const double mu = system == GnssSystem::kGlonass ? 3.9860044e14
                      : system == GnssSystem::kQzss  ? 3.986005e14
                                                     : 3.986004418e14;
    const double earth =
        system == GnssSystem::kGlonass || system == GnssSystem::kBeidou ? 7.292115e-5 : 7.2921151467e-5;
    const double a = 1000.0 * value(7), e = value(8), inclination = value(10) * kDegree, perigee = value(9) * kDegree;
    const double p = a * (1.0 - e * e);
    // dNode/dt = -3/2 n J2 (R / p)^2 cos i.
    const double drift = row[13].empty() ? -1.5 * std::sqrt(mu / (a * a * a)) * 1.0826267e-3 *
                                               std::pow(6378137.0 / p, 2) * std::cos(inclination)
                                         : value(13) * kDegree / 86400.0;
    const auto planes = static_cast<std::size_t>(value(1)), per_plane = satellites.size() / planes;
    for (std::size_t k = 0; k < satellites.size(); ++k) {
      ++count;
      const auto plane = static_cast<double>(k / per_plane), slot = static_cast<double>(k % per_plane);
      const double node0 = (value(2) + plane * value(3)) * kDegree,
                   latitude0 = (value(4) + slot * value(5) + plane * value(6)) * kDegree;
      for (const double s : {0.0, 4321.0, 50000.0, 86400.0 * 3.0 + 10.0}) {
        const double node = node0 + (drift - earth) * s,
                     latitude = latitude0 + (earth - drift) * value(11) / value(12) * s;
        double M = latitude - perigee, E = M;
        for (int n = 0; n < 60; ++n) E = M + e * std::sin(E);
        double radius = a * (1.0 - e * std::cos(E));
        double u =
            perigee + 2.0 * std::atan2(std::sqrt(1.0 + e) * std::sin(0.5 * E), std::sqrt(1.0 - e) * std::cos(0.5 * E));
        if (system == GnssSystem::kGlonass) {
          // J2 R^2 / 4 a sin^2 i in radius, an eighth of it over a in latitude.
          const double wave = 0.25 * 1.0826267e-3 * 6378137.0 * 6378137.0 / a * std::pow(std::sin(inclination), 2);
          radius += wave * std::cos(2.0 * latitude), u += 0.5 * wave / a * std::sin(2.0 * latitude);
        }
        const auto found = sky->state(satellites[k], epoch + s);
        looks.right(found.has_value());
        if (!found) continue;
        looks.near((found->p_E - on_circle(radius, u, inclination, node)).norm(), 0.0, 256.0 * kEpsilon * 60.0 * 4.3e7);
        looks.right(found->frequency_channel == (system == GnssSystem::kGlonass ? channels.at(satellites[k].prn) : 0));
      }
    }
  }
  looks.right(count == sky->satellites().size() && channels.size() == 24);
  for (const auto& [slot, channel] : channels) looks.right(slot >= 1 && slot <= 24 && channel >= -7 && channel <= 6);
  looks.right(stress::not_refused([] { return make_nominal("GX"); }) == 0);
  return looks.figure();
}

/// Of all systems every 5 minutes, with clocks that run evenly.
PreciseOrbits tabulated(const Constellation& sky, GpsTime start, int count) {
  PreciseOrbits out;
  out.interval_s = 300.0;
  for (const SatelliteId sv : sky.satellites())
    for (int k = 0; k < count; ++k) {
      PreciseSample sample;
      sample.t = start + 300.0 * k;
      sample.p_E = sky.state(sv, sample.t)->p_E;
      sample.clock_s = 1e-5 * sv.prn + 1e-10 * sv.prn * 300.0 * k;
      out.satellites[sv].push_back(sample);
    }
  return out;
}

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

/// Figures of samples of all systems by their definition, with the weights of Montenbruck et al. 2015, table 4, of each
/// and of high orbits: 16 eps of sums of a hundred.
StressFigure figures_of_orbits() {
  Looks looks;
  const RandomStream draws(1, "stress.made");
  OrbitErrors errors;
  const SatelliteId all[] = {{GnssSystem::kGps, 1},     {GnssSystem::kGps, 2},    {GnssSystem::kGlonass, 5},
                             {GnssSystem::kGalileo, 7}, {GnssSystem::kBeidou, 1}, {GnssSystem::kBeidou, 20},
                             {GnssSystem::kBeidou, 38}, {GnssSystem::kQzss, 2},   {GnssSystem::kGalileo, 3}};
  std::uint64_t k = 0;
  for (int epoch = 0; epoch < 12; ++epoch)
    for (const SatelliteId sv : all) {
      ++k;
      errors.samples.push_back({sv, GpsTime::from_week_sow(2000, 900.0 * epoch), draws.normal(0, k),
                                2.0 * draws.normal(1, k), 1.5 * draws.normal(2, k), 0.7 + draws.normal(3, k),
                                draws.normal(4, k)});
    }
  const auto check = [&](const OrbitErrorFigures& found, auto wanted) {
    double n = 0.0, radial = 0.0, squares[4] = {}, range = 0.0, receiver = 0.0, across = 0.0;
    std::map<SatelliteId, std::vector<double>> of;
    for (const OrbitErrorSample& s : errors.samples) {
      if (!wanted(s.sv)) continue;
      const bool high = s.sv.system == GnssSystem::kQzss || (s.sv.system == GnssSystem::kBeidou && s.sv.prn != 20);
      const double w = high ? 0.99 : 0.98, part = high                                  ? 126.0
                                                  : s.sv.system == GnssSystem::kGps     ? 49.0
                                                  : s.sv.system == GnssSystem::kGlonass ? 45.0
                                                  : s.sv.system == GnssSystem::kGalileo ? 61.0
                                                                                        : 54.0;
      const double r = w * s.radial_m - s.clock_m;
      ++n, radial += s.radial_m, range += r * r, receiver += s.range_m * s.range_m;
      const double parts[4] = {s.radial_m, s.along_m, s.cross_m, s.clock_m};
      for (int i = 0; i < 4; ++i) squares[i] += parts[i] * parts[i];
      across += (s.along_m * s.along_m + s.cross_m * s.cross_m) / part;
      of[s.sv].push_back(r);
    }
    double unbiased = 0.0;
    for (const auto& [sv, values] : of)
      for (const double a : values)
        for (const double b : values) unbiased += (a - b) * (a - b) / (2.0 * static_cast<double>(values.size()));
    looks.right(found.samples == static_cast<int>(n) && found.satellites == static_cast<int>(of.size()));
    const double grain = 1e-13;
    looks.near(found.radial_mean_m, radial / n, grain),
        looks.near(found.radial_rms_m, std::sqrt(squares[0] / n), grain);
    looks.near(found.along_rms_m, std::sqrt(squares[1] / n), grain),
        looks.near(found.cross_rms_m, std::sqrt(squares[2] / n), grain);
    looks.near(found.clock_rms_m, std::sqrt(squares[3] / n), grain);
    looks.near(found.rms_3d_m, std::sqrt((squares[0] + squares[1] + squares[2]) / n), grain);
    looks.near(found.sisre_m, std::sqrt((range + across) / n), grain);
    looks.near(found.sisre_receiver_m, std::sqrt((receiver + across) / n), grain);
    looks.near(found.sisre_unbiased_m, std::sqrt((unbiased + across) / n), grain);
  };
  check(errors.figures(), [](SatelliteId) { return true; });
  for (const SatelliteId one : all) check(errors.of_satellite(one), [one](SatelliteId sv) { return sv == one; });
  for (const char letter : {'G', 'R', 'E', 'C', 'J'})
    check(errors.of_system(letter), [letter](SatelliteId sv) { return system_letter(sv.system) == letter; });
  looks.right(errors.satellites().at('C').size() == 3 && errors.satellites().at('E').front().prn == 3);
  looks.right(OrbitErrors{}.figures().samples == 0 && std::isnan(OrbitErrors{}.figures().sisre_m));
  return looks.figure();
}

/// What errs of a broadcast against products: orbits moved along their own axes, clocks by an error of their own beside
/// one that all have, delays of the combination, antennas; 1e-3 m where axes turn by a metre over 2.6e7 m and circles'
/// r . v is none.
StressFigure errors_of_broadcasts() {
  Looks looks;
  const GpsTime start = GpsTime::from_week_sow(2000, 0.0);
  const auto sky = make_nominal("GEC");
  PreciseOrbits orbits = tabulated(*sky, start, 4);
  AntexFile antennas;
  for (auto& [sv, track] : orbits.satellites) {
    Antenna antenna;
    antenna.sv = sv;
    const std::string letter(1, system_letter(sv.system));
    antenna.patterns[letter + (sv.system == GnssSystem::kBeidou ? "02" : "01")].offset_m = {0.0, 0.0, 1.5};
    antennas.antennas.push_back(antenna);
    for (PreciseSample& sample : track) {
      const SatelliteState s = *sky->state(sv, sample.t);
      const Vector3d v = s.v_E + Vector3d(0, 0, 7.2921151467e-5).cross(s.p_E), out = s.p_E.normalized(),
                     across = s.p_E.cross(v).normalized(), along = across.cross(out);
      // The mass lies 1.5 m farther out than the antenna.
      sample.p_E = s.p_E + 1.5 * out - 0.4 * out - 0.8 * along + 0.6 * across;
      sample.clock_s = -1e-9 * sv.prn - 5e-8 + (sv.system == GnssSystem::kGps ? 2e-7 : 0.0);
    }
  }
  orbits.satellites[{GnssSystem::kGps, 5}][1].clock_s = kNaN;
  PreciseOptions options;
  options.antennas = &antennas, options.systems = "GE";
  const OrbitErrors found = orbit_errors(*sky, orbits, options);
  looks.right(found.without_clock == 1 && found.samples.size() == 2 * 24 * 4 - 1);
  for (const OrbitErrorSample& e : found.samples) {
    looks.near(e.radial_m, 0.4, 1e-5), looks.near(e.along_m, 0.8, 1e-5), looks.near(e.cross_m, -0.6, 1e-5);
    // Against the middle of 24 satellites, or of 23 that lack the fifth: 13 then.
    const bool lacks = e.sv.system == GnssSystem::kGps && e.t == start + 300.0;
    const double clock_m = 0.299792458 * (e.sv.prn - (lacks ? 13.0 : 12.5));
    looks.near(e.clock_m, clock_m, 1e-4), looks.near(e.range_m, -clock_m, 1e-4);
  }
  looks.right(std::is_sorted(found.samples.begin(), found.samples.end(),
                             [](const auto& a, const auto& b) { return a.t < b.t || (a.t == b.t && a.sv < b.sv); }));
  ClockFile clocks;
  clocks.interval_s = 300.0;
  for (int k = 0; k < 4; ++k) clocks.satellites[{GnssSystem::kGps, 1}].push_back({start + 300.0 * k, 1e-8});
  options.clocks = &clocks;
  const OrbitErrors by_file = orbit_errors(*sky, orbits, options);
  looks.right(by_file.samples.size() == 4 && by_file.without_clock == 2 * 24 * 4 - 4);
  for (const OrbitErrorSample& e : by_file.samples) looks.near(e.clock_m, 0.0, 1e-4);
  return looks.figure();
}

/// What cannot be fitted is not: satellites that have no such record, spans with too few samples, channels that nobody
/// knows; a fit says what it leaves, and its clock is the satellite's straight line.
class Patchy final : public Constellation {
 public:
  Patchy(const Constellation& sky, GpsTime from, GpsTime to, int channel)
      : sky_(sky), from_(from), to_(to), channel_(channel) {}
  const std::vector<SatelliteId>& satellites() const override { return sky_.satellites(); }
  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const override {
    auto s = sky_.state(sv, t);
    if (!s || t < from_ || to_ < t) return std::nullopt;
    s->clock_s = 3e-5 + 4e-11 * (t - from_);
    s->group_delay_s[1] = 4e-9, s->group_delay_s[2] = 6e-9, s->group_delay_s[7] = -2e-9;
    if (sv.system == GnssSystem::kGlonass) s->frequency_channel = channel_;
    return s;
  }

 private:
  const Constellation& sky_;
  GpsTime from_, to_;
  int channel_;
};

StressFigure fits_and_none() {
  Looks looks;
  const auto sky = make_nominal("GREC");
  const GpsTime toe = GpsTime::from_week_sow(2000, 36000.0);
  const Patchy whole(*sky, toe - 7200.0, toe + 7200.0, 4), half(*sky, toe - 3500.0, toe + 3500.0, 4),
      some(*sky, toe - 3900.0, toe + 3700.0, kUnknownChannel);
  const auto fits = [&](const Constellation& of, SatelliteId sv) { return fit_ephemeris(of, sv, toe).has_value(); };
  looks.right(fits(whole, {GnssSystem::kGps, 3}) && !fits(whole, {GnssSystem::kGlonass, 3}) &&
              !fits(whole, {GnssSystem::kSbas, 3}));
  // 25 samples of 5 minutes: two hours of them.
  looks.right(!fits(half, {GnssSystem::kGps, 3}) && fits(some, {GnssSystem::kGps, 3}) &&
              !fits(whole, {GnssSystem::kGps, 99}));
  looks.right(fit_state_vector(whole, {GnssSystem::kGlonass, 3}, toe).has_value());
  looks.right(!fit_state_vector(some, {GnssSystem::kGlonass, 3}, toe) &&
              !fit_state_vector(whole, {GnssSystem::kGps, 3}, toe));
  const Patchy brief(*sky, toe - 300.0, toe + 300.0, 4);
  looks.right(!fit_state_vector(brief, {GnssSystem::kGlonass, 3}, toe));
  for (const SatelliteId sv : {SatelliteId{GnssSystem::kGps, 3},
                               {GnssSystem::kGalileo, 5},
                               {GnssSystem::kBeidou, 20},
                               {GnssSystem::kBeidou, 59}}) {
    const auto fit = fit_ephemeris(whole, sv, toe);
    if (!fit) return {stress::kInfinity, 1.0};
    const KeplerEphemeris& r = fit->ephemeris;
    double squares = 0.0, most = 0.0;
    int n = 0;
    for (double s = -7200.0; s <= 7200.0; s += 300.0, ++n) {
      const double off = (r.at(toe + s).p_E - sky->state(sv, toe + s)->p_E).norm();
      squares += off * off, most = worse(most, off);
      looks.near(r.at(toe + s).clock_s, 3e-5 + 4e-11 * (7200.0 + s), 1e-15);
    }
    looks.near(fit->rms_m, std::sqrt(squares / n), 1e-6), looks.near(fit->max_m, most, 1e-6);
    looks.right(r.toe == toe && r.toc == toe && r.sv == sv && fit->max_m < 1e-3);
    const bool galileo = sv.system == GnssSystem::kGalileo, beidou = sv.system == GnssSystem::kBeidou;
    looks.near(r.tgd_s, beidou ? 6e-9 : 4e-9, 1e-22), looks.near(r.tgd2_s,
                                                                 galileo  ? 4e-9
                                                                 : beidou ? -2e-9
                                                                          : 0.0,
                                                                 1e-22);
    looks.right(r.message == (galileo  ? NavigationMessage::kInav
                              : beidou ? beidou_message(sv.prn)
                                       : NavigationMessage::kLnav));
  }
  const auto vector = fit_state_vector(whole, {GnssSystem::kGlonass, 3}, toe);
  looks.near(vector->ephemeris.delta_tau_s, 2e-9, 1e-22),
      looks.near(vector->ephemeris.clock_s, 3e-5 + 4e-11 * 7200.0, 1e-15);
  looks.near(vector->ephemeris.clock_rate, 4e-11, 1e-16), looks.right(vector->ephemeris.frequency_channel == 4);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> made_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "constellations made of their tables",
           "a plane's step for a slot's, a node from the wrong meridian",
           "each satellite turned to its place by its row: rounding of angles", "of the bound"});
  rows.add("made/slots_of_gps", slots_of_gps).add("made/rows_of_others", rows_of_others);
  rows.of({StressGroup::kData, "constellations made of precise products",
           "a delay against the other clock, a clock across its jump",
           "what was tabulated, with each option's part by itself", "of the bound"});
  rows.add("made/precise_products", precise_products);
  rows.of({StressGroup::kData, "figures of broadcasts against products",
           "a weight of the other system, a mean of the square", "definitions over samples that are known: roundings",
           "of the bound"});
  rows.add("made/figures_of_orbits", figures_of_orbits).add("made/errors_of_broadcasts", errors_of_broadcasts);
  rows.of({StressGroup::kData, "records that are fitted, and that cannot be", "a guard that lets an empty span through",
           "what is left as stated, and none where there is too little", "of the bound"});
  rows.add("made/fits_and_none", fits_and_none);
  return rows.take();
}

}  // namespace canyon::gnss
