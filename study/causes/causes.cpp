#include "canyon/study/causes/causes.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/mission/run.h"

namespace canyon::study {
namespace {

/// What nobody looks at in a replay, where nothing is made of it.
mission::Omissions unread(const mission::MissionConfig& config) {
  mission::Omissions omissions;
  omissions.maps = true;
  mission::Omissions more = omissions;
  more.registration = more.keyframes = true;
  return can_leave_out(config, more) ? more : omissions;
}

/// Drives one run of a comparison without recording anything but what `recorder` wants.
Result<mission::RunRecord> drive(const Comparison& comparison, std::size_t run, mission::MissionConfig config,
                                 mission::Recorder* recorder, mission::LaterParts* later, Progress& progress) {
  const mission::Omissions omissions = unread(config);
  config.run.record_tape = false;
  config = without(std::move(config), omissions);
  if (later != nullptr) later->config = without(std::move(later->config), omissions);
  return run_mission(config, comparison.missions[run], &progress,
                     {.recorder = recorder, .autonomy = nullptr, .omissions = &omissions, .later = later});
}

/// One replay; `removal` may be null: nothing taken away. True: success.
Result<bool> replay(const Comparison& comparison, std::size_t run, const Removal* removal, double from_s, int draw,
                    Progress& progress) {
  mission::MissionConfig config = comparison.configs[run];
  mission::LaterParts later{.config = config, .from_s = from_s, .noise_seed = 0};
  // Any number that no run has as its seed: those end at 9e15.
  constexpr std::uint64_t kBeyondSeeds = 10'000'000'000'000'000u;
  later.noise_seed =
      kBeyondSeeds + static_cast<std::uint64_t>(config.run.seed) * 1000u + static_cast<std::uint64_t>(draw);
  if (removal != nullptr) removal->remove(removal->from_start ? config : later.config);
  CANYON_TRY(const auto record, drive(comparison, run, std::move(config), nullptr, &later, progress));
  return record.outcome == mission::Outcome::kSuccess;
}

/// Which of `replays`, draw by draw as it was and without, came out how.
RemovalOutcome compare_replays(const ModelRow<Removal>& row, const std::vector<bool>& as_it_was,
                               const std::vector<bool>& removed) {
  RemovalOutcome out;
  out.removal = &row;
  for (std::size_t i = 0; i < removed.size(); ++i) {
    out.successes += removed[i] ? 1 : 0;
    int& count = as_it_was[i] ? (removed[i] ? out.pairs.both : out.pairs.only_a)
                              : (removed[i] ? out.pairs.only_b : out.pairs.neither);
    ++count;
  }
  out.difference = paired_difference_interval(out.pairs);
  out.p = fair_coin_tail(out.pairs.only_a, out.pairs.only_a + out.pairs.only_b);
  return out;
}

void judge(Explanation& explanation) {
  constexpr double kLevel = 0.05;
  std::vector<double> p;
  for (const RemovalOutcome& outcome : explanation.outcomes) p.push_back(outcome.p);
  const std::vector<bool> significant = holm(p, kLevel);
  const RemovalOutcome* cause = nullptr;
  for (std::size_t i = 0; i < p.size(); ++i) {
    RemovalOutcome& outcome = explanation.outcomes[i];
    outcome.rescues = significant[i] && outcome.difference.low > 0.0;
    if (!outcome.rescues) continue;
    const auto rank = [](const RemovalOutcome& o) { return std::pair(o.removal->make.breadth, -o.successes); };
    if (cause == nullptr || rank(outcome) < rank(*cause)) cause = &outcome;
  }
  if (cause != nullptr) explanation.cause = cause->removal;
}

}  // namespace

std::vector<bool> holm(const std::vector<double>& p, double level) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<bool> significant(p.size(), false);
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (p[order[k]] > level / static_cast<double>(order.size() - k)) break;
    significant[order[k]] = true;
  }
  return significant;
}

Result<std::vector<Explanation>> explain_failures(const Comparison& comparison, const Results& results, int draws,
                                                  bool show_progress) {
  std::vector<Explanation> explanations;
  std::vector<std::size_t> runs;
  double replays_s = 0.0;
  const auto rows = removals();
  const std::size_t arms = rows.size() + 1, each = arms * static_cast<std::size_t>(draws);
  for (std::size_t i = 0; i < results.records.size(); ++i) {
    if (!results.records[i].failure) continue;
    runs.push_back(i);
    replays_s +=
        static_cast<double>(each + 1) * std::min(comparison.missions[i].nominal_s, comparison.missions[i].time_limit_s);
    Explanation explanation;
    explanation.run = comparison.plan[i].name;
    explanation.seed = comparison.configs[i].run.seed;
    explanation.failure = *results.records[i].failure;
    explanation.draws = draws;
    explanations.push_back(std::move(explanation));
  }
  if (runs.empty()) return explanations;
  Progress progress("driving " + std::to_string(runs.size() * each) + " replays of what failed", replays_s,
                    show_progress);

  std::vector<std::optional<Error>> errors(runs.size() * each);
  parallel_for(runs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      RunEvents events;
      auto record = drive(comparison, runs[k], comparison.configs[runs[k]], &events, nullptr, progress);
      if (!record) errors[k] = record.error();
      explanations[k].events = events.events();
      explanations[k].from_s = chain_start_s(explanations[k].events, explanations[k].failure.t_s);
    }
  });
  std::vector<char> success(errors.size(), 0);  // by run, arm and draw
  parallel_for(errors.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t k = i / each, arm = i % each / static_cast<std::size_t>(draws);
      const Removal* removal = arm == 0 ? nullptr : &rows[arm - 1].make;
      auto result = replay(comparison, runs[k], removal, explanations[k].from_s,
                           static_cast<int>(i % static_cast<std::size_t>(draws)), progress);
      if (result)
        success[i] = *result ? 1 : 0;
      else
        errors[i] = result.error();
    }
  });
  for (const auto& error : errors)
    if (error) return *error;

  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto arm = [&](std::size_t a) {
      const auto from = success.begin() + static_cast<std::ptrdiff_t>(k * each + a * static_cast<std::size_t>(draws));
      return std::vector<bool>(from, from + draws);
    };
    Explanation& explanation = explanations[k];
    const std::vector<bool> as_it_was = arm(0);
    explanation.successes_as_it_was = static_cast<int>(std::count(as_it_was.begin(), as_it_was.end(), true));
    for (std::size_t r = 0; r < rows.size(); ++r)
      explanation.outcomes.push_back(compare_replays(rows[r], as_it_was, arm(r + 1)));
    judge(explanation);
  }
  return explanations;
}

}  // namespace canyon::study
