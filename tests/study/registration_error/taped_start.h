#pragma once

#include "canyon/mission/route_tape.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::study::testing {

/// The short mission's first seconds on a tape, with few beams, registered.
struct TapedStart {
  mission::MissionConfig config;
  mission::PreparedMission mission;
  Tape tape;
};

inline TapedStart taped_start(const std::string& fidelity, double limit_s, const std::string& extra = "") {
  TapedStart out;
  out.config = mission::testing::short_config(fidelity, fidelity,
                                              "[time]\nlimit_s = " + std::to_string(limit_s) +
                                                  "\n[lidar]\nbeams = \"grid:16:-15:15\"\nazimuth_steps = 360\n"
                                                  "[registration]\nmethod = \"gicp\"\n" +
                                                  extra);
  auto prepared = mission::prepare(out.config, mission::testing::scenes());
  EXPECT_TRUE(prepared.ok()) << (prepared.ok() ? "" : prepared.error().str());
  out.mission = *std::move(prepared);
  auto tape = mission::drive_route(out.config, out.mission);
  EXPECT_TRUE(tape.ok()) << (tape.ok() ? "" : tape.error().str());
  out.tape = *std::move(tape);
  while (out.tape.duration_s() > limit_s) out.tape.nodes.pop_back();
  return out;
}

}  // namespace canyon::study::testing
