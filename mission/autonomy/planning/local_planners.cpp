#include "canyon/mission/autonomy/planning/local_planner.h"
#include "canyon/mission/autonomy/planning/plan_parameters.h"

namespace canyon::mission {
namespace {

constexpr ModelRow<MakeLocalPlanner> kPlanners[] = {
    {"offsets", make_offset_planner, "the cheapest of lines beside the lane, each driven in thought",
     parameters_of<PlanParameters>},
    {"hybrid_a_star", make_hybrid_a_star, "the cheapest of ways put together from arcs (Dolgov et al. 2010)",
     parameters_of<PlanParameters>},
};

}  // namespace

ModelTable<MakeLocalPlanner> local_planners() {
  return kPlanners;
}

}  // namespace canyon::mission
