#include "canyon/study/tradeoff/choosing/choose.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/config/text.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/mission/route_tape.h"
#include "canyon/study/tradeoff/choosing/combinations.h"
#include "canyon/study/tradeoff/choosing/movable_keys.h"
#include "canyon/study/tradeoff/probes/taped_run.h"

namespace canyon::study {
namespace {

/// What saves less than this part of a run's time is not moved: one run's time does not tell it from none.
constexpr double kLeastSaving = 0.03;
constexpr int kMostTried = 8;  ///< combinations that are run as a whole before the answer is "none"

using Settings = std::vector<std::pair<std::string, std::string>>;

/// A run's figure and its cost.
struct Outcome {
  double figure = kNaN, cpu_s = kNaN;
};

Result<Outcome> outcome_of(const Question& question, const mission::MissionConfig& config,
                           const mission::PreparedMission& mission, const Tape& tape, double run_s) {
  CANYON_TRY(const RunSummary run, taped_run(config, mission, tape, run_s));
  return Outcome{question.figure->get(run), run.cpu_per_simulated_s()};
}

/// Runs side by side, each on the thread that takes it; what cannot be driven is NaN.
std::vector<Outcome> outcomes_of(const Question& question, const std::vector<const mission::MissionConfig*>& configs,
                                 const mission::PreparedMission& mission, const Tape& tape, double run_s,
                                 Progress& progress) {
  std::vector<Outcome> out(configs.size());
  parallel_for(configs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (const auto one = outcome_of(question, *configs[i], mission, tape, run_s)) out[i] = *one;
      progress.advance(1.0);
    }
  });
  return out;
}

/// What each rung changed alone, and what the fidelity's own settings err.
struct Seen {
  Outcome base;
  std::vector<MovableKey> keys;
  std::vector<std::vector<Option>> options;       ///< of each key those worth taking; the first changes nothing
  std::vector<std::vector<std::size_t>> rung_of;  ///< of each option its rung
  double own_error = 0.0;
};

Result<Seen> look(const Question& question, const mission::MissionFile& file, const TradeoffOptions& options,
                  const Comparison& comparison) {
  Seen seen;
  CANYON_TRY(seen.keys, movable_keys(file, options));
  std::vector<const mission::MissionConfig*> configs{&comparison.configs.front()};
  for (const MovableKey& key : seen.keys)
    for (std::size_t i = 1; i < key.configs.size(); ++i) configs.push_back(&key.configs[i]);
  Progress progress("moving keys one by one", static_cast<double>(configs.size()), options.show_progress);
  const std::vector<Outcome> outcomes =
      outcomes_of(question, configs, comparison.missions.front(), *comparison.tape, options.question_s, progress);
  seen.base = outcomes.front();
  std::size_t next = 1;
  for (const MovableKey& key : seen.keys) {
    std::vector<Option> own{{}};
    std::vector<std::size_t> rungs{0};
    for (std::size_t i = 1; i < key.configs.size(); ++i, ++next) {
      const Outcome& one = outcomes[next];
      const double change = std::abs(one.figure - seen.base.figure), cpu_s = one.cpu_s - seen.base.cpu_s;
      if (i == key.finest && std::isfinite(change)) seen.own_error += change;
      if (!std::isfinite(change) || !(cpu_s < -kLeastSaving * seen.base.cpu_s)) continue;
      own.push_back({cpu_s, change});
      rungs.push_back(i);
    }
    seen.options.push_back(std::move(own));
    seen.rung_of.push_back(std::move(rungs));
  }
  return seen;
}

Settings settings_of(const Seen& seen, const Combination& combination) {
  Settings settings;
  for (std::size_t k = 0; k < seen.keys.size(); ++k) {
    const std::size_t rung = seen.rung_of[k][combination.options[k]];
    if (rung != 0) settings.emplace_back(seen.keys[k].key, seen.keys[k].names[rung]);
  }
  return settings;
}

/// A tape of a seed that has chosen nothing, and what the fidelity's own settings give on it.
struct Fresh {
  mission::MissionFile file;
  mission::PreparedMission mission;
  Tape tape;
  Outcome base;
};

Status drive_fresh(const Question& question, const mission::MissionConfig& config, double run_s, Fresh& fresh) {
  CANYON_TRY(fresh.tape, mission::drive_route(config, fresh.mission));
  CANYON_TRY(fresh.base, outcome_of(question, config, fresh.mission, fresh.tape, run_s));
  return Ok{};
}

Result<std::vector<Fresh>> fresh_seeds(const Question& question, const mission::MissionFile& file,
                                       const TradeoffOptions& options, std::int64_t first, int seeds) {
  mission::SceneCache scenes;
  std::vector<Fresh> out;
  std::vector<mission::MissionConfig> configs;
  for (int i = 0; i < seeds; ++i) {
    Fresh fresh{.file = file, .mission = {}, .tape = {}, .base = {}};
    fresh.file.set_option("run.seed", ConfigNode::of(first + i), "tradeoff");
    CANYON_TRY(auto config, fresh.file.resolve(options.fidelity));
    CANYON_TRY(fresh.mission, mission::prepare(config, scenes));
    configs.push_back(std::move(config));
    out.push_back(std::move(fresh));
  }
  Progress progress("driving seeds that choose nothing", seeds, options.show_progress);
  std::vector<Status> driven(out.size(), Ok{});
  parallel_for(out.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      driven[i] = drive_fresh(question, configs[i], options.question_s, out[i]);
      progress.advance(1.0);
    }
  });
  for (const Status& one : driven) CANYON_TRY_STATUS(one);
  return out;
}

