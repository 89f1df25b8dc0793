#include <algorithm>
#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/allan.h"
#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/imu_log_options.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  ImuLogOptions log;
  std::string kinds, processes, out;
  int per_octave = 4;
  double confidence_percent = 95.0;
  bool force = false;
};

/// The names of a comma-separated list, each of which must be known.
Result<std::vector<std::string>> known_names(const std::string& list, const char* option,
                                             const std::vector<std::string>& known) {
  std::vector<std::string> names;
  if (list.empty()) return names;
  for (const std::string& name : split_list(list)) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      std::string all;
      for (const std::string& k : known) all += (all.empty() ? "of " : ", ") + k;
      return Error{option, 0, "", "\"" + name + "\" is none", all};
    }
    names.push_back(name);
  }
  return names;
}

Result<inertial::LogAnalysis> analyse(const Options& options) {
  inertial::LogAnalysisOptions how{
      .noise = {.per_octave = options.per_octave, .confidence = options.confidence_percent / 100.0, .processes = {}},
      .kinds = {}};
  CANYON_TRY(how.kinds, known_names(options.kinds, "--kind", inertial::deviation_kinds()));
  CANYON_TRY(how.noise.processes, known_names(options.processes, "--processes", inertial::noise_process_names()));
  std::erase(how.kinds, "overlapping");
  CANYON_TRY(inertial::ImuLog log, read_log(options.log, true));
  return inertial::analyse_log(std::move(log), how);
}

Status write_files(const inertial::LogAnalysis& a, const Options& options) {
  CANYON_TRY(auto staged, StagedDirectory::create(options.out, options.force));
  const std::string folder = staged.staging_path();
  CANYON_TRY_STATUS(write_text_file(folder + "/allan.csv", inertial::deviations_csv(a)));
  CANYON_TRY_STATUS(write_text_file(folder + "/allan.json", json_text(allan_json(a), 1) + "\n"));
  CANYON_TRY_STATUS(write_text_file(folder + "/allan.svg", allan_svg(a, options.log.log)));
  return staged.commit();
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  CANYON_TRY(const inertial::LogAnalysis a, analyse(options));
  tell_doubts(a.log);
  tell_motion(options.log.log, a.motion);
  if (!options.out.empty()) CANYON_TRY_STATUS(write_files(a, options));
  if (options.common.json)
    std::printf("%s\n", json_text(allan_json(a)).c_str());
  else
    print_allan(a, options.log.log);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  declare_imu_log(arguments, options->log);
  arguments.option("--kind", options->kinds, "deviations beside the overlapping one: modified,hadamard,total");
  arguments.option("--processes", options->processes,
                   "processes that the fit may use; default all: quantization,white,bias_instability,rate_random_walk,"
                   "ramp,gauss_markov,sinusoid,band_limit");
  arguments.option("--per-octave", options->per_octave, "points of the curves to an octave of averaging time")
      .within(1, 64)
      .default_shown();
  arguments.option("--confidence", options->confidence_percent, "of the intervals, per cent")
      .within(1.0, 99.99)
      .default_shown();
  arguments.option("--out", options->out, "directory for allan.csv, allan.json and allan.svg");
  arguments.flag("--force", options->force, "replace an existing --out");
  return [options]() -> Result<int> { return run(*options); };
}

}  // namespace

Verb imu_allan_verb() {
  return {"imu allan", "Allan deviation of a resting unit's log, and its noise processes",
          "canyon imu allan static.csv --out allan", declare};
}

}  // namespace canyon::apps
