#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/mission/route_tape.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

using ::testing::HasSubstr;

const std::string kShort = "[time]\nlimit_s = 8.0\n[registration]\nmethod = \"gicp\"\n";

Tape tape_of(const RecordedRun& record, const MissionConfig& config) {
  Tape tape{.source = record.name,
            .scene_hash = (*scenes().get(config.scene))->hash(),
            .traffic = traffic_text(config),
            .nodes = record.tape};
  for (TapeNode& node : tape.nodes) node.motion.t.ns -= record.start.ns;
  return tape;
}

void expect_same_bits(const RecordedRun& a, const RecordedRun& b) {
  ASSERT_EQ(a.nav.size(), b.nav.size());
  for (std::size_t i = 0; i < a.nav.size(); ++i) {
    EXPECT_EQ(a.nav[i].X_WB_true.p, b.nav[i].X_WB_true.p) << i;
    EXPECT_EQ(a.nav[i].estimate.X_WB.p, b.nav[i].estimate.X_WB.p) << i;
    EXPECT_EQ(a.nav[i].estimate.X_WB.R.coeffs(), b.nav[i].estimate.X_WB.R.coeffs()) << i;
    EXPECT_EQ(a.nav[i].command.curvature_1_m, b.nav[i].command.curvature_1_m) << i;
  }
  ASSERT_EQ(a.gnss_rows.size(), b.gnss_rows.size());
  for (std::size_t i = 0; i < a.gnss_rows.size(); ++i) EXPECT_EQ(a.gnss_rows[i].update.nis, b.gnss_rows[i].update.nis);
  ASSERT_EQ(a.registered_map.size(), b.registered_map.size());
  for (std::size_t i = 0; i < a.registered_map.size(); ++i)
    ASSERT_EQ(a.registered_map[i].p_W, b.registered_map[i].p_W) << i;
}

TEST(TapeReplay, ARunOnItsOwnTapeIsThatRun) {
  for (const char* fidelity : {"low", "high", "paper"}) {
    const MissionConfig config = short_config(fidelity, fidelity, kShort);
    const RecordedRun closed = drive(config);
    const Tape tape = tape_of(closed, config);
    const RecordedRun open = drive(config, &tape);
    SCOPED_TRACE(fidelity);
    expect_same_bits(closed, open);
    EXPECT_TRUE(open.open_loop);
    EXPECT_TRUE(open.waypoints.empty());
  }
}

// On one tape the true motion is the same whatever the sensors; and their rates need not be multiples of one another.
TEST(TapeReplay, RatesChangeNothingOfTheTruth) {
  const MissionConfig config = short_config("low", "low", "[time]\nlimit_s = 6.0");
  const RecordedRun closed = drive(config);
  const Tape tape = tape_of(closed, config);
  for (const char* rates : {"[imu]\nrate_hz = 25.0", "[imu]\nrate_hz = 333.0\n[gnss]\nrate_hz = 3.0",
                            "[lidar]\nrate_hz = 7.0\n[gnss]\nrate_hz = 4.0"}) {
    const RecordedRun open = drive(short_config("low", "low", std::string("[time]\nlimit_s = 6.0\n") + rates), &tape);
    ASSERT_EQ(open.nav.size(), closed.nav.size()) << rates;
    for (std::size_t i = 0; i < open.nav.size(); ++i)
      EXPECT_EQ(open.nav[i].X_WB_true.p, closed.nav[i].X_WB_true.p) << rates;
    // A white-noise fix of 0.4 m and a filter: the error stays of that size, 1 m is 2.5 sigma of a single fix.
    EXPECT_LT(position_error_m(open.nav.back()), 1.0) << rates;
  }
}

// 2026-11-22: scans that wait for the filter found the motion forgotten that they are deskewed by, and the run ended.
TEST(TapeReplay, ScansMayComeFasterThanImuSamples) {
  const std::string fast = "[time]\nlimit_s = 2.0\n[lidar]\nrate_hz = 50.0\nazimuth_steps = 360\n";
  const MissionConfig config = short_config("low", "low", fast);
  const RecordedRun closed = drive(config);
  const Tape tape = tape_of(closed, config);
  const RecordedRun slow_imu = drive(short_config("low", "low", fast + "[imu]\nrate_hz = 10.0"), &tape);
  EXPECT_EQ(slow_imu.counters.at("lidar_scans"), 100);
  EXPECT_EQ(slow_imu.counters.at("lidar_returns"), closed.counters.at("lidar_returns"));
}

