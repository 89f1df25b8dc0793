#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/json.h"
#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/navigation_file.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/inertial/motion/motion.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  std::string sensor, errors, at, path, points, trajectory, start, out;
  std::vector<std::string> settings;
  double rate_hz = 0.0, duration_s = 0.0;
  std::int64_t seed = 1;
  bool force = false;
};

/// The keys of a motion, and those of the sensor under `imu`.
struct LogConfig {
  inertial::MotionConfig motion;
  inertial::ImuConfig imu;
};
void visit(FieldVisitor& f, LogConfig& c) {
  inertial::visit(f, c.motion);
  f.group("imu", c.imu, "the sensor, as in a mission");
}

constexpr double kUsualDuration_s = 600.0;
constexpr std::size_t kChunk = 256;               // samples
constexpr std::size_t kSamplesPerLook = 4096;     // at whether the user wants to stop
constexpr std::size_t kMostSamples = 10'000'000;  // 14 h at 200 Hz; truth, log and text are held in memory, 6 GB

/// A TOML file (--path), then the other options, then each --set KEY=VALUE.
Result<LogConfig> log_config(const Options& options) {
  ConfigNode node;
  node.value_ = ConfigNode::Table{};
  if (options.path.ends_with(".toml")) {
    CANYON_TRY(node, ConfigNode::load(options.path));
  } else if (!options.path.empty()) {
    node.set("path", ConfigNode::of(options.path), "--path");
  }
  if (!options.points.empty()) {
    node.set("path", ConfigNode::of(std::string("spline")), "--points");
    node.set("file", ConfigNode::of(options.points), "--points");
  }
  if (!options.trajectory.empty()) {
    node.set("path", ConfigNode::of(std::string("recorded")), "--trajectory");
    node.set("file", ConfigNode::of(options.trajectory), "--trajectory");
  }
  if (!options.sensor.empty()) node.set("imu.sensor", ConfigNode::of(options.sensor), "--sensor");
  if (!options.errors.empty()) node.set("imu.errors", ConfigNode::of(options.errors), "--errors");
  if (options.rate_hz > 0.0) node.set("imu.rate_hz", ConfigNode::of(options.rate_hz), "--rate");
  for (const std::string& setting : options.settings) {
    CANYON_TRY(const ConfigNode one, ConfigNode::parse(setting, "--set"));
    node.overlay(one);
  }
  LogConfig config;
  config.imu.rate_hz = 200.0;
  config.imu.lever_arm_m.setZero();
  CANYON_TRY_STATUS(read_config(&node, "", config));
  if (!options.at.empty()) {
    CANYON_TRY(const Geodetic at, parse_place(options.at, "--at"));
    config.motion.lat_deg = at.lat_rad / kDegree;
    config.motion.lon_deg = at.lon_rad / kDegree;
    config.motion.height_m = at.h_m;
  }
  return config;
}

/// What is simulated, sample by sample, and the truth beside it.
struct Simulation {
  inertial::PlacedMotion motion;
  std::string sensor, errors;
  double rate_hz = 0.0, duration_s = 0.0;
  std::vector<ImuSample> truth, measured;
  inertial::IncrementAccuracy accuracy;  ///< of the least accurate true increment
};

Result<double> duration_of(const Options& options, const inertial::PlacedMotion& placed) {
  const double longest_s = placed.motion->duration_s();
  if (options.duration_s == 0.0) return std::isfinite(longest_s) ? longest_s : kUsualDuration_s;
  if (options.duration_s <= longest_s) return options.duration_s;
  char text[80], limit[80];
  std::snprintf(text, sizeof text, "%g s", options.duration_s);
  std::snprintf(limit, sizeof limit, "at most %.9g s, the length of the trajectory", longest_s);
  return Error{"--duration", 0, "", text, limit};
}

inertial::IncrementAccuracy worse(const inertial::IncrementAccuracy& a, const inertial::IncrementAccuracy& b) {
  return {std::max(a.dtheta_rad, b.dtheta_rad), std::max(a.dv_m_s, b.dv_m_s)};
}

