#pragma once

#include <cstdint>
#include <vector>

#include "canyon/mission/autonomy/known_vehicle.h"

namespace canyon::mission {

/// The middles of all cells that are blocked, in the local frame O, sorted into square tiles about a centre, so that
/// what is near a place is found at once. Cells farther than kReach_m from the centre, in either axis, are left out.
class BlockedCells {
 public:
  static constexpr double kReach_m = 64.0;

  BlockedCells() : BlockedCells(Eigen::Vector2d::Zero(), {}) {}
  BlockedCells(const Eigen::Vector2d& centre_O, const std::vector<Eigen::Vector2d>& cells_O);

  const std::vector<Eigen::Vector2d>& all() const { return cells_; }
  /// From the body's rectangle at a pose to the nearest cell's middle, m: 0 where one lies in it, `cap_m` where none is
  /// nearer.
  double clearance_m(const PlanPose& body, const KnownVehicle& vehicle, double cap_m) const;
  /// Which of all() lie within a distance of a place.
  void find_within(const Eigen::Vector2d& p_O, double distance_m, std::vector<std::uint32_t>& found) const;

 private:
  int tile(double from_centre_m) const;
  /// Calls with the first and one past the last of the cells that may lie within `reach_m` of a place, row by row.
  template <class Look>
  void look_around(const Eigen::Vector2d& from_centre, double reach_m, const Look& look) const;

  Eigen::Vector2d centre_;
  std::vector<Eigen::Vector2d> cells_;  ///< tile by tile
  std::vector<std::uint32_t> first_;    ///< of each tile in cells_; one more at the end
};

}  // namespace canyon::mission
