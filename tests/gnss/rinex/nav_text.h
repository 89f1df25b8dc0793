#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "canyon/core/time.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/navigation_data.h"

/// Synthetic navigation files: the twins of the real ones.
namespace canyon::gnss::testing {

/// A plausible GPS satellite of 2010 with every term of the user algorithm switched on.
inline KeplerEphemeris sample_ephemeris(int prn, GpsTime toe) {
  KeplerEphemeris r;
  r.sv = {GnssSystem::kGps, static_cast<std::uint8_t>(prn)};
  r.toc = r.toe = toe;
  r.af0_s = 1e-4 * (prn % 7 - 3);
  r.af1 = 3e-12;
  r.af2_per_s = 1e-20;
  r.tgd_s = -1.2e-8;
  r.sqrt_a = 5153.6 + 0.01 * prn;
  r.e = 0.002 + 0.0005 * prn;
  r.i0_rad = 0.96;
  r.idot_rad_s = -1.7e-10;
  r.omega0_rad = -3.0 + 1.0472 * (prn % 6);
  r.omega_dot_rad_s = -8.1e-9;
  r.argument_of_perigee_rad = 0.3 * prn;
  r.m0_rad = std::remainder(-2.5 + 0.9 * prn, 2.0 * kPi);
  r.delta_n_rad_s = 4.6e-9;
  r.cuc_rad = -4.8e-6;
  r.cus_rad = 5.5e-6;
  r.crc_m = 278.4;
  r.crs_m = -89.7;
  r.cic_rad = 5.6e-8;
  r.cis_rad = -9.3e-8;
  r.iode = 63;
  r.accuracy_m = 2.0;
  return r;
}

/// The constellation of these records alone.
inline std::unique_ptr<Constellation> broadcast_of(std::vector<KeplerEphemeris> records) {
  NavigationData data;
  data.kepler = std::move(records);
  return make_broadcast(data);
}

/// A number as Fortran's D19.12 writes it, or D12.4.
inline std::string fortran(double value, int width = 19, int digits = 12) {
  char text[64];
  std::snprintf(text, sizeof text, "%*.*E", width, digits, value);
  for (char* c = text; *c != 0; ++c)
    if (*c == 'E') *c = 'D';
  return text;
}

inline std::string header_line(const std::string& content, const std::string& label) {
  std::string line = content;
  line.resize(60, ' ');
  return line + label + "\n";
}

inline std::string header(bool version3, bool with_ionosphere = true) {
  std::string out = version3 ? header_line("     3.04           N: GNSS NAV DATA    G: GPS", "RINEX VERSION / TYPE")
                             : header_line("     2.11           N: GPS NAV DATA", "RINEX VERSION / TYPE");
  const double alpha[] = {0.4657e-8, 0.1490e-7, -0.5960e-7, -0.1192e-6},
               beta[] = {0.8192e5, 0.8192e5, -0.6554e5, -0.5243e6};
  std::string a = version3 ? "GPSA " : "  ", b = version3 ? "GPSB " : "  ";
  for (const double x : alpha) a += fortran(x, 12, 4);
  for (const double x : beta) b += fortran(x, 12, 4);
  if (with_ionosphere) {
    out += header_line(a, version3 ? "IONOSPHERIC CORR" : "ION ALPHA");
    out += header_line(b, version3 ? "IONOSPHERIC CORR" : "ION BETA");
  }
  out += header_line("    15", "LEAP SECONDS");
  return out + header_line("", "END OF HEADER");
}

inline std::string record(const KeplerEphemeris& r, bool version3) {
  const CalendarTime c = calendar(r.toc);
  char head[64];
  if (version3)
    std::snprintf(head, sizeof head, "%s %04d %02d %02d %02d %02d %02d", r.sv.str().c_str(), c.year, c.month, c.day,
                  c.hour, c.minute, static_cast<int>(c.second));
  else
    std::snprintf(head, sizeof head, "%2d %02d %2d %2d %2d %2d%5.1f", r.sv.prn, c.year % 100, c.month, c.day, c.hour,
                  c.minute, c.second);
  const std::string indent(version3 ? 4 : 3, ' ');
  const auto line = [&](double a, double b, double d, double e) {
    return indent + fortran(a) + fortran(b) + fortran(d) + fortran(e) + "\n";
  };
  return head + fortran(r.af0_s) + fortran(r.af1) + fortran(r.af2_per_s) + "\n" +
         line(r.iode, r.crs_m, r.delta_n_rad_s, r.m0_rad) + line(r.cuc_rad, r.e, r.cus_rad, r.sqrt_a) +
         line(r.toe.sow_s(), r.cic_rad, r.omega0_rad, r.cis_rad) +
         line(r.i0_rad, r.crc_m, r.argument_of_perigee_rad, r.omega_dot_rad_s) +
         line(r.idot_rad_s, 1.0, r.toe.week(), 0.0) + line(r.accuracy_m, r.health, r.tgd_s, r.iode) +
         line(r.toe.sow_s() - 3600.0, (r.valid_before_s + r.valid_after_s) / 3600.0, 0.0, 0.0);
}

/// Satellites 1..count with records every two hours from `start`.
inline std::string navigation_text(GpsTime start, int count, int sets, bool version3) {
  std::string out = header(version3);
  for (int k = 0; k < sets; ++k)
    for (int prn = 1; prn <= count; ++prn) out += record(sample_ephemeris(prn, start + 7200.0 * k), version3);
  return out;
}

}  // namespace canyon::gnss::testing
