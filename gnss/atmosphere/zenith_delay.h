#pragma once

namespace canyon::gnss {

/// Zenith hydrostatic delay, m (Saastamoinen 1972 with the constants of Davis et al. 1985):
/// 0.0022768 P / (1 - 0.00266 cos 2 lat - 0.00028 h), P in hPa, h in km above the ellipsoid.
double zenith_hydrostatic_m(double pressure_hpa, double lat_rad, double height_m);
/// Zenith wet delay, m (Saastamoinen 1972): 0.0022768 (1255 / T + 0.05) e, T in K, e in hPa.
double zenith_wet_m(double temperature_c, double vapour_pressure_hpa);

}  // namespace canyon::gnss
