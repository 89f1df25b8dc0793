// Scans of which a room alone is kept: shots that end where nobody keeps a return.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/lidar/deskew.h"
#include "canyon/lidar/kept_room.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/scanner.h"
#include "canyon/lidar/stress/beams/closed_room.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector3d;
using made::closed_room;
using made::kScanAt;
using stress::Looks;

/// With a room that is kept every return within it is still there, to the bit and in order, of a vehicle that moves and
/// turns by what it is said to; others are followed no farther than a return could be kept, and not fired at all where
/// nothing stands that near.
StressFigure kept_alone(bool pillars, double tilt_rad, bool radiometric) {
  Looks looks;
  const auto scene = closed_room(pillars);
  LidarConfig c;
  c.beams = "grid:24:-24:24", c.azimuth_steps = 240, c.mount_m = {0.5, 0.2, 1.9};
  c.mount_yaw_pitch_roll_deg = {10.0, 1.0, -1.5};
  c.report.range_bias_m = 0.01;
  if (radiometric) c.detector.name = "radiometric";
  Trajectory motion;
  for (int k = -12; k <= 1; ++k) {
    const double t = 0.01 * k;
    motion.append(
        {kScanAt + t, Pose{rotation_from({.yaw_rad = 0.5 * t, .pitch_rad = tilt_rad + 0.08 * t, .roll_rad = -0.06 * t}),
                           {1.0 + 0.4 * t, 0.0, 0.02}}});
  }
  KeptRoom room{.low_m = -0.4, .high_m = 2.6, .reach_m = 12.0, .turned_rad = 0.0112, .moved_m = 0.045};
  if (!pillars) {
    // From B's origin the nearest wall is 34.9 m off; the ground is level, so that it rises with the tilt.
    room.clear_m = 34.5, room.ground_rise = std::abs(tilt_rad) + 0.02, room.above_ground_m = 1.5;
  }
  const scene::SceneAt at(*scene);
  auto all = make_scanner(c, 5), kept = make_scanner(c, 5);
  looks.right(all.ok() && kept.ok());
  if (!all || !kept) return looks.figure();
  (*kept)->keep(&room);
  const LidarOutput whole = (*all)->scan(4, kScanAt, motion, at), part = (*kept)->scan(4, kScanAt, motion, at);
  const Pose X_BL = sensor_in_body(c);
  const auto within = [&](const LidarScan& scan) {
    std::vector<LidarPoint> out;
    for (const LidarPoint& p : deskew(scan, motion, X_BL).points) {
      const Vector3d p_B = X_BL * Vector3d(p.x, p.y, p.z);
      if (p_B.z() >= room.low_m && p_B.z() <= room.high_m && p_B.norm() <= room.reach_m) out.push_back(p);
    }
    return out;
  };
  const auto a = within(whole.scan), b = within(part.scan);
  looks.right(a.size() == b.size() && a.size() > 200);
  for (std::size_t k = 0; k < a.size() && k < b.size(); ++k)
    looks.right(a[k].x == b[k].x && a[k].y == b[k].y && a[k].z == b[k].z && a[k].time_s == b[k].time_s &&
                a[k].ring == b[k].ring && a[k].intensity == b[k].intensity);
  // How far a return can be that is kept: the reach and the sensor's place, what it moved, and its noise ten times;
  // above and below by its rise, less what it may have turned.
  const Vector3d up_L = X_BL.R.conjugate() * Vector3d::UnitZ();
  const double arm_m = X_BL.p.norm() + 0.2, slack_m = 0.045 + 0.0112 * arm_m + 0.2;
  const double edge_m = radiometric ? 0.75 / (2.0 * 6.0) : 0.0;  // of the faintest echo
  const double noise_m = 10.0 * (0.02 + 0.01 + edge_m) + 0.002 + 0.15;
  for (const LidarPoint& p : part.scan.points) {
    const Vector3d q(p.x, p.y, p.z);
    const double range = q.norm(), rise = up_L.dot(q) / range;
    looks.right(range <= room.reach_m + arm_m + 0.045 + noise_m + 0.05);
    if (rise > 0.02) looks.right(range <= (room.high_m - 1.9 + slack_m) / (rise - 0.0112) + noise_m + 0.05);
    if (rise < -0.02) looks.right(range <= (1.9 - room.low_m + slack_m) / (-rise - 0.0112) + noise_m + 0.05);
  }
  const std::int64_t rays = (*all)->rays(), fewer = (*kept)->rays();
  looks.right(rays == 24 * 240 && (pillars ? fewer == rays : fewer < rays - 1500 && fewer > 1500));
  // Once nothing is said to be kept, all of it is there again.
  (*kept)->keep(nullptr);
  looks.right((*kept)->scan(5, kScanAt, motion, at).scan.points.size() ==
              (*all)->scan(5, kScanAt, motion, at).scan.points.size());
  return looks.figure();
}

}  // namespace

std::vector<StressCase> kept_room_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "shots that end where nobody keeps a return",
           "a room in another frame, a shot that is shortened by what the vehicle moved in place of lengthened",
           "every return that is kept, to the bit; others no farther than they could be", "of the bound"});
  for (const double tilt : {0.0, 0.03, -0.03})
    for (const bool pillars : {true, false})
      for (const bool radiometric : {false, true})
        rows.add("beams/kept_alone_at_a_tilt_of_" + stress::text(tilt) + (pillars ? "_among_pillars" : "") +
                     (radiometric ? "_by_a_threshold" : ""),
                 [=] { return kept_alone(pillars, tilt, radiometric); });
  return rows.take();
}

}  // namespace canyon::lidar
