#include "canyon/apps/options/tradeoff_options.h"

#include <algorithm>
#include <vector>

#include "canyon/apps/line/usage_errors.h"
#include "canyon/core/config/text.h"

namespace canyon::apps {

namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ",") + word;
  return out;
}

/// What only an answer has a use for, where nothing is asked.
Status check_asked(const TradeoffCall& call) {
  const bool write = !call.write.empty(), validate = call.validate.has_value();
  if (!write && !validate && !call.question_s) return Ok{};
  return Error{.file = write      ? "--write"
                       : validate ? "--validate"
                                  : "--seconds",
               .what = "nothing is chosen",
               .expected = "--tolerance or --budget-cpu beside it"};
}

/// The recorded drive, if one is given; nullptr where none is.
Result<std::unique_ptr<const study::RecordedDrive>> recording_of(const TradeoffCall& call) {
  const std::vector<std::string> parts = split_list(call.parts);
  const bool all = call.parts.empty();
  const bool named = std::find(parts.begin(), parts.end(), study::kRecordedPart) != parts.end();
  if (named && call.recording.empty())
    return Error{.file = "--part", .what = "recorded without a recording", .expected = "--recording FILE beside it"};
  if (!named && !all && !call.recording.empty())
    return Error{.file = "--recording", .what = "is for the part recorded", .expected = "it among those of --part"};
  if (call.recording.empty()) return std::unique_ptr<const study::RecordedDrive>();
  return study::read_recorded_drive(call.recording);
}

}  // namespace

Result<AskedTradeoff> asked_tradeoff(const TradeoffCall& call) {
  AskedTradeoff asked;
  study::TradeoffOptions& options = asked.options;
  options = {.parts = call.parts.empty() ? study::tradeoff_parts() : split_list(call.parts),
             .fidelity = call.fidelity,
             .samples = static_cast<std::size_t>(call.samples),
             .repetitions = static_cast<int>(call.repetitions),
             .question_s = call.question_s.value_or(options.question_s),
             .seeds = call.seeds,
             .show_progress = !call.mission.common.json};
  CANYON_TRY_STATUS(study::check_parts(options.parts, "--part"));
  CANYON_TRY(options.outputs, study::outputs_of(split_list(call.outputs), "--for"));
  CANYON_TRY(asked.recording, recording_of(call));
  options.recording = asked.recording.get();
  CANYON_TRY(asked.question, study::read_question(call.tolerance, call.budget_cpu_s, call.figure));
  if (!asked.question) CANYON_TRY_STATUS(check_asked(call));
  asked.validate = static_cast<int>(call.validate.value_or(asked.validate));
  return asked;
}

void declare_tradeoff_options(Arguments& arguments, TradeoffCall& call) {
  declare_mission_options(arguments, call.mission);
  arguments.option("--part", call.parts,
                   "parts to measure, with commas between: " + joined(study::tradeoff_parts()) + "; without it all");
  arguments
      .option("--recording", call.recording,
              "a recorded GNSS drive with its surveyed truth and scene (docs/tradeoff.md), for the part recorded")
      .type("FILE.toml");
  arguments.option("--fidelity", call.fidelity, "what ladders vary one setting of").default_shown();
  arguments.option("--samples", call.samples, "epochs, scans, windows or keyframes, spread over the tape")
      .default_shown()
      .within(std::int64_t{2}, std::int64_t{100'000});
  arguments.option("--repetitions", call.repetitions, "of each model, interleaved in random order")
      .default_shown()
      .within(std::int64_t{5}, std::int64_t{1000});
  arguments
      .option(
          "--seeds", call.seeds,
          "part mission: closed loops of each fidelity, from the mission's own seed on, for the shares of outcomes; "
          "0: none")
      .default_shown()
      .within(std::int64_t{0}, std::int64_t{100'000});
  arguments
      .option("--for", call.outputs, "part mission: what somebody will read of the planned run, with commas between")
      .default_shown();
  arguments.option("--tape", call.tape.tape, "true motion: a .tape, or a results directory; without it the route")
      .type("RUN_DIR");
  arguments.option("--tolerance", call.tolerance,
                   "FIGURE=VALUE: the cheapest settings that change this figure of a run by no more (canyon keys "
                   "--figures lists them)");
  const auto budget =
      arguments.option("--budget-cpu", call.budget_cpu_s,
                       "the settings that change --figure least for so many CPU seconds per simulated second");
  arguments.option("--figure", call.figure, "what --budget-cpu is to keep").default_shown().needs(budget);
  arguments
      .option("--validate", call.validate,
              "seeds that the answer must hold on, which have not chosen it; without it " +
                  std::to_string(AskedTradeoff{}.validate))
      .within(std::int64_t{1}, std::int64_t{10'000});
  arguments
      .option("--seconds", call.question_s,
              "of the true motion, from its start, that it is answered on; without it " +
                  number_text(study::TradeoffOptions{}.question_s))
      .within(1.0, 1e6);
  arguments.option("--write", call.write, "mission file to write, with the answer as the fidelity \"tradeoff\"")
      .type("FILE");
}

}  // namespace canyon::apps
