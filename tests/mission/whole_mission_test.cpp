// The whole built-in mission; takes minutes, so these run with ./test.sh --nightly only.
#include <cmath>

#include "tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

RunRecord whole(const std::string& fidelity, bool truth_as_pose) {
  MissionFile file = *MissionFile::load("");
  file.set_option("run.truth_as_pose", ConfigNode::of(truth_as_pose), "test");
  const auto config = file.resolve(fidelity);
  EXPECT_TRUE(config.ok());
  return drive(*config);
}

TEST(WholeMissionNightly, WithTruthAsPoseEveryWaypointIsReached) {
  const RunSummary summary = summarize(whole("low", true));
  EXPECT_EQ(summary.outcome, "success") << (summary.failure ? summary.failure->detail : "");
  EXPECT_EQ(summary.waypoints_reached, 11);
  EXPECT_EQ(summary.mission_waypoints_reached, 3);
  EXPECT_NEAR(summary.distance_m, 1480, 60);  // the planned 1482 m, less corners cut, plus obstacles driven round
  EXPECT_LT(summary.duration_s, 480);
}

TEST(WholeMissionNightly, RegistrationOnTruthStaysWithinCentimetres) {
  // With the true pose as prior, what registration adds is its own error: the floor of the method.
  const RunSummary summary = summarize(whole("low", true));
  EXPECT_EQ(summary.registration_prior_rms_m, 0.0);
  EXPECT_LT(summary.registration_rms_m, 0.05);
  EXPECT_LT(summary.registered_map.map_error_rms_m, 0.05);
}

TEST(WholeMissionNightly, LowAndHighAreScoredToTheEnd) {
  for (const char* fidelity : {"low", "high"}) {
    const RunRecord record = whole(fidelity, false);
    const RunSummary summary = summarize(record);
    // Whatever the outcome, a run ends for a reason that it names.
    EXPECT_TRUE(summary.outcome == "success" || (summary.failure && !summary.failure->detail.empty())) << fidelity;
    EXPECT_GT(summary.keyframes, 50) << fidelity;
    EXPECT_TRUE(std::isfinite(summary.position_m.rms)) << fidelity;
  }
}

}  // namespace
}  // namespace canyon::mission::testing
