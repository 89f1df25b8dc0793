#pragma once

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "canyon/core/motion/trajectory.h"
#include "canyon/core/units.h"
#include "canyon/lidar/scanner.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

/// Scenes with closed forms, and motions through them.
namespace canyon::lidar::testing {

/// Lays keys of [lidar] over a configuration, as a mission file does: parameters that only a model's own file knows.
inline void set_keys(LidarConfig& config, const std::string& toml) {
  const auto node = ConfigNode::parse(toml, "keys.toml");
  CANYON_CHECK(node.ok(), node.error().str());
  const Status status = read_config(&*node, "lidar", config);
  CANYON_CHECK(status.ok(), status.error().str());
}

inline scene::SceneParts empty_parts() {
  scene::SceneParts parts;
  parts.name = "test";
  parts.materials = scene::builtin_materials();
  return parts;
}

/// Level ground at z = height, edge 2 half_m.
inline void add_ground(scene::SceneParts& parts, double half_m, double height_m = 0.0) {
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("terrain", scene::ObjectKind::kTerrain);
  mesh.quad({-half_m, -half_m, height_m}, {half_m, -half_m, height_m}, {half_m, half_m, height_m},
            {-half_m, half_m, height_m}, mesh.material("asphalt"));
}

/// A vertical wall from a to b, `height_m` high from z = -1.
inline void add_wall(scene::SceneParts& parts, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double height_m,
                     const std::string& material = "concrete") {
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("wall " + std::to_string(parts.objects.size()), scene::ObjectKind::kWall);
  mesh.quad({a.x(), a.y(), -1}, {b.x(), b.y(), -1}, {b.x(), b.y(), height_m}, {a.x(), a.y(), height_m},
            mesh.material(material));
}

inline void add_box(scene::SceneParts& parts, const Eigen::Vector3d& center, const Eigen::Vector3d& half,
                    double yaw_rad) {
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("box " + std::to_string(parts.objects.size()), scene::ObjectKind::kBuilding);
  mesh.box(center, rotation_from({.yaw_rad = yaw_rad}).toRotationMatrix(), half, mesh.material("brick"));
}

/// Four building blocks around the crossing of two 14 m streets, a parked van and a shed: every direction is
/// constrained.
inline scene::SceneParts street_crossing() {
  scene::SceneParts parts = empty_parts();
  add_ground(parts, 120.0);
  add_box(parts, {37, 37, 6}, {30, 30, 7}, 0.0);
  add_box(parts, {-32, 40, 5}, {25, 33, 6}, 0.0);
  add_box(parts, {-40, -35, 8}, {33, 28, 9}, 0.0);
  add_box(parts, {34, -33, 4}, {27, 26, 5}, 0.0);
  add_box(parts, {4.5, 14, 1}, {1, 2.5, 1.2}, 0.1);
  add_box(parts, {-12, -4.5, 1}, {2.0, 1.5, 1.2}, 0.4);
  return parts;
}

inline constexpr GpsTime kStart{1'000'000'000'000'000'000};

inline Trajectory standing(const Pose& X_WB, double seconds = 1.0) {
  Trajectory motion;
  motion.append({kStart - seconds, X_WB});
  motion.append({kStart + seconds, X_WB});
  return motion;
}

/// X_WB(t) = first * Exp(twist * t), stamps every 5 ms from -1 s to +1 s: exactly what interpolation on SE(3) assumes.
inline Trajectory twisting(const Pose& at_start, const Vector6d& twist_per_s) {
  Trajectory motion;
  for (int k = -200; k <= 200; ++k)
    motion.append({kStart + 0.005 * k, at_start * Pose::exp(twist_per_s * (0.005 * k))});
  return motion;
}

inline Pose pose_at(double x, double y, double z, double yaw_deg) {
  return {rotation_from({.yaw_rad = yaw_deg * kDegree}), {x, y, z}};
}

/// A sensor without noise and quantization, in the body's origin.
inline LidarConfig ideal_lidar() {
  LidarConfig config;
  config.mount_m.setZero();
  config.range_noise_m = 0;
  config.report.range_quantum_m = 0;
  return config;
}

inline Eigen::Vector3d position(const LidarPoint& p) {
  return {p.x, p.y, p.z};
}

inline std::vector<Eigen::Vector3f> positions(const LidarScan& scan) {
  std::vector<Eigen::Vector3f> out;
  for (const LidarPoint& p : scan.points) out.emplace_back(p.x, p.y, p.z);
  return out;
}

/// Bit for bit.
inline bool same(const LidarOutput& a, const LidarOutput& b) {
  if (a.scan.t != b.scan.t || a.scan.points.size() != b.scan.points.size() || a.truth.size() != b.truth.size())
    return false;
  for (std::size_t i = 0; i < a.scan.points.size(); ++i) {
    const LidarPoint &p = a.scan.points[i], &q = b.scan.points[i];
    if (p.x != q.x || p.y != q.y || p.z != q.z || p.intensity != q.intensity || p.time_s != q.time_s ||
        p.ring != q.ring)
      return false;
    const LidarPointTruth &s = a.truth[i], &t = b.truth[i];
    if (s.range_m != t.range_m || s.cos_incidence != t.cos_incidence || s.material != t.material ||
        s.object != t.object)
      return false;
  }
  return true;
}

}  // namespace canyon::lidar::testing