Result<Simulation> simulate(const Options& options) {
  CANYON_TRY(const LogConfig config, log_config(options));
  const auto seed = static_cast<std::uint64_t>(options.seed);
  Simulation s;
  s.sensor = config.imu.sensor;
  s.errors = config.imu.errors;
  s.rate_hz = config.imu.rate_hz;
  CANYON_TRY(s.motion, inertial::make_motion(config.motion, seed));
  s.motion.lever_arm_m = config.imu.lever_arm_m;
  if (!options.start.empty()) {
    CANYON_TRY(s.motion.start, GpsTime::parse(options.start, "--start"));
  }
  CANYON_TRY(s.duration_s, duration_of(options, s.motion));
  CANYON_TRY(const auto chain, inertial::make_error_chain(config.imu, seed));

  const auto samples = static_cast<std::size_t>(std::floor(s.duration_s * s.rate_hz * (1.0 + 1e-12)));
  if (samples > kMostSamples)
    return Error{"--duration", 0, "", std::to_string(samples) + " samples",
                 "at most " + std::to_string(kMostSamples) + ": a shorter duration or a lower --rate"};
  if (samples == 0) return Error{"--duration", 0, "", "shorter than one sample", "at least 1 / --rate"};
  s.truth.resize(samples);
  Progress progress("imu simulate", static_cast<double>(samples), !options.common.json);
  std::vector<inertial::IncrementAccuracy> worst((samples - 1) / kChunk + 1);
  parallel_for(samples, kChunk, [&](std::size_t begin, std::size_t end) {
    inertial::IncrementAccuracy& of_chunk = worst[begin / kChunk];
    for (std::size_t k = begin; k < end; ++k) {
      throw_if_cancelled();
      inertial::IncrementAccuracy reached;
      s.truth[k] = inertial::motion_increments(s.motion, static_cast<double>(k) / s.rate_hz,
                                               static_cast<double>(k + 1) / s.rate_hz, &reached);
      of_chunk = worse(of_chunk, reached);
    }
    progress.advance(static_cast<double>(end - begin));
  });
  for (const inertial::IncrementAccuracy& of_chunk : worst) s.accuracy = worse(s.accuracy, of_chunk);
  s.measured = s.truth;
  for (std::size_t k = 0; k < samples; k += kSamplesPerLook) {
    throw_if_cancelled();
    chain->corrupt_batch(static_cast<std::int64_t>(k),
                         std::span(s.measured).subspan(k, std::min(kSamplesPerLook, samples - k)));
  }
  return s;
}

/// Shortest text that reads back to the same bits.
void append_number(std::string& out, double value) {
  char buffer[32];
  const auto [end, status] = std::to_chars(buffer, buffer + sizeof buffer, value);
  out.append(buffer, end);
}

/// Seconds of the start's week, which go on past its end.
void append_time(std::string& out, const Simulation& s, GpsTime t) {
  const std::int64_t ns = t.ns - GpsTime::from_week_sow(s.motion.start.week(), 0.0).ns;
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%lld.%09lld", static_cast<long long>(ns / kNsPerSecond),
                static_cast<long long>(ns % kNsPerSecond));
  out += buffer;
}

void append_six(std::string& out, const Eigen::Vector3d& a, const Eigen::Vector3d& b, char separator) {
  for (const Eigen::Vector3d* v : {&a, &b})
    for (int i = 0; i < 3; ++i) {
      out += separator;
      append_number(out, (*v)[i]);
    }
  out += '\n';
}

constexpr const char* kRatesHeader = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";

/// Mean rates over the true intervals, forward-left-up: an error of the clock is in the stamps alone.
std::string rates_csv(const Simulation& s) {
  std::string out = kRatesHeader;
  for (std::size_t k = 0; k < s.truth.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    const ImuSample& m = s.measured[k];
    append_time(out, s, m.t);
    append_six(out, m.dtheta_U / s.truth[k].dt_s, m.dv_U / s.truth[k].dt_s, ',');
  }
  return out;
}

/// Increments, forward-right-down.
std::string kf_gins_text(const Simulation& s) {
  const Eigen::Vector3d frd(1.0, -1.0, -1.0);
  std::string out;
  for (std::size_t k = 0; k < s.measured.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    const ImuSample& m = s.measured[k];
    append_time(out, s, m.t);
    append_six(out, frd.cwiseProduct(m.dtheta_U), frd.cwiseProduct(m.dv_U), ' ');
  }
  return out;
}

