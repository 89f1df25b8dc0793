#include "canyon/mission/autonomy/planning/driven_arc.h"

#include <algorithm>
#include <cmath>

namespace canyon::mission {
namespace {

constexpr double kAllButTouching_m = 0.1;  // cells are as wide

}  // namespace

double halting_way_m(const MovingBody& body, const KnownVehicle& vehicle) {
  return 0.5 * body.speed_m_s * body.speed_m_s / vehicle.max_deceleration_m_s2;
}

double steered_rad(double steering_rad, double curvature_1_m, double dt_s, const KnownVehicle& vehicle) {
  const double wanted =
      std::clamp(std::atan(curvature_1_m * vehicle.wheelbase_m), -vehicle.max_steering_rad, vehicle.max_steering_rad);
  const double most = vehicle.max_steering_rate_rad_s * dt_s;
  return steering_rad + std::clamp(wanted - steering_rad, -most, most);
}

DrivenArc drive_in_thought(const PlanLine& line, const MovingBody& from, double length_m, const Tracker& tracker,
                           const Room& room, double come_m, const WorthDriving& worth) {
  constexpr int kAskedEvery = 4;  // steps
  DrivenArc arc;
  if (line.empty()) return arc;
  MovingBody body = from;
  const double speed = std::max(kSlowestSteered_m_s, from.speed_m_s), dt_s = DrivenArc::kStep_m / speed;
  std::size_t nearest = line.nearest(body.pose.p_m, 0);
  const int steps = static_cast<int>(std::ceil(length_m / DrivenArc::kStep_m));
  arc.curvature_1_m.reserve(static_cast<std::size_t>(steps));
  const double halting_m = halting_way_m(from, room.vehicle());
  double touching_m = -1.0;
  bool blocked = false;
  for (int i = 1; i <= steps; ++i) {
    nearest = line.nearest(body.pose.p_m, nearest);
    const double wanted = tracker.curvature_1_m(line, nearest, body.pose, speed);
    const double before = body.steering_rad;
    body.steering_rad = steered_rad(before, wanted, dt_s, room.vehicle());
    const double kappa = std::tan(0.5 * (before + body.steering_rad)) / room.vehicle().wheelbase_m;
    body.pose = body.pose.along(kappa, DrivenArc::kStep_m);
    const double clearance = room.clearance_m(body.pose), way_m = i * DrivenArc::kStep_m;
    if (!blocked && !room.allows(body.pose, clearance, come_m + way_m)) {
      blocked = true;
      touching_m = std::min(kAllButTouching_m, 0.5 * room.clearance_m(from.pose));
    }
    if (blocked && (arc.untouched_m >= halting_m || clearance < touching_m)) return arc;
    arc.untouched_m = way_m;
    if (blocked) continue;
    arc.free_m = way_m;
    arc.closeness_m2 += DrivenArc::kStep_m * std::max(0.0, room.clearances().comfort_m - clearance);
    arc.curvature_1_m.push_back(static_cast<float>(kappa));
    if (worth && i % kAskedEvery == 0 && !worth(arc)) return arc;
  }
  arc.ends_free = !blocked;
  return arc;
}

DrivenArc drive_in_thought(const PlanLine& line, const MovingBody& from, double length_m, const Clearances& clearances,
                           const Tracker& tracker, const BlockedCells& blocked, const KnownVehicle& vehicle) {
  return drive_in_thought(line, from, length_m, tracker, Room(from.pose, clearances, blocked, vehicle));
}

double free_along(const PlanPose& from, double curvature_1_m, double distance_m, const Clearances& clearances,
                  const BlockedCells& blocked, const KnownVehicle& vehicle) {
  const double sign = distance_m < 0.0 ? -1.0 : 1.0;
  const Room room(from, {clearances.least_m, clearances.least_m}, blocked, vehicle,
                  distance_m < 0.0 ? Gear::kReverse : Gear::kForward);
  const int steps = static_cast<int>(std::floor(std::abs(distance_m) / DrivenArc::kStep_m));
  for (int i = 1; i <= steps; ++i) {
    const double way = i * DrivenArc::kStep_m;
    const PlanPose pose = from.along(curvature_1_m, sign * way);
    if (!room.allows(pose, room.clearance_m(pose), way)) return way - DrivenArc::kStep_m;
  }
  return std::abs(distance_m);
}

}  // namespace canyon::mission
