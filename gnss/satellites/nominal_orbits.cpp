#include <cmath>
#include <map>
#include <string>

#include <Eigen/Geometry>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/csv_table.h"
#include "canyon/gnss/satellites/ephemerides/kepler.h"
#include "canyon/gnss/satellites/glonass_channels.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/satellites/system_constants.h"

namespace canyon::gnss {
namespace {

constexpr double kEquatorRadiusM = 6378137.0, kJ2 = 1.0826267e-3;  // WGS84

GnssSystem system_of_table(char letter) {
  for (const GnssSystem system : {GnssSystem::kGlonass, GnssSystem::kGalileo, GnssSystem::kBeidou, GnssSystem::kQzss})
    if (letter == system_letter(system)) return system;
  CANYON_CHECK(false, "system ", letter);
  return GnssSystem::kGps;
}

/// "E01-E24 E30" as satellites.
std::vector<SatelliteId> satellites_of(std::string_view list) {
  std::vector<SatelliteId> out;
  while (!list.empty()) {
    const std::size_t blank = std::min(list.find(' '), list.size());
    const std::string_view item = list.substr(0, blank);
    list.remove_prefix(std::min(blank + 1, list.size()));
    const auto first = static_cast<int>(table_number(item.substr(1, 2)));
    const auto last = item.size() > 3 ? static_cast<int>(table_number(item.substr(5, 2))) : first;
    for (int prn = first; prn <= last; ++prn) out.push_back({system_of_table(item[0]), static_cast<std::uint8_t>(prn)});
  }
  return out;
}

struct Orbit {
  double node_rad, latitude_rad;    // at the epoch, in E of the epoch; mean argument of latitude
  double node_rate, latitude_rate;  // rad/s, in the rotating frame E
  double a_m, e, perigee_rad, inclination_rad;
  double radius_wave_m, latitude_wave_rad;  // amplitudes at twice the argument of latitude
  int channel;
};

/// Node rate of an orbit by the Earth's flattening, rad/s.
double node_rate_of(double a_m, double e, double inclination_rad, double mu) {
  const double p = a_m * (1.0 - e * e);
  return -1.5 * std::sqrt(mu / (a_m * a_m * a_m)) * kJ2 * std::pow(kEquatorRadiusM / p, 2) * std::cos(inclination_rad);
}

/// The orbits of one row, by satellite.
void add_row(const std::vector<std::string_view>& row, const std::map<int, int>& channels,
             std::map<SatelliteId, Orbit>& orbits) {
  const auto satellites = satellites_of(row[0]);
  const auto planes = static_cast<std::size_t>(table_number(row[1]));
  CANYON_CHECK(planes > 0 && satellites.size() % planes == 0, "satellites ", row[0]);
  const std::size_t slots = satellites.size() / planes;
  for (std::size_t k = 0; k < satellites.size(); ++k) {
    const double plane = static_cast<double>(k / slots), slot = static_cast<double>(k % slots);
    const SystemConstants& c = constants_of(satellites[k].system);
    Orbit o{};
    o.node_rad = (table_number(row[2]) + plane * table_number(row[3])) * kDegree;
    o.latitude_rad = (table_number(row[4]) + slot * table_number(row[5]) + plane * table_number(row[6])) * kDegree;
    o.a_m = 1e3 * table_number(row[7]);
    o.e = table_number(row[8]);
    o.perigee_rad = table_number(row[9]) * kDegree;
    o.inclination_rad = table_number(row[10]) * kDegree;
    const double drift = row[13].empty() ? node_rate_of(o.a_m, o.e, o.inclination_rad, c.mu_m3_s2)
                                         : table_number(row[13]) * kDegree / 86400.0;
    o.node_rate = drift - c.earth_rate_rad_s;
    o.latitude_rate = -o.node_rate * table_number(row[11]) / table_number(row[12]);
    if (satellites[k].system == GnssSystem::kGlonass) {
      o.channel = channels.at(satellites[k].prn);
      // What the flattening does to a circular orbit within a revolution, to first order: Hill's equations with its
      // force. GLONASS's users integrate that force, so its messages could not describe a plain circle.
      const double squared_sine = std::pow(std::sin(o.inclination_rad), 2);
      o.radius_wave_m = 0.25 * kJ2 * kEquatorRadiusM * kEquatorRadiusM / o.a_m * squared_sine;
      o.latitude_wave_rad = 0.5 * o.radius_wave_m / o.a_m;
    }
    CANYON_CHECK(orbits.emplace(satellites[k], o).second, satellites[k].str(), " stands twice in the table");
  }
}

class NominalOrbits final : public Constellation {
 public:
  explicit NominalOrbits(const std::string& systems)
      : epoch_(GpsTime::from_calendar(2010, 3, 21, 0, 0, 15.0)) {  // GPS - UTC = 15 s then
    const std::map<int, int> channels = glonass_channel_plan();
    for (const auto& row : table_rows("gnss/tables/nominal_orbits.csv"))
      if (systems.find(row[0].front()) != std::string::npos) add_row(row, channels, orbits_);
    for (const auto& [sv, orbit] : orbits_) satellites_.push_back(sv);
  }

