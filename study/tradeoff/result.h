#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "canyon/study/results/over_seeds.h"
#include "canyon/study/statistics/interval.h"
#include "canyon/study/tradeoff/ladders/rungs.h"

namespace canyon::study {

/// One model of a ladder, measured. NaN = undefined.
struct MeasuredModel {
  std::string name;
  std::optional<double> value;  ///< of ladders of numbers
  double error = kNaN;          ///< RMS over the samples, in the ladder's unit; 0 of the reference itself
  double error_sigma = kNaN;    ///< by block bootstrap
  Interval error_interval;
  double undefined_share = 0.0;                ///< of the values, that only this model or only the reference has
  double common_error = kNaN;                  ///< against truth: RMS over the vectors that every model with any has
  double cpu_s = kNaN;                         ///< median over the repetitions, per simulated second
  double cpu_low_s = kNaN, cpu_high_s = kNaN;  ///< the least and the most of them
  double simulated_s = kNaN;                   ///< that one repetition stands for
  std::int64_t work = 0;                       ///< of one repetition
  double memory_mb = kNaN;                     ///< heap that it holds, made ready and run once
  bool on_front = false, in_use = false, is_reference = false;
  bool resolved = true;                ///< false: its error is below what the reference itself errs
  std::vector<std::string> tied_with;  ///< models whose times cannot be told from its
};

/// Time fitted to work on this machine: cpu_s of a repetition = fixed_s + per_work_s * work.
struct TimeFit {
  double fixed_s = kNaN, per_work_s = kNaN;
  double worst_ratio = kNaN;  ///< of measured to fitted, or the reverse, the largest
};

struct MeasuredLadder {
  std::string part{}, key{}, of{}, probe{}, meaning{}, unit{}, work_unit{}, reference{};
  bool against_truth = false;  ///< else errors are differences to the finest
  std::vector<MeasuredModel> models{};
  std::vector<LeftOut> left_out{};
  double order_observed = kNaN;  ///< from the finest three rungs above rounding
  std::vector<double> orders{};  ///< of every three consecutive rungs, coarse to fine
  std::optional<double> order_theory{};
  bool order_must_hold = false;   ///< smooth motion, no noise
  double reference_error = kNaN;  ///< what the reference itself errs; NaN: not known
  TimeFit fit{};

  /// False where an order that must hold is more than 0.2 off: the scheme is not what its row says.
  bool order_holds() const;
};

/// How a fidelity's missions end that are driven in a closed loop, over seeds.
struct MeasuredOutcomes {
  Share share;
  double cpu_s = kNaN, cpu_low_s = kNaN, cpu_high_s = kNaN;  ///< of a mission to its end: median, least, most
};

/// One fidelity's mission as a whole: what it errs in an open loop over the whole tape, what its first part costs, and
/// how it ends where it drives by itself.
struct MeasuredFidelity {
  std::string name;
  bool planned = false;  ///< the fidelity above it, without what its plan says is not needed
  double position_error_rms_m = kNaN, map_error_rms_m = kNaN, registration_error_rms_m = kNaN;
  double tape_s = kNaN;                                      ///< that the errors are of
  double cpu_s = kNaN, cpu_low_s = kNaN, cpu_high_s = kNaN;  ///< per simulated second
  double simulated_s = kNaN;                                 ///< that the times are of
  std::int64_t work = 0;
  std::optional<MeasuredOutcomes> outcomes;  ///< none where no seeds were asked for
};

/// The combination that was asked for.
struct Chosen {
  std::string figure, unit;
  double tolerance = kNaN, budget_cpu_s = kNaN;  ///< what was asked for; the other is NaN
  bool found = false;
  std::vector<std::pair<std::string, std::string>> settings{};  ///< keys of the mission that differ from the fidelity's
  double error = kNaN;                                          ///< largest change of the figure over the seeds
  double cpu_s = kNaN, cpu_reference_s = kNaN;                  ///< per simulated second, as run as a whole
  std::vector<std::int64_t> validated_seeds{};
  int refused = 0;  ///< cheaper combinations that did not hold on seeds that had not chosen them
};

struct Tradeoff {
  std::string mission, fidelity, tape;
  std::int64_t seed = 0;
  int repetitions = 0, threads = 0;
  std::size_t samples = 0;
  std::vector<MeasuredLadder> ladders;
  std::vector<LeftOut> skipped;  ///< ladders that cannot be measured here
  std::vector<MeasuredFidelity> fidelities;
  std::optional<Chosen> chosen;
};

}  // namespace canyon::study
