#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/messages.h"
#include "core/result.h"
#include "core/trajectory.h"
#include "core/truth.h"
#include "scene/scene_at.h"

namespace canyon::lidar {

/// [lidar] of a mission file.
struct LidarConfig {
  std::string beams = "vlp16";  ///< table in lidar/beams
  std::string model = "single_ray";
  double rate_hz = 10.0;                              ///< revolutions per second
  std::int64_t azimuth_steps = 1800;                  ///< firings per revolution
  Eigen::Vector3d mount_m{0.3, 0.0, 1.8};             ///< L in B
  Eigen::Vector3d mount_yaw_pitch_roll_deg{0, 0, 0};  ///< R_BL
  double min_range_m = 0.9;
  double max_range_m = 100.0;
  double range_noise_m = 0.02;  ///< 1-sigma; VLP-16 manual: +-3 cm typical accuracy
  double range_quantum_m = 0.002;
  bool blinded = false;  ///< returns nothing (coupling studies)
};
void visit(FieldVisitor& f, LidarConfig& c);

struct LidarOutput {
  LidarScan scan;
  std::vector<LidarPointTruth> truth;  ///< same index as scan.points
};

/// A spinning LIDAR. Makes the scan stamped t from rays fired over (t - period, t] against the buffered true motion.
class Scanner {
 public:
  virtual ~Scanner() = default;
  /// `truth` must cover [t - period, t]; poses of B in W. `index` numbers the revolution.
  virtual LidarOutput scan(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene) = 0;
  virtual std::int64_t rays() const = 0;  ///< fired so far
};

Result<std::unique_ptr<Scanner>> make_scanner(const LidarConfig& config, std::uint64_t seed);

/// Pose of the sensor in the body, from mount_m and mount_yaw_pitch_roll_deg.
Pose sensor_in_body(const LidarConfig& config);

/// Moves every point to the sensor frame at the scan's stamp, using the buffered motion (normally the filter's own):
/// p' = X_WL(t)^-1 X_WL(t + time_s) p. Points whose time the buffer does not cover are dropped.
/// Returned points are in L at the stamp with time_s = 0.
LidarScan deskew(const LidarScan& scan, const Trajectory& motion, const Pose& X_BL);

}  // namespace canyon::lidar
