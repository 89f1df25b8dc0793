#include "canyon/study/registration_error/error_budget.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/study/registration_error/replayed_run.h"
#include "canyon/study/registration_error/shapley.h"
#include "canyon/study/statistics/sample.h"

namespace canyon::study {
namespace {

/// The sources that the mission has: those without which its configuration is another.
std::vector<std::size_t> acting_sources(const mission::MissionConfig& config, HiddenRemoval hidden) {
  const std::string whole = configuration_text(config);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < error_sources().size(); ++i)
    if (configuration_text(without_sources(config, 1u << i, hidden)) != whole) out.push_back(i);
  return out;
}

/// What one meaning of hidden signals asks of one seed.
struct SeedPlan {
  HiddenRemoval hidden;
  std::vector<std::size_t> acting;
  std::vector<std::vector<std::size_t>> orders;
  std::vector<Coalition> coalitions;
  std::vector<std::size_t> run_of;  ///< by coalition, index into the seed's runs
};

/// Runs of a seed that have to be replayed, each once: coalitions of the two meanings of hidden signals share some.
struct SeedRuns {
  std::vector<SeedPlan> plans;
  std::vector<mission::MissionConfig> configs;
  std::vector<ReplayedRun> runs;  ///< same index
};

SeedRuns plan_seed(const mission::MissionConfig& config, const BudgetOptions& options) {
  SeedRuns out;
  std::map<std::string, std::size_t> known;
  const auto run_of = [&](const mission::MissionConfig& wanted) {
    const auto [place, is_new] = known.emplace(configuration_text(wanted), out.configs.size());
    if (is_new) out.configs.push_back(wanted);
    return place->second;
  };
  run_of(config);  // the plain run is the first
  for (const HiddenRemoval hidden : options.hidden) {
    SeedPlan plan{hidden, acting_sources(config, hidden), {}, {}, {}};
    plan.orders = sampled_orders(plan.acting.size(), static_cast<std::size_t>(options.permutations),
                                 static_cast<std::uint64_t>(config.run.seed));
    plan.coalitions = coalitions_of(plan.orders, plan.acting.size());
    for (const Coalition present : plan.coalitions) {
      std::uint32_t removed = 0;
      for (std::size_t k = 0; k < plan.acting.size(); ++k)
        if ((present >> k & 1u) == 0) removed |= 1u << plan.acting[k];
      plan.run_of.push_back(run_of(without_sources(config, removed, hidden)));
    }
    out.plans.push_back(std::move(plan));
  }
  return out;
}

Status replay_all(const mission::PreparedMission& mission, const Tape& tape, SeedRuns& seed, ReplayStores& stores,
                  Progress& progress) {
  seed.runs.resize(seed.configs.size());
  std::vector<std::optional<Error>> errors(seed.configs.size());
  parallel_for(seed.configs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto run = replay_run(seed.configs[i], mission, tape, stores, i == 0 ? Replay::kPlain : Replay::kThrifty);
      if (run)
        seed.runs[i] = *run;
      else
        errors[i] = run.error();
      progress.advance(1);
    }
  });
  for (const auto& error : errors)
    if (error) return *error;
  return Ok{};
}

void add_counts(const ScanStore::Counts& of_seed, ScanStore::Counts& sum) {
  sum.scans_made += of_seed.scans_made;
  sum.scans_taken += of_seed.scans_taken;
  sum.clouds_taken += of_seed.clouds_taken;
  sum.kept_bytes = std::max(sum.kept_bytes, of_seed.kept_bytes);
}

/// Shares of one figure in one seed, by source; 0 of those that the mission is without.
struct SeedShares {
  double total, floor;
  std::vector<double> share, order_sigma;
};

