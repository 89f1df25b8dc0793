#include "canyon/gnss/nmea/nmea_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/nmea/sentence.h"

namespace canyon::gnss {
namespace {

constexpr double kWrittenKnot = 1852.0 / 3600.0;  // m/s

struct System {
  GnssSystem system;
  const char* talker;
  int number;        ///< system ID of NMEA 0183 4.11, table 20
  int first_signal;  ///< signal ID of its first civil signal, table 19
};
// SBAS satellites are listed with GPS.
constexpr System kSystems[] = {{GnssSystem::kGps, "GP", 1, 1},
                               {GnssSystem::kGlonass, "GL", 2, 1},
                               {GnssSystem::kGalileo, "GA", 3, 7},
                               {GnssSystem::kBeidou, "GB", 4, 1},
                               {GnssSystem::kQzss, "GQ", 5, 1}};

GnssSystem listed_with(GnssSystem system) {
  return system == GnssSystem::kSbas ? GnssSystem::kGps : system;
}

int number_of(SatelliteId sv) {
  if (sv.system == GnssSystem::kGlonass) return sv.prn + 64;
  if (sv.system == GnssSystem::kSbas) return sv.prn + 13;  // RINEX S20 is PRN 120, NMEA 33
  return sv.prn;
}

__attribute__((format(printf, 1, 2))) std::string text(const char* format, ...) {
  char buffer[160];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

std::string optional_number(double value, int decimals) {
  return std::isfinite(value) ? text("%.*f", decimals, value) : std::string();
}

/// "3725.5836200,N"; rounding never gives 60 minutes.
std::string angle(double rad, int degree_digits, char positive, char negative) {
  const auto units = static_cast<long long>(std::llround(std::abs(rad) / kDegree * 60e7));
  const long long degrees = units / 600000000, rest = units % 600000000;
  return text("%0*lld%02lld.%07lld,%c", degree_digits, degrees, rest / 10000000, rest % 10000000,
              rad < 0.0 ? negative : positive);
}

struct Clock {
  std::string time, date;
};

Clock utc(GpsTime t) {
  // Rounded before it is cut into fields, so that no field reads 60.
  const GpsTime rounded{(t.ns + 5'000'000) / 10'000'000 * 10'000'000};
  const int leap = rounded.leap_seconds();
  // The second before the count grows is 23:59:60.
  const int second_60 = (rounded + 1.0).leap_seconds() - leap;
  const CalendarTime c = calendar(rounded - static_cast<double>(leap + second_60));
  const auto hundredths = static_cast<int>(std::llround((c.second + second_60) * 100.0));
  return {text("%02d%02d%02d.%02d", c.hour, c.minute, hundredths / 100, hundredths % 100),
          text("%02d%02d%02d", c.day, c.month, c.year % 100)};
}

std::string place(const Geodetic& g) {
  return angle(g.lat_rad, 2, 'N', 'S') + "," + angle(g.lon_rad, 3, 'E', 'W');
}

std::string gga(const NmeaEpoch& e, const std::string& talker, const Clock& clock, const Geodetic& g) {
  if (e.fix.status == FixStatus::kNone) return talker + "GGA," + clock.time + ",,,,,0,00,,,M,,M,,";
  return talker + "GGA," + clock.time + "," + place(g) +
         text(",%d,%02d,", e.fix.status == FixStatus::kDifferential ? 2 : 1, e.fix.satellites) +
         optional_number(e.fix.dop.hdop, 2) + text(",%.3f,M,%.3f,M,,", g.h_m - e.undulation_m, e.undulation_m);
}

std::string rmc(const NmeaEpoch& e, const std::string& talker, const Clock& clock, const Geodetic& g) {
  if (e.fix.status == FixStatus::kNone) return talker + "RMC," + clock.time + ",V,,,,,,," + clock.date + ",,,N,V";
  std::string speed, course;
  if (e.fix.v_A_E.allFinite()) {
    const Eigen::Vector3d v_enu = rotation_E_from_enu(g).transpose() * e.fix.v_A_E;
    const double speed_m_s = v_enu.head<2>().norm();
    speed = text("%.3f", speed_m_s / kWrittenKnot);
    double course_deg = std::atan2(v_enu.x(), v_enu.y()) / kDegree;
    if (course_deg < 0.0) course_deg += 360.0;
    // Below walking pace the course is noise; receivers leave it empty.
    if (speed_m_s > 0.1) course = text("%.2f", course_deg >= 359.995 ? 0.0 : course_deg);
  }
  return talker + "RMC," + clock.time + ",A," + place(g) + "," + speed + "," + course + "," + clock.date + ",,," +
         (e.fix.status == FixStatus::kDifferential ? "D" : "A") + ",V";
}

std::string gsa(const NmeaEpoch& e, const std::string& talker) {
  const bool fixed = e.fix.status != FixStatus::kNone;
  const std::string dops = fixed ? "," + optional_number(e.fix.dop.pdop, 2) + "," + optional_number(e.fix.dop.hdop, 2) +
                                       "," + optional_number(e.fix.dop.vdop, 2)
                                 : std::string(",,,");
  std::string out;
  for (const System& s : kSystems) {
    std::vector<int> used;
    for (const NmeaSatellite& satellite : e.satellites)
      if (satellite.used && listed_with(satellite.sv.system) == s.system) used.push_back(number_of(satellite.sv));
    if (used.empty() && !(s.system == GnssSystem::kGps && !fixed)) continue;
    // Twelve fields a sentence; a fix with more of one system takes another sentence.
    for (std::size_t begin = 0; begin == 0 || begin < used.size(); begin += 12) {
      std::string body = talker + "GSA,A," + (fixed ? "3" : "1");
      for (std::size_t i = begin; i < begin + 12; ++i)
        body += i < used.size() ? text(",%02d", used[i]) : std::string(",");
      out += nmea_sentence(body + dops + text(",%d", s.number));
    }
  }
  return out;
}

std::string gsv(const NmeaEpoch& e) {
  std::string out;
  for (const System& s : kSystems) {
    std::vector<const NmeaSatellite*> all;
    for (const NmeaSatellite& satellite : e.satellites)
      if (listed_with(satellite.sv.system) == s.system) all.push_back(&satellite);
    const std::size_t sentences = (all.size() + 3) / 4;
    for (std::size_t k = 0; k < sentences; ++k) {
      std::string body = text("%sGSV,%zu,%zu,%02zu", s.talker, sentences, k + 1, all.size());
      for (std::size_t i = 4 * k; i < std::min(all.size(), 4 * k + 4); ++i) {
        body += text(",%02d,%02d,%03d,", number_of(all[i]->sv),
                     static_cast<int>(std::lround(all[i]->elevation_rad / kDegree)),
                     static_cast<int>(std::lround(all[i]->azimuth_rad / kDegree)) % 360);
        if (std::isfinite(all[i]->cn0_dbhz))
          body += text("%02d", std::clamp(static_cast<int>(std::lround(all[i]->cn0_dbhz)), 0, 99));
      }
      out += nmea_sentence(body + text(",%X", static_cast<unsigned>(s.first_signal)));
    }
  }
  return out;
}

/// GN when several systems are used, else that system's.
std::string talker_of(const NmeaEpoch& e) {
  const System* only = nullptr;
  for (const System& s : kSystems) {
    for (const NmeaSatellite& satellite : e.satellites) {
      if (!satellite.used || listed_with(satellite.sv.system) != s.system) continue;
      if (only != nullptr && only != &s) return "GN";
      only = &s;
    }
  }
  return only == nullptr ? "GP" : only->talker;
}

}  // namespace

std::string nmea_text(const NmeaEpoch& epoch) {
  const std::string talker = talker_of(epoch);
  const Clock clock = utc(epoch.fix.t);
  const Geodetic g = epoch.fix.status == FixStatus::kNone ? Geodetic{} : geodetic_from_ecef(epoch.fix.p_A_E);
  return nmea_sentence(gga(epoch, talker, clock, g)) + nmea_sentence(rmc(epoch, talker, clock, g)) +
         gsa(epoch, talker) + gsv(epoch);
}

}  // namespace canyon::gnss
