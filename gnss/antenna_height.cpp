#include "canyon/gnss/antenna_height.h"

#include <cmath>
#include <cstdio>

#include "canyon/core/earth/earth.h"

namespace canyon::gnss {

bool is_covered_height(double h_m) {
  constexpr double kRoundingM = 1e-6;  // of the way through E and back: nanometres
  return h_m >= kLowestAntennaM - kRoundingM && h_m <= kHighestAntennaM + kRoundingM;
}

Status check_antenna_height(double h_m, Error where) {
  if (is_covered_height(h_m)) return Ok{};
  char text[160];
  std::snprintf(text, sizeof text, "the antenna would be %.9g m %s the ellipsoid", std::abs(h_m),
                h_m < 0.0 ? "below" : "above");
  where.what = text;
  std::snprintf(text, sizeof text, "%g to %g m, the heights that the models of the atmosphere cover", kLowestAntennaM,
                kHighestAntennaM);
  where.expected = text;
  return where;
}

Status check_antenna_height(const Eigen::Vector3d& p_E, Error where) {
  // Deep inside the Earth there is no geodetic height to tell; the mean radius gives a figure that says what is wrong.
  constexpr double kInsideM = 6.3e6, kMeanRadiusM = 6371e3;
  const double radius_m = p_E.norm();
  return check_antenna_height(radius_m < kInsideM ? radius_m - kMeanRadiusM : geodetic_from_ecef(p_E).h_m,
                              std::move(where));
}

}  // namespace canyon::gnss
