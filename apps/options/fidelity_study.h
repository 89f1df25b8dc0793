#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "canyon/apps/options/mission_options.h"
#include "canyon/core/output/json.h"
#include "canyon/core/output/staged.h"
#include "canyon/study/compare.h"

namespace canyon::apps {

/// Options of a verb that studies a mission at one fidelity.
struct FidelityStudyOptions {
  MissionOptions mission;
  std::string fidelity = "high";
  std::int64_t seeds = 1;  ///< the mission's own the first
  bool open_loop = true;   ///< on one true motion; else each run drives by itself
  study::TapeChoice tape;  ///< of the open loop
};
/// --fidelity.
void declare_fidelity_option(Arguments& arguments, FidelityStudyOptions& options);
/// --seeds; `further`: what more of them bring.
void declare_seeds_option(Arguments& arguments, FidelityStudyOptions& options, const std::string& further);
/// --tape of verbs whose loop is always open.
void declare_tape_option(Arguments& arguments, FidelityStudyOptions& options);

/// A study that is prepared: every mistake of the options has been found.
struct FidelityStudy {
  study::Comparison comparison;  ///< of that one fidelity
  StagedDirectory directory;

  const mission::MissionConfig& config() const { return comparison.configs.front(); }
  const mission::PreparedMission& mission() const { return comparison.missions.front(); }
  const Tape* tape() const { return comparison.tape ? &*comparison.tape : nullptr; }
};
Result<FidelityStudy> begin_study(const FidelityStudyOptions& options);

/// Writes summary.json and these files (name, text) beside what is there already, with `page` report.html too, gives
/// the directory its name, and prints the table, or with --json the summary. Returns the exit status.
Result<int> finish_study(const FidelityStudyOptions& options, FidelityStudy& study, Json summary,
                         const std::string& table, const std::vector<std::pair<std::string, std::string>>& files,
                         bool page);

}  // namespace canyon::apps
