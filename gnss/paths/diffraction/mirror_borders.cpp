#include "canyon/gnss/paths/diffraction/mirror_borders.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "canyon/gnss/paths/diffraction/screen_edge.h"

namespace canyon::gnss {
namespace {

ScreenEdge screen_of(const scene::FacetBorder& side, const MirroredWave& wave) {
  return {side.from_W, side.to_W, wave.image_W, wave.towards_W, wave.wavelength_m};
}

}  // namespace

double most_mirrored(const scene::Facet& facet, bool holds, const MirroredWave& wave, double least) {
  const double weakest = ScreenEdge::followed(least);
  double most = holds ? 1.0 : 0.0;
  for (const scene::FacetBorder& side : facet.borders) {
    const ScreenEdge screen = screen_of(side, wave);
    if (!screen.is_faded(weakest)) most += screen.most();
  }
  return most;
}

std::complex<double> mirrored_share(const scene::Facet& facet, bool holds, const MirroredWave& wave, double least) {
  std::complex<double> share = holds ? 1.0 : 0.0;
  const double weakest = ScreenEdge::followed(least);
  for (const scene::FacetBorder& side : facet.borders) {
    const ScreenEdge screen = screen_of(side, wave);
    if (screen.is_faded(weakest)) continue;
    const Eigen::Vector3d inward_W = facet.normal_W.cross(side.to_W - side.from_W);
    // On a side as facet_contains has it.
    const bool inner = inward_W.dot(wave.at_W - side.from_W) >= -1e-9 * inward_W.norm();
    const std::complex<double> made = screen.field(weakest);
    share += inner ? -made : made;
  }
  return share;
}

double largest_border_nu(double weakest_db) {
  return kFarEdgeField / std::max(std::pow(10.0, weakest_db / 20.0), kFaintestBorder);
}

Eigen::Vector3d nearest_of_border(const scene::Facet& facet, const Eigen::Vector3d& at_W) {
  Eigen::Vector3d nearest_W = at_W;
  double least_m2 = std::numeric_limits<double>::infinity();
  for (const scene::FacetBorder& side : facet.borders) {
    const Eigen::Vector3d whole_W = side.to_W - side.from_W;
    const double share = whole_W.dot(at_W - side.from_W) / whole_W.squaredNorm();
    const Eigen::Vector3d point_W = side.from_W + std::clamp(share, 0.0, 1.0) * whole_W;
    const double distance_m2 = (point_W - at_W).squaredNorm();
    if (!(distance_m2 < least_m2)) continue;
    least_m2 = distance_m2;
    nearest_W = point_W;
  }
  return nearest_W;
}

}  // namespace canyon::gnss