/// What the chain has added, as rates: the truth record of the log, row by row.
std::string errors_csv(const Simulation& s) {
  std::string out = kRatesHeader;
  for (std::size_t k = 0; k < s.truth.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    const ImuSample &m = s.measured[k], &t = s.truth[k];
    append_time(out, s, t.t);
    append_six(out, (m.dtheta_U - t.dtheta_U) / t.dt_s, (m.dv_U - t.dv_U) / t.dt_s, ',');
  }
  return out;
}

/// The IMU at the start and at every sample's end.
NavigationFile truth_file(const Simulation& s) {
  NavigationFile file;
  file.gravity = "wgs84";
  file.records.resize(s.truth.size() + 1);
  parallel_for(file.records.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    throw_if_cancelled();
    for (std::size_t k = begin; k < end; ++k) {
      const KinematicState imu = s.motion.imu_at(static_cast<double>(k) / s.rate_hz);
      file.records[k] = {k == 0 ? s.motion.start : s.truth[k - 1].t, s.motion.frame.X_EW() * imu.X_WB,
                         s.motion.frame.R_EW() * imu.v_WB_W};
    }
  });
  return file;
}

Json summary_json(const Options& options, const Simulation& s) {
  double speed_m_s = 0.0, rate_rad_s = 0.0, force_m_s2 = 0.0;
  for (std::size_t k = 0; k < s.truth.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    speed_m_s = std::max(speed_m_s, s.motion.motion->at(static_cast<double>(k) / s.rate_hz).v_WB_W.norm());
    rate_rad_s = std::max(rate_rad_s, s.truth[k].dtheta_U.norm() / s.truth[k].dt_s);
    force_m_s2 = std::max(force_m_s2, s.truth[k].dv_U.norm() / s.truth[k].dt_s);
  }
  const Geodetic& origin = s.motion.frame.origin();
  std::size_t lost = 0;
  for (const ImuSample& m : s.measured) lost += m.lost ? 1 : 0;
  return Json{
      {"samples", s.truth.size()},
      {"rate_hz", s.rate_hz},
      {"duration_s", s.truth.back().t - s.motion.start},
      {"start_gps_week", s.motion.start.week()},
      {"start_sow_s", s.motion.start.sow_s()},
      {"sensor", s.sensor},
      {"errors", s.errors},
      {"seed", options.seed},
      {"lost", lost},
      {"speed_max_m_s", speed_m_s},
      {"rate_max_deg_s", rate_rad_s / kDegree},
      {"specific_force_max_m_s2", force_m_s2},
      {"accuracy_rad", s.accuracy.dtheta_rad},
      {"accuracy_m_s", s.accuracy.dv_m_s},
      {"origin", {{"lat_deg", origin.lat_rad / kDegree}, {"lon_deg", origin.lon_rad / kDegree}, {"h_m", origin.h_m}}},
      {"frame",
       "imu.csv, errors.csv: forward-left-up, means over the interval that ends at t_s; imu_kf_gins.txt: "
       "forward-right-down, increments (rad, m/s) over the same; truth.nav: the IMU, forward-right-down "
       "in north-east-down; times are seconds of the start's GPS week"},
      {"gravity", "wgs84"}};
}

bool is_log_alone(const std::string& out) {
  return out.ends_with(".csv") || out.ends_with(".txt");
}

