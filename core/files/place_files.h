#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/result.h"
#include "canyon/core/time.h"

namespace canyon {

/// A point on or above the Earth at an instant.
struct StampedPlace {
  GpsTime t;
  Eigen::Vector3d p_E;
  int line = 0;  ///< of the file it is from; 0 = of none
};

/// CSV of `gps_week,sow,lat_deg,lon_deg,h_m` (ellipsoidal height) or `gps_week,sow,x_m,y_m,z_m` (E), more columns
/// allowed behind. With a header the columns are found by name; without one, points farther than 1000 km from the
/// Earth's centre are coordinates in E. Times must increase.
Result<std::vector<StampedPlace>> read_places(const std::string& path);

/// The way of a point through E: cubic between the places given (Hermite, slopes by differences over the neighbours),
/// so that the velocity is continuous.
class PlacePath {
 public:
  /// At least one place, in the order of time.
  explicit PlacePath(std::vector<StampedPlace> places);
  /// The way of a point fixed to B, `lever_arm_B` from its origin.
  PlacePath(const Trajectory& trajectory, const LocalFrame& frame, const Eigen::Vector3d& lever_arm_B);

  GpsTime first() const { return places_.front().t; }
  GpsTime last() const { return places_.back().t; }
  struct State {
    Eigen::Vector3d p_E, v_E;
  };
  /// nullopt outside [first, last]; a single place holds for all times and stands still.
  std::optional<State> at(GpsTime t) const;

 private:
  Eigen::Vector3d slope(std::size_t i) const;
  std::vector<StampedPlace> places_;
};

}  // namespace canyon
