#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/process/child_process.h"
#include "canyon/core/result.h"

namespace canyon::study {

/// Keys of a mission with the values that are tried, as TOML writes them.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// How the program is called for one trial.
struct TrialSetup {
  std::string program;       ///< canyon itself
  std::string mission;       ///< its file, or the name of the built-in one
  std::string fidelity;      ///< that is driven
  double simulated_s = 3.0;  ///< at most, whatever time.limit_s is set to
  /// Of a trial; its CPU time is that of the mission as it stands, and this much for each simulated second.
  double cpu_per_simulated_s = 40.0;
  ChildLimits limits{.cpu_s = 1200.0, .wall_s = 3600.0, .memory_bytes = std::size_t{4} << 30};
};

/// What came of one trial.
struct TrialEnd {
  bool refused = false;  ///< with one line that names the place, exit status 2
  std::string what;      ///< what must never be; empty: a finite result, or refused
  std::string said{};    ///< on stderr
  double cpu_s = 0.0;
};

/// `canyon run` with these settings in a process of its own, which works in `folder`, an empty one of its own that it
/// makes. Temporary files are its subfolder `tmp`. An Error if the folder cannot be made.
Result<ProcessId> start_trial(const TrialSetup& setup, const Settings& settings, const std::filesystem::path& folder);

/// What came of it: judged by how the process ended, what it said and what it left in the folder. It must not have
/// ended by a signal, or have taken more time or memory than `setup.limits`; with exit status 0 its files and what it
/// printed hold no number that is not finite, with 2 it says one line that names a key of the settings or a file with
/// its line, and leaves nothing; no other status, no internal error's words, no temporary file.
TrialEnd judge_trial(const TrialSetup& setup, const Settings& settings, const ChildEnd& end,
                     const std::filesystem::path& folder);

}  // namespace canyon::study
