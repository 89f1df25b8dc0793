#include "canyon/scene/surfaces/tree.h"

#include <algorithm>
#include <cmath>

namespace canyon::scene {

void add_tree(const Eigen::Vector3d& foot_W, const TreeShape& shape, const RandomStream& leaves, std::size_t number,
              MeshBuilder& mesh, SceneParts& parts) {
  constexpr int kLeaves = 48;
  const Eigen::Vector2d xy = foot_W.head<2>();
  const double ground_m = foot_W.z();
  const std::uint16_t bark = mesh.material("bark"), leaf = mesh.material("foliage");

  const double r = 0.08 * shape.radii_m.x();
  const std::vector<Eigen::Vector2d> trunk{xy + Eigen::Vector2d(r, 0.0),
                                           xy + Eigen::Vector2d(0.5 * r, 0.866 * r),
                                           xy + Eigen::Vector2d(-0.5 * r, 0.866 * r),
                                           xy + Eigen::Vector2d(-r, 0.0),
                                           xy + Eigen::Vector2d(-0.5 * r, -0.866 * r),
                                           xy + Eigen::Vector2d(0.5 * r, -0.866 * r)};
  mesh.walls(trunk, std::vector<double>(6, ground_m - 0.3), std::vector<double>(6, ground_m + shape.crown_center_m),
             bark);

  const Foliage crown{{xy.x(), xy.y(), ground_m + shape.crown_center_m}, shape.radii_m};
  parts.foliage.push_back(crown);
  // Clumps of leaves as free triangles: uniform in the crown, turned at random, together hiding about half of what is
  // behind.
  const auto entity = static_cast<std::uint32_t>(number);
  const double size_m = 0.30 * shape.radii_m.x();
  for (std::uint64_t i = 0; i < kLeaves; ++i) {
    // The largest of three uniform numbers is distributed as a radius in a ball.
    const double radius =
        0.85 * std::max({leaves.uniform(entity, i, 10), leaves.uniform(entity, i, 11), leaves.uniform(entity, i, 12)});
    const Eigen::Vector3d center =
        crown.center_W + radius * leaves.direction(entity, 2 * i).cwiseProduct(crown.radii_m);
    const Eigen::Vector3d normal = leaves.direction(entity, 2 * i + 1);
    const Eigen::Vector3d other = std::abs(normal.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d u = normal.cross(other).normalized(), v = normal.cross(u);
    mesh.triangle(center + size_m * u, center + size_m * (-0.5 * u + 0.866 * v),
                  center + size_m * (-0.5 * u - 0.866 * v), leaf);
  }
}

}  // namespace canyon::scene
