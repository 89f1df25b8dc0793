#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/options/mission_options.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/report/tradeoff/tradeoff_page.h"
#include "canyon/study/tradeoff/choosing/choose.h"
#include "canyon/study/tradeoff/output/tradeoff_output.h"
#include "canyon/study/tradeoff/tradeoff.h"

namespace canyon::apps {

namespace {

struct Options {
  MissionOptions mission;
  study::TapeChoice tape;
  std::string parts, fidelity = "high", tolerance, figure = "position_error_rms_m", write;
  std::optional<double> budget_cpu_s;
  std::int64_t samples = 60, repetitions = 5, seeds = 20;
  double question_s = 30.0;
};

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ",") + word;
  return out;
}

/// What was measured, as files of a directory that has been staged.
Status write_files(const study::Tradeoff& tradeoff, StagedDirectory& staged) {
  const std::string folder = staged.staging_path();
  const std::string summary = json_text(study::tradeoff_json(tradeoff), 2) + "\n";
  CANYON_TRY_STATUS(write_text_file(folder + "/summary.json", summary));
  CANYON_TRY_STATUS(write_text_file(folder + "/tradeoff.csv", study::tradeoff_csv(tradeoff)));
  CANYON_TRY(const std::string page, report::tradeoff_page(folder + "/summary.json"));
  CANYON_TRY_STATUS(write_text_file(folder + "/report.html", page));
  throw_if_cancelled();
  return staged.commit();
}

Result<int> run(const Options& options) {
  set_threads(options.mission.common.threads);
  study::TradeoffOptions asked{.parts = options.parts.empty() ? study::tradeoff_parts() : split_list(options.parts),
                               .fidelity = options.fidelity,
                               .samples = static_cast<std::size_t>(options.samples),
                               .repetitions = static_cast<int>(options.repetitions),
                               .question_s = options.question_s,
                               .show_progress = !options.mission.common.json};
  CANYON_TRY_STATUS(study::check_parts(asked.parts, "--part"));
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
               study::choose_and_describe(*question, file, asked, comparison, static_cast<int>(options.seeds)));
    if (tradeoff.chosen->found && written) {
      CANYON_TRY(const std::string text,
                 study::mission_with(*tradeoff.chosen, asked.fidelity, options.mission.mission, options.write));
      CANYON_TRY_STATUS(written->write(text));
      CANYON_TRY_STATUS(written->commit());
    }
  } else {
    CANYON_TRY(tradeoff, study::measure_tradeoff(file, asked, comparison));
  }
  CANYON_TRY_STATUS(write_files(tradeoff, directory));
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
  arguments.option("--fidelity", options->fidelity, "what ladders vary one setting of").default_shown();
  arguments.option("--samples", options->samples, "epochs, scans, windows or keyframes, spread over the tape")
      .default_shown()
      .within(std::int64_t{2}, std::int64_t{100'000});
  arguments.option("--repetitions", options->repetitions, "of each model, interleaved in random order")
      .default_shown()
      .within(std::int64_t{5}, std::int64_t{1000});
  arguments.option("--tape", options->tape.tape, "true motion: a .tape, or a results directory; without it the route")
      .type("RUN_DIR");
  arguments.option("--tolerance", options->tolerance,
                   "FIGURE=VALUE: the cheapest settings that change this figure of a run by no more (canyon keys "
                   "--figures lists them)");
  arguments.option("--budget-cpu", options->budget_cpu_s,
                   "the settings that change --figure least for so many CPU seconds per simulated second");
  arguments.option("--figure", options->figure, "what --budget-cpu is to keep").default_shown();
  arguments.option("--validate", options->seeds, "seeds that the answer must hold on, which have not chosen it")
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
