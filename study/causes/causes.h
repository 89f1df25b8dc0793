#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/study/causes/events.h"
#include "canyon/study/causes/removals.h"
#include "canyon/study/compare.h"
#include "canyon/study/statistics/interval.h"
#include "canyon/study/statistics/proportions.h"

namespace canyon::study {

/// What came of the replays without one source.
struct RemovalOutcome {
  const ModelRow<Removal>* removal = nullptr;
  int successes = 0;     ///< out of Explanation::draws
  PairedCounts pairs;    ///< a: as it was, b: without; the same redraws in both
  Interval difference;   ///< of the shares of success, 95 %
  double p = 1.0;        ///< one-sided, exact: as many rescues or more, were rescues and harms as likely
  bool rescues = false;  ///< p within 2.5 % over all removals (Holm), and the interval excludes 0
};

/// Why one run failed.
struct Explanation {
  std::string run;
  std::int64_t seed = 0;
  mission::Failure failure;
  std::vector<Event> events;    ///< of the whole run
  double from_s = 0.0;          ///< since when sources were taken away and noise drawn anew
  int draws = 0;                ///< replays with and without each
  int successes_as_it_was = 0;  ///< with other draws, nothing taken away
  std::vector<RemovalOutcome> outcomes;
  const ModelRow<Removal>* cause = nullptr;  ///< the narrowest that rescues; null: undetermined
};

/// So many replays with and without each source a run can have at most.
inline constexpr int kMostDraws = 1000;
/// The noise seed of a replay, with and without a source the same. No two runs of different seeds, nor two draws of
/// one, have the same, and none is the seed of any run. The run's seed is 0 to kLargestSeed, the draw 0 to kMostDraws -
/// 1; throws outside of these.
std::uint64_t replay_seed(std::int64_t run_seed, int draw);

/// Drives each failed run of a closed-loop comparison again: `draws` times, 1 to kMostDraws, with the noise that
/// follows the last chain of events (chain_start_s) drawn anew, and as often, on the same draws, without each source of
/// removals(). A source is the cause if its removal rescues the mission more often than the redraws alone: the paired
/// exact test of McNemar, Holm's correction over all removals (S. Holm, Scand. J. Stat. 6 (1979) 65). Closed loops are
/// chaotic: without the paired redraws, any perturbation might rescue. Where no one error is named from the chain's
/// beginning on, a second look takes sources away from the start on, for what had been at work before, as a drift has;
/// each look has 2.5 %, so that where nothing helps something is named in 5 % at most. Explained are the failed_runs()
/// in `results`, which may have several seeds, by seed; with `most_seeds` no more than so many of each run, the first
/// ones. What is said of one run and seed depends on no other.
Result<std::vector<Explanation>> explain_failures(const Comparison& comparison, const Results& results, int draws,
                                                  bool show_progress,
                                                  std::optional<std::int64_t> most_seeds = std::nullopt);

/// Which of several one-sided p are significant together at `level` (Holm 1979).
std::vector<bool> holm(const std::vector<double>& p, double level);

/// What an explanation comes to: a source that is to blame; no source of navigation, since no replay with the true pose
/// succeeds; or neither can be said.
enum class VerdictKind { kCause, kNotNavigation, kUndetermined };
VerdictKind verdict_kind(const Explanation& explanation);
/// The verdict in one or two sentences.
std::string verdict(const Explanation& explanation);
/// "0 of 12 repeats, so in at most 24 % of such drives (95 %)": what replays of one drive, of which none succeeds, say
/// of all that differ as they do. The upper end of wilson_interval; draws > 0.
std::string replays_bound(int draws);
/// Removals that rescue as well and are as narrow as the cause, which is neither among them nor part of them: each by
/// itself is enough to take away. Empty without a cause.
std::vector<const RemovalOutcome*> alike(const Explanation& explanation);
/// Lines of a chain at most, beside how it ended.
inline constexpr std::size_t kMostChainLines = 10;
/// The chain of events before the failure, one a line; of more than kMostChainLines events those of a kind are one
/// line, at the time of the first. Last how it ended.
std::vector<std::string> chain(const Explanation& explanation);
/// why.json.
nlohmann::ordered_json why_json(const std::vector<Explanation>& explanations);

}  // namespace canyon::study
