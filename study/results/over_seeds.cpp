#include "canyon/study/results/over_seeds.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/math/median.h"
#include "canyon/study/statistics/proportions.h"
#include "canyon/study/statistics/sample.h"

namespace canyon::study {

namespace {

using Seeds = std::vector<std::vector<RunSummary>>;

bool succeeded(const RunSummary& run) {
  return run.outcome == mission::Outcome::kSuccess;
}

/// A time limit of its own has ended it: whether it would have succeeded is not known.
bool was_stopped(const RunSummary& run) {
  return run.outcome == mission::Outcome::kStopped;
}

Share share_of(const Seeds& seeds, std::size_t run) {
  Share out{.fidelity = seeds.front()[run].name, .success = 0, .n = 0, .interval = {}, .outcomes = {}};
  for (const auto& runs : seeds) {
    ++out.outcomes[mission::name(*runs[run].outcome)];
    if (was_stopped(runs[run])) continue;
    ++out.n;
    out.success += succeeded(runs[run]) ? 1 : 0;
  }
  out.interval = wilson_interval(out.success, out.n);
  return out;
}

PairedDifference paired_success(const Seeds& seeds, std::size_t a, std::size_t b) {
  PairedCounts counts;
  for (const auto& runs : seeds) {
    if (was_stopped(runs[a]) || was_stopped(runs[b])) continue;
    const bool in_a = succeeded(runs[a]), in_b = succeeded(runs[b]);
    ++(in_a ? (in_b ? counts.both : counts.only_a) : (in_b ? counts.only_b : counts.neither));
  }
  return {.a = seeds.front()[a].name,
          .b = seeds.front()[b].name,
          .figure = "success",
          .n = counts.n(),
          .difference = counts.difference(),
          .interval = paired_difference_interval(counts),
          .p = counts.n() > 0 ? mcnemar_exact_p(counts.only_a, counts.only_b) : kNaN};
}

PairedDifference paired_figure(const Seeds& seeds, std::size_t a, std::size_t b, const Figure& figure) {
  std::vector<double> differences;
  int larger = 0, smaller = 0;
  for (const auto& runs : seeds) {
    const double difference = figure.get(runs[b]) - figure.get(runs[a]);
    if (!std::isfinite(difference)) continue;
    differences.push_back(difference);
    larger += difference > 0.0 ? 1 : 0;
    smaller += difference < 0.0 ? 1 : 0;
  }
  return {.a = seeds.front()[a].name,
          .b = seeds.front()[b].name,
          .figure = figure.key,
          .n = static_cast<int>(differences.size()),
          .difference = mean(differences),
          .interval = mean_interval(differences),
          .p = differences.empty() ? kNaN : mcnemar_exact_p(smaller, larger)};
}

FigureOverSeeds figure_over(const Seeds& seeds, std::size_t run, const Figure& figure) {
  FigureOverSeeds out{.figure = &figure, .n = 0, .median = {}, .lowest = kNaN, .highest = kNaN};
  std::vector<double> values;
  for (const auto& runs : seeds)
    if (const double value = figure.get(runs[run]); std::isfinite(value)) values.push_back(value);
  out.n = static_cast<int>(values.size());
  if (values.empty()) return out;
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  out.lowest = *lowest;
  out.highest = *highest;
  out.median = {median(values), median_interval(values)};
  return out;
}

}  // namespace

std::string Share::text() const {
  return n > 0 ? std::to_string(success) + " of " + std::to_string(n) : "all stopped";
}

std::vector<std::vector<RunSummary>> runs_by_seed(const Results& results) {
  std::vector<std::vector<RunSummary>> out{results.summaries};
  out.insert(out.end(), results.further_seeds.begin(), results.further_seeds.end());
  return out;
}

OverSeeds over_seeds(const std::vector<std::vector<RunSummary>>& seeds) {
  CANYON_CHECK(!seeds.empty() && !seeds.front().empty(), "seeds = ", seeds.size());
  OverSeeds out;
  out.open_loop = seeds.front().front().open_loop;
  for (const auto& runs : seeds) out.seeds.push_back(runs.front().seed);
  for (std::size_t run = 0; run < seeds.front().size(); ++run) {
    out.fidelities.push_back(seeds.front()[run].name);
    if (!out.open_loop) out.shares.push_back(share_of(seeds, run));
    std::vector<FigureOverSeeds>& of_run = out.figures.emplace_back();
    for (const Figure& figure : figures()) of_run.push_back(figure_over(seeds, run, figure));
    if (run == 0) continue;
    if (!out.open_loop) {
      out.paired.push_back(paired_success(seeds, 0, run));
      continue;
    }
    for (const Figure& figure : figures()) {
      if (figure.better == Better::kNeither || figure.timing) continue;
      if (auto pair = paired_figure(seeds, 0, run, figure); pair.n > 0) out.paired.push_back(std::move(pair));
    }
  }
  return out;
}

}  // namespace canyon::study
