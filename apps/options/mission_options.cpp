#include "canyon/apps/options/mission_options.h"

#include <ctime>

#include "canyon/core/output/staged.h"

namespace canyon::apps {

void declare_mission_choice(Arguments& arguments, MissionOptions& options) {
  declare_common(arguments, options.common);
  arguments
      .option("mission", options.mission,
              std::string("mission file (TOML); ") + mission::kDefaultMission + ", or nothing, is the built-in mission")
      .type("MISSION.toml");
  arguments.option("--seed", options.seed, "seed of every random stream; without it the mission's")
      .within(std::int64_t{0}, kLargestSeed);
  arguments.option("--nav", options.nav, "RINEX navigation file; without it the built-in 24-slot GPS constellation");
  arguments.option(
      "--set", options.settings,
      "KEY=VALUE of the mission's keys (canyon keys), as gnss.rate_hz=2 or 'gnss.ionosphere=\"none\"', for "
      "every fidelity; may be repeated");
  arguments.option("--start", options.start, "first instant: ISO date (GPS time, or UTC with Z) or WEEK:SOW");
}

void declare_mission_options(Arguments& arguments, MissionOptions& options) {
  declare_mission_choice(arguments, options);
  arguments.option("--out", options.out, "results directory; default results/<mission>-<seed>-<time>");
  arguments.flag("--force", options.force,
                 "replace the results directory if it exists; only one that canyon wrote, or an empty one");
}

namespace {

/// A key that has an option of its own, with two values: which of them is meant is not to be guessed.
Status check_set_once(const ConfigNode& setting, bool option_given, const char* option, const char* key) {
  if (!option_given || setting.find(key) == nullptr) return Ok{};
  return Error{.file = option, .what = std::string("stands beside --set ") + key, .expected = "one of the two"};
}

Status check_set_once(const ConfigNode& setting, const MissionOptions& options) {
  CANYON_TRY_STATUS(check_set_once(setting, options.seed.has_value(), "--seed", "run.seed"));
  CANYON_TRY_STATUS(check_set_once(setting, !options.nav.empty(), "--nav", "gnss.nav_file"));
  return check_set_once(setting, !options.start.empty(), "--start", "time.start");
}

}  // namespace

Result<mission::MissionFile> load_mission(const MissionOptions& options) {
  CANYON_TRY(auto file, mission::MissionFile::load(options.mission));
  if (options.seed) file.set_option("run.seed", ConfigNode::of(*options.seed), "--seed");
  if (!options.nav.empty()) file.set_option("gnss.nav_file", ConfigNode::of(options.nav), "--nav");
  if (!options.start.empty()) file.set_option("time.start", ConfigNode::of(options.start), "--start");
  for (const std::string& setting : options.settings) {
    CANYON_TRY(const ConfigNode tree, ConfigNode::parse(setting, "--set"));
    CANYON_TRY_STATUS(check_set_once(tree, options));
    file.lay_over(tree);
  }
  return file;
}

std::string output_directory(const MissionOptions& options, const mission::MissionConfig& config) {
  if (!options.out.empty()) return options.out;
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &local);
  return free_name("results/" + config.run.name + "-" + std::to_string(config.run.seed) + "-" + stamp);
}

}  // namespace canyon::apps