  const std::vector<SatelliteId>& satellites() const override { return satellites_; }

  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const override {
    const auto found = orbits_.find(sv);
    if (found == orbits_.end()) return std::nullopt;
    const Orbit& o = found->second;
    const double node = o.node_rad + turned(o.node_rate, t);
    const double M = o.latitude_rad + turned(o.latitude_rate, t) - o.perigee_rad;
    const double E = eccentric_anomaly(M, o.e);
    const double E_dot = o.latitude_rate / (1.0 - o.e * std::cos(E)), root = std::sqrt(1.0 - o.e * o.e);
    Eigen::Vector2d perifocal = o.a_m * Eigen::Vector2d(std::cos(E) - o.e, root * std::sin(E)),
                    rate = o.a_m * E_dot * Eigen::Vector2d(-std::sin(E), root * std::cos(E));
    if (o.radius_wave_m != 0.0) add_waves(o, 2.0 * (M + o.perigee_rad), perifocal, rate);

    const double cw = std::cos(o.perigee_rad), sw = std::sin(o.perigee_rad), cn = std::cos(node), sn = std::sin(node),
                 ci = std::cos(o.inclination_rad), si = std::sin(o.inclination_rad);
    // Columns: directions of perigee and of a quarter turn after it.
    Eigen::Matrix<double, 3, 2> axes;
    axes << cn * cw - sn * ci * sw, -cn * sw - sn * ci * cw,  //
        sn * cw + cn * ci * sw, -sn * sw + cn * ci * cw,      //
        si * sw, si * cw;
    SatelliteState s;
    s.p_E = axes * perifocal;
    s.v_E = axes * rate + o.node_rate * Eigen::Vector3d(-s.p_E.y(), s.p_E.x(), 0.0);
    s.frequency_channel = o.channel;
    return s;
  }

 private:
  /// Stretches and turns the position in the orbital plane by the waves, and its rate with it.
  static void add_waves(const Orbit& o, double twice_latitude, Eigen::Vector2d& p, Eigen::Vector2d& rate) {
    const double c = std::cos(twice_latitude), s = std::sin(twice_latitude), turns = 2.0 * o.latitude_rate;
    const double stretch = 1.0 + o.radius_wave_m / o.a_m * c, stretch_rate = -o.radius_wave_m / o.a_m * s * turns;
    const double turned_rate = o.latitude_wave_rad * c * turns;
    const Eigen::Rotation2Dd turn(o.latitude_wave_rad * s);
    const Eigen::Vector2d across(-p.y(), p.x());
    rate = turn * (stretch * rate + stretch_rate * p + stretch * turned_rate * across).eval();
    p = turn * (stretch * p).eval();
  }

  /// Angle turned at a constant rate since the epoch, modulo 2 pi; whole days apart, as in nominal_gps.cpp.
  double turned(double rate_rad_s, GpsTime t) const {
    constexpr std::int64_t kDayNs = 86400 * kNsPerSecond;
    const std::int64_t since_ns = t.ns - epoch_.ns;
    const std::int64_t days = since_ns / kDayNs;
    const double per_day = std::remainder(rate_rad_s * 86400.0, 2.0 * kPi);
    return std::remainder(static_cast<double>(days) * per_day, 2.0 * kPi) +
           rate_rad_s * 1e-9 * static_cast<double>(since_ns % kDayNs);
  }

  GpsTime epoch_;
  std::map<SatelliteId, Orbit> orbits_;
  std::vector<SatelliteId> satellites_;
};

}  // namespace

std::unique_ptr<Constellation> make_nominal(const std::string& systems) {
  for (const char letter : systems)
    CANYON_CHECK(std::string_view("GRECJ").find(letter) != std::string_view::npos, "system ", letter);
  std::vector<std::unique_ptr<Constellation>> parts;
  if (systems.find('G') != std::string::npos) parts.push_back(make_nominal_gps());
  parts.push_back(std::make_unique<NominalOrbits>(systems));
  return make_merged(std::move(parts));
}

}  // namespace canyon::gnss
