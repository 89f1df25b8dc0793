// Errors laid over what the autonomy is told.
#include "canyon/mission/told_errors.h"

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

NavEstimate told(const ToldErrors& config, double t_s, std::uint64_t seed = 1) {
  NavEstimate estimate;
  estimate.t = GpsTime{} + t_s;
  ToldErrorDraws(config, seed, GpsTime{}).lay_over(estimate);
  return estimate;
}

TEST(ToldErrors, AreWhatTheirKeysSay) {
  EXPECT_EQ(told({}, 100.0).X_WB.p, Eigen::Vector3d::Zero());
  const ToldErrors steps{.step_m = 3.0, .step_every_s = 20.0};
  EXPECT_EQ(told(steps, 19.9).X_WB.p.norm(), 0.0);
  EXPECT_NEAR(told(steps, 20.1).X_WB.p.norm(), 3.0, 1e-12);
  EXPECT_EQ(told(steps, 39.9).X_WB.p, told(steps, 20.1).X_WB.p) << "it stays";
  EXPECT_GT((told(steps, 40.1).X_WB.p - told(steps, 20.1).X_WB.p).norm(), 1e-3);
  EXPECT_GT((told(steps, 20.1, 2).X_WB.p - told(steps, 20.1).X_WB.p).norm(), 1e-3) << "another seed, another way";
  const ToldErrors drift{.drift_m_s = 0.25};
  EXPECT_NEAR(told(drift, 40.0).X_WB.p.norm(), 10.0, 1e-12);
  EXPECT_LT((told(drift, 40.0).X_WB.p - 4.0 * told(drift, 10.0).X_WB.p).norm(), 1e-12) << "one way";
  EXPECT_EQ(told(drift, 40.0).X_WB.p.z(), 0.0);
  const NavEstimate turned = told({.heading_deg = 5.0}, 1.0);
  EXPECT_NEAR(yaw_pitch_roll(turned.X_WB.R).yaw_rad, -5.0 * kDegree, 1e-12) << "clockwise";
}

// The filter, and what is recorded of it, know nothing of it: while the vehicle still stands everything but the
// autonomy's own doing is the same, and later only its path is another.
TEST(ToldErrors, ReachTheAutonomyAlone) {
  const std::string none = "[time]\nlimit_s = 20.0\n";
  const RecordedRun as_it_was = drive(short_config("low", "low", none));
  const RecordedRun off =
      drive(short_config("low", "low", none + "[run]\ntold_step_m = 30.0\ntold_step_every_s = 1.0\n"));
  ASSERT_FALSE(off.nav.empty());
  double worst_m = 0.0;
  for (const NavRow& row : off.nav) worst_m = std::max(worst_m, position_error_m(row));
  EXPECT_LT(worst_m, 2.0) << "not 30 m";
  EXPECT_GT((off.nav.back().X_WB_true.p - as_it_was.nav.back().X_WB_true.p).norm(), 1.0) << "but it acts";
}

}  // namespace
}  // namespace canyon::mission::testing
