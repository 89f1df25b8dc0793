#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/options/mission_options.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/study/tolerance/tolerance.h"

namespace canyon::apps {

namespace {

struct Options {
  MissionOptions mission;
  std::string fidelity = "low", error = "step_m";
  std::string sizes;
  std::int64_t seeds = 20;
};

Result<std::vector<double>> sizes_of(const Options& options) {
  if (options.sizes.empty()) return study::usual_sizes(options.error);
  std::vector<double> sizes;
  for (const std::string& word : split_list(options.sizes)) {
    double size = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), size);
    if (error != std::errc() || end != word.data() + word.size() || !(size >= 0.0 && size <= 1000.0))
      return Error{
          .file = "--sizes", .what = "\"" + word + "\"", .expected = "numbers from 0 to 1000, apart by commas"};
    sizes.push_back(size);
  }
  return sizes;
}

Result<int> run(const Options& options) {
  set_threads(options.mission.common.threads);
  CANYON_TRY(const auto file, load_mission(options.mission));
  CANYON_TRY_STATUS(file.check_fidelities({options.fidelity}, "--fidelity"));
  CANYON_TRY_STATUS(choose(study::disturbances(), options.error, "--error"));
  CANYON_TRY(const std::vector<double> sizes, sizes_of(options));
  const std::string out = options.mission.out.empty() ? free_name("results/tolerance") : options.mission.out;
  CANYON_TRY(auto directory, StagedDirectory::create(out, options.mission.force));
  CANYON_TRY(const study::ToleranceCurve curve, study::tolerance_curve(file, options.fidelity, options.error, sizes,
                                                                       options.seeds, !options.mission.common.json));
  auto json = study::tolerance_json(curve);
  CANYON_TRY_STATUS(write_text_file(directory.staging_path() + "/summary.json", json_text(json, 2) + "\n"));
  CANYON_TRY_STATUS(write_text_file(directory.staging_path() + "/tolerance.csv", study::tolerance_csv(curve)));
  throw_if_cancelled();
  CANYON_TRY_STATUS(directory.commit());
  if (options.mission.common.json) {
    json["results_dir"] = directory.final_path();
    std::printf("%s\n", json_text(json).c_str());
    return 0;
  }
  const auto place = std::filesystem::absolute(directory.final_path()).lexically_normal();
  std::printf("%s\nResults: %s\n", study::tolerance_table(curve).c_str(), place.c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_mission_options(arguments, options->mission);
  arguments.option("--fidelity", options->fidelity, "what else is simulated").default_shown();
  arguments.option("--error", options->error, with_rows("of which kind", study::disturbances())).default_shown();
  arguments.option("--sizes", options->sizes, "in the kind's unit, apart by commas; else some that span it");
  arguments.option("--seeds", options->seeds, "missions of each size, from the mission's own seed on")
      .default_shown()
      .within(std::int64_t{1}, std::int64_t{10'000});
  return [options] { return run(*options); };
}

}  // namespace

Verb tolerance_verb() {
  return {"tolerance", "how often a mission succeeds against one kind of error of navigation, by its size",
          "canyon tolerance --error step_m --sizes 1,3,10 --seeds 20", declare};
}

}  // namespace canyon::apps
