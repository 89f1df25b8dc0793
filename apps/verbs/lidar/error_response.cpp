#include <charconv>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/options/fidelity_study.h"
#include "canyon/study/registration_error/response/error_response.h"

namespace canyon::apps {

namespace {

struct Options {
  FidelityStudyOptions study;
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

Result<int> run(const Options& options) {
  study::ErrorResponseOptions how = options.response;
  how.methods = split_list(options.methods);
  if (!options.errors.empty()) how.errors = split_list(options.errors);
  if (!options.sizes.empty()) {
    CANYON_TRY(how.sizes, sizes_of(options.sizes));
  }
  how.fidelity = options.study.fidelity;
  how.seeds = options.study.seeds;
  how.show_progress = !options.study.mission.common.json;
  CANYON_TRY_STATUS(study::check_response(how));
  CANYON_TRY(auto study, begin_study(options.study));
  CANYON_TRY(const study::ErrorResponse response,
             study::measure_error_response(study.config(), study.mission(), *study.tape(), how));
  return finish_study(options.study, study, study::error_response_json(response), study::error_response_table(response),
                      {{"error_response.csv", study::error_response_csv(response)}}, true);
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  options->study.seeds = options->response.seeds;
  declare_mission_options(arguments, options->study.mission);
  declare_fidelity_option(arguments, options->study);
  arguments.option("--methods", options->methods, "rows of [registration] method, apart by commas").default_shown();
  arguments.option("--errors", options->errors,
                   with_rows("kinds of error, apart by commas; else all. The estimate", study::estimate_errors()));
  arguments.option("--sizes", options->sizes, "of all kinds, in each one's unit, apart by commas; else some of each");
  arguments.option("--stretch", options->response.stretch_m, "length of a place along the route, m")
      .default_shown()
      .within(10.0, 100'000.0);
  declare_seeds_option(arguments, options->study, "");
  declare_tape_option(arguments, options->study);
  return [options] { return run(*options); };
}

}  // namespace

Verb lidar_error_response_verb() {
  return {"lidar error-response", "up to which errors of the estimate registration heals the map",
          "canyon lidar error-response my.toml --errors jump_m,attitude_deg --methods gicp,none", declare};
}

}  // namespace canyon::apps
