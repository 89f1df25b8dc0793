// The self-check in a whole drive: an estimate that moves off is doubted, driven on slowly, and given up; a sound one
// is believed.
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

RecordedRun drive_told(const std::string& drift_m_s) {
  return drive(short_config("low", "low",
                            "[autonomy.self_check]\nmodel = \"own_motion\"\n"
                            "[lidar]\nazimuth_steps = 900\nrate_hz = 5.0\n"
                            "[run]\ntold_drift_m_s = " +
                                drift_m_s + "\n"));
}

TEST(SelfCheckDrives, AnEstimateThatMovesOffEndsInLost) {
  const RecordedRun run = drive_told("1.0");
  EXPECT_EQ(run.outcome, Outcome::kLost) << (run.failure ? run.failure->detail : "");
  // Doubt has lasted for 12 s by then, in which it drives no faster than 2 m/s.
  double in_doubt = 0.0;
  for (const NavRow& row : run.nav)
    if (run.nav.back().t - row.t < 11.5) in_doubt = std::max(in_doubt, row.command.speed_m_s);
  EXPECT_GT(in_doubt, 0.0);
  EXPECT_LE(in_doubt, 2.0);
  EXPECT_LT(run.simulated_s, 40.0);
}

TEST(SelfCheckDrives, ASoundEstimateIsBelieved) {
  const RecordedRun run = drive_told("0.0");
  EXPECT_EQ(run.outcome, Outcome::kSuccess) << (run.failure ? run.failure->detail : "");
  double fastest = 0.0;
  for (const NavRow& row : run.nav) fastest = std::max(fastest, row.command.speed_m_s);
  EXPECT_GT(fastest, 3.0);
}

}  // namespace
}  // namespace canyon::mission::testing