SeedShares shares_of(const SeedRuns& seed, const SeedPlan& plan, std::size_t figure) {
  std::vector<double> value;
  for (const std::size_t run : plan.run_of) value.push_back(seed.runs[run].mean_square[figure]);
  const ShapleyShares shares = shapley_shares(plan.orders, plan.acting.size(), plan.coalitions, value);
  const std::size_t sources = error_sources().size();
  SeedShares out{shares.total, shares.floor, std::vector<double>(sources, 0.0), std::vector<double>(sources, 0.0)};
  for (std::size_t k = 0; k < plan.acting.size(); ++k) {
    out.share[plan.acting[k]] = shares.share[k];
    out.order_sigma[plan.acting[k]] = shares.order_sigma[k];
  }
  return out;
}

BudgetFigure figure_over_seeds(const std::vector<SeedRuns>& seeds, std::size_t plan, std::size_t figure) {
  BudgetFigure out;
  out.key = kMeanSquares[figure].key;
  out.unit = kMeanSquares[figure].unit;
  std::vector<SeedShares> each;
  std::vector<double> totals, floors;
  for (const SeedRuns& seed : seeds) {
    each.push_back(shares_of(seed, seed.plans[plan], figure));
    totals.push_back(each.back().total);
    floors.push_back(each.back().floor);
  }
  out.total = mean(totals);
  out.floor = mean(floors);
  for (std::size_t i = 0; i < error_sources().size(); ++i) {
    SourceShare share;
    share.source = error_sources()[i].name;
    const auto& acting = seeds.front().plans[plan].acting;
    share.acts = std::find(acting.begin(), acting.end(), i) != acting.end();
    std::vector<double> values;
    double variance = 0.0;
    for (const SeedShares& seed : each) {
      values.push_back(seed.share[i]);
      variance += seed.order_sigma[i] * seed.order_sigma[i];
    }
    share.share = mean(values);
    share.order_sigma = std::sqrt(variance) / static_cast<double>(each.size());
    share.over_seeds = mean_interval(values);
    out.shares.push_back(share);
  }
  return out;
}

}  // namespace

const char* name(HiddenRemoval hidden) {
  return hidden == HiddenRemoval::kHealed ? "healed" : "dropped";
}

Result<ErrorBudget> make_error_budget(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                      const Tape& tape, const BudgetOptions& options) {
  ErrorBudget out;
  out.mission = config.run.name;
  out.fidelity = options.fidelity;
  out.tape = tape.source;
  out.registered = lidar::registers(config.registration);
  out.seed = config.run.seed;
  out.seeds = options.seeds;
  out.permutations = options.permutations + options.permutations % 2;

  std::vector<SeedRuns> seeds;
  for (std::int64_t k = 0; k < options.seeds; ++k) {
    mission::MissionConfig own = config;
    own.run.seed += k;
    own.run.record_tape = false;
    seeds.push_back(plan_seed(own, options));
    out.runs += static_cast<std::int64_t>(seeds.back().configs.size());
  }
  Progress progress("replaying " + std::to_string(out.runs) + " runs", static_cast<double>(out.runs),
                    options.show_progress);
  for (SeedRuns& seed : seeds) {
    // Of one seed: another one's sensors draw otherwise.
    ReplayStores stores{.fixes = {}, .scans = ScanStore(options.keep_mb * 1'000'000)};
    CANYON_TRY_STATUS(replay_all(mission, tape, seed, stores, progress));
    out.receivers += stores.fixes.measured();
    add_counts(stores.scans.counts(), out.scans);
    for (const ReplayedRun& run : seed.runs) out.cpu_s += run.cpu_s;
    out.plain_cpu_s += seed.runs.front().cpu_s;
    seed.configs.clear();
  }
  for (std::size_t plan = 0; plan < options.hidden.size(); ++plan) {
    Budget budget{options.hidden[plan], {}};
    for (std::size_t figure = 0; figure < kMeanSquares.size(); ++figure)
      budget.figures.push_back(figure_over_seeds(seeds, plan, figure));
    out.budgets.push_back(std::move(budget));
  }
  return out;
}

}  // namespace canyon::study
