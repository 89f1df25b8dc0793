#pragma once

#include "canyon/study/results/summary.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {

/// The figures of a run that was kept in memory.
inline study::RunSummary summary_of(const RecordedRun& run) {
  study::RunStatistics statistics(run.frame, ::testing::TempDir());
  for (const NavRow& row : run.nav) EXPECT_TRUE(statistics.epoch(row).ok());
  for (const GnssRow& row : run.gnss_rows) EXPECT_TRUE(statistics.gnss(row).ok());
  for (const KeyframeRow& row : run.keyframes) EXPECT_TRUE(statistics.keyframe(row).ok());
  return *study::summarize(run, statistics);
}

}  // namespace canyon::mission::testing
