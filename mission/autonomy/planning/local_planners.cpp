#include "canyon/mission/autonomy/planning/local_planner.h"

namespace canyon::mission {
namespace {

constexpr ModelRow<MakeLocalPlanner> kPlanners[] = {
    {"offsets", make_offset_planner, "the cheapest of lines beside the lane, each driven in thought",
     offset_planner_parameters},
};

}  // namespace

ModelTable<MakeLocalPlanner> local_planners() {
  return kPlanners;
}

}  // namespace canyon::mission
