#include "canyon/mission/autonomy/planning/local_planner.h"

namespace canyon::mission {
namespace {

constexpr ModelRow<MakeLocalPlanner> kPlanners[] = {
    {"offsets", make_offset_planner, "the cheapest of lines beside the lane, each driven in thought",
     offset_planner_parameters},
    {"hybrid_a_star", make_hybrid_a_star, "a search over arcs that the body can drive", hybrid_a_star_parameters},
};

}  // namespace

ModelTable<MakeLocalPlanner> local_planners() {
  return kPlanners;
}

}  // namespace canyon::mission
