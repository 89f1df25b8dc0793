#include <algorithm>
#include <cmath>

#include "canyon/study/compare.h"
#include "canyon/study/results/over_seeds.h"
#include "canyon/study/tables/text_table.h"

namespace canyon::study {

namespace {

/// What the two loops may say of a run.
struct Column {
  std::size_t run;  ///< of its loop
  bool open;
};

}  // namespace

std::string both_loops_table(const Results& results, const std::vector<std::string>& keys) {
  const OpenLoopRuns& open_loop = *results.open_loop;
  const OverSeeds closed = over_seeds(runs_by_seed(results)), open = over_seeds(open_loop.by_seed);
  const bool several = open.seeds.size() > 1;

  std::vector<Column> columns;
  std::vector<std::string> names, successes;
  for (std::size_t k = 0; k < open.fidelities.size(); ++k) {
    const auto found = std::ranges::find(closed.fidelities, open.fidelities[k]);
    const auto i = static_cast<std::size_t>(found - closed.fidelities.begin());
    columns.insert(columns.end(), {{i, false}, {k, true}});
    names.insert(names.end(), {open.fidelities[k] + ", closed", "open"});
    const RunSummary& first = results.summaries[i];
    const Share& share = closed.shares[i];
    successes.push_back(several ? share.text() : first.outcome ? mission::name(*first.outcome) : "-");
    successes.emplace_back("-");
  }
  const auto of = [&](const Figure& figure, std::size_t column) {
    const auto& [run, is_open] = columns[column];
    if (!several) return estimate(figure, is_open ? open_loop.by_seed.front()[run] : results.summaries[run]);
    for (const FigureOverSeeds& row : (is_open ? open : closed).figures[run])
      if (row.figure == &figure) return row.median;
    return Estimate{};
  };
  auto chosen = *choose_figures(keys, "figures");
  // What only a run that drives by itself has stands in its own table, and what a run costs.
  if (keys.empty())
    std::erase_if(chosen, [&](const Figure* figure) {
      const auto in_open_loop = [&](std::size_t k) { return columns[k].open && std::isfinite(of(*figure, k).value); };
      bool defined = false;
      for (std::size_t k = 0; k < columns.size(); ++k) defined |= in_open_loop(k);
      return !defined || figure->timing;
    });

  TextTable table(names);
  table.heading("both loops, side by side" +
                (several ? ": medians over " + std::to_string(open.seeds.size()) + " seeds" : std::string()));
  table.line(several ? "success" : "outcome", successes);
  std::string group;
  for (const Figure* figure : chosen) {
    if (group != figure->group) table.heading(group = figure->group);
    std::vector<std::string> cells;
    for (std::size_t k = 0; k < columns.size(); ++k) cells.push_back(figure_text(*figure, of(*figure, k)));
    const std::string unit = *figure->unit != '\0' ? std::string(", ") + figure->unit : "";
    table.line(figure->label + unit, std::move(cells));
  }
  return table.str() +
         "\nclosed: each run drives by itself, so it shows what comes of the errors, which lead it elsewhere than the "
         "others\nopen: all on one true motion (" +
         open_loop.tape_source + ", " + fixed(open_loop.duration_s, 0) +
         " s), so it shows what sensors and filter err on one way, and nothing of what they would lead to\n";
}

}  // namespace canyon::study
