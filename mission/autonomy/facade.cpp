#include "canyon/mission/autonomy/facade.h"

#include <algorithm>

namespace canyon::mission {

std::vector<Eigen::Vector3d> facade_points(const scene::Building& building, const Eigen::Vector2d& from_W) {
  constexpr int kGrid = 5;
  constexpr double kInFront = 0.05;  // m
  const auto& corners = building.footprint_W;
  double best = 0.0;
  std::size_t wall = corners.size();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d along = corners[(i + 1) % corners.size()] - corners[i];
    const Eigen::Vector2d outward(along.y(), -along.x());  // footprints run counter-clockwise
    const Eigen::Vector2d sight = from_W - (corners[i] + 0.5 * along);
    // Apparent width: width times cosine over distance.
    const double apparent = outward.dot(sight) / std::max(1.0, sight.squaredNorm());
    if (apparent > best) {
      best = apparent;
      wall = i;
    }
  }
  std::vector<Eigen::Vector3d> points;
  if (wall == corners.size()) return points;  // seen from inside: no wall faces the viewer
  const Eigen::Vector2d a = corners[wall], along = corners[(wall + 1) % corners.size()] - a;
  const Eigen::Vector2d outward = Eigen::Vector2d(along.y(), -along.x()).normalized();
  for (int row = 0; row < kGrid; ++row) {
    for (int column = 0; column < kGrid; ++column) {
      const Eigen::Vector2d p = a + along * ((column + 0.5) / kGrid) + kInFront * outward;
      points.emplace_back(p.x(), p.y(), building.base_m + building.height_m * ((row + 0.5) / kGrid));
    }
  }
  return points;
}

double visible_share(const scene::SceneAt& scene, const Eigen::Vector3d& camera_W,
                     const std::vector<Eigen::Vector3d>& points_W) {
  if (points_W.empty()) return 0.0;
  int seen = 0;
  for (const auto& point : points_W) seen += scene.blocked(camera_W, point) ? 0 : 1;
  return static_cast<double>(seen) / static_cast<double>(points_W.size());
}

}  // namespace canyon::mission
