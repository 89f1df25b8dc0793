#include "canyon/gnss/paths/scatter/facade_tiles.h"

#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"

namespace canyon::gnss {
namespace {

constexpr double kTileCell_m = 40.0;
constexpr double kBeforeWall_m = 0.05;  // rays start there, beyond the rounding of single precision

int cell_of(double x_m) {
  return static_cast<int>(std::floor(x_m / kTileCell_m));
}

}  // namespace

FacadeTiles::FacadeTiles(const scene::Scene& scene, double tile_m) {
  const RandomStream phases(0, "gnss.scatter.tile");
  const auto& facets = scene.facets().facets();
  for (std::uint32_t id = 0; id < facets.size(); ++id) {
    throw_if_cancelled();
    const scene::Facet& f = facets[id];
    if (std::abs(f.normal_W.z()) > kUprightSlope || scene.materials()[f.material].rf_absorbing) continue;
    const auto& c = f.rectangle_W;
    const Eigen::Vector3d u = c[1] - c[0], v = c[3] - c[0];
    const int across = std::max(1, static_cast<int>(std::ceil(u.norm() / tile_m)));
    const int up = std::max(1, static_cast<int>(std::ceil(v.norm() / tile_m)));
    for (int i = 0; i < across; ++i) {
      for (int j = 0; j < up; ++j) {
        const Eigen::Vector3d center_W = c[0] + (i + 0.5) / across * u + (j + 0.5) / up * v;
        if (!f.fills_rectangle && !scene::facet_contains(f, scene, center_W)) continue;
        const auto tile = 2 * static_cast<std::uint64_t>(i * up + j);
        cells_[{cell_of(center_W.x()), cell_of(center_W.y())}].push_back(static_cast<std::uint32_t>(tiles_.size()));
        tiles_.push_back({center_W + (kBeforeWall_m + f.flatness_m) * f.normal_W, f.normal_W,
                          u.norm() * v.norm() / (across * up), f.material,
                          std::polar(1.0, 2.0 * kPi * phases.uniform(id, tile)),
                          std::polar(1.0, 2.0 * kPi * phases.uniform(id, tile + 1))});
      }
    }
  }
}

void FacadeTiles::near(const Eigen::Vector3d& p_W, double radius_m, std::vector<std::uint32_t>& out) const {
  out.clear();
  for (int x = cell_of(p_W.x() - radius_m); x <= cell_of(p_W.x() + radius_m); ++x)
    for (int y = cell_of(p_W.y() - radius_m); y <= cell_of(p_W.y() + radius_m); ++y)
      if (const auto at = cells_.find({x, y}); at != cells_.end())
        out.insert(out.end(), at->second.begin(), at->second.end());
}

}  // namespace canyon::gnss
