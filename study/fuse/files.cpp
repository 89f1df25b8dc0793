#include "canyon/study/fuse/files.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/files/navigation_file.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/study/results/verdict_json.h"

namespace canyon::study {
namespace {

Json windows_json(const std::vector<OutageWindow>& windows) {
  Json out = Json::array();
  for (const OutageWindow& w : windows) {
    const bool known = w.instants > 0;
    out.push_back({{"from_sow_s", w.begin.sow_s()},
                   {"to_sow_s", w.end.sow_s()},
                   {"horizontal_max_m", or_null(known ? w.horizontal_max_m : kNaN)},
                   {"vertical_max_m", or_null(known ? w.vertical_max_m : kNaN)},
                   {"instants", w.instants}});
  }
  return out;
}

Json outage_json(const std::vector<OutageWindow>& windows) {
  if (windows.empty()) return nullptr;
  const OutageScore score = outage_score(windows);
  return {{"horizontal_rms_of_max_m", or_null(score.horizontal_rms_of_max_m)},
          {"vertical_rms_of_max_m", or_null(score.vertical_rms_of_max_m)},
          {"count", score.count},
          {"horizontal_mean_of_max_m", or_null(score.horizontal_mean_of_max_m)},
          {"vertical_mean_of_max_m", or_null(score.vertical_mean_of_max_m)},
          {"windows", windows_json(windows)}};
}

Json innovations_json(const Fused& run) {
  Json out = Json::object();
  for (const auto& [name, score] : run.by_measurement)
    out[name] = {{"count", score.count}, {"accepted", score.accepted}, {"nis_mean", or_null(score.nis_mean())}};
  return out;
}

Json parameters_json(const Fused& run) {
  Json out = Json::object();
  for (const FuseParameter& p : run.parameters)
    out[p.name] = {{"value", p.value}, {"sigma", p.sigma}, {"sigma_at_start", p.sigma_at_start}};
  return out;
}

/// What was wrong with what reached the filter; those of nothing are left out.
Json incidents_json(const fusion::Incidents& incidents) {
  Json out = Json::object();
  for (int i = 1; i < fusion::kTroubles; ++i) {
    const auto trouble = static_cast<fusion::Trouble>(i);
    if (incidents.count(trouble) == 0 || trouble == fusion::Trouble::kAhead) continue;
    out[fusion::trouble_key(trouble)] = {{"count", incidents.count(trouble)},
                                         {"first_sow_s", incidents.first(trouble).sow_s()},
                                         {"what", fusion::trouble_text(trouble)}};
  }
  return out;
}

/// Means of (error / sigma)^2 and the filter's own sigmas, of the instants that are scored.
Json consistency_json(const FuseScore& s) {
  return {{"position_enu", vector_json(s.position_ratio)},
          {"velocity_enu", vector_json(s.velocity_ratio)},
          {"attitude", vector_json(s.attitude_ratio)},
          {"position_sigma_m", vector_json(s.position_sigma_m)},
          {"velocity_sigma_m_s", vector_json(s.velocity_sigma_m_s)},
          {"attitude_sigma_deg", vector_json(s.attitude_sigma_rad / kDegree)}};
}

/// Errors against the reference, over all instants that count.
Json score_json(const FuseScore& s) {
  return {{"rms_3d_m", or_null(s.rms_3d_m)},
          {"rms_e_m", or_null(s.position_rms_m.x())},
          {"rms_n_m", or_null(s.position_rms_m.y())},
          {"rms_u_m", or_null(s.position_rms_m.z())},
          {"velocity_rms_m_s", vector_json(s.velocity_rms_m_s)},
          {"attitude_rms_deg", vector_json(s.attitude_rms_rad / kDegree)},
          {"nees_mean", or_null(s.nees_mean)},
          {"final_error_m", or_null(s.final_error_m)},
          {"final_horizontal_error_m", or_null(s.final_horizontal_m)},
          {"compared", s.instants},
          {"consistency", consistency_json(s)}};
}

Json smoothed_json(const FuseSmoothed& smoothed) {
  Json out{{"name", smoothed.smoother}, {"states", smoothed.epochs.size()}};
  out.update(score_json(fuse_score(smoothed.errors)));
  out["outage"] = outage_json(smoothed.windows);
  return out;
}

/// Rows of a table as they come, looked at now and then for whether the user wants to stop.
class Rows {
 public:
  explicit Rows(std::string header) : text_(std::move(header)) { text_ += '\n'; }
  template <class... Values>
  void add(const char* format, Values... values) {
    constexpr std::size_t kRowsPerLook = 1024;
    if (count_++ % kRowsPerLook == 0) throw_if_cancelled();
    text_ += printed(format, values...);
  }
  void vector(const Eigen::Vector3d& v, int decimals) {
    for (const double x : v) number(x, decimals);
  }
  void number(double x, int decimals) { text_ += std::isfinite(x) ? printed(",%.*f", decimals, x) : ","; }
  void exact(double x) { text_ += printed(",%.9g", x); }
  void end() { text_ += '\n'; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::size_t count_ = 0;
};

std::string nav_csv(const std::vector<FuseEpoch>& epochs) {
  std::string header =
      "gps_week,sow,lat_deg,lon_deg,h_m,vn_m_s,ve_m_s,vu_m_s,roll_deg,pitch_deg,heading_deg,gyro_bias_x_rad_s,"
      "gyro_bias_y_rad_s,gyro_bias_z_rad_s,accel_bias_x_m_s2,accel_bias_y_m_s2,accel_bias_z_m_s2";
  for (int i = 0; i < 9; ++i)
    for (int j = i; j < 9; ++j) header += printed(",p_%d_%d", i, j);
  Rows rows(header);
  for (const FuseEpoch& e : epochs) {
    const Geodetic at = geodetic_from_ecef(e.nav.p_EU_E);
    const Eigen::Vector3d v = rotation_E_from_enu(at).transpose() * e.nav.v_EU_E;
    const NedAttitude a = ned_attitude(at, e.nav.R_EU);
    rows.add("%d,%.9f,%.11f,%.11f,%.5f,%.6f,%.6f,%.6f,%.8f,%.8f,%.8f", e.nav.t.week(), e.nav.t.sow_s(),
             at.lat_rad / kDegree, at.lon_rad / kDegree, at.h_m, v.y(), v.x(), v.z(), a.roll_rad / kDegree,
             a.pitch_rad / kDegree, a.heading_rad / kDegree);
    for (const Eigen::Vector3d* bias : {&e.estimate.gyro_bias_U, &e.estimate.accel_bias_U})
      for (const double x : *bias) rows.exact(x);
    for (int i = 0; i < 9; ++i)
      for (int j = i; j < 9; ++j) rows.exact(e.covariance(i, j));
    rows.end();
  }
  return rows.text();
}

std::string innovations_csv(const Fused& run) {
  Rows rows("gps_week,sow,measurement,accepted,dimension,nis,innovation_1,innovation_2,innovation_3");
  for (const fusion::UpdateReport& u : run.updates) {
    rows.add("%d,%.9f,%s,%d,%d", u.t.week(), u.t.sow_s(), u.measurement, u.accepted ? 1 : 0, u.dimension);
    rows.number(u.dimension > 0 ? u.nis : kNaN, 5);
    for (int i = 0; i < 3; ++i) rows.number(i < u.dimension ? u.innovation[i] : kNaN, 6);
    rows.end();
  }
  return rows.text();
}

std::string errors_csv(const std::vector<FuseError>& errors) {
  Rows rows(
      "gps_week,sow,scored,error_e_m,error_n_m,error_u_m,sigma_e_m,sigma_n_m,sigma_u_m,error_ve_m_s,error_vn_m_s,"
      "error_vu_m_s,sigma_ve_m_s,sigma_vn_m_s,sigma_vu_m_s,error_roll_deg,error_pitch_deg,error_yaw_deg,"
      "sigma_roll_deg,sigma_pitch_deg,sigma_yaw_deg,nees");
  for (const FuseError& e : errors) {
    rows.add("%d,%.9f,%d", e.t.week(), e.t.sow_s(), e.counts ? 1 : 0);
    rows.vector(e.position_enu_m, 6);
    rows.vector(e.position_sigma_m, 6);
    rows.vector(e.velocity_enu_m_s, 7);
    rows.vector(e.velocity_sigma_m_s, 7);
    rows.vector(e.attitude_rad / kDegree, 8);
    rows.vector(e.attitude_sigma_rad / kDegree, 8);
    rows.number(e.nees, 5);
    rows.end();
  }
  return rows.text();
}

std::string kml(const Fused& run) {
  constexpr double kEvery_s = 1.0;
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>\n"
      "<Placemark><name>estimate</name><LineString><altitudeMode>absolute</altitudeMode><coordinates>\n";
  const FuseEpoch* before = nullptr;
  for (const FuseEpoch& e : run.epochs) {
    if (before != nullptr && e.nav.t - before->nav.t < kEvery_s - 1e-6) continue;
    before = &e;
    const Geodetic at = geodetic_from_ecef(e.nav.p_EU_E);
    out += printed("%.9f,%.9f,%.3f\n", at.lon_rad / kDegree, at.lat_rad / kDegree, at.h_m);
  }
  return out + "</coordinates></LineString></Placemark>\n</Document></kml>\n";
}

}  // namespace

Json fuse_json(const FuseInputs& in, const Fused& run, const FuseSmoothed* smoothed) {
  const FuseScore s = fuse_score(run.errors);
  const auto position = run.by_measurement.find("position");
  Json out = score_json(s);
  out["nis_mean"] = or_null(position == run.by_measurement.end() ? kNaN : position->second.nis_mean());
  out["outage"] = outage_json(run.windows);
  out.update(Json{{"smoother", smoothed != nullptr ? smoothed_json(*smoothed) : Json(nullptr)},
                  {"innovations", innovations_json(run)},
                  {"estimated", parameters_json(run)},
                  {"verdict", fusion::verdict_lines(run.verdict)},
                  {"evidence", evidence_json(run.verdict)},
                  {"start", {{"from", run.start_from}, {"sow_s", run.start.sow_s()}, {"week", run.start.week()}}},
                  {"duration_s", run.end - run.start},
                  {"states", run.states},
                  {"measurements", run.measurements},
                  {"samples", run.samples},
                  {"fixes", run.fixes_given},
                  {"fixes_accepted", run.fixes_accepted},
                  {"fixes_withheld", run.fixes_withheld},
                  {"messages_outside", run.messages_outside},
                  {"gaps_bridged", run.gaps_bridged},
                  {"bridged_s", run.bridged_s},
                  {"restarts", run.restarts},
                  {"taken_late", run.replays},
                  {"incidents", incidents_json(run.incidents)},
                  {"inputs", {{"imu", in.imu.path}, {"gnss", in.gnss_path}, {"truth", in.truth.path}}},
                  {"diagnoses", in.diagnoses}});
  return out;
}

namespace {

Status write_navigation(const std::string& path, const std::vector<FuseEpoch>& epochs) {
  NavigationFile file;
  for (const FuseEpoch& e : epochs) file.records.push_back({e.nav.t, {e.nav.R_EU, e.nav.p_EU_E}, e.nav.v_EU_E});
  return write_navigation_file(path, file);
}

}  // namespace

Status write_fused(const FuseInputs& in, const Fused& run, const FuseSmoothed* smoothed, const std::string& folder) {
  Trajectory body;
  for (const FuseEpoch& e : run.epochs)
    if (body.empty() || body.poses().back().t < e.nav.t) body.append({e.nav.t, e.estimate.X_WB});
  CANYON_TRY_STATUS(write_navigation(folder + "/estimate.nav", run.epochs));
  CANYON_TRY_STATUS(write_tum(folder + "/estimate.tum", body));
  CANYON_TRY_STATUS(write_text_file(folder + "/estimate.kml", kml(run)));
  CANYON_TRY_STATUS(write_text_file(folder + "/nav.csv", nav_csv(run.epochs)));
  CANYON_TRY_STATUS(write_text_file(folder + "/innovations.csv", innovations_csv(run)));
  if (!run.errors.empty()) CANYON_TRY_STATUS(write_text_file(folder + "/errors.csv", errors_csv(run.errors)));
  if (smoothed != nullptr) {
    CANYON_TRY_STATUS(write_navigation(folder + "/smoothed.nav", smoothed->epochs));
    CANYON_TRY_STATUS(write_text_file(folder + "/smoothed.csv", nav_csv(smoothed->epochs)));
    if (!smoothed->errors.empty())
      CANYON_TRY_STATUS(write_text_file(folder + "/smoothed_errors.csv", errors_csv(smoothed->errors)));
  }
  return write_text_file(folder + "/summary.json", json_text(fuse_json(in, run, smoothed), 2) + "\n");
}

}  // namespace canyon::study
