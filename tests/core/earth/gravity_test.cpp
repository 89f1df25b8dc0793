#include "canyon/core/earth/gravity.h"

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

/// Two normal gravities of nearly one ellipsoid: they differ by GM's 2005 value, 1.4e-6 m/s^2, and by the series' own
/// remainder of below 1e-6 within 10 km.
TEST(Gravity, TheModelsAgreeToTheirKnownDifference) {
  for (const double lat_deg : {-90.0, -45.0, 0.0, 30.0, 60.0, 90.0}) {
    for (const double h_m : {-400.0, 0.0, 5000.0}) {
      const Eigen::Vector3d p = ecef_from_geodetic({lat_deg * kDegree, 1.0, h_m});
      const Eigen::Vector3d difference = gravity_by_name("grs80_series")(p) - gravity_by_name("wgs84")(p);
      // Off the ellipsoid normal gravity leans by 8e-7 h sin(2 lat) m/s^2 per km against the normal; the series does
      // not.
      EXPECT_LT(difference.norm(), 3e-6 + 1e-8 * std::abs(h_m)) << lat_deg << " " << h_m;
    }
  }
  EXPECT_THROW((void)gravity_by_name("wgs72"), ProgramError);
}

}  // namespace
}  // namespace canyon
