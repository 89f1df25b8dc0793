// Nominal constellations as their sources state them: shapes, planes, periods, and the velocities of their positions.
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

struct Shell {
  char system;
  int first, last;
  double a_m, inclination_deg;
  int planes;
  double revolutions, turns;  ///< of the Earth under the node
};

/// Radius, inclination and planes of a circular shell; the ground track again after its turns; velocities by
/// differences over 20 s: h^4 of the fifth derivative, 1e-8 m/s, and 8 eps of 3e7 m over h. GLONASS's waves are
/// 2.9 km / 4 of the radius and twice as slow as that: to a kilometre, and 1e-4 rad of the plane.
StressFigure shell(const Shell& of) {
  Looks looks;
  const auto sky = make_nominal(std::string(1, of.system));
  const bool wavy = of.system == 'R';
  const GpsTime start = GpsTime::from_week_sow(1800, 12345.0);
  const double w = of.system == 'E' ? 7.2921151467e-5 : 7.292115e-5;
  std::map<int, int> by_plane;
  int satellites = 0;
  for (const SatelliteId sv : sky->satellites()) {
    if (sv.prn < of.first || sv.prn > of.last) continue;
    ++satellites;
    const auto at = [&](double s) { return sky->state(sv, start + s).value(); };
    const SatelliteState s = at(0.0);
    looks.near(s.p_E.norm() / of.a_m, 1.0, wavy ? 5e-5 : 8.0 * kEpsilon);
    const double h = 20.0;
    const Vector3d by = (8.0 * (at(h).p_E - at(-h).p_E) - (at(2 * h).p_E - at(-2 * h).p_E)) / (12.0 * h);
    looks.near((s.v_E - by).norm(), 0.0, 1e-6);
    const Vector3d inertial = s.v_E + w * Vector3d(-s.p_E.y(), s.p_E.x(), 0.0);
    const Vector3d normal = s.p_E.cross(inertial).normalized();
    // A node that drifts by 6e-9 rad/s tilts the way by that over the orbit's rate of 7.3e-5 and more.
    looks.near(std::acos(normal.z()), of.inclination_deg * kPi / 180.0, wavy ? 1e-4 : 8.2e-5);
    const double node = std::atan2(normal.x(), -normal.y());
    const auto plane = static_cast<int>(std::lround(node * 180.0 / kPi));
    bool known = false;
    for (auto& [angle, count] : by_plane)
      if (std::abs(std::remainder((angle - plane) * kPi / 180.0, 2.0 * kPi)) < 0.1) ++count, known = true;
    if (!known) by_plane[plane] = 1;
    looks.right(wavy ? s.frequency_channel >= -7 && s.frequency_channel <= 6 : s.frequency_channel == 0);
    looks.right(s.clock_s == 0.0 && s.clock_rate == 0.0);
    // After its turns of the Earth under the node, which drifts by a part in 1e4 at most, it is where it was.
    const double turn_s = 2.0 * kPi * of.turns;
    double low = 0.9998 * turn_s / w, high = 1.0002 * turn_s / w, best = kInfinity, when = 0.0;
    for (int round = 0; round < 4; ++round) {
      const double step = (high - low) / 400.0;
      best = kInfinity;
      for (double x = low; x <= high; x += step) {
        const double apart = (at(x).p_E - s.p_E).norm();
        if (apart < best) best = apart, when = x;
      }
      low = when - step, high = when + step;
    }
    looks.near(best, 0.0, 20.0);
    // Revolutions by counting where it goes north over the equator.
    if (of.inclination_deg > 1.0 && satellites <= 2) {
      int up = 0;
      double z = at(0.0).p_E.z();
      for (double x = 300.0; x <= when; x += 300.0) {
        const double next = at(x).p_E.z();
        up += z < 0.0 && next >= 0.0 ? 1 : 0;
        z = next;
      }
      looks.near(up, of.revolutions, 1.01);
    }
  }
  looks.right(satellites == of.last - of.first + 1 || of.system == 'C');
  looks.right(static_cast<int>(by_plane.size()) == of.planes);
  for (const auto& [angle, count] : by_plane) looks.right(count == satellites / of.planes);
  return looks.figure();
}

/// QZSS's inclined satellites: eccentric, slowest in the north, on one track about 135 degrees east.
StressFigure eccentric() {
  Looks looks;
  const auto sky = make_nominal("J");
  const GpsTime start = GpsTime::from_week_sow(1800, 0.0);
  for (int prn = 1; prn <= 3; ++prn) {
    double nearest = kInfinity, farthest = 0.0, north = 0.0, at_north = 0.0, longitude = 0.0;
    int n = 0;
    for (double x = 0.0; x < 86164.0; x += 120.0, ++n) {
      const auto s = sky->state({GnssSystem::kQzss, static_cast<std::uint8_t>(prn)}, start + x);
      if (!s) return {kInfinity, 1.0};
      const double r = s->p_E.norm();
      nearest = std::min(nearest, r), farthest = r > farthest ? r : farthest;
      if (s->p_E.z() > north) north = s->p_E.z(), at_north = r;
      longitude += std::atan2(s->p_E.y(), s->p_E.x());
    }
    looks.near(nearest / (42165e3 * 0.925), 1.0, 1e-4);
    looks.near(farthest / (42165e3 * 1.075), 1.0, 1e-4);
    looks.near(at_north / farthest, 1.0, 1e-3);
    looks.near(std::asin(north / at_north) * 180.0 / kPi, 41.0, 0.1);
    looks.near(longitude / n * 180.0 / kPi, 135.0, 1.0);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> nominal_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "constellations without any file",
           .why = "a plane in the place of a slot, a drift of the other sign, a wave that its velocity does not have",
           .expected = "radius, planes and ground track as the sources state them; velocities by differences",
           .unit = "of the bound"});
  const Shell shells[] = {{'E', 1, 24, 29600.318e3, 56.0, 3, 17, 10},
                          {'R', 1, 24, 25508e3, 64.8, 3, 17, 8},
                          {'C', 38, 40, 42164.2e3, 55.0, 3, 1, 1}};
  for (const Shell& of : shells)
    rows.add(std::string("nominal/") + of.system + std::to_string(of.first), [of] { return shell(of); });
  rows.add("nominal/J1", eccentric);
  return rows.take();
}

}  // namespace canyon::gnss
