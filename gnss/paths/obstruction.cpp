#include "canyon/gnss/paths/obstruction.h"

#include <cmath>

#include <Eigen/Geometry>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::gnss {

ObstructionMask::ObstructionMask(const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& up_W,
                                 const Eigen::Vector3d& north_W, const scene::SceneAt& scene)
    : blocked_(static_cast<std::size_t>(kAzimuths * kElevations)) {
  const Eigen::Vector3d east_W = north_W.cross(up_W);
  for (int azimuth = 0; azimuth < kAzimuths; ++azimuth) {
    for (int elevation = 0; elevation < kElevations; ++elevation) {
      const double a = (azimuth + 0.5) * kDegree, e = (elevation + 0.5) * kDegree;
      const Eigen::Vector3d direction =
          std::cos(e) * (std::sin(a) * east_W + std::cos(a) * north_W) + std::sin(e) * up_W;
      blocked_[static_cast<std::size_t>(azimuth * kElevations + elevation)] =
          scene.blocked_towards(p_A_W, direction.normalized()) ? 1 : 0;
    }
  }
}

double ObstructionMask::open_share(int above_elevation_deg) const {
  CANYON_CHECK(above_elevation_deg >= 0 && above_elevation_deg < kElevations,
               "above_elevation_deg = ", above_elevation_deg);
  double open = 0.0, all = 0.0;
  for (int elevation = above_elevation_deg; elevation < kElevations; ++elevation) {
    const double area = std::sin((elevation + 1) * kDegree) - std::sin(elevation * kDegree);
    for (int azimuth = 0; azimuth < kAzimuths; ++azimuth) {
      all += area;
      if (!blocked(azimuth, elevation)) open += area;
    }
  }
  return open / all;
}

}  // namespace canyon::gnss
