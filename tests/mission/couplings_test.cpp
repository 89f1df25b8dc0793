// Every coupling of the closed loop is proven by cutting it.
#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

double largest_distance_from_route(const RunRecord& record, const MissionConfig& config) {
  const auto mission = prepare(config, scenes());
  double worst = 0;
  for (const NavRow& row : record.nav) {
    const Eigen::Vector2d p = row.X_WB_true.p.head<2>();
    const Path& route = mission->prior.route;
    worst = std::max(worst, (p - route.at(route.project(p, 0, route.length_m()))).norm());
  }
  return worst;
}

TEST(Couplings, WithTruthAsPoseTheMissionSucceeds) {
  const RunRecord record = drive(short_config("high", "high", "[run]\ntruth_as_pose = true"));
  EXPECT_EQ(record.outcome, "success") << (record.failure ? record.failure->detail : "");
  for (const NavRow& row : record.nav) ASSERT_EQ(position_error_m(row), 0.0);
}

TEST(Couplings, WithFixesWithheldTheEstimateDriftsAndTheVehicleLeavesItsPath) {
  const MissionConfig with_fixes = short_config("low", "high");
  const MissionConfig without = short_config("low", "high", "[run]\nwithhold_fixes_after_s = 0.0");
  const RunRecord aided = drive(with_fixes), coasting = drive(without);
  EXPECT_EQ(aided.outcome, "success") << (aided.failure ? aided.failure->detail : "");
  EXPECT_NE(coasting.outcome, "success");
  EXPECT_GT(position_error_m(coasting.nav.back()), 10 * position_error_m(aided.nav.back()));
  // It keeps to its path by its own estimate, so what it drifts, it drives beside the street.
  EXPECT_GT(largest_distance_from_route(coasting, without), 2 * largest_distance_from_route(aided, with_fixes));
}

// What bends around an edge does so whatever the wall is made of: satellites received that way are left out of the sum.
TEST(Couplings, WithAbsorbingFacetsReflectionsAndMultipathVanish) {
  const auto reflections_and_multipath = [](const RunRecord& record) {
    double reflections = 0, multipath = 0;
    for (const GnssRow& row : record.gnss_rows) {
      for (const auto& satellite : row.truth.satellites) {
        reflections += satellite.reflections;
        if (satellite.diffractions == 0) multipath += std::abs(satellite.multipath_m);
      }
    }
    return std::pair{reflections, multipath};
  };
  const auto [reflections, multipath] =
      reflections_and_multipath(drive(short_config("high", "high", "[time]\nlimit_s = 20.0")));
  EXPECT_GT(reflections, 0);
  EXPECT_GT(multipath, 0);
  const auto [none, zero] = reflections_and_multipath(
      drive(short_config("high", "high", "[time]\nlimit_s = 20.0\n[scene]\nabsorbing = true")));
  EXPECT_EQ(none, 0);
  EXPECT_EQ(zero, 0);
}

TEST(Couplings, TwoMetresAddedToTheEstimatesHeightLiftThePriorMapByTwoMetres) {
  const std::string truth = "[time]\nlimit_s = 20.0\n[run]\ntruth_as_pose = true\n";
  const std::string lift = "estimate_up_offset_m = 2.0\n", bare = "[scene]\nempty = true\n";
  // Bare terrain of slope up to 8 %: the nearest surface of a point 2 m above it is 2 cos^2(slope) below, 1.987 m at
  // the least.
  const RunRecord level = drive(short_config("low", "low", truth + bare));
  const RunRecord lifted = drive(short_config("low", "low", truth + lift + bare));
  EXPECT_NEAR(lifted.prior_quality.map_error_up_mean_m - level.prior_quality.map_error_up_mean_m, 2.0, 0.015);
  EXPECT_NEAR(lifted.prior_quality.map_error_up_rms_m, 2.0, 0.02);
  // Among parked cars and kerbs a lifted point often finds another level surface nearer than the street.
  const RunRecord city = drive(short_config("low", "low", truth + lift));
  EXPECT_GT(city.prior_quality.map_error_up_mean_m, 1.5);
}

TEST(Couplings, WithTheLidarBlindedTheAutonomyStops) {
  const RunRecord record = drive(short_config("low", "low", "[time]\nlimit_s = 20.0\n[lidar]\nblinded = true"));
  EXPECT_EQ(record.nav.back().state, AutonomyState::kBlind);
  // It may roll for blind_after_s at most, from standstill.
  EXPECT_LT(record.distance_m, 1.0);
  EXPECT_EQ(record.nav.back().true_speed_m_s, 0.0);
}

TEST(Couplings, WithTheSceneEmptiedTheErrorFallsToItsOpenSkyLevel) {
  const auto fix_rms = [](const RunRecord& record) { return summarize(record).fix_error_rms_m; };
  const double city = fix_rms(drive(short_config("high", "high")));
  const RunRecord emptied = drive(short_config("high", "high", "[scene]\nempty = true"));
  EXPECT_EQ(summarize(emptied).nlos_share, 0.0);
  EXPECT_EQ(summarize(emptied).multipath_share, 0.0);
  EXPECT_EQ(emptied.outcome, "success") << (emptied.failure ? emptied.failure->detail : "");
  // Open sky: the same receiver that simply sees everything above the mask.
  const double open_sky = fix_rms(drive(short_config("high", "high", "[gnss]\npaths = \"none\"")));
  EXPECT_LT(fix_rms(emptied), 0.5 * city);
  // The same noise on nearly the same drive: the ratio differs from one only by where the vehicle was at each epoch.
  EXPECT_NEAR(fix_rms(emptied) / open_sky, 1.0, 0.15);
}

TEST(Couplings, LowAndHighDifferOnlyThroughTheirModels) {
  // Same seed, same sensors: what both share must be the same to the bit at the start, before the loop pulls them
  // apart.
  const RunRecord low = drive(short_config("low", "low", "[time]\nlimit_s = 1.0"));
  const RunRecord high = drive(short_config("high", "high", "[time]\nlimit_s = 1.0"));
  ASSERT_FALSE(low.nav.empty());
  EXPECT_EQ(low.nav.front().X_WB_true.p, high.nav.front().X_WB_true.p);
}

}  // namespace
}  // namespace canyon::mission::testing
