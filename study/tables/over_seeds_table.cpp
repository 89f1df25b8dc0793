#include <algorithm>
#include <cmath>
#include <cstdio>

#include "canyon/study/results/over_seeds.h"
#include "canyon/study/tables/text_table.h"

namespace canyon::study {

namespace {

std::string interval_text(const Interval& interval, int decimals) {
  return interval.defined() ? fixed(interval.low, decimals) + " to " + fixed(interval.high, decimals) : "-";
}

std::string p_text(double p) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", p);
  return std::isfinite(p) ? text : "-";
}

Estimate median_of(const OverSeeds& found, std::size_t run, const Figure& figure) {
  for (const FigureOverSeeds& row : found.figures[run])
    if (row.figure == &figure) return row.median;
  return {};
}

std::string medians(const OverSeeds& found, const std::vector<std::string>& keys) {
  auto chosen = *choose_figures(keys, "figures");
  if (keys.empty())
    std::erase_if(chosen, [&](const Figure* figure) {
      for (std::size_t k = 0; k < found.fidelities.size(); ++k)
        if (std::isfinite(median_of(found, k, *figure).value)) return false;
      return true;
    });
  const std::string ratio = found.fidelities.size() > 1 ? found.fidelities[1] + "/" + found.fidelities[0] : "";
  TextTable table(found.fidelities, ratio);
  table.heading("median over " + std::to_string(found.seeds.size()) + " seeds, " + std::to_string(found.seeds.front()) +
                " to " + std::to_string(found.seeds.back()) + ", with its 95 % interval");
  add_figures(
      table, chosen, found.fidelities.size(),
      [&](const Figure& figure, std::size_t k) { return median_of(found, k, figure); }, false);
  return table.str();
}

std::string shares(const OverSeeds& found) {
  TextTable table({"success", "95 % interval", "outcomes"});
  table.heading("share of success over seeds (Wilson)");
  for (const Share& share : found.shares) {
    std::string outcomes;
    for (const auto& [kind, count] : share.outcomes)
      outcomes += (outcomes.empty() ? "" : ", ") + kind + " " + std::to_string(count);
    table.line(share.fidelity, {share.text(), interval_text(share.interval, 2), outcomes});
  }
  return table.str();
}

std::string differences(const OverSeeds& found, const std::vector<std::string>& keys) {
  TextTable table({"difference", "95 % interval", "p"});
  table.heading(found.open_loop ? "difference seed by seed (mean, Student; p: exact sign test)"
                                : "difference of the shares, seed by seed (Newcombe, paired; p: McNemar, exact)");
  for (const PairedDifference& pair : found.paired) {
    const Figure* figure = find_figure(pair.figure);
    if (figure != nullptr && !keys.empty() && std::find(keys.begin(), keys.end(), pair.figure) == keys.end()) continue;
    const int decimals = figure != nullptr ? figure->decimals : 2;
    const double scale = figure != nullptr && figure->kind == Figure::Kind::kShare ? 100.0 : 1.0;
    const Interval scaled{scale * pair.interval.low, scale * pair.interval.high};
    table.line(pair.b + " - " + pair.a + ", " + (figure != nullptr ? figure->label : pair.figure),
               {fixed(scale * pair.difference, decimals), interval_text(scaled, decimals), p_text(pair.p)});
  }
  return table.str();
}

}  // namespace

std::string over_seeds_table(const OverSeeds& found, const std::vector<std::string>& keys) {
  std::string out = medians(found, keys);
  if (!found.open_loop) out += "\n" + shares(found);
  if (!found.paired.empty()) out += "\n" + differences(found, keys);
  return out;
}

std::string squares_over_seeds(const OverSeeds& found, const std::vector<RunSummary>& runs) {
  const Figure& error = *find_figure("position_error_rms_m");
  std::string out;
  for (const TwoByTwo& square : two_by_two(runs)) {
    TextTable table({square.levels[0] + " IMU", square.levels[1] + " IMU"});
    table.heading("2 x 2, " + (square.filter.empty() ? std::string() : "filter " + square.filter + ", ") +
                  (found.open_loop ? "open loop: " : "closed loop: successes and ") +
                  "position error RMS, m, median over " + std::to_string(found.seeds.size()) + " seeds");
    for (std::size_t g = 0; g < 2; ++g) {
      std::vector<std::string> cells;
      for (const RunSummary* run : square.runs[g]) {
        const auto k = static_cast<std::size_t>(run - runs.data());
        cells.push_back((found.open_loop ? "" : found.shares[k].text() + "  ") +
                        figure_text(error, median_of(found, k, error)));
      }
      table.line(square.levels[g] + " GNSS", std::move(cells));
    }
    out += (out.empty() ? "" : "\n") + table.str();
  }
  return out;
}

}  // namespace canyon::study
