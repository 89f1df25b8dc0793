#include "canyon/apps/options/lidar_drive.h"

#include <vector>

#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/units.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::apps {

namespace {

/// A pose from --at X,Y,Z_ABOVE_GROUND,YAW, standing.
Result<Trajectory> standing(const LidarDriveOptions& options, const scene::Scene& scene, GpsTime start,
                            double seconds) {
  CANYON_TRY(const auto v, parse_numbers(options.at, 4, "--at",
                                         "X,Y,H,YAW: metres in the scene, metres above ground, degrees from east"));
  const auto ground = scene.ground(v[0], v[1]);
  if (!ground) return Error{"--at", 0, "", '"' + options.at + "\" lies outside the scene", "a place over its terrain"};
  const Pose X_WB{rotation_from({.yaw_rad = v[3] * kDegree}), {v[0], v[1], ground->height_m + v[2]}};
  return Trajectory({{start - seconds, X_WB}, {start + seconds, X_WB}});
}

Result<Trajectory> read_trajectory(const std::string& path) {
  return path.ends_with(".csv") ? read_csv_trajectory(path) : read_tum(path);
}

void declare_scene(Arguments& arguments, LidarDriveOptions& o) {
  o.scene.scene = mission::kDefaultMission;
  arguments
      .option("--scene", o.scene.scene, "a mission file's scene and LIDAR, a scene file, or \"vicksburg\" (built in)")
      .default_shown();
  declare_import_options(arguments, o.scene.from);
}

Argument declare_trajectory(Arguments& arguments, LidarDriveOptions& o) {
  return arguments.option("--trajectory", o.trajectory, "drive along poses of the vehicle in the scene (TUM, or .csv)");
}

/// The LIDAR; returns its options.
std::vector<Argument> declare_lidar(Arguments& arguments, LidarDriveOptions& o) {
  return {
      arguments
          .option("--fidelity", o.fidelity,
                  "whose LIDAR: low, paper, high, high_aided, modern, or one of the mission file's own")
          .default_shown(),
      arguments.option("--beams", o.beams, "beam table; all [lidar] keys can be set in the mission file"),
      arguments.option("--model", o.model, "single_ray or footprint"),
      arguments.option("--detector", o.detector, "ideal or radiometric"),
      arguments.option("--returns", o.returns, "strongest, first, last, dual or all"),
      arguments.option("--see-through", o.see_through, "what light goes on behind: nothing, glass, leaves or both"),
      arguments.option("--rate", o.rate_hz, "revolutions per second"),
      arguments.option("--azimuth-steps", o.azimuth_steps, "firings per revolution; 0 = as fast as the lasers can"),
  };
}

}  // namespace

void declare_lidar_drive(Arguments& arguments, LidarDriveOptions& o) {
  declare_scene(arguments, o);
  const auto at =
      arguments.option("--at", o.at, "X,Y,H,YAW of the vehicle: metres in the scene, metres above ground, degrees");
  at.excludes(declare_trajectory(arguments, o));
  arguments.option("--scans", o.scans, "with --at: how many revolutions")
      .default_shown()
      .within(std::int64_t{1}, std::int64_t{1'000'000})
      .needs(at);
  declare_lidar(arguments, o);
  arguments.option("--start", o.start, "stamp of the first scan, with --at");
}

Argument declare_lidar_way(Arguments& arguments, LidarDriveOptions& o) {
  declare_scene(arguments, o);
  const Argument trajectory = declare_trajectory(arguments, o);
  for (const Argument& option : declare_lidar(arguments, o)) option.needs(trajectory);
  arguments.option("--start", o.start, "when what moves in the scene begins to; without it the mission's start")
      .needs(trajectory);
  return trajectory;
}

Result<lidar::ScanDrive> lidar_drive(const LidarDriveOptions& options) {
  // A scene by itself is scanned with the built-in mission's LIDAR.
  const bool mission_file = options.scene.scene.ends_with(".toml");
  CANYON_TRY(auto file, mission::MissionFile::load(mission_file ? options.scene.scene : ""));
  const auto set = [&file](const char* key, const std::string& value, const char* option) {
    if (!value.empty()) file.set_option(key, ConfigNode::of(value), option);
  };
  set("lidar.beams", options.beams, "--beams");
  set("lidar.model", options.model, "--model");
  set("lidar.detector", options.detector, "--detector");
  set("lidar.returns", options.returns, "--returns");
  set("lidar.see_through", options.see_through, "--see-through");
  set("time.start", options.start, "--start");
  if (options.rate_hz) file.set_option("lidar.rate_hz", ConfigNode::of(*options.rate_hz), "--rate");
  if (options.azimuth_steps)
    file.set_option("lidar.azimuth_steps", ConfigNode::of(*options.azimuth_steps), "--azimuth-steps");
  CANYON_TRY_STATUS(file.check_fidelities({options.fidelity}, "--fidelity"));
  CANYON_TRY(const mission::MissionConfig config, file.resolve(options.fidelity));
  lidar::ScanDrive out;
  out.lidar = config.lidar;
  const auto start = mission::start_time(config);
  if (!start) return file.locate(start.error(), options.fidelity);
  if (const auto scanner = lidar::make_scanner(out.lidar, 1); !scanner)
    return file.locate(scanner.error(), options.fidelity);
  mission::SceneCache scenes;
  CANYON_TRY(const scene::SceneConfig scene, scene_config(options.scene));
  CANYON_TRY(out.scene, scenes.get(scene));
  CANYON_TRY(out.traffic, scene::Traffic::make(scene.moving, *out.scene));
  out.traffic_start = *start;
  if (options.trajectory.empty()) {
    out.start = *start;
    out.scans = options.scans;
    CANYON_TRY(out.motion, standing(options, *out.scene, *start,
                                    out.before_s() + static_cast<double>(options.scans) * out.period_s()));
    return out;
  }
  CANYON_TRY(out.motion, read_trajectory(options.trajectory));
  out.cover_motion();
  const auto& poses = out.motion.poses();
  if (out.scans < 1)
    return Error{options.trajectory, 0, "", printed("covers %.3f s", poses.back().t - poses.front().t),
                 printed("at least one revolution, %.3f s", out.before_s())};
  return out;
}

}  // namespace canyon::apps