// Driven on truth, the closed loop does not depend on the rates of IMU and GNSS either.
TEST(TapeReplay, DrivenOnTruthNoRateChangesTheMotion) {
  const auto path_with = [](const std::string& rates) {
    const RecordedRun record = drive(short_config(
        "high", "high",
        "[time]\nlimit_s = 8.0\n[run]\ntruth_as_pose = true\n[autonomy]\nmodel = \"route_follower\"\n" + rates));
    return record.tape;
  };
  const auto expected = path_with("");
  EXPECT_GT(expected.back().distance_m, 10.0);
  for (const char* rates :
       {"[imu]\nrate_hz = 50.0", "[imu]\nrate_hz = 200.0", "[gnss]\nrate_hz = 1.0", "[gnss]\nrate_hz = 4.0",
        "[lidar]\nrate_hz = 5.0", "[lidar]\nrate_hz = 20.0\nazimuth_steps = 900"}) {
    const auto got = path_with(rates);
    ASSERT_EQ(got.size(), expected.size()) << rates;
    for (std::size_t i = 0; i < got.size(); ++i)
      ASSERT_EQ(got[i].motion.X_WB.p, expected[i].motion.X_WB.p) << rates << " at node " << i;
  }
}

TEST(TapeReplay, TruthAsPoseRecordsWhatTheFilterEstimates) {
  const RecordedRun record = drive(short_config("high", "high", "[time]\nlimit_s = 3.0\n[run]\ntruth_as_pose = true"));
  EXPECT_GT(position_error_m(record.nav.back()), 0.0);
}

TEST(RouteTape, TheRouteIsDrivenToItsEndWithItsStops) {
  const MissionConfig config = short_config("low", "low");
  const auto mission = prepare(config, scenes());
  const auto tape = drive_route(config, *mission);
  ASSERT_TRUE(tape.ok()) << tape.error().str();
  EXPECT_NEAR(tape->nodes.back().distance_m, mission->prior.route.length_m(),
              2.0);  // it halts within 0.4 m, cuts corners
  int standing = 0;
  for (const TapeNode& node : tape->nodes) standing += node.speed_m_s == 0.0 ? 1 : 0;
  EXPECT_GT(standing, static_cast<int>(config.autonomy.hold_s * 100) - 50);
  EXPECT_TRUE(check_tape(*tape, "t", config, *mission).ok());
}

// 2026-11-22: [time] limit_s made the route one that cannot be driven.
TEST(RouteTape, IsAsLongAsTheTimeLimitAsks) {
  const MissionConfig config = short_config("low", "low", "[time]\nlimit_s = 5.0");
  const auto mission = prepare(config, scenes());
  const auto tape = drive_route(config, *mission);
  ASSERT_TRUE(tape.ok()) << tape.error().str();
  EXPECT_DOUBLE_EQ(tape->duration_s(), 5.0);
  EXPECT_TRUE(check_tape(*tape, "t", config, *mission).ok());
}

TEST(RouteTape, ATapeThatDoesNotFitIsToldInOneLine) {
  const MissionConfig config = short_config("low", "low");
  const auto mission = prepare(config, scenes());
  const Tape good = *drive_route(config, *mission);
  const auto complaint = [&](const Tape& tape, const std::string& extra = "") {
    const auto status = check_tape(tape, "a.tape", short_config("low", "low", extra), *mission);
    return status ? std::string() : status.error().str();
  };
  Tape bad = good;
  bad.scene_hash = std::string(64, 'a');
  EXPECT_THAT(complaint(bad),
              HasSubstr("a.tape: was recorded in another scene, expected a tape of this mission's scene"));
  bad = good;
  bad.traffic = "[{}]";
  EXPECT_THAT(complaint(bad), HasSubstr("a.tape: was recorded in other traffic, expected the same [[scene.moving]]"));
  EXPECT_THAT(complaint(good, "[time]\nlimit_s = 1000.0"),
              HasSubstr("s long, expected at least the 1000 s of time.limit_s"));
  bad = good;
  for (std::size_t i = 500; i < bad.nodes.size(); ++i) bad.nodes[i].motion.X_WB.p.x() += 3.0;
  EXPECT_THAT(complaint(bad), HasSubstr("a.tape: jumps by 3 m at 4.9 s"));
  bad = good;
  for (TapeNode& node : bad.nodes) node.motion.X_WB.p.x() += 2000.0;
  EXPECT_THAT(complaint(bad),
              HasSubstr("a.tape: leaves the scene at 0.0 s, x 2213.9 m, y 30.0 m, expected x from -500"));
  bad = good;
  for (TapeNode& node : bad.nodes) node.motion.X_WB.p.z() -= 20.0;
  EXPECT_THAT(complaint(bad), HasSubstr("m under the ground at 0.0 s"));
}

}  // namespace
}  // namespace canyon::mission::testing
