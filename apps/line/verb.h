#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "canyon/apps/line/arguments.h"
#include "canyon/core/result.h"

namespace canyon::apps {

/// What the arguments of a verb ask for; runs it, and returns the exit status or an Error.
using VerbAction = std::function<Result<int>()>;

/// One verb of the command line. A new verb is one file and one row in command_line.cpp.
struct Verb {
  const char* name;  ///< "run"; "gnss solve" is verb solve of group gnss
  const char* summary;
  const char* example;  ///< shown by --help
  /// Declares the arguments and returns what to do once they are parsed.
  VerbAction (*declare)(Arguments& arguments);
};

Verb compare_verb();
Verb tradeoff_verb();
Verb run_verb();
Verb plan_verb();
Verb reproduce_verb();
Verb tolerance_verb();
Verb stress_verb();
Verb report_verb();
Verb keys_verb();
Verb scene_info_verb();
Verb scene_make_verb();
Verb gnss_sky_verb();
Verb gnss_map_verb();
Verb gnss_drive_check_verb();
Verb gnss_simulate_verb();
Verb gnss_solve_verb();
Verb gnss_orbit_error_verb();
Verb imu_allan_verb();
Verb imu_fit_verb();
Verb imu_simulate_verb();
Verb imu_dead_reckon_verb();
Verb fuse_verb();
Verb lidar_scan_verb();
Verb lidar_evaluate_verb();
Verb lidar_error_budget_verb();
Verb lidar_close_loops_verb();
Verb lidar_error_events_verb();
Verb lidar_error_response_verb();
Verb lidar_register_verb();

/// The largest --seed: what a TOML integer and a JSON number both carry without loss.
inline constexpr std::int64_t kLargestSeed = 9'000'000'000'000'000;

/// Options that every verb has.
struct CommonOptions {
  int threads = 0;
  bool json = false;
};
void declare_common(Arguments& arguments, CommonOptions& options);

/// "warning: " and the line, on stderr.
void print_warning(const std::string& line);
void print_warnings(const std::vector<std::string>& lines);

}  // namespace canyon::apps
