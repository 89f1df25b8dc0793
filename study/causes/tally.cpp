#include "canyon/study/causes/tally.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "canyon/core/output/json.h"
#include "canyon/study/causes/failed_runs.h"
#include "canyon/study/statistics/proportions.h"
#include "canyon/study/tables/text_table.h"

namespace canyon::study {
namespace {

/// A verdict's name and words, without a count yet.
VerdictCount named_verdict(const ModelRow<Removal>& row) {
  return {.verdict = row.name, .words = std::string("because of ") + row.make.cause};
}

CauseTally tally_of_run(const std::string& run, int failed, const std::vector<Explanation>& explanations) {
  CauseTally tally{.run = run, .failed = failed};
  std::vector<VerdictCount> causes;
  for (const auto& row : removals()) causes.push_back(named_verdict(row));
  VerdictCount not_navigation{.verdict = "not_navigation", .words = "navigation is not to blame"};
  VerdictCount undetermined{.verdict = "undetermined", .words = "undetermined"};
  for (const Explanation& e : explanations) {
    if (e.run != run) continue;
    ++tally.explained;
    switch (verdict_kind(e)) {
      case VerdictKind::kCause:
        ++causes[static_cast<std::size_t>(e.cause - removals().data())].n;
        break;
      case VerdictKind::kNotNavigation:
        ++not_navigation.n;
        // The same of each: nothing but no success at all comes to this verdict, and all have as many replays.
        not_navigation.note = "told its true position each succeeds in " + replays_bound(e.draws);
        break;
      case VerdictKind::kUndetermined:
        ++undetermined.n;
        break;
    }
  }
  std::erase_if(causes, [](const VerdictCount& count) { return count.n == 0; });
  tally.counts = std::move(causes);
  tally.counts.push_back(std::move(not_navigation));
  tally.counts.push_back(std::move(undetermined));
  for (VerdictCount& count : tally.counts) count.interval = wilson_interval(count.n, tally.explained);
  return tally;
}

std::string share_text(int count, int of) {
  return std::to_string(count) + " of " + std::to_string(of);
}

}  // namespace

std::vector<CauseTally> cause_tally(const Results& results, const std::vector<Explanation>& explanations) {
  std::vector<int> failed(results.summaries.size(), 0);
  for (const FailedRun& run : failed_runs(results)) ++failed[run.run];
  std::vector<CauseTally> all;
  for (std::size_t run = 0; run < failed.size(); ++run)
    if (failed[run] > 0) all.push_back(tally_of_run(results.summaries[run].name, failed[run], explanations));
  return all;
}

std::string cause_tally_table(const std::vector<CauseTally>& tally) {
  if (tally.empty()) return {};
  TextTable table({"failures", "95 % interval"});
  for (const CauseTally& of_run : tally) {
    table.heading(of_run.run + ": " + share_text(of_run.explained, of_run.failed) +
                  " failures explained, what they come from (Wilson)");
    for (const VerdictCount& count : of_run.counts) {
      table.line(count.words, {share_text(count.n, of_run.explained),
                               fixed(count.interval.low, 2) + " to " + fixed(count.interval.high, 2)});
      if (!count.note.empty()) table.heading("    " + count.note);
    }
  }
  return table.str();
}

nlohmann::ordered_json cause_tally_json(const std::vector<CauseTally>& tally) {
  Json all = Json::array();
  for (const CauseTally& of_run : tally) {
    Json counts = Json::array();
    for (const VerdictCount& count : of_run.counts) {
      Json one{{"verdict", count.verdict},
               {"words", count.words},
               {"n", count.n},
               {"low", or_null(count.interval.low)},
               {"high", or_null(count.interval.high)}};
      if (!count.note.empty()) one["note"] = count.note;
      counts.push_back(std::move(one));
    }
    all.push_back({{"run", of_run.run},
                   {"failed", of_run.failed},
                   {"explained", of_run.explained},
                   {"verdicts", std::move(counts)}});
  }
  return all;
}

}  // namespace canyon::study
