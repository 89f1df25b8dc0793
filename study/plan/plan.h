#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "canyon/core/need.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/omissions.h"
#include "canyon/study/plan/outputs.h"

namespace canyon::study {

/// By a figure's key (study/results/figures.h), in the figure's own unit.
using FigureValues = std::map<std::string, double>;

/// One line of a plan: what was found of one effect on one stretch of the route.
struct PlannedEffect {
  Need need;
  std::string segment;                ///< "whole run", "120-180 m" of the route
  double start_m = 0.0, end_m = 0.0;  ///< both 0 for a whole run
  std::int64_t saved_work = 0;        ///< of a delay: models asked less often, over the replayed epochs (docs/plan.md)
  double saved_cpu_s = kNaN;          ///< over the nominal mission, measured (study/plan/cost.h); NaN: not measured
  FigureValues moves{};               ///< by figure: how far leaving it out moves it at most; what has a tolerance
  bool whole_run() const { return end_m <= start_m; }
};

/// What a mission needs and does not need, for the outputs that somebody reads.
struct Plan {
  std::string mission, fidelity;
  std::vector<Output> outputs;
  double half_width_m = 0.0;  ///< of the corridor for which it holds
  FigureValues tolerances;    ///< that it was made for
  std::vector<PlannedEffect> effects;
  FigureValues figure_bounds;                    ///< how far all that is left out moves them at most
  std::vector<double> epoch_t_s, epoch_bound_m;  ///< the estimate of position, row by row of a run
  std::string tape_hash;                         ///< of the motion along which these bounds hold; empty: there are none
  std::vector<std::int64_t> seeds;               ///< whose runs on it they were taken from
  mission::Omissions omissions;
};

/// What decides a plan beside the mission.
struct PlanRequest {
  std::string fidelity;
  std::vector<Output> outputs;
  double half_width_m = kCorridor_m;
  bool open_loop = false;     ///< for runs on a tape
  FigureValues tolerances{};  ///< of figures that a bound reaches (study/plan/tolerated.h)
  /// Half of a street's lane and more: the reference autonomy leaves its line by 3.5 m at most, as it believes.
  static constexpr double kCorridor_m = 5.0;
};

/// Asks who reads what the run makes, and every model that can say it whether its effects can act along the route, from
/// the start to the time limit of the mission. Nothing is driven, unless there are tolerances: they are carried along
/// the route. Errors as of the GNSS sensor's files, and as of leave_out_tolerated().
Result<Plan> make_plan(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                       const PlanRequest& request);

}  // namespace canyon::study
