#include "canyon/mission/autonomy/reference_2012.h"

#include <gtest/gtest.h>

namespace canyon::mission {
namespace {

const GpsTime kStopStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

NavEstimate standing_at(double x_m, GpsTime t) {
  NavEstimate e;
  e.t = t;
  e.X_WB.p = {x_m, 0.0, 0.0};
  return e;
}

/// Flat ground all around, so that nothing blocks and nothing counts as blind.
LidarScan ground_scan(GpsTime t) {
  LidarScan scan;
  scan.t = t;
  for (float x = -10; x <= 20; x += 0.5f)
    for (float y = -5; y <= 5; y += 0.5f) scan.points.push_back({x, y, -1.5f, 0.3f, 0.0f, 0, 0});
  return scan;
}

// 2026-11-21: a fix that moved the estimate back by more than the stop's tolerance set a vehicle moving that stood and
// looked at its building, and cut the halt in two (4 of 20 seeds of the low fidelity missed a waypoint by that).
TEST(ReferenceAutonomy, StaysUntilItHasLookedAlsoWhenTheEstimateMovesBack) {
  AutonomyConfig config;
  config.waypoints = {{"W1", {4.0, 0.0}, "building 1"}, {"W2", {60.0, 0.0}, ""}};
  PriorKnowledge prior;
  prior.route = Path({{0.0, 0.0}, {60.0, 0.0}}, config.corner_radius_m);
  prior.waypoint_s_m = {4.0, 60.0};
  const auto autonomy = make_autonomy(config, prior, kStopStart);

  double looked_s = 0.0;
  for (int k = 0; k <= 100; ++k) {
    const GpsTime t = kStopStart + 0.1 * k;
    const double jump_m = k % 20 < 10 ? 0.0 : -0.6;
    const NavEstimate estimate = standing_at(3.9 + jump_m, t);
    const Pose X_WL{Eigen::Quaterniond::Identity(), estimate.X_WB.p + Eigen::Vector3d(0, 0, 1.5)};
    autonomy->see(ground_scan(t), X_WL, estimate);
    const DriveCommand command = autonomy->drive(estimate);
    if (autonomy->next_waypoint() == 0) {
      EXPECT_EQ(command.speed_m_s, 0.0) << "after " << 0.1 * k << " s";
      EXPECT_EQ(autonomy->state(), AutonomyState::kObserving);
      looked_s = t - kStopStart;
    }
  }
  EXPECT_NEAR(looked_s, config.hold_s, 0.1 + 1e-9);
  EXPECT_EQ(autonomy->next_waypoint(), 1);
}

}  // namespace
}  // namespace canyon::mission
