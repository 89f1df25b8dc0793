#include "canyon/core/files/navigation_file.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/inertial/motion/models.h"
#include "canyon/inertial/motion/pose_spline.h"

namespace canyon::inertial {
namespace {

/// A reference solution in E, in a frame W at its first point.
Trajectory local_trajectory(const NavigationFile& file, const LocalFrame& frame) {
  Trajectory trajectory;
  for (const NavigationRecord& record : file.records)
    trajectory.append({record.t, frame.X_EW().inverse() * record.X_EU});
  return trajectory;
}

struct Recording {
  LocalFrame frame;
  Trajectory trajectory;
};

Result<Recording> read_recording(const MotionConfig& config) {
  Recording out{frame_of(config), {}};
  if (config.file.ends_with(".tum")) {
    CANYON_TRY(out.trajectory, read_tum(config.file));
    return out;
  }
  if (config.file.ends_with(".kitti")) {
    CANYON_TRY(out.trajectory, read_kitti(config.file, GpsTime{}, config.file_rate_hz));
    return out;
  }
  if (config.file.ends_with(".csv")) {
    auto poses = read_csv_trajectory(config.file);
    if (poses) {
      out.trajectory = std::move(*poses);
      return out;
    }
    // A CSV of geodetic positions is a reference solution; of any other the complaint about poses is the right one.
    const auto navigation = read_navigation_file(config.file);
    if (!navigation && poses.error().line != 1) return poses.error();
  }
  CANYON_TRY(const NavigationFile file, read_navigation_file(config.file));
  out.frame = LocalFrame(geodetic_from_ecef(file.records.front().X_EU.p));
  out.trajectory = local_trajectory(file, out.frame);
  return out;
}

}  // namespace

Result<PlacedMotion> make_recorded(const MotionConfig& config) {
  if (config.file.empty())
    return Error{.key = "file", .what = "no file given", .expected = "a .tum, .kitti, .csv or KF-GINS trajectory"};
  CANYON_TRY(const Recording recording, read_recording(config));
  PoseKnots knots;
  const auto& poses = recording.trajectory.poses();
  for (const StampedPose& pose : poses) {
    knots.t_s.push_back(pose.t - poses.front().t);
    knots.p_WB.push_back(pose.X_WB.p);
    knots.R_WB.push_back(pose.X_WB.R);
  }
  const auto motion = make_pose_spline(knots, config.smoothing_s);
  if (!motion) return Error{.file = config.file, .what = motion.error().what, .expected = motion.error().expected};
  return PlacedMotion{.frame = recording.frame, .start = poses.front().t, .motion = *motion};
}

}  // namespace canyon::inertial
