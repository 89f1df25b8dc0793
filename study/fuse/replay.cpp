#include "canyon/study/fuse/replay.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/units.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::study {
namespace {

/// The tree of a configuration as JSON keeps it.
ConfigNode node_of(const nlohmann::json& json) {
  ConfigNode node;
  if (json.is_boolean()) {
    node.value_ = json.get<bool>();
  } else if (json.is_number_integer()) {
    node.value_ = json.get<std::int64_t>();
  } else if (json.is_number()) {
    node.value_ = json.get<double>();
  } else if (json.is_string()) {
    node.value_ = json.get<std::string>();
  } else if (json.is_array()) {
    ConfigNode::Array items;
    for (const auto& item : json) items.push_back(node_of(item));
    node.value_ = std::move(items);
  } else if (json.is_object()) {
    ConfigNode::Table table;
    for (const auto& [key, value] : json.items())
      if (!value.is_null()) table[key] = node_of(value);
    node.value_ = std::move(table);
  }
  return node;
}

Result<nlohmann::json> read_json(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_file(path));
  return parse_json(text, path);
}

Error lacks(const std::string& path, const std::string& key) {
  return Error{path, 0, key, "is not there, or is something else", "a results directory of canyon run or compare"};
}

Result<std::vector<double>> numbers_at(const nlohmann::json& json, const std::string& path, const std::string& run,
                                       const char* key, std::size_t count) {
  const auto pointer = nlohmann::json::json_pointer("/initial_estimates/" + run + "/" + key);
  std::vector<double> out;
  if (json.contains(pointer) && json.at(pointer).is_array())
    for (const auto& item : json.at(pointer))
      if (item.is_number()) out.push_back(item.get<double>());
  if (out.size() != count) return lacks(path, std::string("initial_estimates.") + run + "." + key);
  return out;
}

/// A table of a sensor log: rows of fields by the names of its header.
class LogRows {
 public:
  static Result<LogRows> open(const std::string& path, const std::vector<std::string>& columns) {
    CANYON_TRY(std::string text, read_text_file(path));
    LogRows out(path, std::move(text));
    std::string_view header;
    if (!out.in_.next(header)) return out.in_.empty_file("samples");
    const auto names = split(header, ",", false);
    for (const std::string& column : columns) {
      const auto at = std::find(names.begin(), names.end(), column);
      if (at == names.end()) return out.in_.error("no column " + column, "as docs/results.md says");
      out.places_.push_back(static_cast<std::size_t>(at - names.begin()));
    }
    out.columns_ = names.size();
    return out;
  }
  /// False at the end.
  Result<bool> next() {
    std::string_view line;
    if (!in_.next(line)) return false;
    split(line, ",", false, fields_);
    if (fields_.size() == columns_) return true;
    return in_.error(std::to_string(fields_.size()) + " fields", std::to_string(columns_) + " as in the header");
  }
  std::string_view text(std::size_t column) const { return fields_[places_[column]]; }
  /// NaN of an empty field.
  Result<double> number(std::size_t column) const {
    if (text(column).empty()) return kNaN;
    return parse_number(in_, text(column));
  }
  Result<GpsTime> time(std::size_t column, GpsTime start) const {
    CANYON_TRY(const double ns, number(column));
    if (!(std::abs(ns) < 4e15)) return in_.error("no time", "whole nanoseconds since the start");
    start.ns += static_cast<std::int64_t>(ns);
    return start;
  }
  Result<Eigen::Vector3d> three(std::size_t first) const {
    Eigen::Vector3d out;
    for (std::size_t i = 0; i < 3; ++i) {
      CANYON_TRY(out[static_cast<Eigen::Index>(i)], number(first + i));
    }
    return out;
  }
  Result<Eigen::Matrix3d> square(std::size_t first) const {
    Eigen::Matrix3d out;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) {
        CANYON_TRY(out(i, j), number(first++));
        out(j, i) = out(i, j);
      }
    return out;
  }
  Error error(const char* what) const { return in_.error(what, "as docs/results.md says"); }

 private:
  LogRows(const std::string& path, std::string text) : in_(path, std::move(text)) {}
  LineReader in_;
  std::vector<std::size_t> places_;
  std::size_t columns_ = 0;
  std::vector<std::string_view> fields_;
};

