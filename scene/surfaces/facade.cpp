#include "canyon/scene/surfaces/facade.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/process/progress.h"
#include "canyon/scene/scene.h"

namespace canyon::scene {
namespace {

constexpr double kSteepest = 0.5;  // |z| of the normal, 30 degrees: as map_quality counts walls

/// W height from which each object's floors count; NaN of what is no listed building.
std::vector<double> bases_of(const Scene& scene) {
  std::vector<double> base_m(scene.objects().size(), std::numeric_limits<double>::quiet_NaN());
  for (const Building& b : scene.buildings())
    if (b.object < base_m.size() && std::isfinite(b.base_m)) base_m[b.object] = b.base_m;
  return base_m;
}

constexpr double kRound_m = 1e-3;  // of corners in single precision, 10 km off: whole floors and bays stay whole

}  // namespace

void Facade::divide() {
  bays = std::floor((end_m - begin_m + kRound_m) / kBay_m);
  if (!(bays >= 1.0)) bays = 0.0;
  bays_per_m = bays > 0.0 ? bays / (end_m - begin_m) : 0.0;
  first_floor = std::ceil((bottom_m - base_m - kRound_m) / kFloor_m);
  first_floor = std::max(first_floor, 0.0);  // walls go on below their building's ground
  end_floor = std::max(first_floor, std::floor((top_m - base_m + kRound_m) / kFloor_m));
}

FacadeIndex::FacadeIndex(const Scene& scene)
    : of_(scene.mesh().triangles.size(), kNone), materials_(scene.materials().size(), 0) {
  const Mesh& mesh = scene.mesh();
  const std::vector<double> base_m = bases_of(scene);
  for (const Facet& facet : scene.facets().facets()) {
    if (scene.objects()[facet.object].kind != ObjectKind::kBuilding) continue;
    if (!(std::abs(facet.normal_W.z()) <= kSteepest)) continue;
    throw_if_cancelled();
    Facade wall;
    wall.along_W = Eigen::Vector2d(-facet.normal_W.y(), facet.normal_W.x()).normalized();
    wall.begin_m = std::numeric_limits<double>::infinity(), wall.end_m = -wall.begin_m;
    for (const std::uint32_t triangle : facet.triangles) {
      for (const std::uint32_t vertex : mesh.triangles[triangle]) {
        const double at_m = wall.along_W.dot(mesh.vertices[vertex].head<2>().cast<double>());
        wall.begin_m = std::min(wall.begin_m, at_m);
        wall.end_m = std::max(wall.end_m, at_m);
      }
      of_[triangle] = static_cast<std::uint32_t>(facades_.size());
    }
    wall.bottom_m = facet.bottom_m, wall.top_m = facet.top_m;
    wall.base_m = std::isnan(base_m[facet.object]) ? facet.bottom_m : base_m[facet.object];
    wall.divide();
    materials_[facet.material] = 1;
    facades_.push_back(wall);
  }
}

}  // namespace canyon::scene
