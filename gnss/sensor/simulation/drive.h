#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "canyon/core/files/place_files.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/gnss/solver/ellipse_coverage.h"

namespace canyon::gnss {

/// Where and when a receiver measures, by itself: without vehicle and filter.
struct Drive {
  PlacePath path;         ///< of the antenna
  std::string path_name;  ///< the file that it is from; empty: it stands in one place
  GpsTime start;
  double duration_s = 0.0;
  double rate_hz = 1.0;

  /// Epochs at the start, the end and between.
  std::int64_t epochs() const;
  bool stands() const { return path_name.empty(); }
};

/// What is told of a drive at its end; NaN where there is nothing to say.
struct DriveTotals {
  std::int64_t epochs = 0, fixes = 0, tracked = 0, nlos = 0;
  std::int64_t below_ground = 0;  ///< epochs with the antenna below the scene's ground, which hides the sky
  double deepest_m = 0.0;
  double square_m2 = 0.0;  ///< of the fixes' errors, sum
  std::vector<double> gdop, horizontal_m;
  EllipseCoverage reported;

  void add(const GnssOutput& output);
  double satellites_mean() const;
  double nlos_share() const;
  double rms_m() const;
  double gdop_median() const;
  /// Of the fixes' horizontal errors.
  double horizontal_percentile_m(double share) const;
};

/// How far a point is below the ground of the scene, m; 0 above it and beside the scene.
double depth_below_ground_m(const scene::Scene& scene, const Eigen::Vector3d& p_W);

/// Measures epoch by epoch; `take` is given each. An Error where the way leads to a height that no model covers.
Result<DriveTotals> simulate_drive(const Drive& drive, GnssSensor& sensor, const scene::Scene& scene,
                                   const std::function<void(const GnssOutput&)>& take);

}  // namespace canyon::gnss
