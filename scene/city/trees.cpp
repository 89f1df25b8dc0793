#include "canyon/scene/city/furniture.h"

#include <cmath>
#include <string>

#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/scene/city/draws.h"
#include "canyon/scene/city/kerb.h"
#include "canyon/scene/surfaces/tree.h"

namespace canyon::scene::city {
namespace {

bool clear_of_buildings(const Eigen::Vector2d& xy, double clearance_m, const std::vector<Building>& buildings) {
  for (const Building& b : buildings) {
    Eigen::Vector2d low = b.footprint_W[0], high = low;
    for (const Eigen::Vector2d& p : b.footprint_W) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const Eigen::Vector2d outside = (low - xy).cwiseMax(xy - high).cwiseMax(0.0);
    if (outside.norm() < clearance_m) return false;
  }
  return true;
}

}  // namespace

void add_trees(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  constexpr double kSpacing_m = 13.0, kCorner_m = 12.0, kBeyondKerb_m = 1.3;
  const auto seed = static_cast<std::uint64_t>(config.seed);
  const RandomStream streets(seed, "scene.city.street_trees"), parks(seed, "scene.city.park_trees"),
      leaves(seed, "scene.city.leaves");
  MeshBuilder mesh(parts);
  std::size_t number = 0;
  const auto plant = [&](const Eigen::Vector2d& xy, const TreeShape& shape) {
    mesh.begin_object("tree " + std::to_string(number + 1), ObjectKind::kTree);
    add_tree({xy.x(), xy.y(), terrain.height(xy.x(), xy.y())}, shape, leaves, number++, mesh, parts);
  };

  const std::vector<Kerb> all = kerbs(plan);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Kerb& kerb = all[k];
    const double share = by_zone(kerb.zone, 0.25, 0.4, 0.5, 0.4);
    for (std::size_t slot = 0; kCorner_m + (static_cast<double>(slot) + 1.0) * kSpacing_m < kerb.length_m - kCorner_m;
         ++slot) {
      throw_if_cancelled();
      Draws draws(streets, k, slot);
      const bool grown = draws.chance(share);
      const double radius_m = draws.between(1.3, 1.7), tall_m = draws.between(1.6, 2.0),
                   center_m = draws.between(4.9, 5.6);
      if (!grown) continue;
      const Eigen::Vector2d xy = kerb.at(kCorner_m + (static_cast<double>(slot) + 0.5) * kSpacing_m,
                                         0.5 * config.street_width_m + kBeyondKerb_m);
      plant(xy, {center_m, {radius_m, radius_m, tall_m}});
    }
  }

  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    const Block& block = plan.blocks[b];
    const Rectangle land = block.kerb.inset(kSidewalk_m + 2.5);
    const double area_per_tree_m2 = by_zone(block.zone, 2500.0, 900.0, 500.0, 260.0);
    const auto wished = static_cast<std::size_t>(land.width() * land.depth() / area_per_tree_m2);
    for (std::size_t i = 0; i < wished; ++i) {
      throw_if_cancelled();
      Draws draws(parks, b, i);
      const double x = draws.between(land.x0, land.x1), y = draws.between(land.y0, land.y1);
      const Eigen::Vector2d xy(x, y);
      const double radius_m = draws.between(1.8, 3.5), tall_m = draws.between(2.0, 3.2),
                   center_m = draws.between(5.5, 7.0);
      if (!clear_of_buildings(xy, radius_m + 0.5, parts.buildings)) continue;
      plant(xy, {center_m, {radius_m, radius_m, tall_m}});
    }
  }
}

}  // namespace canyon::scene::city
