#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/report/read/cloud_summary.h"
#include "canyon/report/read/epoch_table.h"
#include "canyon/report/read/filter_verdict.h"

/// A results directory (docs/results.md) in memory. Undefined numbers are NaN, undefined texts empty. Positions are in
/// W, metres.
namespace canyon::report {

struct Waypoint {
  std::string name;
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  bool mission = false;
  std::string building;  ///< of interest; may be empty
};

struct Mission {
  std::string name, seed, start;
  double nominal_duration_s = 0.0, time_limit_s = 0.0;
  std::vector<Eigen::Vector2d> route_W;
  std::vector<Waypoint> waypoints;
};

struct SceneFacts {
  std::string name;
  double buildings = 0.0, triangles = 0.0;
  std::vector<double> extent_m;  ///< 3 numbers, or empty
  double lat_deg = 0.0, lon_deg = 0.0, h_m = 0.0;
};

struct Failure {
  std::string kind, detail;
  double t_s = 0.0, x_m = 0.0, y_m = 0.0;
};

struct MissionWaypoint {
  std::string name;
  bool reached = false;
  double closest_m = 0.0, stopped_s = 0.0, facade_seen_share = 0.0;
};

/// What had to be done at a waypoint: of the run's configuration, [success]; NaN where the directory does not say.
struct SuccessRules {
  double waypoint_radius_m = std::nan(""), stop_s = std::nan("");
};

/// What a figure of a run is: a row of summary.json's `figures`, from which the page makes its tables.
struct Figure {
  enum class Kind { kQuantity, kCount, kShare };
  std::string key = {}, group = {}, label = {}, unit = {}, meaning = {};
  std::string better = {};  ///< "lower", "higher" or neither
  std::string total = {};   ///< key of the figure that it is a part of; may be empty
  Kind kind = Kind::kQuantity;
  double cap = std::nan("");  ///< values that reach it are known to be that or more
  bool timing = false;        ///< stands under the run's `timing`
};

/// 95 %; NaN where there is none.
struct Interval {
  double low = std::nan(""), high = std::nan("");
};

/// What replays say of why a run failed (why.json).
struct Why {
  struct Removal {
    std::string name;
    double successes = 0.0, p = 1.0;
    Interval difference;
    bool rescues = false;
  };
  std::string verdict;
  std::vector<std::string> chain;  ///< of events, one a line
  double draws = 0.0, successes_as_it_was = 0.0;
  std::vector<Removal> removals;
};

/// The same of a run with a seed that its epochs are not of.
struct SeedWhy {
  std::string run, seed;
  Why why;
};

/// Over several seeds, what the failures of one run come from.
struct CauseTally {
  struct Count {
    std::string words;  ///< the verdict
    std::string note;   ///< how much the replays bear; may be empty
    double n = 0.0;     ///< of those explained
    Interval interval;
  };
  std::string run;
  double failed = 0.0, explained = 0.0;
  std::vector<Count> counts;
};

/// One run's summary and whatever of its epochs and clouds the directory holds.
struct Run {
  std::string fidelity, gnss, imu, outcome;
  std::string filter;  ///< where it is a factor of the comparison; else empty
  std::optional<Failure> failure;
  std::optional<Why> why;                              ///< where it was asked for
  std::map<std::string, double, std::less<>> figures;  ///< by their keys, those under `timing` among them
  std::map<std::string, Interval, std::less<>> intervals;
  std::vector<MissionWaypoint> mission_waypoints;
  SuccessRules rules;
  FilterVerdict filter_verdict;
  std::vector<std::pair<std::string, double>> counters;
  std::vector<std::pair<std::string, double>> cpu_parts_s;

  std::optional<EpochTable> nav, gnss_epochs, satellites, keyframes;
  std::optional<CloudSummary> prior_cloud, registered_cloud;

