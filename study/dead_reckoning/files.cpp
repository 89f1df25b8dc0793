#include "canyon/study/dead_reckoning/files.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/files/navigation_file.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"

namespace canyon::study {
namespace {

constexpr std::size_t kRowsPerLook = 4096;  // at whether the user wants to stop

Json position_json(const fusion::NavErrorStatistics& s) {
  return Json{{"rms_3d_m", or_null(s.position_rms_m)},
              {"rms_e_m", or_null(s.position_rms_enu_m.x())},
              {"rms_n_m", or_null(s.position_rms_enu_m.y())},
              {"rms_u_m", or_null(s.position_rms_enu_m.z())},
              {"velocity_rms_m_s", vector_json(s.velocity_rms_enu_m_s)},
              {"final_error_m", or_null(s.final_error_m)},
              {"final_horizontal_error_m", or_null(s.final_horizontal_m)}};
}

Json scored_json(const DeadReckoning& o) {
  if (o.errors.size() < 2) return nullptr;
  const GpsTime week = GpsTime::from_week_sow(o.errors.front().t.week(), 0.0);
  const Unscored left = unscored(o);
  return Json{{"from_sow_s", o.errors.front().t - week},
              {"to_sow_s", o.errors.back().t - week},
              {"duration_s", o.errors.back().t - o.errors.front().t},
              {"unscored_before_s", left.before_s},
              {"unscored_behind_s", left.behind_s}};
}

void append_row(std::string& out, const char* format, auto... values) {
  char row[400];
  std::snprintf(row, sizeof row, format, values...);
  out += row;
}

std::string drift_csv(const DeadReckoning& o) {
  std::string out =
      "t_s,error_e_m,error_n_m,error_u_m,error_ve_m_s,error_vn_m_s,error_vu_m_s,error_roll_deg,error_pitch_deg,"
      "error_yaw_deg\n";
  for (std::size_t k = 0; k < o.errors.size(); ++k) {
    if (k % kRowsPerLook == 0) throw_if_cancelled();
    const fusion::NavError& e = o.errors[k];
    const Eigen::Vector3d p = e.position_enu_m, v = e.velocity_enu_m_s, a = e.attitude_rad / kDegree;
    const bool held = k < o.held.count;
    append_row(out, "%.9f,", o.since_start_s(e.t));
    out += held ? "" : ",,,";
    if (held) append_row(out, "%.7f,%.7f,%.7f,", p.x(), p.y(), p.z());
    if (held && v.allFinite()) {
      append_row(out, "%.9f,%.9f,%.9f,", v.x(), v.y(), v.z());
    } else {
      out += ",,,";
    }
    append_row(out, "%.10f,%.10f,%.10f\n", a.x(), a.y(), a.z());
  }
  return out;
}

std::string heading_csv(const DeadReckoning& o, const PlainIntegrals& plain) {
  std::string out = "t_s,roll_deg,pitch_deg,heading_deg,angle_x_deg,angle_y_deg,angle_z_deg\n";
  for (std::size_t k = 0; k < plain.t_s.size(); ++k) {
    if (k % kRowsPerLook == 0) throw_if_cancelled();
    const fusion::NavState& s = o.states[k + 1];
    const NedAttitude a = ned_attitude(geodetic_from_ecef(s.p_EU_E), s.R_EU);
    append_row(out, "%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f\n", plain.t_s[k], a.roll_rad / kDegree, a.pitch_rad / kDegree,
               a.heading_rad / kDegree, plain.angle_deg[0][k], plain.angle_deg[1][k], plain.angle_deg[2][k]);
  }
  return out;
}

}  // namespace

Json dead_reckoning_json(const DeadReckoning& o) {
  const fusion::NavErrorStatistics none = fusion::navigation_error_statistics({});
  Json out = position_json(o.holds() ? o.statistics : none);
  out["attitude_rms_deg"] = vector_json(o.statistics.attitude_rms_rad / kDegree);
  out["holds_until_s"] = o.holds() ? Json(nullptr) : Json(o.since_start_s(*o.held.until));
  out["reason"] = o.holds() ? Json(nullptr) : Json(rounding_reason(o));
  out["rounding_m"] = or_null(o.held.rounding_m);
  if (!o.holds()) out["held"] = position_json(o.held_ones);
  out["integrator"] = o.integrator;
  out["gravity"] = o.gravity;
  out["samples"] = o.states.size() - 1;
  out["gaps"] = o.recording.gaps.count;
  out["compared"] = o.errors.empty() ? 0 : o.errors.size() - 1;
  out["start_sow_s"] = o.states.front().t.sow_s();
  out["duration_s"] = o.states.back().t - o.states.front().t;
  out["scored"] = scored_json(o);
  return out;
}

Status write_dead_reckoning(const DeadReckoning& o, const PlainIntegrals& plain, const std::string& folder) {
  NavigationFile path;
  path.gravity = o.gravity;
  for (const fusion::NavState& s : o.states) path.records.push_back({s.t, {s.R_EU, s.p_EU_E}, s.v_EU_E});
  CANYON_TRY_STATUS(write_navigation_file(folder + "/estimate.nav", path));
  CANYON_TRY_STATUS(write_text_file(folder + "/heading.csv", heading_csv(o, plain)));
  if (!o.errors.empty()) CANYON_TRY_STATUS(write_text_file(folder + "/drift.csv", drift_csv(o)));
  return write_text_file(folder + "/summary.json", json_text(dead_reckoning_json(o), 2) + "\n");
}

}  // namespace canyon::study
