#pragma once

#include <string>

#include <gtest/gtest.h>

#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/recorder/estimate_error.h"
#include "canyon/mission/run.h"
#include "canyon/tests/mission/memory_recorder.h"

namespace canyon::mission::testing {

/// A drive of about a minute up a street of the tall quarter, with one building to look at. Registration is left out
/// unless a test asks for it: most couplings do not need it.
inline constexpr const char* kShortMission = R"(
base = "vicksburg"
[run]
name = "short"
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[registration]
method = "none"
[autonomy]
[[autonomy.waypoint]]
name = "crossing"
p_m = [213.9, 109.9]
[[autonomy.waypoint]]
name = "house"
p_m = [213.9, 150.0]
observe = "building 273"
)";

/// What `high` was until 2026-11-25: GPS alone, each epoch solved by itself, among mirrors and thin screens. What acts
/// on ranges is seen in the fix at once, and what is taken away is gone.
inline constexpr const char* kSnapshot = R"(
[gnss]
receiver = "snapshot_gps"
diffraction = "double_knife_edge"
scatter = "none"
clutter = "none"
)";

/// The short mission with more TOML laid over it; `receiver` as kSnapshot.
inline MissionConfig short_config(const std::string& gnss, const std::string& imu, const std::string& extra = "",
                                  const std::string& receiver = "") {
  auto file = MissionFile::parse(kShortMission + receiver, "short.toml");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().str());
  auto config = gnss == imu ? file->resolve(gnss) : file->resolve_mixed(gnss, imu);
  EXPECT_TRUE(config.ok()) << (config.ok() ? "" : config.error().str());
  if (!extra.empty()) {
    auto tree = ConfigNode::parse(extra, "extra.toml");
    EXPECT_TRUE(tree.ok());
    const auto status = read_config(&*tree, "", *config);
    EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().str());
  }
  return *config;
}

/// Scenes are shared by all tests of the executable: building one takes longer than most runs.
inline SceneCache& scenes() {
  static SceneCache cache;
  return cache;
}

/// A run and all that it gave on the way.
struct RecordedRun : RunRecord, MemoryRecorder {};

inline RecordedRun drive(const MissionConfig& config, const Tape* tape = nullptr) {
  auto mission = prepare(config, scenes());
  EXPECT_TRUE(mission.ok()) << (mission.ok() ? "" : mission.error().str());
  RecordedRun run;
  auto record = run_mission(config, *mission, nullptr, {.tape = tape, .recorder = &run, .autonomy = nullptr});
  EXPECT_TRUE(record.ok()) << (record.ok() ? "" : record.error().str());
  static_cast<RunRecord&>(run) = *std::move(record);
  return run;
}

inline double position_error_m(const NavRow& row) {
  return estimate_error(row).position_W_m.norm();
}

}  // namespace canyon::mission::testing
