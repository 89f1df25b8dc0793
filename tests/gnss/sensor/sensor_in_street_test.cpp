#include <cmath>

#include <gtest/gtest.h>

#include "canyon/tests/gnss/sensor/pseudorange_sensor_fixture.h"

namespace canyon::gnss {
namespace {

using testing::errors_off;
using testing::PseudorangeSensorTest;
using testing::WallScene;

TEST_F(PseudorangeSensorTest, StreetCanyonBlocksAndReflects) {
  GnssConfig c;
  c.reception.multipath_rule.name = "correlator";
  const auto sensor = make(c);
  int blocked = 0, reflected = 0, nlos = 0;
  double worst_m = 0.0;
  for (std::int64_t k = 0; k < 1000; k += 10) {
    const GnssOutput out = measure(*sensor, k);
    for (const auto& s : out.truth.satellites) {
      blocked += s.line_of_sight ? 0 : 1;
      reflected += s.reflections > 0 ? 1 : 0;
      nlos += !s.line_of_sight && s.tracked ? 1 : 0;
      worst_m = std::max(worst_m, std::abs(s.multipath_m));
      if (!s.line_of_sight && s.tracked) {
        EXPECT_GT(s.multipath_m, 0.0);
      }
      if (!s.tracked) {
        EXPECT_EQ(s.multipath_m, 0.0);
      }
    }
  }
  EXPECT_GT(blocked, 0);
  EXPECT_GT(reflected, 0);
  EXPECT_GT(nlos, 0);
  EXPECT_GT(worst_m, 0.1);
  const GnssCounters counters = sensor->counters();
  EXPECT_EQ(counters.epochs, 100);
  EXPECT_GT(counters.occlusion_rays, 0);
  EXPECT_GT(counters.facets_tested, 0);
  EXPECT_GT(counters.reflected_paths, 0);
}

// The coupling cut: with every surface absorbing, reflections and multipath vanish and only blockage stays.
TEST_F(PseudorangeSensorTest, AbsorbingWallsLeaveNoMultipath) {
  scene =
      WallScene().box({-60, -300, 0}, {-12, 300, 30}, "absorber").box({9, -300, 0}, {60, 300, 18}, "absorber").build();
  for (const char* rule : {"paper_first_return", "correlator"}) {
    GnssConfig c;
    c.reception.multipath_rule.name = rule;
    const auto sensor = make(c);
    int blocked = 0;
    for (std::int64_t k = 0; k < 500; k += 25) {
      for (const auto& s : measure(*sensor, k).truth.satellites) {
        EXPECT_EQ(s.reflections, 0);
        EXPECT_EQ(s.multipath_m, 0.0);
        EXPECT_EQ(s.tracked, s.line_of_sight);  // epochs measured one by one: nothing is being reacquired
        blocked += s.line_of_sight ? 0 : 1;
      }
    }
    EXPECT_GT(blocked, 0);
    EXPECT_EQ(sensor->counters().reflected_paths, 0);
  }
}

TEST_F(PseudorangeSensorTest, InsideABuildingThereIsNoFix) {
  antenna_W = {-30, 0, 5};
  const GnssOutput out = measure(*make(GnssConfig{}), 0);
  EXPECT_EQ(out.fix.status, FixStatus::kNone);
  EXPECT_EQ(out.fix.reason, "0 satellites, a fix needs 4");
  EXPECT_TRUE(out.epoch.observations.empty());
  EXPECT_GE(out.truth.satellites.size(), 5u);
}

TEST_F(PseudorangeSensorTest, FewSatellitesAreAStatusAndStillObserved) {
  GnssConfig c = errors_off();
  c.mask_deg = 45.0;
  const auto sensor = make(c);
  bool seen = false;
  for (std::int64_t k = 0; k < 200000 && !seen; k += 400) {
    const GnssOutput out = measure(*sensor, k);
    const std::size_t n = out.epoch.observations.size();
    if (n != 3) continue;
    seen = true;
    EXPECT_EQ(out.fix.status, FixStatus::kNone);
    EXPECT_EQ(out.fix.reason, "3 satellites, a fix needs 4");
    for (std::size_t i = 0; i < n; ++i) {
      const auto& o = out.epoch.observations[i];
      EXPECT_FALSE(o.used);
      EXPECT_GT(o.sigma_m, 0.0);
      // A tightly coupled filter can use them all the same: the satellite is known to centimetres even without a fix.
      EXPECT_NEAR((o.p_E - truth_E()).norm(), out.truth.satellites[i].range_m, 0.02);
      EXPECT_TRUE(o.v_E.allFinite());
    }
  }
  EXPECT_TRUE(seen);
}

TEST_F(PseudorangeSensorTest, FaultExclusionMeetsNlos) {
  GnssConfig c;
  c.reception.multipath_rule.name = "correlator";
  c.position.raim = "greedy";
  c.position.weighting.name = "elevation_cn0";
  const auto with = make(c);
  c.position.raim = "none";
  const auto without = make(c);
  int excluded = 0;
  for (std::int64_t k = 0; k < 20000; k += 20) {
    const GnssOutput a = measure(*with, k), b = measure(*without, k);
    ASSERT_EQ(a.epoch.observations.size(), b.epoch.observations.size());
    int used = 0;
    for (std::size_t i = 0; i < a.epoch.observations.size(); ++i) {
      EXPECT_EQ(a.epoch.observations[i].pseudorange_m, b.epoch.observations[i].pseudorange_m);
      used += a.epoch.observations[i].used ? 1 : 0;
      if (a.fix.status != FixStatus::kNone && !a.epoch.observations[i].used) ++excluded;
    }
    if (a.fix.status != FixStatus::kNone) {
      EXPECT_EQ(used, a.fix.satellites);
    }
  }
  EXPECT_GT(excluded, 0);
}

}  // namespace
}  // namespace canyon::gnss
