#pragma once

#include <complex>
#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "canyon/scene/scene.h"

namespace canyon::gnss {

/// A piece of a wall that scatters as one.
struct FacadeTile {
  Eigen::Vector3d center_W, normal_W;
  double area_m2;
  std::uint16_t material;
  std::complex<double> phase, cross_phase;  ///< of what it scatters into either hand, |1|: fixed to the place
};

/// Upright facets (normals within 30 degrees of level) of a scene, cut into near-square tiles of at most `tile_m`.
/// Their phases are even over the circle, by facet and tile alone (stream "gnss.scatter.tile"): every run, seed and
/// pass meets the same street.
class FacadeTiles {
 public:
  FacadeTiles(const scene::Scene& scene, double tile_m);

  const std::vector<FacadeTile>& tiles() const { return tiles_; }
  /// Those with their middle within `radius_m` of p, horizontally, or a little farther; in a fixed order.
  void near(const Eigen::Vector3d& p_W, double radius_m, std::vector<std::uint32_t>& out) const;

 private:
  std::vector<FacadeTile> tiles_;
  std::map<std::pair<int, int>, std::vector<std::uint32_t>> cells_;
};

}  // namespace canyon::gnss
