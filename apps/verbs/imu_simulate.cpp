#include <cmath>
#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/imu_simulation.h"
#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/output/json.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/inertial/mounting.h"
#include "canyon/inertial/simulation/simulated_log.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  ImuSimulationOptions what;
  std::string out;
  double duration_s = 0.0;
  std::int64_t seed = 1;
  bool force = false;
};

constexpr double kUsualDuration_s = 600.0;
constexpr std::size_t kMostSamples = 10'000'000;  // 14 h at 200 Hz; truth, log and text are held in memory, 6 GB

Result<double> duration_of(const Options& options, const inertial::PlacedMotion& placed) {
  const double longest_s = placed.motion->duration_s();
  if (options.duration_s == 0.0) return std::isfinite(longest_s) ? longest_s : kUsualDuration_s;
  if (options.duration_s <= longest_s) return options.duration_s;
  char text[80], limit[80];
  std::snprintf(text, sizeof text, "%g s", options.duration_s);
  std::snprintf(limit, sizeof limit, "at most %.9g s, the length of the trajectory", longest_s);
  return Error{"--duration", 0, "", text, limit};
}

Result<inertial::SimulatedLog> simulate(const Options& options, const LogConfig& config) {
  const auto seed = static_cast<std::uint64_t>(options.seed);
  CANYON_TRY(auto motion, inertial::make_motion(config.motion, seed));
  motion.lever_arm_m = config.imu.lever_arm_m;
  motion.R_BU = inertial::mounting(config.imu, seed);
  if (!options.what.start.empty()) {
    CANYON_TRY(motion.start, GpsTime::parse(options.what.start, "--start"));
  }
  CANYON_TRY(const double duration_s, duration_of(options, motion));
  CANYON_TRY(const auto chain, inertial::make_error_chain(config.imu, seed));
  const std::size_t samples = inertial::whole_samples(duration_s, config.imu.rate_hz);
  if (samples > kMostSamples)
    return Error{"--duration", 0, "", std::to_string(samples) + " samples",
                 "at most " + std::to_string(kMostSamples) + ": a shorter duration or a lower --rate"};
  if (samples == 0) return Error{"--duration", 0, "", "shorter than one sample", "at least 1 / --rate"};
  Progress progress("imu simulate", static_cast<double>(samples), !options.common.json);
  return inertial::simulate_log(motion, config.imu.rate_hz, samples, *chain, progress);
}

Json summary_json(const Options& options, const LogConfig& config, const inertial::SimulatedLog& s) {
  const inertial::LogExtremes most = inertial::extremes(s);
  const Geodetic& origin = s.motion.frame.origin();
  const Eigen::Vector3d askew_deg = so3_log(s.motion.R_BU.value_or(Eigen::Quaterniond::Identity())) / kDegree;
  return Json{
      {"samples", s.truth.size()},
      {"rate_hz", s.rate_hz},
      {"duration_s", s.truth.back().t - s.motion.start},
      {"start_gps_week", s.motion.start.week()},
      {"start_sow_s", s.motion.start.sow_s()},
      {"sensor", config.imu.sensor},
      {"errors", config.imu.errors},
      {"seed", options.seed},
      {"mounting_deg", {askew_deg.x(), askew_deg.y(), askew_deg.z()}},
      {"lost", most.lost},
      {"speed_max_m_s", most.speed_m_s},
      {"rate_max_deg_s", most.rate_rad_s / kDegree},
      {"specific_force_max_m_s2", most.force_m_s2},
      {"accuracy_rad", s.accuracy.dtheta_rad},
      {"accuracy_m_s", s.accuracy.dv_m_s},
      {"origin", {{"lat_deg", origin.lat_rad / kDegree}, {"lon_deg", origin.lon_rad / kDegree}, {"h_m", origin.h_m}}},
      {"frame", inertial::kSimulatedLogFrames},
      {"gravity", "wgs84"}};
}

bool is_log_alone(const std::string& out) {
  return out.ends_with(".csv") || out.ends_with(".txt");
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  OutputSet outputs(options.force);
  CANYON_TRY(StagedFile* const log, outputs.file(is_log_alone(options.out) ? options.out : ""));
  CANYON_TRY(const StagedDirectory* const folder, outputs.directory(is_log_alone(options.out) ? "" : options.out));
  CANYON_TRY(const LogConfig config, log_config(options.what));
  CANYON_TRY(const inertial::SimulatedLog s, simulate(options, config));
  const Json summary = summary_json(options, config, s);
  if (log != nullptr)
    CANYON_TRY_STATUS(log->write(options.out.ends_with(".csv") ? inertial::rates_csv(s) : inertial::kf_gins_text(s)));
  if (folder != nullptr) {
    CANYON_TRY_STATUS(inertial::write_simulated_log(folder->staging_path(), s));
    CANYON_TRY_STATUS(write_text_file(folder->staging_path() + "/summary.json", json_text(summary, 2) + "\n"));
  }
  CANYON_TRY_STATUS(outputs.commit());
  if (options.common.json) {
    std::printf("%s\n", json_text(summary).c_str());
    return 0;
  }
  std::printf("%zu samples at %g Hz, %g s, %s with errors %s, seed %lld\n", s.truth.size(), s.rate_hz,
              s.truth.back().t - s.motion.start, config.imu.sensor.c_str(), config.imu.errors.c_str(),
              static_cast<long long>(options.seed));
  std::printf("  at most %.4g m/s, %.4g deg/s, %.4g m/s^2\n", summary["speed_max_m_s"].get<double>(),
              summary["rate_max_deg_s"].get<double>(), summary["specific_force_max_m_s2"].get<double>());
  std::printf("  true increments within %.1g rad and %.1g m/s\n", s.accuracy.dtheta_rad, s.accuracy.dv_m_s);
  if (log != nullptr) std::printf("Written: %s\n", log->final_path().c_str());
  if (folder != nullptr) std::printf("Written: %s\n", folder->final_path().c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  declare_imu_simulation(arguments, options->what);
  arguments
      .option("--duration", options->duration_s,
              "seconds; default: all of a trajectory, else " + number_text(kUsualDuration_s))
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
    CANYON_TRY_STATUS(check_motion_given(options->what));
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
