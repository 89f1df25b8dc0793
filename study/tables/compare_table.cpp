#include <algorithm>
#include <cmath>

#include "canyon/mission/scoring/told_failure.h"
#include "canyon/study/compare.h"
#include "canyon/study/results/paired_errors.h"
#include "canyon/study/results/verdict_json.h"
#include "canyon/study/tables/text_table.h"

namespace canyon::study {

namespace {

std::string left(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string cell(const std::string& word, double value, int decimals, const char* unit) {
  return word + "  " + fixed(value, decimals) + unit;
}

/// The 2 x 2 of GNSS and IMU fidelity as lines of text.
std::string square_text(const TwoByTwo& square) {
  const bool open_loop = square.runs[0][0]->open_loop;
  std::size_t width = 14;
  for (const std::string& level : square.levels) width = std::max(width, level.size() + 9);
  std::string out = "2 x 2, " + (square.filter.empty() ? std::string() : "filter " + square.filter + ", ") +
                    (open_loop ? "open loop: position error RMS on one true motion\n"
                               : "closed loop: outcome and position error RMS\n");
  out += left("", width) + "  " + left(square.levels[0] + " IMU", 26) + "  " + square.levels[1] + " IMU\n";
  for (std::size_t g = 0; g < 2; ++g) {
    out += left("  " + square.levels[g] + " GNSS", width);
    for (const RunSummary* run : square.runs[g])
      out += "  " + left(cell(run->outcome ? mission::name(*run->outcome) : "", run->position_m.rms, 2, " m"), 26);
    out += "\n";
  }
  return out;
}

/// CPU time of the parts of a run: what they are depends on what works in it.
void add_cpu_parts(TextTable& table, const std::vector<RunSummary>& runs) {
  for (std::size_t part = 0; part < runs.front().cpu_parts_s.size(); ++part) {
    std::vector<std::string> cells;
    for (const RunSummary& run : runs) cells.push_back(fixed(run.cpu_parts_s[part].second, 2));
    table.line("  " + runs.front().cpu_parts_s[part].first + ", s", std::move(cells));
  }
}

}  // namespace

std::string comparison_table(const Results& results, const std::vector<std::string>& keys) {
  // The mixed runs have a table of their own.
  std::vector<RunSummary> runs;
  for (const RunSummary& run : results.summaries)
    if (run.gnss == run.imu) runs.push_back(run);
  std::vector<std::string> names, outcomes;
  for (const RunSummary& run : runs) {
    names.push_back(run.name);
    outcomes.emplace_back(run.outcome ? mission::name(*run.outcome) : "");
  }
  TextTable table(names, runs.size() > 1 ? names[1] + "/" + names[0] : "");
  if (results.summaries.front().open_loop) {
    table.heading("open loop: one true motion for all runs");
  } else {
    table.heading("closed loop: each run drives by itself");
    table.line("outcome", outcomes);
  }
  auto chosen = *choose_figures(keys, "figures");
  // In an open loop nobody reaches waypoints: no row for what no run has.
  if (keys.empty() && results.summaries.front().open_loop)
    std::erase_if(chosen, [&](const Figure* figure) {
      return std::none_of(runs.begin(), runs.end(), [&](const auto& run) { return std::isfinite(figure->get(run)); });
    });
  add_figures(
      table, chosen, runs.size(), [&](const Figure& figure, std::size_t k) { return estimate(figure, runs[k]); }, true);
  if (keys.empty() && !runs.empty()) add_cpu_parts(table, runs);

  std::string out = table.str();
  for (const RunSummary& run : results.summaries) {
    if (!run.failure) continue;
    out += "\n" + run.name + ", after " + fixed(run.failure->t_s, 1) + " s at x " + fixed(run.failure->p_W.x(), 1) +
           " m, y " + fixed(run.failure->p_W.y(), 1) + " m: it " + failure_line(told_failure(*run.failure));
  }
  if (out.back() != '\n') out += "\n";
  for (const RunSummary& run : results.summaries)
    if (keys.empty() && !run.verdict.empty())
      out += "\nfilter of " + run.name + ": " + verdict_in_short(run.verdict) + "\n";
  for (const PairedErrors& pair : results.paired) {
    const std::string interval = std::isfinite(pair.low_m)
                                     ? "95 % interval " + fixed(pair.low_m, 3) + " to " + fixed(pair.high_m, 3) + " m"
                                     : "too short for an interval";
    out += "\n" + pair.b + " against " + pair.a + ", epoch by epoch (" + std::to_string(pair.epochs) +
           "): 3-D error larger by " + fixed(pair.mean_m, 3) + " m on average, " + interval + "; larger at " +
           fixed(100.0 * pair.worse_share, 0) + " % of epochs\n";
  }
  for (const TwoByTwo& square : two_by_two(results.summaries)) out += "\n" + square_text(square);
  return out;
}

}  // namespace canyon::study
