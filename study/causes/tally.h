#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/study/causes/causes.h"
#include "canyon/study/results/results.h"
#include "canyon/study/statistics/interval.h"

/// Over several seeds: how often which verdict is what a run's failures come to.
namespace canyon::study {

/// How many of a run's explained failures came to one verdict.
struct VerdictCount {
  std::string verdict{};  ///< row of removals(), "not_navigation" or "undetermined"
  std::string words{};    ///< the same for people
  std::string note{};     ///< how much the replays bear; may be empty
  int n = 0;
  Interval interval{};  ///< of the share of those explained (wilson_interval)
};

/// What the failures of one run come from.
struct CauseTally {
  std::string run{};
  int failed = 0;     ///< seeds with which it failed by itself
  int explained = 0;  ///< of these
  /// Each explained failure in one of them: causes that were named at all, in the order of removals(), then
  /// "not_navigation" and "undetermined", be it that none came to them.
  std::vector<VerdictCount> counts{};
};

/// Of each run that failed with any seed, in the order of the runs. `explanations` are of these results.
std::vector<CauseTally> cause_tally(const Results& results, const std::vector<Explanation>& explanations);

/// For a terminal.
std::string cause_tally_table(const std::vector<CauseTally>& tally);
/// `tally` of why.json.
nlohmann::ordered_json cause_tally_json(const std::vector<CauseTally>& tally);

}  // namespace canyon::study
