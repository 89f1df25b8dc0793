#include "canyon/gnss/rinex/navigation/glonass_record.h"

#include <algorithm>
#include <cmath>

#include "canyon/gnss/rinex/calendar_fields.h"

namespace canyon::gnss {

Result<GlonassEphemeris> parse_glonass_record(const RecordLines& record, SatelliteId sv) {
  GlonassEphemeris r;
  r.sv = sv;
  if (record.lines.size() != 4 && record.lines.size() != 5)
    return Error{record.file, record.first_line, "",
                 sv.str() + ": the record has " + std::to_string(record.lines.size()) + " lines",
                 "4, or 5 from RINEX 3.05 on"};
  RecordFields f(record, sv.str());
  r.toe = gps_time_of_utc(f.epoch());
  r.clock_s = f.clock(0, "-TauN");
  r.clock_rate = f.clock(1, "+GammaN");
  const char* const names[3][3] = {{"X", "X velocity", "X acceleration"},
                                   {"Y", "Y velocity", "Y acceleration"},
                                   {"Z", "Z velocity", "Z acceleration"}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    r.p_E[i] = 1e3 * f.orbit(axis + 1, 0, names[axis][0]);
    r.v_E[i] = 1e3 * f.orbit(axis + 1, 1, names[axis][1]);
    r.a_E[i] = 1e3 * f.orbit(axis + 1, 2, names[axis][2]);
  }
  const double health = f.orbit(1, 3, "health");
  const double channel = f.orbit(2, 3, "frequency number");
  const double age_days = f.orbit(3, 3, "age of information", false);
  const double delta_tau_s = f.known(4, 1, "delta tau").value_or(0.0);
  const double health_flags = f.known(4, 3, "health flags").value_or(0.0);

  f.require(std::abs(r.clock_s) < 1.0, 0, "-TauN = " + join_values(r.clock_s), "less than 1 s");
  f.require(std::abs(r.clock_rate) < 1e-6, 0, "+GammaN = " + join_values(r.clock_rate), "less than 1e-6");
  const double radius_m = r.p_E.norm(), speed_m_s = r.v_E.norm();
  f.require(radius_m > 2.4e7 && radius_m < 2.7e7, 1,
            "distance from the Earth's centre = " + join_values(radius_m) + " m", "24000 to 27000 km (GLONASS: 25500)");
  f.require(speed_m_s > 2e3 && speed_m_s < 5e3, 1, "speed = " + join_values(speed_m_s) + " m/s", "2000 to 5000 m/s");
  f.require(r.a_E.norm() < 1e-4, 1, "acceleration = " + join_values(r.a_E.norm()) + " m/s^2", "less than 1e-4");
  f.require(health >= 0.0 && health <= 7.0, 1, "health = " + join_values(health), "0 to 7");
  f.require(channel >= -7.0 && channel <= 13.0, 2, "frequency number = " + join_values(channel), "-7 to 13");
  if (!f.ok()) return f.error();

  r.health = static_cast<int>(health);
  // Bit 2 of the flags of RINEX 3.05 on: l(3) of the third string, "malfunction".
  if ((static_cast<unsigned>(std::clamp(health_flags, 0.0, 7.0)) & 4u) != 0) r.health |= 8;
  r.frequency_channel = static_cast<int>(channel);
  r.age_days = age_days;
  if (std::abs(delta_tau_s) < 1e-6) r.delta_tau_s = delta_tau_s;  // 0.999999999999E+09 = not known
  return r;
}

}  // namespace canyon::gnss