Result<std::vector<ImuSample>> read_samples(const std::string& path, GpsTime start) {
  CANYON_TRY(auto rows,
             LogRows::open(path, {"t_ns", "dt_s", "gx_rad", "gy_rad", "gz_rad", "ax_m_s", "ay_m_s", "az_m_s", "lost"}));
  std::vector<ImuSample> out;
  while (true) {
    CANYON_TRY(const bool more, rows.next());
    if (!more) break;
    ImuSample s;
    CANYON_TRY(s.t, rows.time(0, start));
    CANYON_TRY(s.dt_s, rows.number(1));
    CANYON_TRY(s.dtheta_U, rows.three(2));
    CANYON_TRY(s.dv_U, rows.three(5));
    CANYON_TRY(const double lost, rows.number(8));
    s.lost = lost != 0.0;
    if (!(s.dt_s > 0.0) || !s.dtheta_U.allFinite() || !s.dv_U.allFinite()) return rows.error("no sample");
    out.push_back(s);
  }
  if (out.empty()) return Error{path, 0, "", "holds no samples", "at least one"};
  return out;
}

Result<std::vector<GnssFix>> read_fixes(const std::string& path, GpsTime start, std::size_t& withheld) {
  CANYON_TRY(
      auto rows,
      LogRows::open(path, {"t_ns",   "offered",   "status",    "x_m",       "y_m",       "z_m",       "xx_m2",
                           "xy_m2",  "xz_m2",     "yy_m2",     "yz_m2",     "zz_m2",     "vx_m_s",    "vy_m_s",
                           "vz_m_s", "vxx_m2_s2", "vxy_m2_s2", "vxz_m2_s2", "vyy_m2_s2", "vyz_m2_s2", "vzz_m2_s2"}));
  std::vector<GnssFix> out;
  while (true) {
    CANYON_TRY(const bool more, rows.next());
    if (!more) break;
    GnssFix fix;
    CANYON_TRY(fix.t, rows.time(0, start));
    withheld += rows.text(1) == "0" ? 1 : 0;
    if (rows.text(1) == "0" || rows.text(2) == "none") continue;
    fix.status = rows.text(2) == "differential" ? FixStatus::kDifferential : FixStatus::kSingle;
    CANYON_TRY(fix.p_A_E, rows.three(3));
    CANYON_TRY(fix.covariance_E, rows.square(6));
    CANYON_TRY(fix.v_A_E, rows.three(12));
    CANYON_TRY(fix.velocity_covariance_E, rows.square(15));
    if (!fix.p_A_E.allFinite() || !fix.covariance_E.allFinite()) return rows.error("no fix");
    out.push_back(fix);
  }
  return out;
}

/// "G05"; nothing of what is no satellite.
std::optional<SatelliteId> satellite_of(std::string_view name) {
  for (const GnssSystem system : {GnssSystem::kGps, GnssSystem::kGlonass, GnssSystem::kGalileo, GnssSystem::kBeidou,
                                  GnssSystem::kQzss, GnssSystem::kSbas}) {
    if (name.size() != 3 || name[0] != system_letter(system)) continue;
    if (name[1] < '0' || name[1] > '9' || name[2] < '0' || name[2] > '9') continue;
    return SatelliteId{system, static_cast<std::uint8_t>(10 * (name[1] - '0') + (name[2] - '0'))};
  }
  return std::nullopt;
}

