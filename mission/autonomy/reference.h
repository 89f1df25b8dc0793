#pragma once

#include <memory>
#include <string>

#include "canyon/mission/autonomy/autonomy.h"
#include "canyon/mission/autonomy/perception/lane_reference.h"
#include "canyon/mission/autonomy/perception/perception.h"
#include "canyon/mission/autonomy/planning/local_planner.h"
#include "canyon/mission/autonomy/planning/recovery.h"
#include "canyon/mission/autonomy/planning/speed_rule.h"
#include "canyon/mission/autonomy/planning/tracker.h"
#include "canyon/mission/autonomy/self_check/self_check.h"

namespace canyon::mission {

/// A choice among the rows of one table, as a group of keys: `model`, and the keys of the rows.
template <auto Rows>
struct PartChoice {
  ModelChoice<Rows> model;
};
template <auto Rows>
void visit(FieldVisitor& f, PartChoice<Rows>& c) {
  static const std::string doc = with_rows("which", Rows());
  visit_choice(f, "model", c.model, doc.c_str());
}

/// Keys of the reference autonomy: its parts.
struct ReferenceParameters {
  PartChoice<perceptions> perception{ModelChoice<perceptions>("ground_grid")};
  PartChoice<lane_references> lane{ModelChoice<lane_references>("seen_street")};
  PartChoice<local_planners> planner{ModelChoice<local_planners>("offsets")};
  PartChoice<trackers> tracker{ModelChoice<trackers>("pure_pursuit")};
  PartChoice<speed_rules> speed{ModelChoice<speed_rules>("stopping_distance")};
  PartChoice<recoveries> recovery{ModelChoice<recoveries>("back_up")};
  PartChoice<self_checks> self_check{ModelChoice<self_checks>("none")};
  std::string memory_by = "estimate";  ///< whose speed what it has seen moves by: "estimate" or "wheel"
};
void visit(FieldVisitor& f, ReferenceParameters& c);

/// Whether it is a reference autonomy that wants an odometer.
bool counts_wheel(const AutonomyConfig& config);

/// The reference autonomy, in parts that can be exchanged one by one: perception of what blocks the way, where the lane
/// is, a plan that is driven in thought with the vehicle's own body and limits, a tracker, a speed from which it halts
/// within what it sees, what it does where nothing is free, and whether it still believes its estimate. What it sees it
/// remembers in an odometry frame that fixes do not move (perception/odometry_frame.h); route and waypoints it knows in
/// W, by the estimate.
std::unique_ptr<Autonomy> make_reference(const ModelParameters& own, const AutonomyConfig& config,
                                         const PriorKnowledge& prior, GpsTime start);

}  // namespace canyon::mission
