#include "canyon/scene/city/furniture.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/scene/city/draws.h"

namespace canyon::scene::city {
namespace {

/// A straight wall that follows the ground in short pieces.
void add_wall(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double height_m, const Terrain& terrain,
              std::size_t number, MeshBuilder& mesh) {
  constexpr double kPiece_m = 6.0, kHalfThickness_m = 0.12;
  mesh.begin_object("wall " + std::to_string(number), ObjectKind::kWall);
  const std::uint16_t brick = mesh.material("brick");
  const Eigen::Vector2d along = (to - from).normalized(),
                        left = kHalfThickness_m * Eigen::Vector2d(-along.y(), along.x());
  const int pieces = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kPiece_m)));
  for (int i = 0; i < pieces; ++i) {
    const Eigen::Vector2d a = from + (to - from) * i / pieces, b = from + (to - from) * (i + 1) / pieces;
    const double za = terrain.height(a.x(), a.y()), zb = terrain.height(b.x(), b.y());
    const std::vector<Eigen::Vector2d> outline{a - left, b - left, b + left, a + left};
    const std::vector<double> top{za + height_m, zb + height_m, zb + height_m, za + height_m};
    mesh.walls(outline, {za - 0.4, zb - 0.4, zb - 0.4, za - 0.4}, top, brick);
    const auto corner = [&](std::size_t k) { return Eigen::Vector3d(outline[k].x(), outline[k].y(), top[k]); };
    mesh.quad(corner(0), corner(1), corner(2), corner(3), brick);
  }
}

}  // namespace

void add_garden_walls(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  constexpr double kGate_m = 4.0;
  const RandomStream stream(static_cast<std::uint64_t>(config.seed), "scene.city.walls");
  MeshBuilder mesh(parts);
  std::size_t count = 0;
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    throw_if_cancelled();
    if (plan.blocks[b].zone != Zone::kLow) continue;
    const Rectangle land = plan.blocks[b].kerb.inset(kSidewalk_m + 0.3);
    const auto corners = rectangle(land.x0, land.y0, land.x1, land.y1);
    for (std::size_t side = 0; side < 4; ++side) {
      Draws draws(stream, b, side);
      const bool built = draws.chance(0.45);
      const double gate = draws.between(0.3, 0.7), height_m = draws.between(0.9, 1.8);
      if (!built) continue;
      const Eigen::Vector2d from = corners[side], to = corners[(side + 1) % 4], along = (to - from).normalized();
      const double length_m = (to - from).norm();
      add_wall(from + 2.0 * along, from + (gate * length_m - 0.5 * kGate_m) * along, height_m, terrain, ++count, mesh);
      add_wall(from + (gate * length_m + 0.5 * kGate_m) * along, to - 2.0 * along, height_m, terrain, ++count, mesh);
    }
  }
}

}  // namespace canyon::scene::city
