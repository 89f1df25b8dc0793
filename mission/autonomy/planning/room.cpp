#include "canyon/mission/autonomy/planning/room.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace canyon::mission {
namespace {

constexpr double kTogether_m = 0.5;  // cells so far apart are of one thing
constexpr double kSlack_m = 0.05, kTouching_m = 0.01;
constexpr double kTurning_m = 2.0;  // at 5 m/s a body beside a wall has turned its tail out by then
constexpr double kGrowth = 0.1;     // from there on, a metre

/// Which cells a body stands nearer to than `least_m`, and those that hang together with them.
std::vector<bool> beside_body(const PlanPose& body, double least_m, const BlockedCells& blocked,
                              const KnownVehicle& vehicle) {
  const std::vector<Eigen::Vector2d>& cells = blocked.all();
  std::vector<bool> is_found(cells.size(), false);
  std::vector<std::uint32_t> found, next;
  const auto add = [&](std::uint32_t i) {
    if (is_found[i]) return;
    is_found[i] = true;
    found.push_back(i);
  };
  for (std::uint32_t i = 0; i < cells.size(); ++i)
    if (vehicle.distance_m(body, cells[i]) < least_m) add(i);
  for (std::size_t k = 0; k < found.size(); ++k) {
    next.clear();
    blocked.find_within(cells[found[k]], kTogether_m, next);
    for (const std::uint32_t i : next) add(i);
  }
  return is_found;
}

}  // namespace

Room::Room(const PlanPose& from, const Clearances& clearances, const BlockedCells& blocked, const KnownVehicle& vehicle,
           Gear gear)
    : clearances_(clearances), blocked_(blocked), vehicle_(vehicle) {
  const double least_m = clearances.least_m;
  if (blocked.clearance_m(from, vehicle, least_m) >= least_m) return;
  const std::vector<bool> is_near = beside_body(from, least_m, blocked, vehicle);
  std::vector<Eigen::Vector2d> near, rest;
  for (std::size_t i = 0; i < is_near.size(); ++i) (is_near[i] ? near : rest).push_back(blocked.all()[i]);
  Beside beside;
  beside.near = BlockedCells(from.p_m, near);
  beside.rest = BlockedCells(from.p_m, rest);
  beside.leading = vehicle;
  (gear == Gear::kForward ? beside.leading.rear_m : beside.leading.front_m) = 0.5 * (vehicle.rear_m + vehicle.front_m);
  beside.whole_m = std::max(0.0, beside.near.clearance_m(from, vehicle, least_m) - kSlack_m);
  // Every scan is a new beginning, and slack upon slack leads into what is ahead: at half the clearance it is gone.
  const double leading_m = beside.near.clearance_m(from, beside.leading, least_m);
  beside.leading_m = std::max(kTouching_m, leading_m - std::clamp(leading_m - 0.5 * least_m, 0.0, kSlack_m));
  beside_ = std::move(beside);
}

double Room::clearance_m(const PlanPose& body) const {
  return blocked_.clearance_m(body, vehicle_, std::max(clearances_.least_m, clearances_.comfort_m));
}

bool Room::allowed_beside(const PlanPose& body, double way_m) const {
  const double least_m = clearances_.least_m;
  const double whole_m = std::min(least_m, beside_->whole_m + kGrowth * std::max(0.0, way_m - kTurning_m));
  return beside_->rest.clearance_m(body, vehicle_, least_m) >= least_m &&
         beside_->near.clearance_m(body, vehicle_, least_m) >= whole_m &&
         beside_->near.clearance_m(body, beside_->leading, least_m) >= beside_->leading_m;
}

}  // namespace canyon::mission
