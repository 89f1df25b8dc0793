#pragma once

#include <functional>
#include <vector>

#include "canyon/mission/autonomy/perception/blocked_cells.h"
#include "canyon/mission/autonomy/planning/room.h"
#include "canyon/mission/autonomy/planning/tracker.h"

namespace canyon::mission {

/// The vehicle as it moves in the local frame.
struct MovingBody {
  PlanPose pose;
  double speed_m_s = 0.0;
  double steering_rad = 0.0;
};

/// What is driven when a tracker follows a line with the vehicle's limits of steering angle and rate, and what the body
/// sweeps on the way.
struct DrivenArc {
  static constexpr double kStep_m = 0.25;

  double free_m = 0.0;        ///< driven before the body comes too near to a blocked cell
  bool ends_free = false;     ///< nothing is in the way
  double untouched_m = 0.0;   ///< driven before the body all but touches one; looked for as far as it takes to halt
  double closeness_m2 = 0.0;  ///< way driven, times how much nearer than the comfortable clearance
  std::vector<float> curvature_1_m;  ///< at every step
};

/// Way that it takes to halt by full braking.
double halting_way_m(const MovingBody& body, const KnownVehicle& vehicle);

/// That steering rates are reckoned with, m/s: nothing is steered on the spot.
inline constexpr double kSlowestSteered_m_s = 1.0;

/// Steering once the vehicle has been asked for a curvature for a while.
double steered_rad(double steering_rad, double curvature_1_m, double dt_s, const KnownVehicle& vehicle);

/// Whether an arc that has been driven so far is still worth driving on.
using WorthDriving = std::function<bool(const DrivenArc& so_far)>;

/// Over `length_m`, the first pose being the body's own, as long as it keeps to `room`, in which it has come `come_m`
/// already. `worth` (may be empty) is asked every now and then; once it says no, the arc ends there and does not end
/// free.
DrivenArc drive_in_thought(const PlanLine& line, const MovingBody& from, double length_m, const Tracker& tracker,
                           const Room& room, double come_m = 0.0, const WorthDriving& worth = {});
/// In the room that the body has where it is.
DrivenArc drive_in_thought(const PlanLine& line, const MovingBody& from, double length_m, const Clearances& clearances,
                           const Tracker& tracker, const BlockedCells& blocked, const KnownVehicle& vehicle);

/// How far the body may go along an arc of constant curvature, in reverse if `distance_m` is negative; at most that.
double free_along(const PlanPose& from, double curvature_1_m, double distance_m, const Clearances& clearances,
                  const BlockedCells& blocked, const KnownVehicle& vehicle);

}  // namespace canyon::mission
