// Constellations that are made of tables of slots and planes.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/csv_table.h"
#include "canyon/gnss/satellites/glonass_channels.h"
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

}  // namespace

std::vector<StressCase> nominal_table_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "constellations made of their tables",
           "a plane's step for a slot's, a node from the wrong meridian",
           "each satellite turned to its place by its row: rounding of angles", "of the bound"});
  rows.add("made/slots_of_gps", slots_of_gps).add("made/rows_of_others", rows_of_others);
  return rows.take();
}

}  // namespace canyon::gnss