Status write_folder(const std::string& path, const Simulation& s, const Json& summary) {
  const std::string folder = path + "/";
  CANYON_TRY_STATUS(write_text_file(folder + "imu.csv", rates_csv(s)));
  CANYON_TRY_STATUS(write_text_file(folder + "imu_kf_gins.txt", kf_gins_text(s)));
  CANYON_TRY_STATUS(write_text_file(folder + "errors.csv", errors_csv(s)));
  CANYON_TRY_STATUS(write_navigation_file(folder + "truth.nav", truth_file(s)));
  return write_text_file(folder + "summary.json", summary.dump(2) + "\n");
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  OutputSet outputs(options.force);
  CANYON_TRY(StagedFile* const log, outputs.file(is_log_alone(options.out) ? options.out : ""));
  CANYON_TRY(const StagedDirectory* const folder, outputs.directory(is_log_alone(options.out) ? "" : options.out));
  CANYON_TRY(const Simulation s, simulate(options));
  const Json summary = summary_json(options, s);
  if (log != nullptr) CANYON_TRY_STATUS(log->write(options.out.ends_with(".csv") ? rates_csv(s) : kf_gins_text(s)));
  if (folder != nullptr) CANYON_TRY_STATUS(write_folder(folder->staging_path(), s, summary));
  CANYON_TRY_STATUS(outputs.commit());
  if (options.common.json) {
    std::printf("%s\n", summary.dump().c_str());
    return 0;
  }
  std::printf("%zu samples at %g Hz, %g s, %s with errors %s, seed %lld\n", s.truth.size(), s.rate_hz,
              s.truth.back().t - s.motion.start, s.sensor.c_str(), s.errors.c_str(),
              static_cast<long long>(options.seed));
  std::printf("  at most %.4g m/s, %.4g deg/s, %.4g m/s^2\n", summary["speed_max_m_s"].get<double>(),
              summary["rate_max_deg_s"].get<double>(), summary["specific_force_max_m_s2"].get<double>());
  std::printf("  true increments within %.1g rad and %.1g m/s\n", s.accuracy.dtheta_rad, s.accuracy.dv_m_s);
  if (log != nullptr) std::printf("Written: %s\n", log->final_path().c_str());
  if (folder != nullptr) std::printf("Written: %s\n", folder->final_path().c_str());
  return 0;
}

std::string paths_help() {
  std::string out = "a motion in closed form, or a TOML file of one:";
  for (const inertial::MotionRow& row : inertial::motion_models()) out += std::string("\n") + row.name + ": " + row.doc;
  return out;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments.option("--sensor", options->sensor,
                   "entry of the catalogue, or a TOML file of your own sensor; default high_grade_mems");
  arguments.option("--errors", options->errors, "error chain, default datasheet; none: an ideal sensor");
  const auto path = arguments.option("--path", options->path, paths_help());
  const auto points =
      arguments.option("--points", options->points,
                       "smooth through points: CSV of t_s,x_m,y_m,z_m and yaw_deg,pitch_deg,roll_deg or nose "
                       "ahead, in W");
  const auto trajectory =
      arguments.option("--trajectory", options->trajectory,
                       "a recorded trajectory: .tum, .kitti or CSV of poses in W; KF-GINS truth text, or CSV with "
                       "sow,lat_deg,lon_deg,h_m,roll_deg,pitch_deg,heading_deg");
  path.excludes(points).excludes(trajectory);
  points.excludes(trajectory);
  arguments.option("--set", options->settings,
                   "KEY=VALUE of the motion, as radius_m=50 or smoothing_s=0.5, or of the sensor, as "
                   "imu.lever_arm_m=[0.3,0,0.5] or 'imu.leave_out=[\"white_noise\"]'; may be repeated");
  arguments.option("--at", options->at, "LAT,LON,H: where it stands, or W's origin; degrees, ellipsoidal metres");
  arguments.option("--start", options->start,
                   "first instant: ISO date or WEEK:SOW; default: the trajectory's, else 0:0");
  arguments.option("--rate", options->rate_hz, "samples per second; default 200").within(10.0, 5000.0);
  arguments.option("--duration", options->duration_s, "seconds; default: all of a trajectory, else 600")
      .within(0.0, 1e7);
  arguments.option("--seed", options->seed, "seed of every random stream")
      .default_shown()
      .within(std::int64_t{0}, kLargestSeed);
  arguments.option(
      "--out", options->out,
      "directory for imu.csv, imu_kf_gins.txt, errors.csv, truth.nav and summary.json; NAME.csv or NAME.txt: "
      "the log alone, as rates or as KF-GINS increments");
  arguments.flag("--force", options->force,
                 "replace the file if it exists, or the directory: only one that canyon wrote, or an empty one");
  return [options]() -> Result<int> {
    if (options->at.empty() && options->path.empty() && options->points.empty() && options->trajectory.empty())
      return Error{"", 0, "command line", "no motion given",
                   "--at LAT,LON,H, --path NAME, --points or --trajectory FILE"};
    return run(*options);
  };
}

}  // namespace

Verb imu_simulate_verb() {
  return {"imu simulate", "an inertial sensor's log on any motion, with its truth",
          "canyon imu simulate --sensor stim300 --path circle --set radius_m=50 --set speed_m_s=10 --out circle",
          declare};
}

}  // namespace canyon::apps
