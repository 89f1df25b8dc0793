#include "canyon/study/dead_reckoning/reference.h"

#include <algorithm>
#include <cstdio>

#include "canyon/core/config/text.h"
#include "canyon/fusion/dead_reckoning.h"
#include "canyon/fusion/reference_track.h"

namespace canyon::study {
namespace {

fusion::NavState state_of(const NavigationRecord& record) {
  return {.t = record.t, .R_EU = record.X_EU.R, .p_EU_E = record.X_EU.p, .v_EU_E = record.v_EU_E};
}

}  // namespace

std::string of_week(GpsTime first, GpsTime last) {
  const GpsTime week = GpsTime::from_week_sow(first.week(), 0.0);
  char text[80];
  std::snprintf(text, sizeof text, "%.3f to %.3f s of the week", first - week, last - week);
  return text;
}

Result<Reference> reference_from_file(const NavigationFile& truth, const std::string& path,
                                      const ImuRecording& recording) {
  const std::vector<ImuSample>& samples = recording.samples;
  std::vector<fusion::NavState> states;
  for (const NavigationRecord& record : truth.records) states.push_back(state_of(record));
  const auto start = fusion::first_common_state(states, samples);
  if (!start)
    return Error{path, 0, "", "covers " + of_week(states.front().t, states.back().t),
                 "times from " + of_week(samples.front().t - samples.front().dt_s, samples.back().t) + ", as in " +
                     recording.path};
  if (!start->v_EU_E.allFinite()) return Error{path, 0, "", "has no velocity to start from", "columns vn,ve,vd"};
  return Reference{*start, fusion::reference_from(*start, states), truth.gravity};
}

Status check_stated_gravity(const NavigationFile& truth, const std::string& path) {
  const std::vector<std::string> known = gravity_names();
  if (truth.gravity.empty() || std::find(known.begin(), known.end(), truth.gravity) != known.end()) return Ok{};
  const std::string nearest = nearest_word(truth.gravity, known);
  return Error{
      path, truth.gravity_line, "# gravity", "unknown name \"" + truth.gravity + "\"",
      "one of " + quoted_list(known) + ", or --gravity" + (nearest.empty() ? "" : "; nearest is \"" + nearest + "\"")};
}

Reference reference_from_state(const InitialState& state, const ImuRecording& recording) {
  Reference out;
  const Eigen::Vector3d& v = state.v_ned_m_s;
  out.initial.t = recording.samples.front().t;
  out.initial.p_EU_E = ecef_from_geodetic(state.place);
  out.initial.R_EU = attitude_from_ned(state.place, state.roll_rad, state.pitch_rad, state.heading_rad);
  out.initial.v_EU_E = rotation_E_from_enu(state.place) * Eigen::Vector3d(v.y(), v.x(), -v.z());
  return out;
}

Reference reference_at_rest(const Geodetic& place, double heading_rad, double level_s, const ImuRecording& recording) {
  const std::vector<ImuSample>& samples = recording.samples;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const ImuSample& s : samples) {
    if (s.t - samples.front().t > level_s) break;
    force += s.dv_U;
  }
  Reference out;
  out.initial = fusion::levelled(place, heading_rad, force);
  out.initial.t = samples.front().t;
  for (const ImuSample& s : samples) {
    out.truth.push_back(out.initial);
    out.truth.back().t = s.t;
  }
  return out;
}

}  // namespace canyon::study
