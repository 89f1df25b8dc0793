#pragma once

#include "canyon/core/motion/true_motion.h"
#include "canyon/lidar/scanner.h"
#include "canyon/study/tradeoff/probes/probe.h"

namespace canyon::study {

/// Scans a tape at ticks of the configured rate, each against poses every pose_step_s of the true motion.
class TapedScanner {
 public:
  static Result<TapedScanner> make(const ProbeSetup& setup, double pose_step_s);

  /// Stamp of a tick; poses from before its first ray to the stamp.
  GpsTime time_of(std::int64_t k) const { return tick(setup_.mission.start, k, setup_.config.lidar.rate_hz); }
  Trajectory poses(const TrueMotion& motion, std::int64_t k) const;
  /// Places what moves; then scan() is the sensor's own work.
  void prepare(std::int64_t k);
  void scan(std::int64_t k, const Trajectory& poses, lidar::LidarOutput& out);
  std::int64_t rays() const { return scanner_->rays(); }
  /// The shortest time after the tape's start at which a whole scan lies on it.
  double margin_s() const;

 private:
  TapedScanner(const ProbeSetup& setup, std::unique_ptr<lidar::Scanner> scanner, double pose_step_s)
      : setup_(setup), scanner_(std::move(scanner)), scene_(*setup.mission.scene), pose_step_s_(pose_step_s) {}

  ProbeSetup setup_;
  std::unique_ptr<lidar::Scanner> scanner_;
  scene::SceneAt scene_;
  double pose_step_s_;
};

}  // namespace canyon::study
