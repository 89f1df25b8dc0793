#include "canyon/apps/options/fidelity_study.h"

#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/process/parallel.h"
#include "canyon/report/html_report.h"
#include "canyon/study/seeds/further_seeds.h"

namespace canyon::apps {

void declare_fidelity_option(Arguments& arguments, FidelityStudyOptions& options) {
  arguments
      .option("--fidelity", options.fidelity, "low, paper, high, high_aided, modern, or one of the mission file's own")
      .default_shown();
}

void declare_seeds_option(Arguments& arguments, FidelityStudyOptions& options, const std::string& further) {
  arguments.option("--seeds", options.seeds, "so many, the mission's own the first" + further)
      .default_shown()
      .within(std::int64_t{1}, std::int64_t{1000});
}

void declare_tape_option(Arguments& arguments, FidelityStudyOptions& options) {
  arguments
      .option(
          "--tape", options.tape.tape,
          "true motion to replay on: a .tape, or a results directory; else the mission's own route, driven on truth")
      .type("RUN_DIR");
}

Result<FidelityStudy> begin_study(const FidelityStudyOptions& options) {
  set_threads(options.mission.common.threads);
  CANYON_TRY(const auto file, load_mission(options.mission));
  CANYON_TRY_STATUS(file.check_fidelities({options.fidelity}, "--fidelity"));
  CANYON_TRY(auto comparison, study::prepare_comparison(file, study::plan_runs({options.fidelity}, false)));
  CANYON_TRY_STATUS(study::check_seeds(comparison, options.seeds));
  if (options.open_loop) CANYON_TRY_STATUS(study::choose_tape(options.tape, comparison));
  const std::string path = output_directory(options.mission, comparison.configs.front());
  CANYON_TRY(auto directory, StagedDirectory::create(path, options.mission.force));
  return FidelityStudy{std::move(comparison), std::move(directory)};
}

Result<int> finish_study(const FidelityStudyOptions& options, FidelityStudy& study, Json summary,
                         const std::string& table, const std::vector<std::pair<std::string, std::string>>& files,
                         bool page) {
  const std::string& staging = study.directory.staging_path();
  for (const auto& [name, text] : files) CANYON_TRY_STATUS(write_text_file(staging + "/" + name, text));
  CANYON_TRY_STATUS(write_text_file(staging + "/summary.json", json_text(summary, 2) + "\n"));
  if (page) CANYON_TRY_STATUS(report::write_html_report(staging, staging + "/report.html"));
  CANYON_TRY_STATUS(study.directory.commit());
  if (options.mission.common.json) {
    summary["results_dir"] = study.directory.final_path();
    std::printf("%s\n", json_text(summary).c_str());
    return 0;
  }
  const auto place = std::filesystem::absolute(study.directory.final_path()).lexically_normal();
  std::printf("%s\nResults: %s\n", table.c_str(), place.c_str());
  return 0;
}

}  // namespace canyon::apps
