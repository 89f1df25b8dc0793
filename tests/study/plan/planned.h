#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/mission/route_tape.h"
#include "canyon/study/plan/plan.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::study::testing {

/// A mission that has been prepared, and a plan for it. "high" here with a receiver whose bounds are known (kSnapshot),
/// unless `receiver` says another.
struct Planned {
  Planned(const std::string& fidelity, const std::string& extra, const std::vector<Output>& outputs,
          bool open_loop = false, const FigureValues& tolerances = {},
          const std::optional<std::string>& receiver = std::nullopt)
      : config(mission::testing::short_config(
            fidelity, fidelity, extra, receiver.value_or(fidelity == "high" ? mission::testing::kSnapshot : ""))),
        mission(*mission::prepare(config, mission::testing::scenes())),
        plan(*make_plan(config, mission,
                        {.fidelity = fidelity, .outputs = outputs, .open_loop = open_loop, .tolerances = tolerances})) {
  }

  Verdict verdict(const std::string& effect) const {
    for (const PlannedEffect& line : plan.effects)
      if (line.need.effect == effect) return line.need.verdict;
    ADD_FAILURE() << effect;
    return Verdict::kUndecidable;
  }
  mission::testing::RecordedRun drive(bool as_planned, const Tape* tape = nullptr) const {
    mission::testing::RecordedRun run;
    const auto used = as_planned ? mission::without(config, plan.omissions) : config;
    auto record = mission::run_mission(
        used, mission, nullptr,
        {.tape = tape, .recorder = &run, .autonomy = nullptr, .omissions = as_planned ? &plan.omissions : nullptr});
    static_cast<mission::RunRecord&>(run) = *std::move(record);
    return run;
  }

  mission::MissionConfig config;
  mission::PreparedMission mission;
  Plan plan;
};

inline const std::vector<Output> kDriving{Output::kOutcome, Output::kPosition};

}  // namespace canyon::study::testing