Result<std::vector<DueRanges>> read_ranges(const std::string& path, GpsTime start) {
  std::vector<DueRanges> out;
  if (!std::filesystem::exists(path)) return out;
  CANYON_TRY(auto rows,
             LogRows::open(path, {"t_ns", "offered", "received_ns", "satellite", "corrected_m", "rate_m_s", "sigma_m",
                                  "cn0_dbhz", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s"}));
  while (true) {
    CANYON_TRY(const bool more, rows.next());
    if (!more) return out;
    CANYON_TRY(const GpsTime t, rows.time(0, start));
    if (rows.text(1) == "0") continue;
    CANYON_TRY(const GpsTime received, rows.time(2, start));
    const auto sv = satellite_of(rows.text(3));
    if (!sv) return rows.error("no satellite");
    GnssObservation o;
    o.sv = *sv;
    CANYON_TRY(o.pseudorange_m, rows.number(4));  // the corrections are in it
    CANYON_TRY(o.rate_m_s, rows.number(5));
    CANYON_TRY(o.sigma_m, rows.number(6));
    CANYON_TRY(o.cn0_dbhz, rows.number(7));
    CANYON_TRY(o.p_E, rows.three(8));
    CANYON_TRY(o.v_E, rows.three(11));
    if (out.empty() || out.back().due != t) out.push_back({.due = t, .epoch = {.t = received, .observations = {}}});
    out.back().epoch.observations.push_back(o);
  }
}

Result<std::vector<OdometerSample>> read_counts(const std::string& path, GpsTime start) {
  std::vector<OdometerSample> out;
  if (!std::filesystem::exists(path)) return out;
  CANYON_TRY(auto rows, LogRows::open(path, {"t_ns", "dt_s", "ticks", "speed_m_s"}));
  while (true) {
    CANYON_TRY(const bool more, rows.next());
    if (!more) return out;
    OdometerSample s;
    CANYON_TRY(s.t, rows.time(0, start));
    CANYON_TRY(s.dt_s, rows.number(1));
    CANYON_TRY(const double ticks, rows.number(2));
    CANYON_TRY(s.speed_m_s, rows.number(3));
    if (!(s.dt_s > 0.0) || !(std::abs(ticks) < 9e15) || !std::isfinite(s.speed_m_s)) return rows.error("no count");
    s.ticks = static_cast<std::int64_t>(ticks);
    out.push_back(s);
  }
}

/// What a sensor measured, in `columns` beside the time; nothing where it has no log.
template <class Sample, class Take>
Result<std::vector<Sample>> read_measured(const std::string& path, GpsTime start, std::vector<std::string> columns,
                                          const Take& take) {
  std::vector<Sample> out;
  if (!std::filesystem::exists(path)) return out;
  columns.insert(columns.begin(), "t_ns");
  CANYON_TRY(auto rows, LogRows::open(path, columns));
  while (true) {
    CANYON_TRY(const bool more, rows.next());
    if (!more) return out;
    Sample sample;
    CANYON_TRY(sample.t, rows.time(0, start));
    CANYON_TRY_STATUS(take(rows, sample));
    out.push_back(sample);
  }
}

Result<std::vector<BarometerSample>> read_pressures(const std::string& path, GpsTime start) {
  return read_measured<BarometerSample>(path, start, {"pressure_pa"}, [](const LogRows& rows, auto& s) -> Status {
    CANYON_TRY(s.pressure_pa, rows.number(1));
    return std::isfinite(s.pressure_pa) ? Status(Ok{}) : rows.error("no pressure");
  });
}

Result<std::vector<MagnetometerSample>> read_fields(const std::string& path, GpsTime start) {
  return read_measured<MagnetometerSample>(path, start, {"x_t", "y_t", "z_t"},
                                           [](const LogRows& rows, auto& s) -> Status {
                                             CANYON_TRY(s.field_U_t, rows.three(1));
                                             return s.field_U_t.allFinite() ? Status(Ok{}) : rows.error("no field");
                                           });
}

/// The true poses of the vehicle, and the instants of the run's epochs.
Status read_epochs(const std::string& path, const LocalFrame& frame, GpsTime start, double rate_hz, RecordedRun& out) {
  CANYON_TRY(const Trajectory trajectory, read_csv_trajectory(path));
  out.inputs.truth = {.path = path, .states = {}, .has_attitude = true, .has_velocity = false, .of = TruthPoint::kBody};
  for (const StampedPose& pose : trajectory.poses()) {
    // The file has milliseconds.
    const GpsTime t = tick(start, std::llround((pose.t - start) * rate_hz), rate_hz);
    fusion::NavState state;
    state.t = t;
    state.R_EU = (Eigen::Quaterniond(frame.R_EW()) * pose.X_WB.R).normalized();
    state.p_EU_E = frame.to_E(pose.X_WB.p);
    state.v_EU_E.setConstant(kNaN);
    out.inputs.truth.states.push_back(state);
    out.plan.epochs.push_back(t);
  }
  return Ok{};
}

Result<LocalFrame> frame_of(const std::string& directory) {
  const std::string path = directory + "/summary.json";
  CANYON_TRY(const auto json, read_json(path));
  const auto origin = nlohmann::json::json_pointer("/scene/origin");
  double v[3] = {};
  int i = 0;
  for (const char* key : {"lat_deg", "lon_deg", "h_m"}) {
    if (!json.contains(origin / key) || !json.at(origin / key).is_number()) return lacks(path, "scene.origin");
    v[i++] = json.at(origin / key).get<double>();
  }
  return LocalFrame({v[0] * kDegree, v[1] * kDegree, v[2]});
}

Result<mission::MissionConfig> config_of(const nlohmann::json& manifest, const std::string& path,
                                         const std::string& run) {
  if (!manifest.contains("configuration") || !manifest["configuration"].is_object())
    return lacks(path, "configuration");
  std::vector<std::string> names;
  for (const auto& [name, value] : manifest["configuration"].items()) names.push_back(name);
  const auto& runs = manifest["configuration"];
  if (!runs.contains(run)) {
    Error error = unknown_name("--run", run, names);
    error.file = path;
    return error;
  }
  mission::MissionConfig config;
  const ConfigNode node = node_of(runs[run]);
  if (const Status read = read_config(&node, "", config); !read.ok()) {
    Error error = read.error();
    error.file = path;
    return error;
  }
  return config;
}

}  // namespace

Result<RecordedRun> read_recorded_run(const std::string& directory, const std::string& run) {
  const std::string manifest_path = directory + "/manifest.json";
  CANYON_TRY(const auto manifest, read_json(manifest_path));
  CANYON_TRY(const mission::MissionConfig config, config_of(manifest, manifest_path, run));
  const std::string stem = directory + "/epochs/" + run;
  if (!config.run.record_filter_input || !std::filesystem::exists(stem + "_imu.csv"))
    return Error{directory, 0, "run.record_filter_input", "the run \"" + run + "\" did not record its filter's input",
                 "true in the mission"};
  RecordedRun out;
  out.manifest = manifest_path;
  out.inputs.of_run = run;
  CANYON_TRY(const GpsTime start, mission::start_time(config));
  CANYON_TRY(out.plan.frame, frame_of(directory));
  CANYON_TRY(out.plan.noise, mission::noise_told_to_filter(config));
  CANYON_TRY(const auto p, numbers_at(manifest, manifest_path, run, "position_m", 3));
  CANYON_TRY(const auto q, numbers_at(manifest, manifest_path, run, "attitude_wxyz", 4));
  CANYON_TRY(const auto v, numbers_at(manifest, manifest_path, run, "velocity_m_s", 3));
  FusePlan& plan = out.plan;
  plan.filter = config.fusion;
  plan.lever_U_B = config.imu.lever_arm_m;
  plan.lever_A_B = config.gnss.lever_arm_m;
  plan.start_from = "the run " + run;
  plan.start = start;
  plan.X_WB = {Eigen::Quaterniond(q[0], q[1], q[2], q[3]), Eigen::Vector3d(p[0], p[1], p[2])};
  plan.v_WB_W = Eigen::Vector3d(v[0], v[1], v[2]);
  plan.rate_hz = 0.0;
  plan.timeline = fusion::TimelineConfig::as_recorded();
  plan.interval_s = 1.0 / config.imu.rate_hz;

  out.inputs.imu.path = stem + "_imu.csv";
  out.inputs.gnss_path = stem + "_fixes.csv";
  out.inputs.odometer_path = stem + "_odometer.csv";
  CANYON_TRY(out.inputs.imu.samples, read_samples(out.inputs.imu.path, start));
  out.inputs.imu.interval_s = plan.interval_s;
  std::size_t withheld = 0;
  CANYON_TRY(out.inputs.fixes, read_fixes(out.inputs.gnss_path, start, withheld));
  if (withheld > 0) out.inputs.diagnoses["fixes_marked_withheld"] = withheld;
  CANYON_TRY(out.inputs.ranges, read_ranges(stem + "_ranges.csv", start));
  CANYON_TRY(out.inputs.odometer, read_counts(out.inputs.odometer_path, start));
  CANYON_TRY(out.inputs.barometer, read_pressures(stem + "_barometer.csv", start));
  CANYON_TRY(out.inputs.magnetometer, read_fields(stem + "_magnetometer.csv", start));
  CANYON_TRY_STATUS(read_epochs(stem + "_nav.csv", plan.frame, start, config.run.epoch_rate_hz, out));
  for (std::size_t k = 0; k < out.inputs.imu.samples.size(); ++k)
    plan.due.push_back(tick(start, static_cast<std::int64_t>(k) + 1, config.imu.rate_hz));
  return out;
}

namespace {

/// Keys that say how logs are read.
Status refuse_keys_of_logs(const FuseConfig& config) {
  for (const char* key :
       {"imu.columns", "imu.axes", "imu.turn_deg", "imu.instantaneous", "imu.clock_offset_s", "imu.lever_m",
        "imu.bridge_s", "gnss", "odometer", "heading", "poses", "truth", "start", "timeline", "output"})
    if (config.file.find(key) != nullptr)
      return at_key(config, key, "is of logs, and a recorded run has its own",
                    "[fusion], the figures of [imu], [score]");
  return Ok{};
}

}  // namespace

Status take_config(const FuseConfig& config, RecordedRun& run) {
  CANYON_TRY_STATUS(refuse_keys_of_logs(config));
  const bool own_filter = config.file.find("fusion") == nullptr;
  if (!own_filter) run.plan.filter = config.fusion;
  if (config.imu.sensor_given) {
    CANYON_TRY(run.plan.noise, fuse_noise(config));
  }
  run.plan.skip_s = config.score.skip_s;
  FuseConfig checked = config;
  checked.fusion = run.plan.filter;
  const Status fits = check_fuse_filter(run.inputs, checked);
  if (fits.ok() || !own_filter) return fits;
  Error error = fits.error();
  error.file = run.manifest;
  return error;
}

}  // namespace canyon::study
