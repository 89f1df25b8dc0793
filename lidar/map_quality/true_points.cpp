#include "canyon/lidar/map_quality/true_points.h"

#include <array>
#include <cmath>
#include <unordered_set>

#include <Eigen/Geometry>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::lidar {
namespace {

using CubeKey = std::array<std::int64_t, 3>;
struct CubeHash {
  std::size_t operator()(const CubeKey& k) const {
    std::uint64_t hash = 14695981039346656037u;
    for (const std::int64_t v : k) hash = (hash ^ static_cast<std::uint64_t>(v)) * 1099511628211u;
    return static_cast<std::size_t>(hash ^ (hash >> 29));
  }
};

CubeKey cube_of(const Eigen::Vector3d& p, double edge_m) {
  CubeKey key{};
  for (std::size_t i = 0; i < 3; ++i)
    key[i] = static_cast<std::int64_t>(std::floor(p[static_cast<Eigen::Index>(i)] / edge_m));
  return key;
}

/// The same beams, without anything that errs.
LidarConfig faultless(LidarConfig config) {
  config.model.name = "single_ray";
  config.detector.name = "ideal";
  config.see_through = {};
  config.weather = {};
  config.crosstalk = {};
  config.range_noise_m = config.angle_noise_deg = config.latency_s = 0.0;
  config.report.range_quantum_m = config.report.range_bias_m = 0.0;
  return config;
}

constexpr double kReach_m = 1.0, kBlock_m = 8.0, kPointsPerM2 = 16.0;
constexpr std::size_t kTrianglesAtOnce = 4096;

/// Whether a box comes near a map point, judged by blocks that hold some.
bool comes_near(const Eigen::AlignedBox3d& box, const std::unordered_set<CubeKey, CubeHash>& blocks) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kReach_m);
  const CubeKey low = cube_of(box.min() - margin, kBlock_m), high = cube_of(box.max() + margin, kBlock_m);
  for (std::int64_t x = low[0]; x <= high[0]; ++x)
    for (std::int64_t y = low[1]; y <= high[1]; ++y)
      for (std::int64_t z = low[2]; z <= high[2]; ++z)
        if (blocks.contains({x, y, z})) return true;
  return false;
}

/// Random points of a triangle that lie near the map.
void add_points(std::uint32_t t, const scene::Scene& scene, const std::unordered_set<CubeKey, CubeHash>& blocks,
                const PointGrid& map, std::vector<Eigen::Vector3f>& out) {
  const RandomStream stream(1, "lidar.map_quality.surfaces");
  const auto triangle = scene::Triangle::of(scene.mesh(), t);
  Eigen::AlignedBox3d box(triangle.a);
  box.extend(triangle.b).extend(triangle.c);
  if (!comes_near(box, blocks)) return;
  // As many as its area asks for in the mean, the last by chance.
  const double wanted = 0.5 * triangle.area_normal().norm() * kPointsPerM2;
  const auto count = static_cast<std::uint64_t>(wanted + stream.uniform(t, 0, 2));
  for (std::uint64_t i = 1; i <= count; ++i) {
    double u = stream.uniform(t, i, 0), v = stream.uniform(t, i, 1);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const Eigen::Vector3d p = triangle.a + u * (triangle.b - triangle.a) + v * (triangle.c - triangle.a);
    if (map.comes_within(p, kReach_m)) out.push_back(p.cast<float>());
  }
}

}  // namespace

Result<TruePoints> beams_met(const ScanDrive& drive, double step_m, double reach_m) {
  ScanDrive ideal = drive;
  ideal.lidar = faultless(drive.lidar);
  CANYON_TRY(const auto scanner, make_scanner(ideal.lidar, 1));
  const scene::SceneAt scene(*drive.scene);
  const Pose X_BL = sensor_in_body(ideal.lidar);
  TruePoints out;
  std::unordered_set<CubeKey, CubeHash> taken;
  LidarOutput output;
  for (std::int64_t k = 0; k < drive.scans; ++k) {
    throw_if_cancelled();
    const GpsTime t = drive.start + static_cast<double>(k) / drive.lidar.rate_hz;
    const auto X_WB = drive.motion.at(t);
    if (!X_WB) continue;
    const Eigen::Vector3f place = (*X_WB * X_BL.p).cast<float>();
    if (!out.sensor_W.empty() && (place - out.sensor_W.back()).norm() < step_m) continue;
    out.sensor_W.push_back(place);
    scanner->scan(k, t, drive.motion, scene, output);
    for (const LidarPoint& p : points_in_scene(ideal, output.scan)) {
      const Eigen::Vector3d at(p.x, p.y, p.z);
      if ((at - place.cast<double>()).norm() > reach_m) continue;
      if (taken.insert(cube_of(at, kTruePointLeaf_m)).second) out.met_W.push_back(at.cast<float>());
    }
  }
  return out;
}

std::vector<Eigen::Vector3f> surfaces_near(const PointGrid& map, const scene::Scene& scene) {
  std::unordered_set<CubeKey, CubeHash> blocks;
  for (const Eigen::Vector3f& p : map.points()) blocks.insert(cube_of(p.cast<double>(), kBlock_m));
  const PointGrid near_map(map.points(), kReach_m);
  const std::size_t triangles = scene.mesh().triangles.size();
  std::vector<std::vector<Eigen::Vector3f>> chunks((triangles + kTrianglesAtOnce - 1) / kTrianglesAtOnce);
  parallel_for(triangles, kTrianglesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      add_points(static_cast<std::uint32_t>(t), scene, blocks, near_map, chunks[begin / kTrianglesAtOnce]);
  });
  std::vector<Eigen::Vector3f> out;
  for (const auto& chunk : chunks) out.insert(out.end(), chunk.begin(), chunk.end());
  return out;
}

}  // namespace canyon::lidar
