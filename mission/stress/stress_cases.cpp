#include "canyon/mission/stress/stress_cases.h"

#include "canyon/mission/stress/runs/subjects.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (auto* const subject :
       {autonomy_cases,    boundary_cases,    collision_cases, command_cases,   drive_cases,
        ground_cell_cases, localizer_cases,   mapping_cases,   path_cases,      perception_cases,
        plan_cases,        plan_model_cases,  schedule_cases,  score_cases,     searched_plan_cases,
        self_check_cases,  sprung_mass_cases, tape_cases,      traffic_cases,   vehicle_cases,
        corridor_cases,    default_cases,     ended_run_cases, heard_run_cases, search_cases})
    for (StressCase& one : subject()) all.push_back(std::move(one));
  return all;
}

}  // namespace canyon::mission
