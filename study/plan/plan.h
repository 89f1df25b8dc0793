#pragma once

#include <string>
#include <vector>

#include "canyon/core/need.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/omissions.h"
#include "canyon/study/plan/outputs.h"

namespace canyon::study {

/// One line of a plan: what was found of one effect on one stretch of the route.
struct PlannedEffect {
  Need need;
  std::string segment;                ///< "whole run", "120-180 m" of the route
  double start_m = 0.0, end_m = 0.0;  ///< both 0 for a whole run
  double saved_cpu_s = kNaN;          ///< over the nominal mission, measured (study/plan/cost.h); NaN: not measured
  bool whole_run() const { return end_m <= start_m; }
};

/// What a mission needs and does not need, for the outputs that somebody reads.
struct Plan {
  std::string mission, fidelity;
  std::vector<Output> outputs;
  double half_width_m = 0.0;  ///< of the corridor for which it holds
  std::vector<PlannedEffect> effects;
  mission::Omissions omissions;
};

/// What decides a plan beside the mission.
struct PlanRequest {
  std::string fidelity;
  std::vector<Output> outputs;
  double half_width_m = kCorridor_m;
  /// Half of a street's lane and more: the reference autonomy leaves its line by 3.5 m at most, as it believes.
  static constexpr double kCorridor_m = 5.0;
};

/// Asks who reads what the run makes, and every model that can say it whether its effects can act along the route, from
/// the start to the time limit of the mission. Nothing is driven. Errors as of the GNSS sensor's files.
Result<Plan> make_plan(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                       const PlanRequest& request);

}  // namespace canyon::study
