#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "canyon/apps/line/verb.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::apps {

/// Options shared by the verbs that drive a mission.
struct MissionOptions {
  CommonOptions common;
  std::string mission;  ///< empty = built-in
  std::optional<std::int64_t> seed;
  std::string nav, start, out;
  std::vector<std::string> settings;  ///< "KEY=VALUE"
  bool force = false;
};
void declare_mission_options(Arguments& arguments, MissionOptions& options);
/// Of these, which mission it is: no results directory.
void declare_mission_choice(Arguments& arguments, MissionOptions& options);

/// The mission file with the options laid over it.
Result<mission::MissionFile> load_mission(const MissionOptions& options);

/// --out, or results/<mission>-<seed>-<time>.
std::string output_directory(const MissionOptions& options, const mission::MissionConfig& config);

}  // namespace canyon::apps
