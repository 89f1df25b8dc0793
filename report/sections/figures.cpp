#include "canyon/report/sections/figures.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/messages.h"
#include "canyon/report/format.h"

namespace canyon::report {
namespace {

/// A number that all runs agree on, "2 to 5 m" where they do not; empty where no run says it.
std::string agreed(const Results& results, double SuccessRules::*rule, const std::string& unit) {
  double low = kNaN, high = kNaN;
  for (const Run& run : results.runs) {
    low = std::fmin(low, run.rules.*rule);
    high = std::fmax(high, run.rules.*rule);
  }
  if (!std::isfinite(low)) return {};
  // As it was configured, not as it was measured: 3 m, not 3.00 m.
  const auto show = [&unit](double v) { return fixed(v, 3) + "\xC2\xA0" + unit; };
  return low == high ? show(low) : show(low) + " to " + show(high);
}

void replace(std::string& text, const std::string& word, const std::string& by) {
  const std::size_t at = text.find(word);
  if (at != std::string::npos && !by.empty()) text.replace(at, word.size(), by);
}

}  // namespace

std::vector<const Figure*> shown_figures(const Results& results) {
  std::vector<const Figure*> out;
  for (const Figure& figure : results.figures) {
    const bool is_total = std::any_of(results.figures.begin(), results.figures.end(),
                                      [&](const Figure& other) { return other.total == figure.key; });
    const bool defined = std::any_of(results.runs.begin(), results.runs.end(), [&](const Run& run) {
      const auto found = run.figures.find(figure.key);
      return found != run.figures.end() && std::isfinite(found->second);
    });
    // In an open loop nobody reaches waypoints: no row for what no run has.
    if (!is_total && (defined || !results.open_loop)) out.push_back(&figure);
  }
  return out;
}

std::string figure_meaning(const Figure& figure, const Results& results) {
  std::string text = figure.meaning;
  replace(text, "[success] waypoint_radius_m", agreed(results, &SuccessRules::waypoint_radius_m, "m"));
  replace(text, "[success] stop_s", agreed(results, &SuccessRules::stop_s, "s"));
  return text;
}

bool at_cap(const Figure& figure, double value) {
  return value >= figure.cap;
}

std::string show_figure(const Figure& figure, double value) {
  if (at_cap(figure, value)) return "\xE2\x89\xA5\xC2\xA0" + show_count(figure.cap);
  if (figure.kind == Figure::Kind::kCount && value == std::floor(value)) return show_count(value);
  if (figure.kind == Figure::Kind::kShare) {
    const std::string share = show_share(value);  // the unit stands in its own column
    return share.substr(0, share.find("\xC2\xA0"));
  }
  return show_number(value);
}

std::string show_interval(const Figure& figure, const Interval& interval) {
  if (!std::isfinite(interval.low) || !std::isfinite(interval.high)) return {};
  return show_figure(figure, interval.low) + " to " + show_figure(figure, interval.high);
}

std::string figure_cell(const std::string& text, bool undefined) {
  return undefined ? "<td class=\"undefined\"><span aria-label=\"undefined\">\xE2\x80\x93</span></td>"
                   : "<td>" + text + "</td>";
}

std::string unit_cell(const Figure& figure) {
  return "<td class=\"unit\">" + escape_html(figure.unit) + "</td><td class=\"unit\">" +
         (figure.better == "lower" || figure.better == "higher" ? escape_html(figure.better) : "") + "</td>";
}

}  // namespace canyon::report
