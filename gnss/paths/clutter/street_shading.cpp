#include "canyon/gnss/paths/clutter/street_shading.h"

#include <cmath>

namespace canyon::gnss {

double StreetShading::level_db(const Eigen::Vector3d& p_W, const Eigen::Vector3d& from_W, GpsTime t) const {
  // Directions on a plane, by their angle from the zenith: no pole, no seam.
  const double level = from_W.head<2>().norm(), up = std::abs(from_W.z());
  const double zenith_rad = std::atan2(level, up);
  const Eigen::Vector2d d_rad =
      level > 0.0 ? Eigen::Vector2d(zenith_rad / level * from_W.head<2>()) : Eigen::Vector2d::Zero();
  const auto field = [&](double cell_m, double cell_rad, std::uint32_t layer) {
    return static_.at<4>({p_W.x() / cell_m, p_W.y() / cell_m, d_rad.x() / cell_rad, d_rad.y() / cell_rad}, layer);
  };
  double state = field(scale_.state_m, scale_.state_rad, 0);
  if (scale_.moving_share > 0.0) {
    const double seconds = static_cast<double>(t.ns) / static_cast<double>(kNsPerSecond);
    const double passing =
        moving_.at<3>({d_rad.x() / scale_.state_rad, d_rad.y() / scale_.state_rad, seconds / scale_.coherence_s}, 0);
    state = std::sqrt(1.0 - scale_.moving_share) * state + std::sqrt(scale_.moving_share) * passing;
  }
  const double elevation_rad = 0.5 * kPi - zenith_rad, mean_db = law_.mean_level_db(state, elevation_rad);
  return mean_db + law_.spread_db(mean_db, elevation_rad) * field(scale_.spread_m, scale_.spread_rad, 1);
}

}  // namespace canyon::gnss
