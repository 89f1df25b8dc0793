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

std::string medians(const OverSeeds& found, const std::vector<std::string>& keys) {
  const auto chosen = *choose_figures(keys, "figures");
  const std::string ratio = found.fidelities.size() > 1 ? found.fidelities[1] + "/" + found.fidelities[0] : "";
  TextTable table(found.fidelities, ratio);
  table.heading("median over " + std::to_string(found.seeds.size()) + " seeds, " + std::to_string(found.seeds.front()) +
                " to " + std::to_string(found.seeds.back()) + ", with its 95 % interval");
  add_figures(
      table, chosen, found.fidelities.size(),
      [&](const Figure& figure, std::size_t k) {
        for (const FigureOverSeeds& row : found.figures[k])
          if (row.figure == &figure) return row.median;
        return Estimate{};
      },
      false);
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

}  // namespace canyon::study
