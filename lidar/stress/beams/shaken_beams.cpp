// Beams that point beside where the sensor believes, in a room whose walls say how far they go.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/firing_pattern.h"
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
using stress::kHalfUlp;
using stress::kInfinity;
using stress::Looks;

double way_to_the_walls(const Vector3d& o, const Vector3d& d) {
  double best = kInfinity;
  const Vector3d low(-40, -35, 0), high(40, 35, 12);
  for (int a = 0; a < 3; ++a) {
    const double way = ((d[a] > 0.0 ? high[a] : low[a]) - o[a]) / d[a];
    if (way < best) best = way;
  }
  return best;
}

/// Beams that point beside where the sensor believes: each range is that along the direction which the documented
/// stream gives, each point along the nominal one; the true ranges alike. Single precision of 50 m and of directions,
/// over a slant of 10.
StressFigure shaken(std::int64_t index) {
  Looks looks;
  const auto scene = closed_room(false);
  LidarConfig c;
  c.beams = "grid:8:-8:25", c.azimuth_steps = 200, c.mount_m = {0.4, -0.3, 1.9};
  c.mount_yaw_pitch_roll_deg = {20.0, 3.0, -2.0};
  c.range_noise_m = 0.0, c.angle_noise_deg = 0.7, c.report.range_quantum_m = 0.0, c.report.min_range_m = 0.01;
  auto scanner = make_scanner(c, 51);
  const auto table = load_beam_table(c.beams);
  looks.right(scanner.ok() && table.ok());
  if (!scanner || !table) return looks.figure();
  const FiringPattern pattern(*table, 10.0, 200);
  const Pose X_WB{rotation_from({.yaw_rad = 0.4, .pitch_rad = -0.02, .roll_rad = 0.03}), {3.0, -5.0, 0.2}};
  Trajectory still;
  for (const double dt : {-1.0, 1.0}) still.append({kScanAt + dt, X_WB});
  const scene::SceneAt at(*scene);
  const LidarOutput out = (*scanner)->scan(index, kScanAt, still, at);
  const std::vector<float> ranges = (*scanner)->true_ranges(index, kScanAt, still, at);
  looks.right(out.scan.points.size() == 1600 && ranges.size() == 1600);
  if (out.scan.points.size() != 1600 || ranges.size() != 1600) return looks.figure();
  const Pose X_BL = sensor_in_body(c), X_WL = X_WB * X_BL;
  const RandomStream stream(51, "lidar.angle");
  const auto sweep = pattern.sweep(index);
  const double sigma = 0.7 * kDegree;
  double square = 0.0;
  for (std::size_t laser = 0; laser < 8; ++laser)
    for (std::size_t cycle = 0; cycle < 200; cycle += 16) {
      AimPacket aim;
      pattern.aim(sweep, laser, cycle, aim);
      for (std::size_t i = 0; i < 16 && cycle + i < 200; ++i) {
        const Vector3d d(aim.direction_x[i], aim.direction_y[i], aim.direction_z[i]);
        const Vector3d across = d.unitOrthogonal(), along = d.cross(across);
        const auto entity = static_cast<std::uint32_t>(laser);
        const auto n = static_cast<std::uint64_t>(index) * 200 + cycle + i;
        const Vector3d u =
            (d + sigma * (stream.normal(entity, n, 0) * across + stream.normal(entity, n, 1) * along)).normalized();
        const double exact = way_to_the_walls(X_WL.p, X_WL.R * u), grain = 10.0 * 50.0 * 8.0 * kHalfUlp;
        const LidarPoint& p = out.scan.points[(cycle + i) * 8 + laser];
        looks.right(p.ring == laser);
        looks.near(Vector3d(p.x, p.y, p.z).norm(), exact, grain);
        looks.near((Vector3d(p.x, p.y, p.z) - exact * d).norm(), 0.0, 2.0 * grain);
        looks.near(ranges[laser * 200 + cycle + i], exact, grain);
        square += (u - d).squaredNorm() / (2.0 * sigma * sigma) / 1600.0;
      }
    }
  // The stream's own scatter: 1600 pairs of normals.
  looks.near(square, 1.0, 5.0 / std::sqrt(1600.0));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> shaken_beam_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "beams that point beside where the sensor believes",
           "an axis twice, draws of another scan, a point along the beam that was truly fired",
           "the documented stream against the walls of a room: single precision over a slant", "of the bound"});
  rows.add("beams/shaken", [] { return shaken(0); }).add("beams/shaken_in_a_later_scan", [] { return shaken(7); });
  return rows.take();
}

}  // namespace canyon::lidar
