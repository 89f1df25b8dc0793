#include "apps/drive.h"

#include <cstdio>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "apps/invocation.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "mission/results.h"
#include "report/html_report.h"

namespace canyon::apps {

namespace {

void print_json(const mission::Results& results, const std::string& directory, const std::string& hash) {
  nlohmann::ordered_json out = mission::summary_json(results);
  // The contract's figures of cost stand beside the others, not under `timing`.
  for (auto& run : out["runs"]) {
    run["real_time_factor"] = run["timing"]["real_time_factor"];
    run["cpu_s"] = run["timing"]["cpu_s"];
  }
  out["seed"] = out["mission"]["seed"];
  out["results_dir"] = directory;
  out["hash"] = hash;
  // The directory's name may be of any bytes.
  std::printf("%s\n", out.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

/// Each warning once, however many runs met it.
void print_warnings(const mission::Results& results) {
  std::set<std::string> told;
  for (const auto& record : results.records)
    for (const auto& warning : record.warnings)
      if (told.insert(warning).second) std::fprintf(stderr, "warning: %s\n", warning.c_str());
}

}  // namespace

Result<int> drive_and_report(const MissionOptions& options, const mission::MissionFile& file,
                             const std::vector<study::RunPlan>& plan) {
  set_threads(options.common.threads);
  CANYON_TRY(const auto comparison, study::prepare_comparison(file, plan));
  const std::string directory = output_directory(options, comparison.configs.front());
  CANYON_TRY(auto staged, StagedDirectory::create(directory, options.force));
  CANYON_TRY(auto results, study::compare(comparison, !options.common.json));
  results.command_line = invocation().command_line;
  results.commit = invocation().commit;
  CANYON_TRY(const std::string hash, mission::write_results(staged.staging_path(), results));
  CANYON_TRY_STATUS(report::write_html_report(staged.staging_path(), staged.staging_path() + "/report.html"));
  throw_if_cancelled();
  CANYON_TRY_STATUS(staged.commit());

  print_warnings(results);
  if (options.common.json) {
    print_json(results, staged.final_path(), hash);
    return 0;
  }
  const auto& mission = *results.mission;
  std::printf("Mission %s, seed %lld, %s: %.0f m planned, nominal %.0f s, limit %.0f s\n\n",
              comparison.configs.front().run.name.c_str(), static_cast<long long>(comparison.configs.front().run.seed),
              mission.start.iso(0).c_str(), mission.prior.route.length_m(), mission.nominal_s, mission.time_limit_s);
  std::printf("%s\n", study::comparison_table(results).c_str());
  const auto place = std::filesystem::absolute(staged.final_path()).lexically_normal();
  std::printf("Driven in %.1f s.\nResults: %s\nReport:  %s\n", results.wall_s, place.c_str(),
              (place / "report.html").c_str());
  return 0;
}

}  // namespace canyon::apps
