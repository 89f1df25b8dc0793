#include "canyon/scene/city/furniture.h"

#include <string>

#include "canyon/core/random/random.h"
#include "canyon/scene/city/draws.h"
#include "canyon/scene/city/kerb.h"

namespace canyon::scene::city {

void add_vehicles(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  constexpr double kLength_m = 4.5, kWidth_m = 1.8, kSlot_m = 6.5, kCorner_m = 15.0;
  const RandomStream stream(static_cast<std::uint64_t>(config.seed), "scene.city.vehicles");
  MeshBuilder mesh(parts);
  const std::uint16_t paint = mesh.material("painted_metal"), glass = mesh.material("glass");
  std::size_t count = 0;
  const std::vector<Kerb> all = kerbs(plan);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Kerb& kerb = all[k];
    const double share = by_zone(kerb.zone, 0.45, 0.35, 0.2, 0.05);
    for (std::size_t slot = 0; kCorner_m + (static_cast<double>(slot) + 1.0) * kSlot_m < kerb.length_m - kCorner_m;
         ++slot) {
      Draws draws(stream, k, slot);
      const bool occupied = draws.chance(share);
      const double along_m = kCorner_m + (static_cast<double>(slot) + 0.5) * kSlot_m + draws.between(-0.6, 0.6);
      const double across_m = 0.5 * config.street_width_m - 0.5 * kWidth_m - draws.between(0.08, 0.16);
      if (!occupied) continue;
      const Eigen::Vector2d xy = kerb.at(along_m, across_m);
      Eigen::Matrix3d axes;
      axes.col(2) = terrain.normal(xy.x(), xy.y());
      const Eigen::Vector3d heading(kerb.along.x(), kerb.along.y(), 0.0);
      axes.col(1) = axes.col(2).cross(heading).normalized();
      axes.col(0) = axes.col(1).cross(axes.col(2));
      const Eigen::Vector3d on_ground(xy.x(), xy.y(), terrain.height(xy.x(), xy.y()));
      mesh.begin_object("vehicle " + std::to_string(++count), ObjectKind::kVehicle);
      mesh.box(on_ground + 0.55 * axes.col(2), axes, {0.5 * kLength_m, 0.5 * kWidth_m, 0.35}, paint);
      mesh.box(on_ground + 1.20 * axes.col(2) - 0.2 * axes.col(0), axes, {1.2, 0.5 * kWidth_m - 0.12, 0.30}, glass);
    }
  }
}

}  // namespace canyon::scene::city
