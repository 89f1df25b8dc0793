#include <algorithm>
#include <cmath>

#include "canyon/report/draw/html.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/read/run_story.h"
#include "canyon/report/sections/figures.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {
namespace {

/// A run's figure in one loop: its value, over several seeds the median.
double value_in(const std::vector<Run>& runs, const std::optional<OverSeeds>& over, const std::string& fidelity,
                const Figure& figure) {
  if (over) {
    for (const auto& [name, of_run] : over->medians) {
      const auto found = of_run.find(figure.key);
      if (name == fidelity) return found != of_run.end() ? found->second.value : std::nan("");
    }
    return std::nan("");
  }
  const auto run = std::ranges::find(runs, fidelity, &Run::fidelity);
  return run != runs.end() ? run->figure(figure.key) : std::nan("");
}

std::string outcome_in(const Results& results, const Run& run) {
  if (!results.over_seeds) return outcome_label(run.outcome);
  for (const SuccessShare& share : results.over_seeds->shares)
    if (share.fidelity == run.fidelity)
      return share.n > 0 ? show_count(share.success) + " of " + show_count(share.n) + " succeed" : "all stopped";
  return {};
}

std::string table(const Results& results) {
  const LoopBeside& beside = *results.beside;
  std::string head = "<thead><tr><td></td>", loops = "<tr><td></td>", outcomes;
  std::vector<std::string> fidelities;
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const Run& run = results.runs[i];
    if (std::ranges::find(beside.runs, run.fidelity, &Run::fidelity) == beside.runs.end()) continue;
    fidelities.push_back(run.fidelity);
    head += "<th scope=\"colgroup\" colspan=\"2\">" + run_tag(results.runs, i) + "</th>";
    loops += "<th scope=\"col\">closed</th><th scope=\"col\">open</th>";
    outcomes += figure_cell(escape_html(outcome_in(results, run)), false) + figure_cell({}, true);
  }
  std::string body = "<tr><th scope=\"row\">outcome</th>" + outcomes + "<td></td><td></td></tr>\n";
  for (const Figure* figure : shown_figures(results)) {
    std::string cells;
    bool defined = false;
    for (const std::string& fidelity : fidelities) {
      const double closed = value_in(results.runs, results.over_seeds, fidelity, *figure),
                   open = value_in(beside.runs, beside.over_seeds, fidelity, *figure);
      defined |= std::isfinite(open);
      for (const double value : {closed, open})
        cells += figure_cell(show_figure(*figure, value), !std::isfinite(value));
    }
    // What only a run that drives by itself has stands among all figures, and what it costs.
    if (!defined || figure->timing) continue;
    body += "<tr><th scope=\"row\">" + escape_html(figure->label) + "</th>" + cells + unit_cell(*figure) + "</tr>\n";
  }
  return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Closed and open loop side by "
         "side\"><table class=\"figures\">\n" +
         head + "<td></td><td></td></tr>" + loops +
         "<th scope=\"col\">unit</th><th scope=\"col\">better</th></tr></thead>\n<tbody>" + body +
         "</tbody></table></div>\n";
}

/// By how much one run errs more than another, or less.
std::string compared(const PairedErrors& pair, bool of_several_seeds) {
  if (!std::isfinite(pair.difference_m)) return {};
  const bool less = pair.difference_m < 0.0;
  const double low_m = less ? -pair.high_m : pair.low_m, high_m = less ? -pair.low_m : pair.high_m;
  std::string says = " Epoch by epoch " + escape_html(pair.b) + " errs by " +
                     show_quantity(std::abs(pair.difference_m), "m") + (less ? " less than " : " more than ") +
                     escape_html(pair.a) + " on it";
  if (of_several_seeds) says += ", with the first seed";
  if (std::isfinite(low_m + high_m))
    says += " (95 % interval " + show_number(low_m) + " to " + show_quantity(high_m, "m") + ")";
  return says + ".";
}

}  // namespace

std::string loops_section(const Results& results) {
  if (!results.beside) return {};
  const LoopBeside& beside = *results.beside;
  std::string says =
      "Closed, each run drives by itself: it shows what comes of its errors, which lead it elsewhere than the others. "
      "Open, all are on one true motion (" +
      escape_html(beside.loop.tape) + ", " + show_quantity(beside.duration_s, "s") +
      "): it shows what sensors and filter err on one way, and nothing of what that would lead to.";
  if (beside.over_seeds) says += " Medians over " + show_count(beside.over_seeds->count) + " seeds.";
  for (const PairedErrors& pair : beside.loop.paired) says += compared(pair, beside.over_seeds.has_value());
  return section("loops", "Closed and open loop", says, table(results));
}

}  // namespace canyon::report
