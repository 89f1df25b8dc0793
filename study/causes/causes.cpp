#include "canyon/study/causes/causes.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/mission/run.h"
#include "canyon/study/causes/failed_runs.h"
#include "canyon/study/seeds/further_seeds.h"

namespace canyon::study {
namespace {

/// What nobody looks at in a replay, where nothing is made of it. The run whose events are told keeps its keyframes, by
/// which the event map_doubled is told; the map that would be scored is left out there too.
mission::Omissions unread(const mission::MissionConfig& config, bool told) {
  mission::Omissions omissions;
  omissions.maps = true;
  if (told) return omissions;
  mission::Omissions more = omissions;
  more.registration = more.keyframes = true;
  return can_leave_out(config, more) ? more : omissions;
}

/// One failed run and what is known of it.
struct Failed {
  std::size_t run;  ///< of the comparison
  Explanation explanation;
};

/// Its configuration: all seeds have the comparison's but for the seed.
mission::MissionConfig config_of(const Comparison& comparison, const Failed& failed) {
  mission::MissionConfig config = comparison.configs[failed.run];
  config.run.seed = failed.explanation.seed;
  return config;
}

/// Drives one run of a comparison without recording anything but what `recorder` wants.
Result<mission::RunRecord> drive(const Comparison& comparison, std::size_t run, mission::MissionConfig config,
                                 mission::Recorder* recorder, mission::LaterParts* later, Progress& progress) {
  mission::PreparedMission mission = comparison.missions[run];
  if (later != nullptr) {
    // Whether a replay succeeds shows at its own end.
    config.time.limit_s = later->config.time.limit_s = 0.0;
    mission.time_limit_s = config.success.limit_factor * mission.nominal_s;
  }
  const mission::Omissions omissions = unread(config, recorder != nullptr);
  config.run.record_tape = false;
  config = without(std::move(config), omissions);
  if (later != nullptr) later->config = without(std::move(later->config), omissions);
  return run_mission(config, mission, &progress,
                     {.recorder = recorder, .autonomy = nullptr, .omissions = &omissions, .later = later});
}

/// One replay; `removal` may be null: nothing taken away. True: success.
Result<bool> replay(const Comparison& comparison, const Failed& failed, const Removal* removal, int draw,
                    Progress& progress) {
  mission::MissionConfig config = config_of(comparison, failed);
  mission::LaterParts later{
      .config = config, .from_s = failed.explanation.from_s, .noise_seed = replay_seed(config.run.seed, draw)};
  if (removal != nullptr) removal->remove(removal->from_start ? config : later.config);
  CANYON_TRY(const auto record, drive(comparison, failed.run, std::move(config), nullptr, &later, progress));
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

/// Two looks are taken at most (explain_failures), so each has half of the 5 %.
constexpr double kLevel = 0.05 / 2;

void judge(Explanation& explanation) {
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

/// Drives each again, to see its events and where its replays begin to differ.
Status see_events(const Comparison& comparison, std::vector<Failed>& failed, bool show_progress) {
  double whole_s = 0.0;
  for (const Failed& f : failed) whole_s += comparison.missions[f.run].nominal_s;
  Progress progress("driving " + std::to_string(failed.size()) + " failed runs again", whole_s, show_progress);
  std::vector<std::optional<Error>> errors(failed.size());
  parallel_for(failed.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      mission::MissionConfig config = config_of(comparison, failed[i]);
      RunEvents events(first_plan_by_s(config));
      const auto record = drive(comparison, failed[i].run, std::move(config), &events, nullptr, progress);
      if (!record) {
        errors[i] = record.error();
        continue;
      }
      Explanation& explanation = failed[i].explanation;
      explanation.events = events.events();
      explanation.from_s = chain_start_s(explanation.events, explanation.failure.t_s);
    }
  });
  for (const auto& error : errors)
    if (error) return *error;
  return Ok{};
}

/// What acts at the start alone can only be taken away there; a run that goes its own way from the start on is no
/// replay of one that failed later, whatever it was that went.
bool asked(const Removal& removal, const Failed& failed) {
  return !removal.from_start || failed.explanation.from_s <= 0.0;
}

/// Drives the replays of each from its from_s on, and judges. `title`: what they are, for people.
Status look(const Comparison& comparison, std::vector<Failed>& failed, const char* title, bool show_progress) {
  const auto rows = removals();
  const auto draws = static_cast<std::size_t>(failed.front().explanation.draws);
  const std::size_t each = (rows.size() + 1) * draws;
  std::size_t replays = 0;
  double whole_s = 0.0;
  for (const Failed& f : failed) {
    const auto arms = 1 + std::count_if(rows.begin(), rows.end(), [&](const auto& row) { return asked(row.make, f); });
    const std::size_t of_it = static_cast<std::size_t>(arms) * draws;
    replays += of_it;
    whole_s += static_cast<double>(of_it) * comparison.missions[f.run].nominal_s;
  }
  Progress progress("driving " + std::to_string(replays) + " " + title, whole_s, show_progress);
  std::vector<std::optional<Error>> errors(failed.size() * each);
  std::vector<char> success(errors.size(), 0);  // by run, arm and draw
  parallel_for(errors.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Failed& of = failed[i / each];
      const std::size_t arm = i % each / draws;
      const Removal* removal = arm == 0 ? nullptr : &rows[arm - 1].make;
      if (removal != nullptr && !asked(*removal, of)) continue;
      auto result = replay(comparison, of, removal, static_cast<int>(i % draws), progress);
      if (result)
        success[i] = *result ? 1 : 0;
      else
        errors[i] = result.error();
    }
  });
  for (const auto& error : errors)
    if (error) return *error;
  for (std::size_t k = 0; k < failed.size(); ++k) {
    const auto arm = [&](std::size_t a) {
      const auto from = success.begin() + static_cast<std::ptrdiff_t>(k * each + a * draws);
      return std::vector<bool>(from, from + static_cast<std::ptrdiff_t>(draws));
    };
    Explanation& explanation = failed[k].explanation;
    const std::vector<bool> as_it_was = arm(0);
    explanation.successes_as_it_was = static_cast<int>(std::count(as_it_was.begin(), as_it_was.end(), true));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (asked(rows[r].make, failed[k]))
        explanation.outcomes.push_back(compare_replays(rows[r], as_it_was, arm(r + 1)));
    }
    judge(explanation);
  }
  return Ok{};
}

