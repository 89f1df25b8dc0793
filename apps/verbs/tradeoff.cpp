#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/tradeoff_files.h"
#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/options/mission_options.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/study/tradeoff/choosing/choose.h"
#include "canyon/study/tradeoff/output/tradeoff_output.h"
#include "canyon/study/tradeoff/recorded/recorded_drive.h"
#include "canyon/study/tradeoff/tradeoff.h"

namespace canyon::apps {

namespace {

struct Options {
  MissionOptions mission;
  study::TapeChoice tape;
  std::string recording, parts, fidelity = "high", tolerance, figure = "position_error_rms_m", write;
  std::optional<double> budget_cpu_s;
  std::int64_t samples = 60, repetitions = 5, seeds = 3, validate = 20;
  std::string outputs = "outcome,position,map,clouds";
  double question_s = 30.0;
};

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ",") + word;
  return out;
}

/// The recorded drive, if one is given; nullptr where none is.
Result<std::unique_ptr<const study::RecordedDrive>> recording_of(const Options& options) {
  const std::vector<std::string> parts = split_list(options.parts);
  const bool all = options.parts.empty();
  const bool named = std::find(parts.begin(), parts.end(), study::kRecordedPart) != parts.end();
  if (named && options.recording.empty())
    return Error{.file = "--part", .what = "recorded without a recording", .expected = "--recording FILE beside it"};
  if (!named && !all && !options.recording.empty())
    return Error{.file = "--recording", .what = "is for the part recorded", .expected = "it among those of --part"};
  if (options.recording.empty()) return std::unique_ptr<const study::RecordedDrive>();
  return study::read_recorded_drive(options.recording);
}

Result<int> run(const Options& options) {
  set_threads(options.mission.common.threads);
  study::TradeoffOptions asked{.parts = options.parts.empty() ? study::tradeoff_parts() : split_list(options.parts),
                               .fidelity = options.fidelity,
                               .samples = static_cast<std::size_t>(options.samples),
                               .repetitions = static_cast<int>(options.repetitions),
                               .question_s = options.question_s,
                               .seeds = options.seeds,
                               .show_progress = !options.mission.common.json};
  CANYON_TRY_STATUS(study::check_parts(asked.parts, "--part"));
  CANYON_TRY(asked.outputs, study::outputs_of(split_list(options.outputs), "--for"));
  CANYON_TRY(const auto recording, recording_of(options));
  asked.recording = recording.get();
  CANYON_TRY(const auto question, study::read_question(options.tolerance, options.budget_cpu_s, options.figure));
  if (!question && !options.write.empty())
    return Error{.file = "--write", .what = "nothing is chosen", .expected = "--tolerance or --budget-cpu beside it"};
  CANYON_TRY(const auto file, load_mission(options.mission));
  CANYON_TRY_STATUS(file.check_fidelities({asked.fidelity}, "--fidelity"));
  CANYON_TRY(const auto comparison, study::prepare_tradeoff(file, asked, options.tape));

  // What cannot be written is said before minutes are spent.
  CANYON_TRY(auto directory, StagedDirectory::create(output_directory(options.mission, comparison.configs.front()),
                                                     options.mission.force));
  std::optional<StagedFile> written;
  if (!options.write.empty()) {
    CANYON_TRY(StagedFile staged, StagedFile::create(options.write, options.mission.force));
    written.emplace(std::move(staged));
  }

  study::Tradeoff tradeoff;
  if (question) {
    CANYON_TRY(tradeoff,
               study::choose_and_describe(*question, file, asked, comparison, static_cast<int>(options.validate)));
    if (tradeoff.chosen->found && written) {
      CANYON_TRY(const std::string text,
                 study::mission_with(*tradeoff.chosen, asked.fidelity, options.mission.mission, options.write));
      CANYON_TRY_STATUS(written->write(text));
      CANYON_TRY_STATUS(written->commit());
    }
  } else {
    CANYON_TRY(tradeoff, study::measure_tradeoff(file, asked, comparison));
  }
  CANYON_TRY_STATUS(write_tradeoff_files(tradeoff, directory));
  if (options.mission.common.json) {
    auto out = study::tradeoff_json(tradeoff);
    out["results_dir"] = directory.final_path();
    std::printf("%s\n", json_text(out).c_str());
    return 0;
  }
  const auto place = std::filesystem::absolute(directory.final_path()).lexically_normal();
  std::printf("%sResults: %s\nReport:  %s\n", study::tradeoff_table(tradeoff).c_str(), place.c_str(),
              (place / "report.html").c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_mission_options(arguments, options->mission);
  arguments.option("--part", options->parts,
                   "parts to measure, with commas between: " + joined(study::tradeoff_parts()) + "; without it all");
  arguments
      .option("--recording", options->recording,
              "a recorded GNSS drive with its surveyed truth and scene (docs/tradeoff.md), for the part recorded")
      .type("FILE.toml");
  arguments.option("--fidelity", options->fidelity, "what ladders vary one setting of").default_shown();
  arguments.option("--samples", options->samples, "epochs, scans, windows or keyframes, spread over the tape")
      .default_shown()
      .within(std::int64_t{2}, std::int64_t{100'000});
  arguments.option("--repetitions", options->repetitions, "of each model, interleaved in random order")
      .default_shown()
      .within(std::int64_t{5}, std::int64_t{1000});
  arguments
      .option(
          "--seeds", options->seeds,
          "part mission: closed loops of each fidelity, from the mission's own seed on, for the shares of outcomes; "
          "0: none")
      .default_shown()
      .within(std::int64_t{0}, std::int64_t{100'000});
  arguments
      .option("--for", options->outputs,
              "part mission: what somebody will read of the planned run, with commas between")
      .default_shown();
  arguments.option("--tape", options->tape.tape, "true motion: a .tape, or a results directory; without it the route")
      .type("RUN_DIR");
  arguments.option("--tolerance", options->tolerance,
                   "FIGURE=VALUE: the cheapest settings that change this figure of a run by no more (canyon keys "
                   "--figures lists them)");
  arguments.option("--budget-cpu", options->budget_cpu_s,
                   "the settings that change --figure least for so many CPU seconds per simulated second");
  arguments.option("--figure", options->figure, "what --budget-cpu is to keep").default_shown();
  arguments.option("--validate", options->validate, "seeds that the answer must hold on, which have not chosen it")
      .default_shown()
      .within(std::int64_t{1}, std::int64_t{10'000});
  arguments.option("--seconds", options->question_s, "of the true motion, from its start, that it is answered on")
      .default_shown()
      .within(1.0, 1e6);
  arguments.option("--write", options->write, "mission file to write, with the answer as the fidelity \"tradeoff\"")
      .type("FILE");
  return [options] { return run(*options); };
}

}  // namespace

Verb tradeoff_verb() {
  return {"tradeoff", "error against run time: every model of a part, what it errs and what it costs",
          "canyon tradeoff my.toml --part gnss,fusion", declare};
}

}  // namespace canyon::apps
