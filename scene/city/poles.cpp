#include "canyon/scene/city/furniture.h"

#include <string>

#include "canyon/core/process/progress.h"
#include "canyon/scene/city/kerb.h"

namespace canyon::scene::city {

void add_poles(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  constexpr double kSpacing_m = 26.0, kCorner_m = 12.0, kBeyondKerb_m = 0.6, kHeight_m = 8.0, kHalf_m = 0.07;
  MeshBuilder mesh(parts);
  const std::uint16_t metal = mesh.material("metal");
  std::size_t count = 0;
  const std::vector<Kerb> all = kerbs(plan);
  for (std::size_t k = 0; k < all.size(); ++k) {
    throw_if_cancelled();
    const Kerb& kerb = all[k];
    for (double along_m = kCorner_m + (k % 2 == 0 ? 0.0 : 13.0); along_m < kerb.length_m - kCorner_m;
         along_m += kSpacing_m) {
      const Eigen::Vector2d p = kerb.at(along_m, 0.5 * config.street_width_m + kBeyondKerb_m);
      const double ground_m = terrain.height(p.x(), p.y());
      mesh.begin_object("pole " + std::to_string(++count), ObjectKind::kPole);
      mesh.block(rectangle(p.x() - kHalf_m, p.y() - kHalf_m, p.x() + kHalf_m, p.y() + kHalf_m), ground_m - 0.3,
                 ground_m + kHeight_m, metal, metal);
    }
  }
}

}  // namespace canyon::scene::city
