#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/result.h"
#include "canyon/core/time.h"

namespace canyon {

struct StampedPose {
  GpsTime t;
  Pose X_WB;
};

/// Poses in time order with interpolation on SE(3). Used for buffered truth and estimates, and for files.
class Trajectory {
 public:
  Trajectory() = default;
  explicit Trajectory(std::vector<StampedPose> poses);

  /// Times must increase strictly; throws otherwise.
  void append(const StampedPose& pose);
  /// Forgets poses before t, but keeps the one just before it, so that interpolation from t on stays possible.
  void forget_before(GpsTime t);
  /// Every pose becomes X * pose: the whole is moved, the motion in it stays.
  void move(const Pose& X);

  /// Pose at t; nullopt outside [first, last].
  std::optional<Pose> at(GpsTime t) const;
  const std::vector<StampedPose>& poses() const { return poses_; }
  bool empty() const { return poses_.empty(); }

 private:
  std::vector<StampedPose> poses_;
};

/// TUM: `t x y z qx qy qz qw` with t in seconds (GPS seconds since the GPS epoch when we write).
Result<Trajectory> read_tum(const std::string& path);
Status write_tum(const std::string& path, const Trajectory& trajectory);
/// KITTI: 12 numbers per line, row-major 3x4; no times, so `rate_hz` and `start` give them.
Result<Trajectory> read_kitti(const std::string& path, GpsTime start, double rate_hz);
Status write_kitti(const std::string& path, const Trajectory& trajectory);
/// CSV with header `gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz`, or the true poses of a mission's epochs/RUN_nav.csv.
Result<Trajectory> read_csv_trajectory(const std::string& path);

}  // namespace canyon
