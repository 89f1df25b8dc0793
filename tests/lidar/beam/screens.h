#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "canyon/tests/lidar/lidar_scenes.h"

/// Screens of one material before a sensor, for the closed forms of the LIDAR's models.
namespace canyon::lidar::testing {

inline LidarOutput scan_of(const scene::SceneParts& parts, const LidarConfig& config, const Pose& X_WB = Pose{},
                           std::int64_t index = 0) {
  const scene::Scene scene(parts);
  auto scanner = make_scanner(config, 1);
  EXPECT_TRUE(scanner.ok()) << scanner.error().str();
  return (*scanner)->scan(index, kStart, standing(X_WB), scene::SceneAt(scene));
}

/// A material that reflects light as said, and does nothing else.
inline void add_material(scene::SceneParts& parts, const std::string& name, double reflectance) {
  scene::Material m;
  m.name = name;
  m.lidar_reflectance = reflectance;
  parts.materials.push_back(m);
}

/// A plane square to x at x = range, wide enough for a beam that looks along x.
inline void add_screen(scene::SceneParts& parts, double range_m, double half_m, const std::string& material,
                       double y_min = -1e9) {
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("screen " + std::to_string(parts.objects.size()), scene::ObjectKind::kWall);
  const double left = std::max(-half_m, y_min);
  mesh.quad({range_m, half_m, -half_m}, {range_m, left, -half_m}, {range_m, left, half_m}, {range_m, half_m, half_m},
            mesh.material(material));
}

/// One laser that looks along the horizon.
inline LidarConfig level_laser() {
  LidarConfig config = ideal_lidar();
  config.beams = "grid:1:0:0";
  config.azimuth_steps = 3600;
  config.report.max_range_m = 1000;
  return config;
}

inline double yaw_deg(const LidarPoint& p) {
  return std::atan2(p.y, p.x) / kDegree;
}
}  // namespace canyon::lidar::testing
