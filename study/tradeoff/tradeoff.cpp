#include "canyon/study/tradeoff/tradeoff.h"

#include <algorithm>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/study/tradeoff/measuring/fidelities.h"
#include "canyon/study/tradeoff/measuring/measure.h"
#include "canyon/study/tradeoff/recorded/recorded_drive.h"

namespace canyon::study {
namespace {

bool asked_for(const TradeoffOptions& options, const std::string& part) {
  return std::find(options.parts.begin(), options.parts.end(), part) != options.parts.end();
}

Status measure_ladder(const Ladder& ladder, const mission::MissionFile& file, const TradeoffOptions& options,
                      const Measuring& with, Tradeoff& out) {
  const bool recorded = ladder.part == kRecordedPart;
  const auto lists =
      make_rungs(ladder, recorded ? with_receiver(file, *options.recording) : file, options.fidelity, probe_keys());
  if (!lists) {
    out.skipped.push_back({ladder.key, lists.error().str()});
    return Ok{};
  }
  for (const RungList& list : *lists) {
    auto measured = measure(list, with);
    if (measured)
      out.ladders.push_back(*std::move(measured));
    else if (measured.error().exit_code == 2)
      out.skipped.push_back({ladder.key, measured.error().str()});
    else
      return measured.error();
  }
  return Ok{};
}

}  // namespace

Status check_parts(const std::vector<std::string>& parts, const std::string& option) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto& known = tradeoff_parts();
    if (std::find(known.begin(), known.end(), parts[i]) == known.end()) {
      Error error = unknown_name("", parts[i], known);
      error.file = option;
      return error;
    }
    for (std::size_t k = 0; k < i; ++k)
      if (parts[k] == parts[i]) return Error{.file = option, .what = "\"" + parts[i] + "\" stands there twice"};
  }
  return Ok{};
}

Result<Comparison> prepare_tradeoff(const mission::MissionFile& file, const TradeoffOptions& options,
                                    const TapeChoice& tape) {
  std::vector<std::string> fidelities{options.fidelity};
  if (asked_for(options, "mission"))
    for (const std::string& name : file.fidelities())
      if (name != options.fidelity) fidelities.push_back(name);
  // What a recording says of its receiver is a mistake of the call, not of one ladder.
  if (options.recording != nullptr)
    CANYON_TRY_STATUS(with_receiver(file, *options.recording).resolve(options.fidelity));
  CANYON_TRY(Comparison comparison, prepare_comparison(file, plan_runs(fidelities, false)));
  CANYON_TRY_STATUS(choose_tape(tape, comparison));
  return comparison;
}

Tradeoff described(const TradeoffOptions& options, const Comparison& comparison) {
  const mission::MissionConfig& config = comparison.configs.front();
  Tradeoff out;
  out.mission = config.run.name;
  out.fidelity = options.fidelity;
  out.tape = comparison.tape->source;
  out.seed = config.run.seed;
  out.repetitions = options.repetitions;
  out.samples = options.samples;
  out.threads = threads();
  return out;
}

Result<Tradeoff> measure_tradeoff(const mission::MissionFile& file, const TradeoffOptions& options,
                                  const Comparison& comparison) {
  Tradeoff out = described(options, comparison);
  const Measuring with{comparison.missions.front(),          *comparison.tape, options.samples, options.repetitions,
                       static_cast<std::uint64_t>(out.seed), options.recording};
  std::vector<const Ladder*> ladders;
  for (const Ladder& ladder : built_in_ladders().ladder)
    if (asked_for(options, ladder.part) && (ladder.part != kRecordedPart || options.recording != nullptr))
      ladders.push_back(&ladder);
  Progress progress("measuring ladders", static_cast<double>(ladders.size()), options.show_progress);
  for (const Ladder* ladder : ladders) {
    CANYON_TRY_STATUS(measure_ladder(*ladder, file, options, with, out));
    progress.advance(1.0);
  }
  if (asked_for(options, kRecordedPart) && options.recording == nullptr)
    out.skipped.push_back({"ladders against a recorded drive", "no recording is given (--recording)"});
  if (asked_for(options, "mission")) {
    CANYON_TRY(out.fidelities, measure_fidelities(comparison, {.outputs = options.outputs,
                                                               .repetitions = options.repetitions,
                                                               .seeds = options.seeds,
                                                               .seed = with.seed,
                                                               .show_progress = options.show_progress}));
  }
  return out;
}

}  // namespace canyon::study
