#pragma once

#include <cstdio>
#include <string>

#include "core/units.h"
#include "gnss/satellites/constellation.h"

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

}  // namespace canyon::gnss::testing
