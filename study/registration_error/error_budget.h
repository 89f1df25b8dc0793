#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/core/output/json.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/registration_error/error_sources.h"
#include "canyon/study/registration_error/scan_store.h"
#include "canyon/study/statistics/interval.h"

namespace canyon::study {

struct BudgetOptions {
  std::string fidelity = "high";
  std::int64_t seeds = 1;         ///< the mission's own the first
  std::int64_t permutations = 8;  ///< orders in which sources are taken away, for each seed; rounded up to even
  std::vector<HiddenRemoval> hidden{HiddenRemoval::kHealed, HiddenRemoval::kDropped};
  /// Memory for scans and clouds that replays of one seed hand on to one another; 0: each makes its own. What comes
  /// once it is full each makes for itself.
  std::int64_t keep_mb = 1024;
  bool show_progress = true;
};

/// What a source causes of a mean square error.
struct SourceShare {
  std::string source;
  bool acts = true;           ///< false: the mission is without it, so its share is exactly 0
  double share = 0.0;         ///< mean over the seeds, in the figure's unit
  double order_sigma = kNaN;  ///< 1-sigma of it by the sampling of orders alone
  Interval over_seeds;        ///< Student's; none with one seed
};

/// One mean square error and its shares, which add up to total - floor.
struct BudgetFigure {
  std::string key;                    ///< "map", "height", "keyframe", "keyframe_east", ..., "roll"
  std::string unit;                   ///< "m2" or "deg2"
  double total = kNaN, floor = kNaN;  ///< means over the seeds
  std::vector<SourceShare> shares;    ///< in the order of error_sources()
};

struct Budget {
  HiddenRemoval hidden;
  std::vector<BudgetFigure> figures;
};

struct ErrorBudget {
  std::string mission, fidelity, tape;
  bool registered = false;  ///< of the registered map and keyframes; else of the filter's
  std::int64_t seed = 0, seeds = 0, permutations = 0;
  std::vector<Budget> budgets;            ///< one for each meaning of hidden signals that was asked for
  std::int64_t runs = 0;                  ///< that were replayed, of all seeds
  std::int64_t receivers = 0;             ///< that measured anew; the other runs took their fixes
  ScanStore::Counts scans;                ///< of all seeds but the plain runs; kept_bytes: the most of one seed
  double cpu_s = 0.0, plain_cpu_s = 0.0;  ///< of everything; of one plain run of each seed
  double cost_factor() const { return plain_cpu_s > 0.0 ? cpu_s / plain_cpu_s : kNaN; }
};

/// What each source of error causes of a mission's mean square map error (distance to the true surfaces, capped as the
/// map's figures are), of its height part (over level ground and roofs) and of its keyframes' poses: of the registered
/// ones, or of the filter's where registration is off.
///
/// Every run is replayed on one true motion, the tape, with some of the sources taken away and the same draws
/// (error_sources.h). A source's share is its Shapley value: by how much its going lowers the mean square error, in the
/// mean over the orders in which sources go (shapley.h). Roots do not add up, mean squares need interactions to be
/// given to somebody; this gives each its half of what two do together. Same bits for any number of threads and
/// whatever is kept.
Result<ErrorBudget> make_error_budget(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                      const Tape& tape, const BudgetOptions& options);

Json error_budget_json(const ErrorBudget& budget);
/// `hidden,figure,unit,source,share,order_sigma,low,high,total,floor`, a line per share.
std::string error_budget_csv(const ErrorBudget& budget);
std::string error_budget_table(const ErrorBudget& budget);

const char* name(HiddenRemoval hidden);  ///< "healed", "dropped"

}  // namespace canyon::study
