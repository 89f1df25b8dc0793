#include "canyon/gnss/single_point/position_statistics.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"

namespace canyon::gnss {
namespace {

TEST(PositionStatistics, ClosedForm) {
  const Eigen::Vector3d truth_E = ecef_from_geodetic({0.5, 1.0, 10.0});
  const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(truth_E));
  std::vector<GnssFix> fixes(5);
  for (int i = 0; i < 4; ++i) {
    fixes[static_cast<std::size_t>(i)].status = FixStatus::kSingle;
    fixes[static_cast<std::size_t>(i)].p_A_E = truth_E + R * Eigen::Vector3d(i, 0.0, i % 2 == 0 ? 2.0 : -2.0);
  }
  const auto s = position_statistics(fixes, [&](GpsTime) { return std::optional(TruePlace{truth_E, std::nullopt}); });
  EXPECT_EQ(s.epochs, 5);
  EXPECT_EQ(s.solved, 4);
  EXPECT_NEAR(s.mean_enu_m.x(), 1.5, 1e-8);
  EXPECT_NEAR(s.std_enu_m.x(), std::sqrt(1.25), 1e-8);
  EXPECT_NEAR(s.std_enu_m.z(), 2.0, 1e-8);
  EXPECT_NEAR(s.h50_m, 1.5, 1e-8);
  EXPECT_NEAR(s.h95_m, 2.85, 1e-8);
  EXPECT_NEAR(s.v95_m, 2.0, 1e-8);
  EXPECT_NEAR(s.rms_3d_m, std::sqrt(14.0 / 4.0 + 4.0), 1e-8);
}

}  // namespace
}  // namespace canyon::gnss
