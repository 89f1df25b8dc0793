// What drives while it is scanned: where it is, shot by shot.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/stress/looks.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/scanner.h"
#include "canyon/lidar/stress/beams/closed_room.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {
namespace {

using made::closed_room;
using made::kScanAt;
using stress::kHalfUlp;
using stress::Looks;

/// A cube that drives away while it is scanned: it is where it was in the middle of every 32 firing cycles, less the
/// latency, and so are the points on its face. Single precision of 20 m.
StressFigure driven_meanwhile(double latency_s) {
  Looks looks;
  const auto scene = closed_room(false);
  scene::SceneParts cube;
  cube.name = "cube", cube.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(cube);
  mesh.begin_object("cube", scene::ObjectKind::kVehicle);
  mesh.box({0, 0, 3}, Eigen::Matrix3d::Identity(), {1, 30, 3}, mesh.material("brick"));
  const auto shape = std::make_shared<const scene::RigidShape>("cube", scene::ObjectKind::kVehicle, cube.mesh);
  LidarConfig c;
  c.beams = "grid:4:-5:5", c.azimuth_steps = 300, c.mount_m = {0, 0, 2.0}, c.latency_s = latency_s;
  c.range_noise_m = 0.0, c.report.range_quantum_m = 0.0, c.report.min_range_m = 0.01;
  auto scanner = make_scanner(c, 3);
  looks.right(scanner.ok());
  if (!scanner) return looks.figure();
  Trajectory still;
  for (const double dt : {-1.0, 1.0}) still.append({kScanAt + dt, Pose{}});
  std::mutex mutex;
  std::vector<double> asked_s;
  const auto place_m = [](double after_s) { return 15.0 + 40.0 * after_s; };
  const auto moving = [&](double after_s) {
    const std::lock_guard lock(mutex);
    asked_s.push_back(after_s);
    return std::vector<scene::Instance>{
        {shape, "cube", Pose{Eigen::Quaterniond::Identity(), {place_m(after_s), 0.0, 0.0}}}};
  };
  scene::SceneAt at(*scene);
  at.set_instances(moving(0.0));
  asked_s.clear();
  LidarOutput out;
  (*scanner)->scan(2, kScanAt, still, at, moving, out);
  std::sort(asked_s.begin(), asked_s.end());
  // 300 cycles of a third of a millisecond, the last of them at the stamp: nine volleys of 32 and one of twelve.
  const double step_s = 0.1 / 300.0;
  looks.right(asked_s.size() == 10);
  std::vector<double> middle_s;
  for (int v = 0; v < 10; ++v) middle_s.push_back(-0.1 + step_s * (1.0 + 32.0 * v + (v < 9 ? 16.0 : 6.0)) - latency_s);
  for (std::size_t v = 0; v < asked_s.size() && v < 10; ++v) looks.near(asked_s[v], middle_s[v], 1e-9);
  int on_it = 0;
  for (std::size_t k = 0; k < out.scan.points.size(); ++k) {
    if (out.truth[k].object != scene->objects().size()) continue;
    const LidarPoint& p = out.scan.points[k];
    const auto cycle = static_cast<std::size_t>(std::lround((p.time_s + 0.1) / step_s)) - 1;
    looks.near(p.x, place_m(middle_s[std::min<std::size_t>(cycle / 32, 9)]) - 1.0, 16.0 * kHalfUlp * 20.0);
    ++on_it;
  }
  looks.right(on_it > 200);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> driven_meanwhile_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "what drives while it is scanned", "the place at the stamp, or at the end of a volley",
           "where it is in the middle of every 32 cycles: single precision", "of the bound"});
  rows.add("beams/driven_meanwhile", [] { return driven_meanwhile(0.0); }).add("beams/driven_meanwhile_told_late", [] {
    return driven_meanwhile(0.04);
  });
  return rows.take();
}

}  // namespace canyon::lidar
