#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "canyon/core/files/tape.h"
#include "canyon/core/result.h"
#include "canyon/study/plan/plan.h"

namespace canyon::study {

/// `effects` of `canyon plan --json` and of a plan file.
nlohmann::ordered_json effects_json(const Plan& plan);

/// `tolerances`: {figure, tolerance, bound} each, and `position_bounds`: {tape_hash, seeds, t_s, position_m}, row by
/// row.
nlohmann::ordered_json tolerances_json(const Plan& plan);
nlohmann::ordered_json position_bounds_json(const Plan& plan);

/// Of these what is left out: {effect, segment, reason} each.
nlohmann::ordered_json left_out_json(const Plan& plan);

/// A plan as a file that `run --plan` and `compare --plan` follow: JSON, docs/plan.md. It names the version, the
/// mission's configuration (without its seed, which decides nothing of a plan) and the scene that it was made for.
std::string plan_text(const Plan& plan, const mission::MissionConfig& config, const mission::PreparedMission& mission);

/// Reads it back for this mission, which is driven along `tape`; nullptr: in a closed loop. An Error, with file and
/// line, for what is no plan; for one of another version, mission, fidelity or scene, for one that leaves out what the
/// mission reads, for one without an autonomy or with a tolerance in a closed loop, and for one with a tolerance that
/// holds along another tape.
Result<Plan> read_plan(const std::string& path, const mission::MissionConfig& config,
                       const mission::PreparedMission& mission, const Tape* tape = nullptr);

}  // namespace canyon::study
