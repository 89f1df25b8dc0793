#include <algorithm>
#include <filesystem>

#include "canyon/mission/route_tape.h"
#include "canyon/study/compare.h"

namespace canyon::study {

namespace {

namespace fs = std::filesystem;

/// The tape file that `path` names: itself, or the only one of a results directory.
Result<std::string> find_tape(const std::string& path) {
  std::error_code code;
  if (!fs::is_directory(path, code)) return path;
  std::vector<std::string> tapes;
  for (const auto& entry : fs::directory_iterator(fs::path(path) / "tapes", code))
    if (entry.path().extension() == ".tape") tapes.push_back(entry.path().string());
  std::sort(tapes.begin(), tapes.end());
  if (tapes.size() == 1) return tapes.front();
  if (tapes.empty())
    return Error{.file = path, .what = "holds no tape", .expected = "the results of a run with run.record_tape = true"};
  std::string names;
  for (const auto& tape : tapes) names += (names.empty() ? "" : ", ") + fs::path(tape).filename().string();
  return Error{.file = path,
               .what = "holds " + std::to_string(tapes.size()) + " tapes (" + names + ")",
               .expected = "one of them, for example " + tapes.front()};
}

}  // namespace

Status choose_tape(const TapeChoice& choice, Comparison& comparison) {
  const mission::MissionConfig& config = comparison.configs.front();
  const mission::PreparedMission& first = comparison.missions.front();
  std::string path = choice.trajectory;
  if (!choice.tape.empty()) {
    CANYON_TRY(path, find_tape(choice.tape));
    CANYON_TRY(comparison.tape, read_tape(path));
  } else if (!choice.trajectory.empty()) {
    CANYON_TRY(comparison.tape, mission::tape_from_trajectory(path, choice.trajectory_rate_hz, first.scene->frame()));
  } else {
    CANYON_TRY(comparison.tape, mission::drive_route(config, first));
  }
  for (std::size_t i = 0; i < comparison.plan.size(); ++i)
    CANYON_TRY_STATUS(mission::check_tape(*comparison.tape, path, comparison.configs[i], comparison.missions[i]));
  return Ok{};
}

}  // namespace canyon::study
