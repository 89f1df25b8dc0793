#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/verb.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/stress/cases.h"
#include "canyon/study/stress/stress_output.h"
#include "canyon/study/stress/sweep/sweep.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> what;
  study::CaseChoice cases;
  std::string fidelity;  // empty: not given
  std::optional<std::int64_t> seed, pairs;
  std::optional<double> budget_s;
  bool list = false, pairs_only = false;
};

bool is_mission(const std::string& name) {
  return name.ends_with(".toml") || name == mission::kDefaultMission;
}

/// An option of the other form is a mistake, not to be passed over.
Status refuse(bool given, const char* option, bool mission) {
  if (!given) return Ok{};
  return Error{.file = option,
               .what = mission ? "is for cases, not for a mission" : "is for a mission, not for cases",
               .expected = mission ? "cases, or the mission without it" : "a mission, or cases without it"};
}

Status check_form(const Options& o, bool mission) {
  if (mission) {
    CANYON_TRY_STATUS(refuse(!o.cases.group.empty(), "--group", mission));
    CANYON_TRY_STATUS(refuse(o.cases.long_form, "--long", mission));
    return refuse(o.list, "--list", mission);
  }
  CANYON_TRY_STATUS(refuse(!o.fidelity.empty(), "--fidelity", mission));
  CANYON_TRY_STATUS(refuse(o.pairs.has_value(), "--pairs", mission));
  CANYON_TRY_STATUS(refuse(o.pairs_only, "--pairs-only", mission));
  CANYON_TRY_STATUS(refuse(o.seed.has_value(), "--seed", mission));
  return refuse(o.budget_s.has_value(), "--budget-s", mission);
}

Result<int> run_cases(Options options) {
  options.cases.names = options.what;
  CANYON_TRY(const auto cases, study::choose_cases(study::all_stress_cases(), options.cases));
  if (options.list) {
    std::fputs(study::stress_list(cases).c_str(), stdout);
    return 0;
  }
  const auto results = study::run_cases(cases, !options.common.json);
  if (options.common.json)
    std::printf("%s\n", json_text(Json{{"cases", study::stress_json(results)}}).c_str());
  else
    std::fputs(study::stress_table(results).c_str(), stdout);
  for (const study::CaseResult& result : results)
    if (result.verdict == study::CaseVerdict::kFails) return 1;
  return 0;
}

Result<int> sweep(const Options& options) {
  const std::string& name = options.what.front();
  const std::string path = mission::is_built_in(name) ? name : std::filesystem::absolute(name).string();
  CANYON_TRY(const auto file, mission::MissionFile::load(path));
  const std::string fidelity = options.fidelity.empty() ? "high" : options.fidelity;
  CANYON_TRY_STATUS(file.check_fidelities({fidelity}, "--fidelity"));
  CANYON_TRY(auto config, file.resolve(fidelity));
  const auto keys = study::swept_keys([&config](FieldVisitor& f) { visit(f, config); });
  CANYON_TRY(const study::Sweep found,
             study::sweep_mission(keys, {.setup = {.program = std::filesystem::read_symlink("/proc/self/exe").string(),
                                                   .mission = path,
                                                   .fidelity = fidelity},
                                         .seed = static_cast<std::uint64_t>(options.seed.value_or(1)),
                                         .pairs = options.pairs.value_or(500),
                                         .singles = !options.pairs_only,
                                         .budget_s = options.budget_s,
                                         .show_progress = !options.common.json}));
  if (options.common.json) {
    Json json{{"cases", Json::array()}};
    json.update(study::sweep_json(found));
    std::printf("%s\n", json_text(json).c_str());
  } else {
    std::fputs(study::sweep_table(found).c_str(), stdout);
  }
  std::fflush(stdout);
  throw_if_cancelled();
  return found.failures.empty() ? 0 : 1;
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  bool missions = false;
  for (const std::string& name : options.what) missions = missions || is_mission(name);
  if (missions && options.what.size() > 1)
    return Error{.file = "command line", .what = "a mission and more", .expected = "one mission, or cases"};
  CANYON_TRY_STATUS(check_form(options, missions));
  if (!missions) return run_cases(options);
  return sweep(options);
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments
      .option("what", options->what,
              "cases, or subjects of cases (what stands before the \"/\"); or one mission, a .toml file or " +
                  std::string(mission::kDefaultMission) + ": every key of it at its ends; without it all cases")
      .type("CASE|MISSION.toml");
  arguments.option("--group", options->cases.group, with_rows("cases of one group", study::stress_groups()));
  arguments.flag("--long", options->cases.long_form, "also the cases that take long");
  arguments.flag("--list", options->list, "say what the cases are, as docs/stress.md does, and run none");
  arguments.option("--fidelity", options->fidelity, "that a mission is driven at; else high");
  arguments
      .option("--pairs", options->pairs,
              "of a mission's keys at once, drawn with the seed, after each by itself; else 500")
      .within(std::int64_t{0}, std::int64_t{1'000'000});
  arguments.flag("--pairs-only", options->pairs_only,
                 "leave out each key by itself, which no seed changes: for a second seed");
  arguments.option("--seed", options->seed, "of the pairs, and of the order under --budget-s; else 1")
      .within(std::int64_t{0}, kLargestSeed);
  arguments.option("--budget-s", options->budget_s, "seconds that a mission's trials may take, in random order")
      .within(1e-3, 1e9);
  return [options]() -> Result<int> { return run(*options); };
}

}  // namespace

Verb stress_verb() {
  return {"stress", "stiff and extreme cases of every model, or every key of a mission at its ends",
          "canyon stress --group stiff; canyon stress my.toml --budget-s 600", declare};
}

}  // namespace canyon::apps
