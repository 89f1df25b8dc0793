#pragma once

#include <memory>

#include "canyon/mission/autonomy/path.h"
#include "canyon/mission/autonomy/planning/driven_arc.h"

namespace canyon::mission {

/// What a plan is made from. The lane's middle is the route, as believed, moved sideways by `lane_m` (left positive).
struct PlanTask {
  const Path& route;  ///< in W
  double s_m = 0.0;   ///< where the vehicle is along it
  Eigen::Vector2d from_O_to_W{0, 0};
  double lane_m = 0.0;
  MovingBody body;  ///< in O
  const BlockedCells& blocked;
  const Tracker& tracker;
  const KnownVehicle& vehicle;
};

/// A line to follow, and what following it means.
struct LocalPlan {
  PlanLine line;
  DrivenArc arc;
  double offset_m = 0.0;   ///< of its end from the lane's middle, left positive
  double horizon_m = 0.0;  ///< how far it was looked at
};

/// Where to drive next. One-level interface; the models are in the table below, each in its own file with its own
/// parameters.
class LocalPlanner {
 public:
  virtual ~LocalPlanner() = default;
  virtual LocalPlan plan(const PlanTask& task) = 0;
  virtual Clearances clearances() const = 0;
};

using MakeLocalPlanner = std::unique_ptr<LocalPlanner>(const ModelParameters& own);
ModelTable<MakeLocalPlanner> local_planners();

/// Makers of the rows of the table in planning/local_planners.cpp, each in the file of its model.
std::unique_ptr<LocalPlanner> make_offset_planner(const ModelParameters& own);
std::unique_ptr<LocalPlanner> make_hybrid_a_star(const ModelParameters& own);

}  // namespace canyon::mission