  double figure(std::string_view key) const;
  /// False where each keyframe stayed where the filter had placed it: [registration] method "none".
  bool registers() const;
  bool succeeded() const { return outcome == "success"; }
  /// A time limit of its own has ended it: neither success nor failure.
  bool was_stopped() const { return outcome == "stopped"; }
  /// Both sensors of the run's own fidelity: not one of the mixed runs of the 2 x 2.
  bool is_pure() const { return gnss == imu; }
};

/// Low and high GNSS (rows) with low and high IMU (columns).
struct TwoByTwo {
  std::string filter;  ///< of all four, where it is a factor
  std::vector<std::string> gnss, imu;
  std::vector<std::vector<std::string>> outcome;
  std::map<std::string, std::vector<std::vector<double>>, std::less<>> figures;
};

struct Building {
  std::string name;
  double base_m = 0.0, height_m = 0.0;
  std::vector<Eigen::Vector2d> footprint_W;
};

struct Street {
  Eigen::Vector2d a_W, b_W;
  double width_m = 0.0;
};

struct Tree {
  Eigen::Vector2d p_W;
  double radius_m = 0.0;
};

/// The scene from above.
struct SceneDrawing {
  Eigen::Vector2d min_W = Eigen::Vector2d::Zero(), max_W = Eigen::Vector2d::Zero();
  std::vector<Building> buildings;
  std::vector<Street> streets;
  std::vector<Tree> trees;
  std::vector<Eigen::Vector2d> vehicles;
};

/// How much larger one run's position error is than another's, epoch by epoch on one true motion.
struct PairedErrors {
  std::string a, b;
  double epochs = 0.0, difference_m = 0.0, low_m = 0.0, high_m = 0.0, worse_share = 0.0;
};

/// All runs on one true motion: nobody drove, so there is no outcome.
struct OpenLoop {
  std::string tape;  ///< where the motion is from
  std::vector<PairedErrors> paired;
};

/// How often a run succeeds over several seeds.
struct SuccessShare {
  std::string fidelity;
  double success = 0.0, n = 0.0;
  Interval interval;
  std::vector<std::pair<std::string, double>> outcomes;
};

/// One run against another, seed by seed.
struct PairedSeeds {
  std::string a, b, figure;  ///< "success" or a figure's key
  double n = 0.0, difference = 0.0;
  Interval interval;
  double p = 0.0;
};

/// A figure of a run over seeds.
struct Median {
  double value = std::nan("");
  Interval interval;
  double lowest = std::nan(""), highest = std::nan("");
};

/// What the same runs with several seeds say. Epochs and clouds are those of the first seed.
struct OverSeeds {
  std::string first, last;  ///< seeds
  double count = 0.0;
  std::vector<SuccessShare> shares;
  std::vector<PairedSeeds> paired;
  std::vector<std::pair<std::string, std::map<std::string, Median, std::less<>>>> medians;  ///< by fidelity
};

/// The same runs on one true motion, beside closed loops. Figures alone.
struct LoopBeside {
  OpenLoop loop;
  double duration_s = 0.0;
  std::vector<Run> runs;  ///< with the first seed
  std::optional<OverSeeds> over_seeds;
};

struct Results {
  Mission mission;
  std::vector<Figure> figures;  ///< what the runs' figures are, in the order of the table
  std::optional<OverSeeds> over_seeds;
  std::optional<OpenLoop> open_loop;  ///< where these results are of one
  std::optional<LoopBeside> beside;   ///< where they are of closed loops, and the open one was driven as well
  SceneFacts scene;
  SceneDrawing drawing;
  MapGrid grid;  ///< over the scene; the clouds' cells
  std::vector<Run> runs;
  std::vector<SeedWhy> further_why;     ///< where it was asked for, in the order of why.json
  std::vector<CauseTally> cause_tally;  ///< where that was over several seeds
  std::vector<TwoByTwo> two_by_two;     ///< one for each filter; empty where the mixed runs were not made
  std::string hash;
  double wall_s = 0.0, cpu_s = 0.0, peak_memory_mb = 0.0, threads = 0.0;
  std::string version, commit, command_line, instruction_set, scene_hash;  ///< of manifest.json

  const Run* run(std::string_view fidelity) const;
  const Figure* figure(std::string_view key) const;
};

}  // namespace canyon::report