bool names_one_error(const Explanation& e) {
  return e.cause != nullptr && e.cause->make.breadth == Breadth::kOneError;
}

}  // namespace

std::uint64_t replay_seed(std::int64_t run_seed, int draw) {
  constexpr std::int64_t kBeyondSeeds = 10'000'000'000'000'000;
  static_assert(kBeyondSeeds > kLargestSeed);
  CANYON_CHECK(run_seed >= 0 && run_seed <= kLargestSeed && draw >= 0 && draw < kMostDraws, "seed ", run_seed,
               ", draw ", draw);
  return static_cast<std::uint64_t>(kBeyondSeeds + run_seed * kMostDraws + draw);
}

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
                                                  bool show_progress, std::optional<std::int64_t> most_seeds) {
  CANYON_CHECK(draws > 0 && draws <= kMostDraws, "draws ", draws);
  std::vector<Failed> failed;
  for (FailedRun& run : failed_runs(results, most_seeds)) {
    Explanation explanation;
    explanation.run = comparison.plan[run.run].name;
    explanation.seed = run.seed;
    explanation.failure = std::move(run.failure);
    explanation.draws = draws;
    failed.push_back({run.run, std::move(explanation)});
  }
  if (failed.empty()) return std::vector<Explanation>();
  CANYON_TRY_STATUS(see_events(comparison, failed, show_progress));
  CANYON_TRY_STATUS(look(comparison, failed, "replays of what failed", show_progress));

  // Where no one error is to blame from there on, it may have been at work before, as a drift is.
  std::vector<Failed> again;
  std::vector<std::size_t> of;
  for (std::size_t k = 0; k < failed.size(); ++k) {
    if (names_one_error(failed[k].explanation) || failed[k].explanation.from_s <= 0.0) continue;
    again.push_back(failed[k]);
    Explanation& explanation = again.back().explanation;
    explanation.from_s = 0.0;
    explanation.outcomes.clear();
    explanation.cause = nullptr;
    of.push_back(k);
  }
  if (!again.empty()) {
    CANYON_TRY_STATUS(look(comparison, again, "replays from the start", show_progress));
  }
  for (std::size_t i = 0; i < again.size(); ++i) {
    Explanation &first = failed[of[i]].explanation, &second = again[i].explanation;
    const bool narrower =
        second.cause != nullptr && first.cause != nullptr && second.cause->make.breadth < first.cause->make.breadth;
    if (first.cause == nullptr || narrower) first = std::move(second);
  }
  std::vector<Explanation> explanations;
  for (Failed& f : failed) explanations.push_back(std::move(f.explanation));
  return explanations;
}

}  // namespace canyon::study
