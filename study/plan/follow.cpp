#include "canyon/study/plan/follow.h"

#include "canyon/core/check.h"
#include "canyon/study/plan/plan_file.h"

namespace canyon::study {

namespace {

Status check_outputs(const std::string& path, const Plan& plan, const std::vector<Output>& asked) {
  std::string made_for;
  for (const Output output : plan.outputs) made_for += (made_for.empty() ? "" : ",") + std::string(name(output));
  for (const Output output : asked)
    if (!reads(plan.outputs, output))
      return Error{.file = path,
                   .what = std::string("is a plan for runs of which nobody reads ") + name(output),
                   .expected = "--for " + made_for + ", or a plan made for what is to be read"};
  return Ok{};
}

}  // namespace

Status follow_plan(const std::string& path, const std::optional<std::vector<Output>>& outputs, Comparison& comparison) {
  CANYON_CHECK(comparison.plans.empty(), "a plan is followed already");
  const Tape* tape = comparison.tape ? &*comparison.tape : nullptr;
  for (std::size_t i = 0; i < comparison.plan.size(); ++i) {
    mission::MissionConfig& config = comparison.configs[i];
    const mission::PreparedMission& mission = comparison.missions[i];
    const RunPlan& run = comparison.plan[i];
    auto plan =
        path.empty()
            ? make_plan(
                  config, mission,
                  {.fidelity = run.name, .outputs = outputs ? *outputs : all_outputs(), .open_loop = tape != nullptr})
            : read_plan(path, config, mission, tape);
    if (!plan) {
      Error error = plan.error();
      if (comparison.plan.size() > 1 && !path.empty()) error.what = "run " + run.name + ": " + error.what;
      return error;
    }
    if (!path.empty() && outputs) CANYON_TRY_STATUS(check_outputs(path, *plan, *outputs));
    config = mission::without(config, plan->omissions);
    comparison.plans.push_back(*std::move(plan));
  }
  return Ok{};
}

}  // namespace canyon::study
