#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress_rows.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/stress/made_scenes.h"

/// Things of the built-in city on ground that is known in closed form, and their extremes.
namespace canyon::scene::made {

/// Single precision of 200 m, of a corner and of the ground under it.
inline constexpr double kCornerGrain_m = 4.0 * stress::kHalfUlp * 200.0;

/// A plane that rises by 4 % to the north-east: its ground is known in closed form.
inline CityConfig tilted_city() {
  CityConfig config;
  config.seed = 41, config.extent_m = 400.0, config.terrain_cell_m = 16.0;
  config.slope_percent = 4.0, config.hill_height_m = 0.0, config.street_width_m = 14.0;
  return config;
}
inline double tilted_ground_m(const Eigen::Vector2d& p) {
  return 0.04 * std::sqrt(0.5) * (p.x() + p.y());
}

/// Corners of the triangles of each object, of one material.
inline std::vector<std::vector<Eigen::Vector3d>> corners_by_object(const SceneParts& parts,
                                                                   const std::string& material) {
  std::vector<std::vector<Eigen::Vector3d>> out(parts.objects.size());
  for (std::size_t i = 0; i < parts.mesh.triangles.size(); ++i) {
    if (parts.materials[parts.mesh.material[i]].name != material) continue;
    for (const std::uint32_t v : parts.mesh.triangles[i])
      out[parts.mesh.object[i]].push_back(parts.mesh.vertices[v].cast<double>());
  }
  return out;
}
struct Span3 {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(stress::kInfinity),
                  high = Eigen::Vector3d::Constant(-stress::kInfinity);
};
/// Extremes of corners along the axes of a frame.
inline Span3 span_of(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& origin,
                     const Eigen::Matrix3d& axes) {
  Span3 out;
  for (const Eigen::Vector3d& p : corners) {
    const Eigen::Vector3d q = axes.transpose() * (p - origin);
    out.low = out.low.cwiseMin(q), out.high = out.high.cwiseMax(q);
  }
  return out;
}

}  // namespace canyon::scene::made
