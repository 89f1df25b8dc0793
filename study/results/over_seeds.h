#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/study/results/figures.h"
#include "canyon/study/results/results.h"

/// What the same runs with several seeds say: how often they succeed, and how their figures are spread.
namespace canyon::study {

/// How often a run succeeds. One that [time] limit_s stopped stands among the outcomes alone.
struct Share {
  std::string fidelity;
  int success = 0, n = 0;               ///< of how many that ended by themselves
  Interval interval;                    ///< Wilson's
  std::map<std::string, int> outcomes;  ///< how many seeds ended how

  /// "3 of 20"; "all stopped" if none ended by itself.
  std::string text() const;
};

/// Run b against run a, seed by seed.
struct PairedDifference {
  std::string a, b;
  std::string figure;  ///< "success", or a figure's key
  int n = 0;           ///< pairs in which both are defined; of success: ended by themselves
  /// Of success: share of b minus share of a with Newcombe's interval (paired_difference_interval) and McNemar's exact
  /// p. Of a figure: mean of b minus a with Student's interval, and p of the exact sign test (mcnemar_exact_p of how
  /// often b is the larger and the smaller one).
  double difference = kNaN;
  Interval interval;
  double p = kNaN;
};

/// A figure of one run over the seeds at which it is defined.
struct FigureOverSeeds {
  const Figure* figure = nullptr;
  int n = 0;
  Estimate median;  ///< with an interval by order statistics (median_interval)
  double lowest = kNaN, highest = kNaN;
};

struct OverSeeds {
  bool open_loop = false;
  std::vector<std::int64_t> seeds;
  std::vector<std::string> fidelities;                ///< one per run
  std::vector<Share> shares;                          ///< same index; none in an open loop, where nobody drove
  std::vector<PairedDifference> paired;               ///< each run against the first: success, in an open loop figures
  std::vector<std::vector<FigureOverSeeds>> figures;  ///< [run][as figures()]
};

/// Of at least one seed: runs[seed][run].
OverSeeds over_seeds(const std::vector<std::vector<RunSummary>>& runs);
/// The first seed's runs and the further ones.
std::vector<std::vector<RunSummary>> runs_by_seed(const Results& results);

/// `seeds`, `shares` (null in an open loop), `paired` and `over_seeds` as members of summary.json.
void write_over_seeds(const OverSeeds& found, nlohmann::ordered_json& out);

/// The same for a terminal: medians of the figures with these keys, or of all that any run has; shares and differences.
std::string over_seeds_table(const OverSeeds& found, const std::vector<std::string>& keys = {});
/// The 2 x 2 of GNSS and IMU, one for each filter, of medians; empty where the runs of a seed, in the order of `found`,
/// make none.
std::string squares_over_seeds(const OverSeeds& found, const std::vector<RunSummary>& runs);

}  // namespace canyon::study
