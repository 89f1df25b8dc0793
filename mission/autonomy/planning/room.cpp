#include "canyon/mission/autonomy/planning/room.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace canyon::mission {
namespace {

constexpr double kTogether_m = 0.5;  // cells so far apart are of one thing
constexpr double kSlack_m = 0.05, kTouching_m = 0.01;
constexpr double kTurning_m = 2.0;  // at 5 m/s a body beside a wall has turned its tail out by then
constexpr double kGrowth = 0.1;     // from there on, a metre

std::int64_t square_of(const Eigen::Vector2d& cell) {
  const auto x = static_cast<std::int64_t>(std::floor(cell.x() / kTogether_m)),
             y = static_cast<std::int64_t>(std::floor(cell.y() / kTogether_m));
  return (x << 32) + y;
}

/// Cells that hang together with the first `begun` ones come to the front; how many they are then.
std::size_t gather(std::vector<Eigen::Vector2d>& cells, std::size_t begun) {
  std::unordered_multimap<std::int64_t, std::size_t> left;
  for (std::size_t i = begun; i < cells.size(); ++i) left.emplace(square_of(cells[i]), i);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < begun; ++i) found.push_back(i);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Eigen::Vector2d at = cells[found[k]];
    for (const double dx : {-kTogether_m, 0.0, kTogether_m})
      for (const double dy : {-kTogether_m, 0.0, kTogether_m}) {
        auto [next, end] = left.equal_range(square_of(at + Eigen::Vector2d(dx, dy)));
        while (next != end) {
          if ((cells[next->second] - at).norm() > kTogether_m) {
            ++next;
            continue;
          }
          found.push_back(next->second);
          next = left.erase(next);
        }
      }
  }
  std::vector<bool> is_found(cells.size(), false);
  for (const std::size_t i : found) is_found[i] = true;
  std::vector<Eigen::Vector2d> sorted;
  sorted.reserve(cells.size());
  for (const bool wanted : {true, false})
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (is_found[i] == wanted) sorted.push_back(cells[i]);
  cells = std::move(sorted);
  return found.size();
}

}  // namespace

Room::Room(const PlanPose& from, const Clearances& clearances, const BlockedCells& blocked, const KnownVehicle& vehicle,
           Gear gear)
    : clearances_(clearances), blocked_(blocked), vehicle_(vehicle) {
  const double least_m = clearances.least_m;
  if (blocked.clearance_m(from, vehicle, least_m) >= least_m) return;
  std::vector<Eigen::Vector2d> cells = blocked.all();
  const auto far = std::stable_partition(cells.begin(), cells.end(), [&](const Eigen::Vector2d& cell) {
    return vehicle.distance_m(from, cell) < least_m;
  });
  const std::size_t near = gather(cells, static_cast<std::size_t>(far - cells.begin()));
  const auto border = cells.begin() + static_cast<std::ptrdiff_t>(near);
  Beside beside;
  beside.near = BlockedCells(from.p_m, {cells.begin(), border});
  beside.rest = BlockedCells(from.p_m, {border, cells.end()});
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
