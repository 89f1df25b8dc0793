#include "canyon/core/earth/gravity.h"

#include <cmath>

#include "canyon/core/earth/earth.h"

namespace canyon {
namespace {

/// GRS80 normal gravity as a series in latitude (Moritz, Geodetic Reference System 1980) with the free-air terms of
/// Schwarz & Wei, along the ellipsoid's normal. Better than 1e-6 m/s^2 within 10 km of the ellipsoid.
Eigen::Vector3d grs80_series_E(const Eigen::Vector3d& p_E) {
  const Geodetic at = geodetic_from_ecef(p_E);
  const double s2 = std::sin(at.lat_rad) * std::sin(at.lat_rad);
  const double s4 = s2 * s2;
  const double g0 = 9.7803267715 * (1 + 0.0052790414 * s2 + 0.0000232718 * s4 + 1.262e-7 * s2 * s4 + 7e-10 * s4 * s4);
  const double g = g0 + (-3.0876910891e-6 + 4.3977311e-9 * s2) * at.h_m + 0.7211e-12 * at.h_m * at.h_m;
  return -g * rotation_E_from_enu(at).col(2);
}

constexpr GravityModel kModels[] = {
    {"wgs84", gravity_E, "WGS84 normal gravity in closed form; what Canyon simulates with"},
    {"grs80_series", grs80_series_E, "GRS80 normal gravity as the series of KF-GINS and many other programs"},
};

}  // namespace

ModelTable<GravityFunction> gravity_models() {
  return kModels;
}

}  // namespace canyon
