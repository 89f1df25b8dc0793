#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/config/config.h"
#include "canyon/core/motion/rotation.h"

namespace canyon::mission {

/// [autonomy.grid] of a mission file.
struct LocalGridConfig {
  double cell_m = 0.25;
  double half_size_m = 25.0;           ///< what lies farther off counts as free
  double memory_s = 6.0;               ///< a surface not seen again for this long is forgotten
  double obstacle_step_m = 0.4;        ///< height difference within a cell that no wheel climbs
  double max_obstacle_height_m = 2.2;  ///< above the vehicle's own ground plane; higher things are driven under
  double min_depth_m = -2.5;           ///< below that plane; lower points are not of this street
  std::int64_t min_hits = 3;           ///< points in a cell before it is judged
};
void visit(FieldVisitor& f, LocalGridConfig& c);

/// The autonomy's own picture of its surroundings: a rolling height grid in the frame of the estimate (W as the vehicle
/// believes it). A cell whose points differ in height by more than a wheel climbs is an obstacle. Because points are
/// placed with the estimated pose, a jump of the estimate leaves the street at two heights, and so obstacles that are
/// not there.
class LocalGrid {
 public:
  explicit LocalGrid(const LocalGridConfig& config);

  /// Adds points (in L at the scan's stamp) seen from X_WL; `t_s` is the scan's time. X_WB gives the ground plane.
  void add(const std::vector<Eigen::Vector3f>& points_L, const Pose& X_WL, const Pose& X_WB, double t_s);
  /// Recomputes the distance to the nearest obstacle for every cell.
  void update_distances();

  /// Distance from p to the nearest obstacle's cell, m; capped at kFar. Outside the grid: kFar.
  double distance_m(const Eigen::Vector2d& p_W) const;
  std::int64_t obstacles() const { return obstacles_; }
  static constexpr double kFar = 10.0;

 private:
  /// Heights seen in one half of the memory; two alternate, so that the oldest half can be forgotten at once.
  struct Slot {
    float min_z, max_z;
    std::int32_t hits = 0;
    std::int32_t era = -1;
  };
  struct Cell {
    Slot slot[2];
  };
  std::size_t index(int ix, int iy) const;

  LocalGridConfig config_;
  int n_;
  std::int64_t center_x_ = 0, center_y_ = 0;  ///< cell indices of the centre in W
  std::vector<Cell> cells_;                   ///< wraps around: cell (ix, iy) lives at (ix mod n, iy mod n)
  std::vector<std::int64_t> owner_x_, owner_y_;
  std::vector<float> distance_;
  std::int32_t era_ = 0;
  std::int64_t obstacles_ = 0;
};

}  // namespace canyon::mission
