#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "canyon/core/math/chi_square.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/time_charts.h"
#include "canyon/report/format.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {
namespace {

/// A panel per run: prior and registered pose error of each keyframe, and a lane of those that could not be aligned.
Panel run_panel(const Results& results, std::size_t i, const Axis& y) {
  const Run& run = results.runs[i];
  const EpochTable& keyframes = *run.keyframes;
  Panel panel{.title = "Keyframe position error, run " + run.fidelity + " (logarithmic)", .unit = "m"};
  panel.marks_of = i;
  panel.y = y;
  Line prior = column_line(results, i, keyframes, "prior_error_m", Line::Style::kThin);
  prior.name = "prior";
  Line registered = column_line(results, i, keyframes, "registered_error_m");
  registered.name = "registered";
  panel.lines = {std::move(registered), std::move(prior)};
  Lane failed{.run = i, .name = "could not be aligned"};
  double unconverged = 0;
  for (std::size_t k = 0; k < keyframes.rows; ++k) {
    const std::string& status = keyframes.text("status")[k];
    if (status == "converged" || status == "not_registered") continue;
    ++unconverged;
    const double t_s = keyframes["t_s"][k];
    failed.intervals.emplace_back(t_s - 0.25, t_s + 0.25);
  }
  if (unconverged > 0) {
    panel.lanes.push_back(std::move(failed));
    panel.notes.push_back("Bars at the foot: " + count_of(unconverged, "keyframe", "keyframes") + " of " +
                          show_count(static_cast<double>(keyframes.rows)) + " that could not be aligned.");
  }
  return panel;
}

/// How keyframes ended, most frequent first; how many steps, converged or not, are farther off than their own
/// covariance has it, as study/keyframes.py counts them: also those without one, which bounds nothing; and how many do
/// not determine every direction, where the method tells that.
std::string endings(const EpochTable& k) {
  const double bound = chi_square_threshold(1e-3, 6.0);
  std::map<std::string, double> count;
  double steps = 0, beyond = 0, beyond_unconverged = 0, told = 0, open = 0;
  for (std::size_t row = 0; row < k.rows; ++row) {
    const std::string& status = k.text("status")[row];
    if (status == "not_registered") continue;
    ++count[status];
    ++steps;
    const double nees = k["step_nees"][row], directions = k["open_directions"][row];
    const bool converged = status == "converged", within = nees >= 0.0 && nees <= bound;
    if (!within) ++beyond;
    if (!within && !converged) ++beyond_unconverged;
    if (!converged) continue;
    if (std::isfinite(directions)) ++told;
    if (directions > 0.0) ++open;
  }
  if (count.empty()) return {};
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [status, n] : count) order.emplace_back(n, status);
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text = " They ended: ";
  for (const auto& [n, status] : order)
    text += (n == order.front().first && status == order.front().second ? "" : ", ") + escape_html(status) + ' ' +
            show_count(n);
  text += '.';
  text += " Of " + count_of(steps, "step", "steps") + ", beyond their own 99.9 % bound: " + show_count(beyond);
  if (beyond_unconverged > 0) text += " (" + show_count(beyond_unconverged) + " of them did not converge)";
  text += '.';
  if (told > 0) text += " Converged with a direction left open: " + show_count(open) + '.';
  return text;
}

std::string improvement(const Results& results, std::size_t i) {
  const EpochTable& k = *results.runs[i].keyframes;
  double better = 0, defined = 0;
  for (std::size_t row = 0; row < k.rows; ++row) {
    if (k.text("status")[row] == "not_registered") continue;  // the first one
    const double prior = k["prior_error_m"][row], registered = k["registered_error_m"][row];
    if (!std::isfinite(prior) || !std::isfinite(registered)) continue;
    ++defined;
    better += registered < prior ? 1 : 0;
  }
  std::string text = run_tag(results.runs, i) + " " + count_of(static_cast<double>(k.rows), "keyframe", "keyframes");
  if (defined > 0) text += "; registration made the pose better in " + show_share(better / defined);
  return text + "." + endings(k);
}

}  // namespace

std::string registration_section(const Results& results) {
  const std::string title = "Registration";
  Chart chart = time_chart(results, "registration-chart", "Registration error by keyframe");
  chart.solid = true;
  std::vector<std::size_t> drawn;
  std::vector<Line> all;
  std::vector<std::string> unregistered;
  std::string missing, caption;
  for (const std::size_t i : pure_runs(results)) {
    const Run& run = results.runs[i];
    if (!run.keyframes || run.keyframes->rows == 0) {
      missing += note(missing_file(run, "keyframes", "_keyframes.csv"));
      continue;
    }
    if (!run.registers()) {
      unregistered.push_back(run.fidelity);
      continue;
    }
    drawn.push_back(i);
    all.push_back(column_line(results, i, *run.keyframes, "prior_error_m"));
    all.push_back(column_line(results, i, *run.keyframes, "registered_error_m"));
    caption += (caption.empty() ? "" : "<br>") + improvement(results, i);
  }
  if (!unregistered.empty())
    missing += note((unregistered.size() == 1 ? "Run " : "Runs ") + listed(unregistered) +
                    " registered nothing ([registration] method = \"none\"): each keyframe stands where the filter "
                    "placed it.");
  if (drawn.empty()) return section("registration", title, {}, missing);
  const Axis y = error_axis(all);  // one scale for all runs, so that the panels can be compared
  for (const std::size_t i : drawn) {
    chart.panels.push_back(run_panel(results, i, y));
    chart.description += results.runs[i].fidelity + ": prior RMS " +
                         show_quantity(results.runs[i].figure("registration_error_prior_rms_m"), "m") +
                         ", registered RMS " + show_quantity(results.runs[i].figure("registration_error_rms_m"), "m") +
                         ". ";
  }
  return section("registration", title,
                 "Position error of each keyframe of the map: where the filter placed it (prior, thin) and where "
                 "registration moved it (registered, bold).",
                 figure(draw(chart), caption) + missing);
}

}  // namespace canyon::report
