#include "canyon/study/plan/follow.h"

#include "canyon/core/check.h"
#include "canyon/study/plan/plan_file.h"

namespace canyon::study {

Status follow_plan(const std::string& path, const std::vector<Output>& outputs, bool open_loop,
                   Comparison& comparison) {
  CANYON_CHECK(comparison.plans.empty(), "a plan is followed already");
  for (std::size_t i = 0; i < comparison.plan.size(); ++i) {
    mission::MissionConfig& config = comparison.configs[i];
    const mission::PreparedMission& mission = comparison.missions[i];
    const RunPlan& run = comparison.plan[i];
    auto plan = path.empty()
                    ? make_plan(config, mission, {.fidelity = run.name, .outputs = outputs, .open_loop = open_loop})
                    : read_plan(path, config, mission, open_loop);
    if (!plan) {
      Error error = plan.error();
      if (comparison.plan.size() > 1 && !path.empty()) error.what = "run " + run.name + ": " + error.what;
      return error;
    }
    config = mission::without(config, plan->omissions);
    comparison.plans.push_back(*std::move(plan));
  }
  return Ok{};
}

}  // namespace canyon::study
