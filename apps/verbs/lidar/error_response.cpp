#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/options/drive.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/report/html_report.h"
#include "canyon/study/registration_error/response/error_response.h"
#include "canyon/study/seeds/further_seeds.h"

namespace canyon::apps {

namespace {

struct Options {
  MissionOptions mission;
  study::TapeChoice tape;
  study::ErrorResponseOptions response;
  std::string methods = "gicp,point_to_plane,none", errors, sizes;
};

Result<std::vector<double>> sizes_of(const std::string& list) {
  std::vector<double> sizes;
  for (const std::string& word : split_list(list)) {
    double size = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), size);
    if (error != std::errc() || end != word.data() + word.size() || !(size > 0.0 && size <= 1000.0))
      return Error{
          .file = "--sizes", .what = "\"" + word + "\"", .expected = "numbers above 0, up to 1000, apart by commas"};
    sizes.push_back(size);
  }
  return sizes;
}

Status write_files(const study::ErrorResponse& response, const std::string& directory) {
  CANYON_TRY_STATUS(write_text_file(directory + "/error_response.csv", study::error_response_csv(response)));
  CANYON_TRY_STATUS(
      write_text_file(directory + "/summary.json", json_text(study::error_response_json(response), 2) + "\n"));
  return report::write_html_report(directory, directory + "/report.html");
}

Result<int> run(const Options& options) {
  set_threads(options.mission.common.threads);
  study::ErrorResponseOptions how = options.response;
  how.methods = split_list(options.methods);
  if (!options.errors.empty()) how.errors = split_list(options.errors);
  if (!options.sizes.empty()) {
    CANYON_TRY(how.sizes, sizes_of(options.sizes));
  }
  CANYON_TRY_STATUS(study::check_response(how));
  how.show_progress = !options.mission.common.json;
  CANYON_TRY(const auto file, load_mission(options.mission));
  CANYON_TRY_STATUS(file.check_fidelities({how.fidelity}, "--fidelity"));
  CANYON_TRY(auto comparison, study::prepare_comparison(file, study::plan_runs({how.fidelity}, false)));
  CANYON_TRY_STATUS(study::check_seeds(comparison, how.seeds));
  const mission::MissionConfig& config = comparison.configs.front();
  CANYON_TRY_STATUS(study::choose_tape(options.tape, comparison));
  CANYON_TRY(auto directory, StagedDirectory::create(output_directory(options.mission, config), options.mission.force));
  CANYON_TRY(const study::ErrorResponse response,
             study::measure_error_response(config, comparison.missions.front(), *comparison.tape, how));
  CANYON_TRY_STATUS(write_files(response, directory.staging_path()));
  CANYON_TRY_STATUS(directory.commit());
  if (options.mission.common.json) {
    Json out = study::error_response_json(response);
    out["results_dir"] = directory.final_path();
    std::printf("%s\n", json_text(out).c_str());
    return 0;
  }
  const auto place = std::filesystem::absolute(directory.final_path()).lexically_normal();
  std::printf("%s\nResults: %s\n", study::error_response_table(response).c_str(), place.c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_mission_options(arguments, options->mission);
  arguments
      .option("--fidelity", options->response.fidelity,
              "whose LIDAR and filter: low, paper, high, high_aided, modern, or one of the mission file's own")
      .default_shown();
  arguments.option("--methods", options->methods, "rows of [registration] method, apart by commas").default_shown();
  arguments.option("--errors", options->errors,
                   with_rows("kinds of error, apart by commas; else all. The estimate", study::estimate_errors()));
  arguments.option("--sizes", options->sizes, "of all kinds, in each one's unit, apart by commas; else some of each");
  arguments.option("--stretch", options->response.stretch_m, "length of a place along the route, m")
      .default_shown()
      .within(10.0, 100'000.0);
  arguments.option("--seeds", options->response.seeds, "so many, the mission's own the first")
      .default_shown()
      .within(std::int64_t{1}, std::int64_t{1000});
  arguments
      .option(
          "--tape", options->tape.tape,
          "true motion to replay on: a .tape, or a results directory; else the mission's own route, driven on truth")
      .type("RUN_DIR");
  return [options] { return run(*options); };
}

}  // namespace

Verb lidar_error_response_verb() {
  return {"lidar error-response", "up to which errors of the estimate registration heals the map",
          "canyon lidar error-response my.toml --errors jump_m,attitude_deg --methods gicp,none", declare};
}

}  // namespace canyon::apps
