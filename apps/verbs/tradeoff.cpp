#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/tradeoff_files.h"
#include "canyon/apps/options/tradeoff_options.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/study/tradeoff/choosing/choose.h"
#include "canyon/study/tradeoff/output/tradeoff_output.h"

namespace canyon::apps {

namespace {

Result<study::Tradeoff> answer(const AskedTradeoff& asked, const mission::MissionFile& file,
                               const study::Comparison& comparison) {
  if (!asked.question) return study::measure_tradeoff(file, asked.options, comparison);
  return study::choose_and_describe(*asked.question, file, asked.options, comparison, asked.validate);
}

Result<int> run(const TradeoffCall& call) {
  set_threads(call.mission.common.threads);
  CANYON_TRY(const AskedTradeoff asked, asked_tradeoff(call));
  CANYON_TRY(const auto file, load_mission(call.mission));
  CANYON_TRY_STATUS(file.check_fidelities({asked.options.fidelity}, "--fidelity"));
  if (!call.write.empty()) CANYON_TRY_STATUS(study::check_writable(call.mission.mission, file, call.write));
  CANYON_TRY(const auto comparison, study::prepare_tradeoff(file, asked.options, call.tape));

  // What cannot be written is said before minutes are spent.
  CANYON_TRY(auto directory,
             StagedDirectory::create(output_directory(call.mission, comparison.configs.front()), call.mission.force));
  std::optional<StagedFile> written;
  if (!call.write.empty()) {
    CANYON_TRY(StagedFile staged, StagedFile::create(call.write, call.mission.force));
    written.emplace(std::move(staged));
  }
  CANYON_TRY(const study::Tradeoff tradeoff, answer(asked, file, comparison));
  std::vector<Staged*> outputs{&directory};
  if (written && tradeoff.chosen && tradeoff.chosen->found) {
    CANYON_TRY(const std::string text,
               study::mission_with(*tradeoff.chosen, asked.options.fidelity, call.mission.mission, call.write));
    CANYON_TRY_STATUS(written->write(text));
    outputs.push_back(&*written);
  }
  CANYON_TRY_STATUS(write_tradeoff_files(tradeoff, directory));
  CANYON_TRY_STATUS(commit_together(outputs));
  if (call.mission.common.json) {
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
  const auto call = std::make_shared<TradeoffCall>();
  declare_tradeoff_options(arguments, *call);
  return [call] { return run(*call); };
}

}  // namespace

Verb tradeoff_verb() {
  return {"tradeoff", "error against run time: every model of a part, what it errs and what it costs",
          "canyon tradeoff my.toml --part gnss,fusion", declare};
}

}  // namespace canyon::apps
