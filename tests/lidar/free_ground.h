#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "canyon/tests/lidar/ground_under.h"

/// Which beams of a recording are bound for ground that nothing stands on, and how many of these came back.
namespace canyon::lidar::testing {

/// A shot of a recording, in the sensor's frame L.
struct AimedShot {
  Eigen::Vector3d from_L{0, 0, 0};   ///< where its beam begins, m
  Eigen::Vector3d along_L{1, 0, 0};  ///< unit
  bool returned = false;
  Eigen::Vector3d p_L{0, 0, 0};
  double intensity = 0.0;  ///< as the sensor gives it
};
/// The shots of one direction seen from above, the lowest first.
struct ShotColumn {
  double azimuth_rad = 0.0;  ///< in L, from x towards y
  std::vector<AimedShot> shots;
};

inline constexpr double kOpen_m = 1e9;
/// How far a column's ground is free, m across the sensor's axis; kOpen_m: nothing stands on it that a beam met. Up to
/// the first return, from the lowest beam up, that is not of the ground. Where that lies below the plane, the ground
/// falls away somewhere between its beam and the one below: half way. A return within the ground's tolerance may be of
/// a wall's foot: it is not counted, as its beam would have met the ground behind the wall.
double free_ground_m(const ShotColumn& column, const GroundPlane& ground);

/// Shots that would meet free ground so far off along the beam, how many came back from it, and how bright.
struct GroundBin {
  static constexpr double kWidth_m = 2.5;
  double shots = 0.0, returned = 0.0;
  double incidence_deg = 0.0;       ///< sum over the shots
  std::vector<double> intensities;  ///< of what came back, as the sensor gives them
  /// How many shots another sensor in the same place must, and may, have here.
  double least = 0.0, most = 0.0;

  double share() const { return returned / shots; }
  double median_intensity() const;
  double mean_intensity() const;
};
inline constexpr std::size_t kGroundBins = 24;
inline constexpr double kFarthestGround_m = GroundBin::kWidth_m * kGroundBins;
using GroundBins = std::array<GroundBin, kGroundBins>;

/// Adds the columns of a turn, in the order of their directions. `step_rad` is from one to the next. A ray of another
/// sensor may meet what up to `beside` columns on either side met; 0: its directions are the recorded ones.
void count_ground(const std::vector<ShotColumn>& turn, const std::vector<double>& free_m, const GroundPlane& ground,
                  double step_rad, std::ptrdiff_t beside, GroundBins& out);

/// Prints the median distance up to which the ground is free, for each of eight directions seen from above.
void print_free_ground(const std::vector<ShotColumn>& columns, const std::vector<double>& free_m);

}  // namespace canyon::lidar::testing
