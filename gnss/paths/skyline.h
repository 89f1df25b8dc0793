#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/scene/surfaces/facet.h"

namespace canyon::gnss {

/// What walls surely hide from a point. The horizon is cut into sectors; in each the upright rectangular wall that
/// rises highest of those that fill the whole sector is kept. A facet is hidden if in every sector that it touches the
/// wall there is nearer, reaches higher and begins lower. What only several walls of one sector, or walls that do not
/// stand upright, would hide counts as not hidden.
class Skyline {
 public:
  Skyline(const Eigen::Vector3d& p_W, const std::vector<scene::Facet>& facets,
          std::span<const std::uint32_t> candidates);
  bool hides(const scene::Facet& facet) const;

 private:
  static constexpr int kSectors = 720;
  struct Sector {
    double top = -1e300;    ///< tangent of the elevation up to which the wall hides
    double bottom = 1e300;  ///< and from which
    double far_m = 1e300;   ///< horizontal distance at which the wall ends
  };
  struct Span {
    double first, last;  ///< in sectors, first <= last < first + kSectors
    double near_m;       ///< horizontal distance of the nearest point
  };
  /// Of the facet's bounding rectangle in plan, as seen from p; false if p stands above or below it, or at its foot.
  bool span(const scene::Facet& facet, Span& out) const;
  void add(const scene::Facet& wall);

  Eigen::Vector3d p_W_;
  std::vector<Sector> sectors_;
};

}  // namespace canyon::gnss
