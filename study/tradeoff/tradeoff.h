#pragma once

#include <string>
#include <vector>

#include "canyon/mission/config/mission_file.h"
#include "canyon/study/compare.h"
#include "canyon/study/tradeoff/result.h"

namespace canyon::study {

struct RecordedDrive;  // study/tradeoff/recorded/recorded_drive.h

/// What is to be measured.
struct TradeoffOptions {
  std::vector<std::string> parts;  ///< of tradeoff_parts()
  std::string fidelity = "high";   ///< what ladders vary one setting of
  std::size_t samples = 60;
  int repetitions = 5;
  double question_s = 30.0;  ///< of the tape, from its start, that --tolerance and --budget-cpu are answered on
  std::int64_t seeds = 3;    ///< part mission: closed loops of each fidelity; 0: none
  std::vector<Output> outputs = all_outputs();  ///< part mission: what somebody reads of the planned run
  const RecordedDrive* recording = nullptr;     ///< part recorded; none: it is left out, and that is said
  bool show_progress = true;
};

/// Names of parts, which must be known and none twice; `option` is named in the Error.
Status check_parts(const std::vector<std::string>& parts, const std::string& option);

/// A mission that has been read and checked, with the true motion that everything is measured on: the mission's own
/// route, driven on truth with its own seed, or what `tape` names.
Result<Comparison> prepare_tradeoff(const mission::MissionFile& file, const TradeoffOptions& options,
                                    const TapeChoice& tape);

/// What it is measured on, without anything measured yet.
Tradeoff described(const TradeoffOptions& options, const Comparison& comparison);

/// Every ladder of the parts asked for; with the part mission also every fidelity of the file, and the one in hand as
/// planned, as whole missions. A ladder that cannot be measured here stands in `skipped` with the reason.
Result<Tradeoff> measure_tradeoff(const mission::MissionFile& file, const TradeoffOptions& options,
                                  const Comparison& comparison);

}  // namespace canyon::study
