#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/map_report.h"
#include "canyon/apps/options/lidar_drive.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/lidar/files/map_files.h"
#include "canyon/lidar/map_quality/true_points.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::apps {

namespace {

struct Options {
  LidarDriveOptions drive;
  CommonOptions common;
  std::string map, estimate, alignment = "none", aligned;
  double rate_hz = 10.0, cap_m = 5.0, reach_m = 40.0, neighbourhood_m = 0.5;
  bool force = false;
};

Result<Trajectory> poses_of(const std::string& path, GpsTime start, double rate_hz) {
  if (path.ends_with(".kitti")) return read_kitti(path, start, rate_hz);
  return path.ends_with(".csv") ? read_csv_trajectory(path) : read_tum(path);
}

/// The estimate against the true way; written as it was laid over that, if it was asked for.
Status compare_trajectories(const Options& options, const Trajectory& truth, StagedFile* aligned, MapAnswer& answer) {
  CANYON_TRY(const auto* alignment, choose(lidar::trajectory_alignments(), options.alignment, "--alignment"));
  CANYON_TRY(const Trajectory estimate, poses_of(options.estimate, truth.poses().front().t, options.rate_hz));
  answer.trajectory = lidar::trajectory_errors(truth, estimate, alignment->make);
  answer.alignment = options.alignment;
  if (answer.trajectory->poses == 0)
    return Error{options.estimate, 0, "", "no pose lies within the time of the true way", "times of the same clock"};
  if (aligned == nullptr) return Ok{};
  Trajectory laid = estimate;
  laid.move(answer.trajectory->X_true_estimated);
  const std::string& path = aligned->staging_path();
  return options.aligned.ends_with(".kitti") ? write_kitti(path, laid) : write_tum(path, laid);
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  OutputSet outputs(options.force);
  CANYON_TRY(StagedFile* const aligned, outputs.file(options.aligned));
  CANYON_TRY(const lidar::ReadMap map, lidar::read_map(options.map));
  MapAnswer answer;
  lidar::MapTruth truth;
  std::shared_ptr<const scene::Scene> scene;
  if (!options.drive.trajectory.empty()) {
    CANYON_TRY(const lidar::ScanDrive drive, lidar_drive(options.drive));
    scene = drive.scene;
    CANYON_TRY(lidar::TruePoints met, lidar::beams_met(drive, 1.0, options.reach_m));
    truth = {std::move(met.met_W), std::move(met.sensor_W)};
    answer.completeness_of = "beams";
    if (!options.estimate.empty()) CANYON_TRY_STATUS(compare_trajectories(options, drive.motion, aligned, answer));
  } else {
    CANYON_TRY(const scene::SceneConfig config, scene_config(options.drive.scene));
    mission::SceneCache scenes;
    CANYON_TRY(scene, scenes.get(config));
    truth.points_W = lidar::surfaces_near(lidar::PointGrid(map.points, options.neighbourhood_m), *scene);
    answer.completeness_of = "surfaces near the map";
  }
  answer.map = lidar::report_map(map.points, *scene, truth, options.cap_m, options.neighbourhood_m);
  CANYON_TRY_STATUS(outputs.commit());
  if (map.not_finite > 0) print_warning(std::to_string(map.not_finite) + " points that are not finite were left out");
  if (options.common.json)
    std::printf("%s\n", json_text(map_answer_json(answer)).c_str());
  else
    std::printf("%s", map_answer_text(answer).c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments.option("map", options->map, "a map in the scene's frame: PCD, PLY, LAS or .bin").required().type("MAP");
  const Argument trajectory = declare_lidar_way(arguments, options->drive);
  const auto estimate =
      arguments.option("--estimate", options->estimate,
                       "estimated poses of the vehicle, compared with --trajectory (TUM, .kitti or .csv)");
  arguments.option("--estimate-rate", options->rate_hz, "poses per second of an estimate without times")
      .default_shown()
      .within(1e-3, 1e4)
      .needs(estimate);
  arguments.option("--alignment", options->alignment, "how the estimate is laid over the truth: none, yaw or se3")
      .default_shown()
      .needs(estimate);
  arguments.option("--aligned", options->aligned, "write the estimate as it was laid over the truth (.tum or .kitti)");
  arguments.option("--cap", options->cap_m, "larger distances count as this, m").default_shown().within(0.1, 100.0);
  arguments.option("--reach", options->reach_m, "with --trajectory: true beams count as far as this, m")
      .default_shown()
      .within(1.0, 1000.0)
      .needs(trajectory);
  arguments.option("--neighbourhood", options->neighbourhood_m, "radius of entropy and plane variance, m")
      .default_shown()
      .within(0.05, 5.0);
  arguments.flag("--force", options->force, "replace the file of --aligned if it exists");
  return [options]() -> Result<int> {
    if (!options->estimate.empty() && options->drive.trajectory.empty())
      return Error{"", 0, "command line", "--estimate without the true way", "--trajectory FILE"};
    if (!options->aligned.empty() && options->estimate.empty())
      return Error{"", 0, "command line", "--aligned without an estimate", "--estimate FILE"};
    return run(*options);
  };
}

}  // namespace

Verb lidar_evaluate_verb() {
  return {"lidar evaluate", "a map against the true surfaces of its scene, and its trajectory against the true way",
          "canyon lidar evaluate results/first/clouds/high_registered.pcd --scene my.toml --trajectory truth.tum",
          declare};
}

}  // namespace canyon::apps
