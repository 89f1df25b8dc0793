#pragma once

#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"

/// What summary.json of `canyon tradeoff` says, as the page needs it; NaN = undefined (docs/tradeoff.md).
namespace canyon::report {

struct TradeoffModel {
  std::string name;
  double error = kNaN, error_low = kNaN, error_high = kNaN, undefined_share = kNaN;
  double cpu_s = kNaN, cpu_low_s = kNaN, cpu_high_s = kNaN, work = kNaN, memory_mb = kNaN;
  bool on_front = false, in_use = false, is_reference = false, resolved = true;
  std::vector<std::string> tied_with;
};

struct TradeoffLadder {
  std::string part, key, of, meaning, unit, error_is, reference, work_unit;
  std::vector<TradeoffModel> models;
  std::vector<std::string> left_out;
  double order_observed = kNaN, order_theory = kNaN, reference_error = kNaN;
  double fixed_s = kNaN, per_work_s = kNaN, worst_ratio = kNaN;
  bool order_holds = true;
};

struct TradeoffRun {
  std::string fidelity;
  double position_m = kNaN, map_m = kNaN, registration_m = kNaN, tape_s = kNaN;
  double cpu_s = kNaN, cpu_low_s = kNaN, cpu_high_s = kNaN, simulated_s = kNaN;
  bool driven = false;  ///< closed loops, of which the rest tells
  double success = kNaN, seeds = kNaN, success_low = kNaN, success_high = kNaN, mission_cpu_s = kNaN;
  std::vector<std::string> outcomes;  ///< "collision 2"
};

struct TradeoffChoice {
  bool asked = false, found = false;
  std::string figure, unit;
  double tolerance = kNaN, budget_cpu_s = kNaN, error = kNaN, cpu_s = kNaN, cpu_reference_s = kNaN, refused = kNaN;
  std::vector<std::string> settings;
  std::size_t seeds = 0;
};

struct TradeoffSummary {
  std::string mission, fidelity, seed, tape;
  double samples = kNaN, repetitions = kNaN, threads = kNaN;
  std::vector<TradeoffLadder> ladders;
  std::vector<std::string> skipped;
  std::vector<TradeoffRun> runs;
  TradeoffChoice choice;
};

/// An Error with file, line and key for what is malformed.
Result<TradeoffSummary> read_tradeoff(const std::string& path);

}  // namespace canyon::report
