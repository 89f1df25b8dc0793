#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/math/chi_square.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/time_charts.h"
#include "canyon/report/format.h"
#include "canyon/report/read/run_story.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {
namespace {

struct AxisColumns {
  const char* title;
  const char* error;
  const char* sigma;
};
constexpr std::array<AxisColumns, 3> kAxes{{{"East error", "error_e_m", "sigma_e_m"},
                                            {"North error", "error_n_m", "sigma_n_m"},
                                            {"Up error", "error_u_m", "sigma_u_m"}}};

Line norm_line(const Results& results, std::size_t i) {
  const EpochTable& nav = *results.runs[i].nav;
  Line line{.run = i, .name = results.runs[i].fidelity, .x = nav["t_s"], .y = {}};
  for (std::size_t k = 0; k < nav.rows; ++k) line.y.push_back(error_norm_m(nav, k));
  return line;
}

Panel norm_panel(const std::vector<Line>& lines) {
  Panel panel{.title = "Position error, 3-D (logarithmic)", .unit = "m"};
  panel.y = error_axis(lines);
  panel.lines = lines;
  panel.height_px = 150;
  return panel;
}

Panel axis_panel(const Results& results, const std::vector<std::size_t>& drawn, const AxisColumns& columns) {
  Panel panel{.title = columns.title, .unit = "m"};
  panel.zero_line = true;
  panel.height_px = 130;
  std::vector<double> sigmas;
  for (const std::size_t i : drawn) {
    const EpochTable& nav = *results.runs[i].nav;
    panel.lines.push_back(column_line(results, i, nav, columns.error));
    Band band{.run = i, .x = nav["t_s"], .low = {}, .high = {}};
    for (const double sigma : nav[columns.sigma]) {
      band.low.push_back(-sigma);
      band.high.push_back(sigma);
      if (std::isfinite(sigma)) sigmas.push_back(sigma);
    }
    panel.bands.push_back(std::move(band));
  }
  const Extremes e = extremes_of(panel.lines);
  // The frame holds all errors, and the usual sigma too; a sigma that grows without bound in an outage is cut off.
  double reach_m = e.drawn ? std::max(std::abs(e.min), std::abs(e.max)) : 1.0;
  if (!sigmas.empty()) {
    std::nth_element(sigmas.begin(), sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2), sigmas.end());
    reach_m = std::max(reach_m, sigmas[sigmas.size() / 2]);
  }
  panel.y = Axis::linear_rounded(e.drawn ? std::min(e.min, -0.2 * reach_m) : -1,
                                 e.drawn ? std::max(e.max, 0.2 * reach_m) : 1, 4);
  return panel;
}

/// What a consistent filter's NIS of a fix, chi-square distributed with three degrees of freedom, exceeds once in a
/// thousand.
constexpr double kNisFalseAlarm = 1e-3;
double nis_limit() {
  return chi_square_threshold(kNisFalseAlarm, 3);
}

/// The error of the fixes, and how far each was from where the filter believed the antenna: what it corrects itself by.
std::vector<Panel> fix_panels(const Results& results, const std::vector<std::size_t>& drawn) {
  Panel error{.title = "Error of the fix, 3-D (logarithmic)", .unit = "m"};
  Panel nis{.title = "Squared innovation of the fix over what the filter expects, NIS (logarithmic)"};
  for (const std::size_t i : drawn) {
    if (!results.runs[i].gnss_epochs) continue;  // the section on satellites says so
    const EpochTable& gnss = *results.runs[i].gnss_epochs;
    Line line{.run = i, .name = results.runs[i].fidelity, .x = gnss["t_s"]};
    for (std::size_t k = 0; k < gnss.rows; ++k) line.y.push_back(error_norm_m(gnss, k));
    error.lines.push_back(std::move(line));
    nis.lines.push_back(column_line(results, i, gnss, "nis"));
  }
  if (error.lines.empty()) return {};
  error.y = error_axis(error.lines);
  error.height_px = nis.height_px = 110;
  constexpr double kLowest = 0.1;  // one in 120 of a consistent filter's lies below
  nis.y = Axis::logarithmic(kLowest, std::max(2 * nis_limit(), extremes_of(nis.lines).max));
  nis.limit = nis_limit();
  nis.notes.push_back("Dashed: " + show_number(nis_limit()) +
                      ", which an honest filter\xE2\x80\x99s NIS exceeds once in a thousand fixes.");
  return {std::move(error), std::move(nis)};
}

