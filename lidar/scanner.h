#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/result.h"
#include "canyon/core/truth.h"
#include "canyon/lidar/beam/no_surface.h"
#include "canyon/lidar/kept_room.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {

struct LidarOutput {
  LidarScan scan;
  std::vector<LidarPointTruth> truth;  ///< same index as scan.points
};

/// A LIDAR that scans. Makes the scan stamped t from rays fired over (t - period, t] against the buffered true motion.
///
/// Each ray leaves from where the sensor truly is at its firing time. What comes back goes through the chain of
/// LidarConfig: how the beam meets the scene (`model`), the air (`weather`), other sensors (`crosstalk`), the receiver
/// (`detector`), which echoes it reports (`returns`), bias, quantization and range limits. Points come in the order of
/// firing: cycle by cycle, within a cycle by firing time (equal times: by laser), within a shot by range; return_index
/// counts these from 0. A point lies where the sensor believes it pointed.
class Scanner {
 public:
  virtual ~Scanner() = default;
  /// `truth` must cover [t - latency - period, t - latency], lasers that run free one firing cycle more at the
  /// beginning (reach_s()); poses of B in W. `index` numbers the revolution. What was in `out` is replaced; its memory
  /// is used again, which saves a tenth of the time. `moving` says where moving things are so many seconds after the
  /// stamp; without it they stand as in `scene`, which must hold the same things in the same order in either case. They
  /// are placed anew for every 32 firing cycles.
  using InstancesAt = std::function<std::vector<scene::Instance>(double after_stamp_s)>;
  virtual void scan(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene,
                    const InstancesAt& moving, LidarOutput& out) = 0;
  void scan(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene, LidarOutput& out) {
    scan(index, t, truth, scene, nullptr, out);
  }
  LidarOutput scan(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene) {
    LidarOutput out;
    scan(index, t, truth, scene, out);
    return out;
  }
  /// True distances along the middle of every beam, laser by laser in the order of firing; infinity where nothing is
  /// met within max_range_m. Neither noise nor any other model.
  virtual void true_ranges(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene,
                           std::vector<float>& out) = 0;
  std::vector<float> true_ranges(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene) {
    std::vector<float> out;
    true_ranges(index, t, truth, scene, out);
    return out;
  }
  /// So long before its stamp the first shot of scan `index` may be fired, s: `truth` must reach back to there.
  virtual double reach_s(std::int64_t index) const = 0;
  /// From the next scan on, until it is called again: what its readers keep of it; null: all. Returns that lie outside
  /// may then be missing, the others are the same bits in the same order. A scanner whose shots depend on more than
  /// themselves follows all of them as ever (follows_shots_alone).
  virtual void keep(const KeptRoom*) {}
  virtual std::int64_t rays() const = 0;  ///< fired so far
};

Result<std::unique_ptr<Scanner>> make_scanner(const LidarConfig& config, std::uint64_t seed);

/// Pose of the sensor in the body, from mount_m and mount_yaw_pitch_roll_deg.
Pose sensor_in_body(const LidarConfig& config);

}  // namespace canyon::lidar