/// Runs the combination on every fresh seed; the largest change and the mean cost.
Result<Outcome> on_fresh_seeds(const Question& question, const TradeoffOptions& options, const Settings& settings,
                               const std::vector<Fresh>& seeds) {
  std::vector<std::optional<Result<Outcome>>> outcomes(seeds.size());
  parallel_for(seeds.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto config = with_settings(seeds[i].file, options.fidelity, settings);
      if (config)
        outcomes[i] = outcome_of(question, *config, seeds[i].mission, seeds[i].tape, options.question_s);
      else
        outcomes[i] = config.error();
    }
  });
  Outcome worst{0.0, 0.0};
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    if (!outcomes[i]->ok()) return outcomes[i]->error();
    const double change = std::abs((**outcomes[i]).figure - seeds[i].base.figure);
    // One that is undefined holds on no seed.
    worst.figure = std::isfinite(change) ? std::max(worst.figure, change) : kNaN;
    worst.cpu_s += (**outcomes[i]).cpu_s / static_cast<double>(seeds.size());
    if (std::isnan(worst.figure)) return worst;
  }
  return worst;
}

/// Combinations in the order in which they are to be tried.
std::vector<Combination> ranked(const Question& question, const Seen& seen) {
  std::vector<Combination> all = best_combinations(seen.options);
  const bool by_budget = std::isfinite(question.budget_cpu_s);
  const auto fits = [&](const Combination& one) {
    return by_budget ? seen.base.cpu_s + one.cpu_s <= question.budget_cpu_s : one.change <= question.tolerance;
  };
  std::vector<Combination> out;
  for (const Combination& one : all)
    if (fits(one)) out.push_back(one);
  if (by_budget)
    std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.change < b.change; });
  return out;
}

Status check_question(const Question& question, const TradeoffOptions& options, const Seen& seen) {
  const Figure& figure = *question.figure;
  const std::string unit = *figure.unit == '\0' ? "" : std::string(" ") + figure.unit;
  if (!std::isfinite(seen.base.figure))
    return Error{.file = std::isfinite(question.tolerance) ? "--tolerance" : "--figure",
                 .what = std::string(figure.key) + " is undefined here in an open loop",
                 .expected = "a figure that it has, such as position_error_rms_m"};
  if (question.tolerance < seen.own_error)
    return Error{.file = "--tolerance",
                 .what = std::string(figure.key) + "=" + number_text(question.tolerance) + " is below what " +
                         options.fidelity + " itself errs against its finest rungs",
                 .expected = "at least " + number_text(std::ceil(seen.own_error * 1e6) * 1e-6) + unit};
  double least_s = seen.base.cpu_s;
  for (const auto& options_of_key : seen.options) {
    double most_saved_s = 0.0;
    for (const Option& one : options_of_key) most_saved_s = std::min(most_saved_s, one.cpu_s);
    least_s += most_saved_s;
  }
  if (question.budget_cpu_s < least_s)
    return Error{.file = "--budget-cpu",
                 .what = number_text(question.budget_cpu_s) + " s per simulated s is below the cheapest rungs",
                 .expected = "at least " + number_text(std::ceil(least_s * 1e4) * 1e-4)};
  return Ok{};
}

}  // namespace

Result<Chosen> choose_settings(const Question& question, const mission::MissionFile& file,
                               const TradeoffOptions& options, const Comparison& comparison, int seeds) {
  CANYON_TRY(const Seen seen, look(question, file, options, comparison));
  CANYON_TRY_STATUS(check_question(question, options, seen));
  const std::int64_t first = comparison.configs.front().run.seed + 1;
  CANYON_TRY(const std::vector<Fresh> fresh, fresh_seeds(question, file, options, first, seeds));
  Chosen chosen{.figure = question.figure->key,
                .unit = question.figure->unit,
                .tolerance = question.tolerance,
                .budget_cpu_s = question.budget_cpu_s};
  chosen.cpu_reference_s = 0.0;
  for (const Fresh& one : fresh) chosen.cpu_reference_s += one.base.cpu_s / static_cast<double>(fresh.size());
  Progress progress("running whole combinations", kMostTried, options.show_progress);
  for (const Combination& combination : ranked(question, seen)) {
    if (chosen.refused == kMostTried) break;
    const Settings settings = settings_of(seen, combination);
    CANYON_TRY(const Outcome worst, on_fresh_seeds(question, options, settings, fresh));
    progress.advance(1.0);
    const bool holds = std::isfinite(question.budget_cpu_s)
                           ? std::isfinite(worst.figure) && worst.cpu_s <= question.budget_cpu_s
                           : worst.figure <= question.tolerance;
    if (!holds) {
      ++chosen.refused;
      continue;
    }
    chosen.found = true;
    chosen.settings = settings;
    chosen.error = worst.figure;
    chosen.cpu_s = worst.cpu_s;
    for (int i = 0; i < seeds; ++i) chosen.validated_seeds.push_back(first + i);
    return chosen;
  }
  return chosen;
}

Result<Tradeoff> choose_and_describe(const Question& question, const mission::MissionFile& file,
                                     const TradeoffOptions& options, const Comparison& comparison, int seeds) {
  Tradeoff out = described(options, comparison);
  CANYON_TRY(out.chosen, choose_settings(question, file, options, comparison, seeds));
  return out;
}

}  // namespace canyon::study
