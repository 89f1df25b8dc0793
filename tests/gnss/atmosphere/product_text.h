#pragma once

#include <cmath>
#include <cstdio>
#include <span>
#include <string>

#include "canyon/core/units.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/tests/gnss/rinex/nav_text.h"

/// Synthetic precise products: the twins of the real ones.
namespace canyon::gnss::testing {

inline double periodic_relativity_s(const SatelliteState& s) {
  return -2.0 * s.p_E.dot(s.v_E) / (kSpeedOfLight * kSpeedOfLight);
}

inline std::string date_text(GpsTime t, const char* format) {
  const CalendarTime c = calendar(t);
  char text[80];
  std::snprintf(text, sizeof text, format, c.year, c.month, c.day, c.hour, c.minute, c.second);
  return text;
}

/// An SP3-d file of a constellation's orbits and clocks, `epochs` of them from `start`.
inline std::string sp3_text(const Constellation& constellation, GpsTime start, double step_s, int epochs,
                            const std::string& time_system = "GPS", bool velocities = false) {
  char line[128];
  std::string out = date_text(start, "#dP%4d %2d %2d %2d %2d %11.8f") + "      96 ORBIT IGS14 HLM  IGS\n";
  if (velocities) out[2] = 'V';
  std::snprintf(line, sizeof line, "## %4d %15.8f %14.8f %5d %15.13f\n", start.week(), start.sow_s(), step_s, 55378,
                0.0);
  out += line;
  out += "+   32   G01G02G03G04G05G06G07G08G09G10G11G12G13G14G15G16G17\n";
  out += "%c M  cc " + time_system + " ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n";
  out += "/* synthetic\n";
  for (int k = 0; k < epochs; ++k) {
    const GpsTime t = start + k * step_s;
    out += date_text(t, "*  %4d %2d %2d %2d %2d %11.8f\n");
    for (const SatelliteId sv : constellation.satellites()) {
      const auto s = constellation.state(sv, t);
      if (!s) continue;
      std::snprintf(line, sizeof line, "P%s%14.6f%14.6f%14.6f%14.6f\n", sv.str().c_str(), 1e-3 * s->p_E.x(),
                    1e-3 * s->p_E.y(), 1e-3 * s->p_E.z(), 1e6 * (s->clock_s - periodic_relativity_s(*s)));
      out += line;
      if (!velocities) continue;
      std::snprintf(line, sizeof line, "V%s%14.6f%14.6f%14.6f%14.6f\n", sv.str().c_str(), 10.0 * s->v_E.x(),
                    10.0 * s->v_E.y(), 10.0 * s->v_E.z(), 0.0);
      out += line;
    }
  }
  return out + "EOF\n";
}

/// A RINEX clock file of one receiver and two satellites.
inline std::string clock_text(GpsTime start, int epochs, double step_s) {
  std::string out = header_line("     3.00           C", "RINEX VERSION / TYPE") +
                    header_line("     2    AR    AS", "# / TYPES OF DATA") + header_line("", "END OF HEADER");
  for (int k = 0; k < epochs; ++k)
    for (const char* who : {"AR ALBH", "AS G01 ", "AS G09 "}) {
      char value[32];
      std::snprintf(value, sizeof value, "%19.12E", 1e-4 + 1e-9 * k);
      out += who + date_text(start + k * step_s, " %4d %02d %02d %02d %02d %9.6f") + "  1   " + value + "\n";
    }
  return out;
}

inline std::string antex_frequency(const std::string& code, double north, double east, double up, bool azimuths) {
  char line[128];
  std::string out = header_line("   " + code, "START OF FREQUENCY");
  std::snprintf(line, sizeof line, "%10.2f%10.2f%10.2f", north, east, up);
  out += header_line(line, "NORTH / EAST / UP");
  const auto row = [&](const std::string& name, double offset) {
    out += name;
    for (int z = 0; z <= 90; z += 30) {
      std::snprintf(line, sizeof line, "%8.2f", offset + z / 10.0);
      out += line;
    }
    out += "\n";
  };
  row("   NOAZI", 0.0);
  if (azimuths)
    for (int a = 0; a <= 360; a += 90) {
      std::snprintf(line, sizeof line, "%8.1f", static_cast<double>(a));
      row(line, a == 360 ? 0.0 : a / 90.0);
    }
  return out + header_line("   " + code, "END OF FREQUENCY");
}

/// Two satellites that were G01 one after the other, and a receiver's antenna.
inline std::string antex_text() {
  std::string out = header_line("     1.4            M", "ANTEX VERSION / SYST") + header_line("", "END OF HEADER");
  const auto satellite = [&](double up, const char* from, const char* until) {
    out += header_line("", "START OF ANTENNA");
    out += header_line("BLOCK IIA           G01                 G032      1990-103A", "TYPE / SERIAL NO");
    out += header_line("     0.0", "DAZI") + header_line("     0.0  90.0  30.0", "ZEN1 / ZEN2 / DZEN");
    out += header_line(from, "VALID FROM");
    if (*until != 0) out += header_line(until, "VALID UNTIL");
    out += antex_frequency("G01", 279.0, 0.0, up, false) + antex_frequency("G02", 279.0, 0.0, up, false);
    out += header_line("", "END OF ANTENNA");
  };
  satellite(2000.0, "  1992    11    22     0     0    0.0000000", "  2008    10    16    23    59   59.9999999");
  satellite(2500.0, "  2008    10    17     0     0    0.0000000", "");
  out += header_line("", "START OF ANTENNA") + header_line("TRM29659.00     NONE", "TYPE / SERIAL NO");
  out += header_line("    90.0", "DAZI") + header_line("     0.0  90.0  30.0", "ZEN1 / ZEN2 / DZEN");
  out += antex_frequency("G01", -0.06, -0.91, 91.95, true) + header_line("", "END OF ANTENNA");
  return out;
}

/// Two maps two hours apart on a coarse global grid: 10 + latitude / 10 + 5 cos(longitude), and twice that.
inline std::string ionex_text() {
  std::string out = header_line("     1.0            IONOSPHERE MAPS     GPS", "IONEX VERSION / TYPE") +
                    header_line("     2", "MAP DIMENSION") + header_line("  6371.0", "BASE RADIUS") +
                    header_line("   450.0 450.0   0.0", "HGT1 / HGT2 / DHGT") +
                    header_line("    60.0 -60.0 -30.0", "LAT1 / LAT2 / DLAT") +
                    header_line("  -180.0 180.0  15.0", "LON1 / LON2 / DLON") + header_line("    -1", "EXPONENT") +
                    header_line("", "END OF HEADER");
  for (int k = 0; k < 2; ++k) {
    out += header_line("     " + std::to_string(k + 1), "START OF TEC MAP");
    out += header_line("  2010    12     4    " + std::string(k == 0 ? " 0" : " 2") + "     0     0",
                       "EPOCH OF CURRENT MAP");
    for (int lat = 60; lat >= -60; lat -= 30) {
      char line[64];
      std::snprintf(line, sizeof line, "  %6.1f-180.0 180.0  15.0 450.0", static_cast<double>(lat));
      out += header_line(line, "LAT/LON1/LON2/DLON/H");
      int column = 0;
      for (int lon = -180; lon <= 180; lon += 15) {
        const double vtec = (k + 1) * (10.0 + lat / 10.0 + 5.0 * std::cos(lon * kDegree));
        std::snprintf(line, sizeof line, "%5d", static_cast<int>(std::lround(10.0 * vtec)));
        out += line;
        if (++column % 16 == 0) out += "\n";
      }
      out += "\n";
    }
    out += header_line("     " + std::to_string(k + 1), "END OF TEC MAP");
  }
  return out + header_line("", "END OF FILE");
}

struct AlmanacSatellite {
  int prn, health;
  double e, i_rad, node_rate, sqrt_a, node_rad, perigee_rad, m_rad, af0, af1;
};
inline const AlmanacSatellite kAlmanac[] = {
    {1, 0, 0.5221366882e-2, 0.9637857480, -0.7897471819e-8, 5153.602051, -1.159458779, 0.451712027, -2.105941778,
     0.1621246338e-4, 0.0},
    {2, 63, 0.1561927795e-1, 0.9425197409, -0.8091765626e-8, 5153.698242, -1.203799662, -2.138141893, -1.698904695,
     0.5979537964e-3, 3.637978807e-12}};

inline std::string yuma_text(std::span<const AlmanacSatellite> satellites = kAlmanac) {
  std::string out;
  char line[80];
  for (const auto& s : satellites) {
    std::snprintf(line, sizeof line, "******** Week 866 almanac for PRN-%02d ********\n", s.prn);
    out += line;
    const auto add = [&](const char* name, const char* format, auto value) {
      std::snprintf(line, sizeof line, format, value);
      out += std::string(name) + line + "\n";
    };
    add("ID:                         ", "%02d", s.prn);
    add("Health:                     ", "%03d", s.health);
    add("Eccentricity:               ", "%.10E", s.e);
    add("Time of Applicability(s):  ", "%.4f", 589824.0);
    add("Orbital Inclination(rad):   ", "%.10f", s.i_rad);
    add("Rate of Right Ascen(r/s):  ", "%.10E", s.node_rate);
    add("SQRT(A)  (m 1/2):           ", "%.6f", s.sqrt_a);
    add("Right Ascen at Week(rad):  ", "%.10E", s.node_rad);
    add("Argument of Perigee(rad):   ", "%.9f", s.perigee_rad);
    add("Mean Anom(rad):            ", "%.10E", s.m_rad);
    add("Af0(s):                     ", "%.10E", s.af0);
    add("Af1(s/s):                   ", "%.10E", s.af1);
    out += "week:                        866\n\n";
  }
  return out;
}

/// The same two satellites as a SEM almanac.
inline std::string sem_text(std::span<const AlmanacSatellite> satellites = kAlmanac) {
  std::string out = " " + std::to_string(satellites.size()) + "  CURRENT.ALM\n 866 589824\n\n";
  char line[120];
  for (const auto& s : satellites) {
    std::snprintf(line, sizeof line, "%d\n63\n0\n", s.prn);
    out += line;
    std::snprintf(line, sizeof line, " %.14E %.14E %.14E\n", s.e, s.i_rad / kPi - 0.30, s.node_rate / kPi);
    out += line;
    std::snprintf(line, sizeof line, " %.14E %.14E %.14E\n", s.sqrt_a, s.node_rad / kPi, s.perigee_rad / kPi);
    out += line;
    std::snprintf(line, sizeof line, " %.14E %.14E %.14E\n", s.m_rad / kPi, s.af0, s.af1);
    out += line;
    std::snprintf(line, sizeof line, "%d\n11\n\n", s.health);
    out += line;
  }
  return out;
}

}  // namespace canyon::gnss::testing
