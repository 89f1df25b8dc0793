#pragma once

#include <optional>

#include "canyon/mission/autonomy/perception/blocked_cells.h"

namespace canyon::mission {

struct Clearances {
  double least_m = 0.3;    ///< from the body to a blocked cell, at which it counts as hit
  double comfort_m = 0.8;  ///< nearer than this costs
};

enum class Gear { kForward, kReverse };

/// Where a body may go from where it stands. It keeps the least clearance from everything; of things that it stands
/// nearer to already it may not come nearer but by what its tail swings out while it turns away, and has to leave them
/// behind it. That is of these things alone: whatever else there is keeps its least clearance.
class Room {
 public:
  Room(const PlanPose& from, const Clearances& clearances, const BlockedCells& blocked, const KnownVehicle& vehicle,
       Gear gear = Gear::kForward);

  const KnownVehicle& vehicle() const { return vehicle_; }
  const Clearances& clearances() const { return clearances_; }
  /// From everything; at most the larger of both clearances.
  double clearance_m(const PlanPose& body) const;
  /// Whether the body may be there, with that clearance, after such a way.
  bool allows(const PlanPose& body, double clearance_m, double way_m) const {
    return clearance_m >= clearances_.least_m || (beside_ && allowed_beside(body, way_m));
  }

 private:
  bool allowed_beside(const PlanPose& body, double way_m) const;

  /// What the body stands too near to, with what hangs together with it, and the rest.
  struct Beside {
    BlockedCells near, rest;
    KnownVehicle leading;                   ///< the half of the body that goes ahead
    double whole_m = 0.0, leading_m = 0.0;  ///< what has to be kept, of the body and of that half
  };

  Clearances clearances_;
  const BlockedCells& blocked_;
  const KnownVehicle& vehicle_;
  std::optional<Beside> beside_;
};

}  // namespace canyon::mission
