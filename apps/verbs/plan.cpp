#include <cstdio>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/options/mission_options.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/mission/route_tape.h"
#include "canyon/study/compare.h"
#include "canyon/study/plan/cost.h"
#include "canyon/study/plan/plan_file.h"
#include "canyon/study/plan/plan_table.h"
#include "canyon/study/plan/tolerated.h"
#include "canyon/study/plan/verify.h"
#include "canyon/study/results/tolerance.h"

namespace canyon::apps {

namespace {

struct Options {
  MissionOptions mission;
  std::string fidelity = "high", outputs = "outcome,position,map,clouds", tolerances, write;
  bool open_loop = false;
  double corridor_m = study::PlanRequest::kCorridor_m;
  std::optional<std::int64_t> verify;
};

void print_json(const study::Plan& plan, const study::PredictedCost& cost,
                const std::optional<study::Verification>& verification) {
  Json json{{"mission", plan.mission}, {"fidelity", plan.fidelity}};
  json["effects"] = study::effects_json(plan);
  json["tolerances"] = study::tolerances_json(plan);
  json["position_bounds"] = study::position_bounds_json(plan);
  json["full_cpu_s"] = or_null(cost.full_s);
  json["planned_cpu_s"] = or_null(cost.planned_s);
  if (verification) {
    json["verified_epochs"] = verification->epochs();
    json["verified_by_kind"] = Json::object();
    for (const auto kind :
         {study::Verified::kPlaces, study::Verified::kRanges, study::Verified::kEstimates, study::Verified::kReaders})
      json["verified_by_kind"][study::name(kind)] = verification->epochs(kind);
    json["violations"] = verification->violations();
    json["tightness"] = or_null(verification->tightness());
    json["position_tightness"] = or_null(verification->position_tightness());
    json["verified"] = Json::array();
    for (const auto& effect : verification->effects)
      json["verified"].push_back({{"effect", effect.effect},
                                  {"kind", study::name(effect.kind)},
                                  {"replayed", effect.replayed},
                                  {"epochs", effect.epochs},
                                  {"violations", effect.violations},
                                  {"bound", effect.bound},
                                  {"unit", effect.unit},
                                  {"largest_difference", or_null(effect.largest_difference)}});
  }
  std::printf("%s\n", json_text(json).c_str());
}

Result<int> run(const Options& options) {
  set_threads(options.mission.common.threads);
  CANYON_TRY(const auto outputs, study::outputs_of(split_list(options.outputs), "--for"));
  const auto asked = options.tolerances.empty() ? std::vector<std::string>() : split_list(options.tolerances);
  CANYON_TRY(const auto tolerances, study::tolerances_of(asked, "--tolerance"));
  CANYON_TRY_STATUS(study::check_reached(tolerances, "--tolerance"));
  CANYON_TRY(const auto file, load_mission(options.mission));
  CANYON_TRY_STATUS(file.check_fidelities({options.fidelity}, "--fidelity"));
  std::optional<StagedFile> written;
  if (!options.write.empty()) {
    CANYON_TRY(StagedFile staged, StagedFile::create(options.write, options.mission.force));
    written.emplace(std::move(staged));
  }
  CANYON_TRY(const auto comparison, study::prepare_comparison(file, study::plan_runs({options.fidelity}, false)));
  const auto& config = comparison.configs.front();
  const auto& mission = comparison.missions.front();
  CANYON_TRY(auto plan,
             study::make_plan(config, mission,
                              {options.fidelity, outputs, options.corridor_m, options.open_loop, tolerances}));
  CANYON_TRY(const Tape tape, mission::drive_route(config, mission));
  CANYON_TRY(const auto cost, study::measure_cost(config, mission, tape, plan));
  std::optional<study::Verification> verification;
  if (options.verify) {
    CANYON_TRY(verification, study::verify_plan(config, mission, tape, plan, *options.verify));
  }
  const bool refuted = verification && verification->violations() > 0;
  if (written && !refuted) {
    CANYON_TRY_STATUS(written->write(study::plan_text(plan, config, mission)));
    CANYON_TRY_STATUS(written->commit());
  }
  print_warnings(mission.warnings);
  if (options.mission.common.json) {
    print_json(plan, cost, verification);
  } else {
    std::printf("%s", study::plan_table(plan, cost, mission.nominal_s).c_str());
    if (verification) std::printf("\n%s", study::verification_table(*verification).c_str());
    if (written && !refuted) std::printf("\nPlan: %s, for canyon run --plan\n", written->final_path().c_str());
    if (written && refuted) std::printf("\nPlan not written: it does not hold.\n");
  }
  return refuted ? 1 : 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_mission_choice(arguments, options->mission);
  arguments
      .option("--fidelity", options->fidelity, "low, paper, high, high_aided, modern, or one of the mission file's own")
      .default_shown();
  arguments
      .option("--for", options->outputs,
              "what somebody will read, with commas between: outcome, position, map, clouds; what only others need is "
              "left out")
      .default_shown();
  arguments
      .option("--tolerance", options->tolerances,
              "how far a figure may move over the run, in its own unit, with commas between (canyon keys --figures): "
              "what acts by less is left out too; without it nothing moves at all")
      .type("FIGURE=VALUE");
  arguments.flag("--open-loop", options->open_loop,
                 "the plan is for runs on a tape, which the autonomy does not drive");
  arguments.option("--corridor", options->corridor_m, "how far beside the planned route the plan holds, m")
      .default_shown()
      .within(0.5, 100.0);
  arguments.option("--write", options->write, "file that canyon run --plan and compare --plan follow").type("FILE");
  arguments.flag("--force", options->mission.force, "replace that file if it exists");
  arguments
      .option("--verify", options->verify,
              "replay so many epochs with and without what is left out; if one differs by more than its bound, exit "
              "status 1, and the plan is not written")
      .within(std::int64_t{1}, std::int64_t{10'000'000});
  return [options]() -> Result<int> { return run(*options); };
}

}  // namespace

Verb plan_verb() {
  return {"plan", "what a mission's scene and readers need, what they do not, and what that saves",
          "canyon plan my.toml --for outcome,position --write my.plan --verify 1000", declare};
}

}  // namespace canyon::apps