/// "7 of 209 fixes have a NIS above 16.3"; empty without fixes that reached the filter.
std::string surprises(const EpochTable& gnss) {
  std::size_t fixes = 0, above = 0;
  for (const double nis : gnss["nis"]) {
    if (!std::isfinite(nis)) continue;
    ++fixes;
    above += nis > nis_limit() ? 1 : 0;
  }
  if (fixes == 0) return {};
  return show_count(static_cast<double>(above)) + " of " + count_of(static_cast<double>(fixes), "fix", "fixes") +
         (above == 1 ? " has" : " have") + " a NIS above " + show_number(nis_limit());
}

/// "low: RMS 0.21 m, inside its own ±1σ 66 % of the time (68 % expected), ±3σ 99 % (99.7 %)".
std::string consistency(const Results& results, std::size_t i) {
  const Run& run = results.runs[i];
  const double one = share_within_sigma(*run.nav, 1), three = share_within_sigma(*run.nav, 3);
  std::string text = run_tag(results.runs, i) + " largest 3-D error ";
  double largest_m = std::nan(""), at_s = 0;
  for (std::size_t k = 0; k < run.nav->rows; ++k) {
    const double error_m = error_norm_m(*run.nav, k);
    if (std::isfinite(error_m) && !(error_m <= largest_m)) largest_m = error_m, at_s = (*run.nav)["t_s"][k];
  }
  if (!std::isfinite(largest_m)) return text + "undefined.";
  text += show_quantity(largest_m, "m") + " at " + show_quantity(at_s, "s");
  if (std::isfinite(one)) {
    text +=
        "; errors lie within the filter\xE2\x80\x99s own \xC2\xB1"
        "1\xCF\x83 in " +
        show_share(one) +
        ", within \xC2\xB1"
        "3\xCF\x83 in " +
        show_share(three) + " of cases";
  }
  const std::string surprised = run.gnss_epochs ? surprises(*run.gnss_epochs) : std::string();
  if (!surprised.empty()) text += "; " + surprised;
  return text + ".";
}

}  // namespace

std::string error_section(const Results& results) {
  std::vector<std::size_t> drawn;
  std::string missing;
  for (const std::size_t i : pure_runs(results)) {
    const Run& run = results.runs[i];
    if (run.nav && run.nav->rows > 0) {
      drawn.push_back(i);
    } else {
      missing += note(missing_file(run, "navigation epochs", "_nav.csv"));
    }
  }
  const std::string intro =
      "The filter\xE2\x80\x99s estimate minus truth. Bands with an edge: what the filter itself claims, \xC2\xB1"
      "1\xCF\x83; beside an error of many metres they are but a line along zero. An honest filter has 68.3 % of its "
      "errors "
      "within \xC2\xB1"
      "1\xCF\x83 and 99.7 % within \xC2\xB1"
      "3\xCF\x83. The fixes are what it corrects itself by; a fix far from where it believed the antenna, by its own "
      "covariance and the receiver\xE2\x80\x99s, has a large NIS.";
  if (drawn.empty()) return section("errors", "Position error against time", {}, missing);

  Chart chart = time_chart(results, "error-chart", "Position error against time");
  std::vector<Line> norms;
  std::string caption;
  for (const std::size_t i : drawn) {
    norms.push_back(norm_line(results, i));
    caption += (caption.empty() ? "" : "<br>") + consistency(results, i);
    const Extremes e = extremes_of({norms.back()});
    if (e.drawn) chart.description += results.runs[i].fidelity + ": up to " + show_quantity(e.max, "m") + ". ";
  }
  chart.panels.push_back(norm_panel(norms));
  for (Panel& panel : fix_panels(results, drawn)) chart.panels.push_back(std::move(panel));
  for (const AxisColumns& columns : kAxes) chart.panels.push_back(axis_panel(results, drawn, columns));
  return section("errors", "Position error against time", intro,
                 run_legend(results.runs, drawn) + figure(draw(chart), caption) + missing);
}

}  // namespace canyon::report
