#include "canyon/report/sections/filter_verdict.h"

#include <algorithm>
#include <cmath>

#include "canyon/report/draw/html.h"
#include "canyon/report/format.h"
#include "canyon/report/sections/figures.h"

namespace canyon::report {
namespace {

bool is_fault(const std::string& line) {
  return line != "consistent" && !line.ends_with("not observed");
}

std::string open_table(const char* label, const std::vector<const char*>& titles) {
  std::string out = std::string("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"") + label +
                    "\"><table class=\"figures\">\n<thead><tr><td></td>";
  for (const char* title : titles) out += std::string("<th scope=\"col\">") + title + "</th>";
  return out + "</tr></thead>\n";
}

std::string cell(double value, std::string_view unit = {}) {
  const bool known = std::isfinite(value);
  return figure_cell(unit.empty() ? show_number(value) : show_quantity(value, unit), !known);
}

/// "0.94 to 1.06", or "up to 1.3" where only what is too large is told.
std::string band(const ConsistencyRow& row) {
  if (!std::isfinite(row.high)) return figure_cell({}, true);
  return figure_cell((row.low > 0.0 ? show_number(row.low) + " to " : "up to ") + show_number(row.high), false);
}

std::string consistency_line(const ConsistencyRow& row) {
  const bool off = row.factor > row.high || row.factor < row.low;
  const std::string share = row.refused > 0.0 ? ", " + show_count(row.refused) + " refused" : "";
  return "<tr><th scope=\"row\">" + escape_html(row.name) + "</th><td" + (off ? " class=\"strong\"" : "") + ">" +
         show_number(row.factor) + "</td>" + band(row) + cell(row.rms, row.unit) + cell(row.claimed, row.unit) +
         figure_cell(show_count(row.count) + share, !std::isfinite(row.count)) +
         figure_cell(row.correlation_s > 0.0 ? show_quantity(row.correlation_s, "s") : "", !(row.correlation_s > 0.0)) +
         "</tr>\n";
}

std::string title_of(const std::string& group) {
  if (group == "errors") return "Errors of the estimate against the truth";
  return group == "innovations" ? "Innovations: what was measured minus what was predicted"
                                : "Errors of what it is corrected by";
}

}  // namespace

std::string filter_words(const FilterVerdict& verdict) {
  std::string out;
  for (const std::string& line : verdict.lines)
    out += std::string("<li class=\"") +
           (line == "consistent" ? "good"
            : is_fault(line)     ? "bad"
                                 : "soft") +
           "\">" + escape_html(line) + "</li>\n";
  return out.empty() ? out : "<ul class=\"findings\">\n" + out + "</ul>\n";
}

std::string consistency_table(const FilterVerdict& verdict) {
  std::string rows, group;
  for (const ConsistencyRow& row : verdict.rows) {
    if (!std::isfinite(row.factor)) continue;
    if (row.group != group) {
      rows += (group.empty() ? "<tbody>" : "</tbody>\n<tbody>") +
              ("<tr class=\"group\"><th scope=\"rowgroup\" colspan=\"7\">" + title_of(row.group) + "</th></tr>\n");
      group = row.group;
    }
    rows += consistency_line(row);
  }
  if (rows.empty()) return {};
  return open_table("How large errors and innovations are, over what the filter claims",
                    {"\xC3\x97 claimed", "right filter", "RMS", "claimed", "number", "alike for"}) +
         rows + "</tbody></table></div>\n";
}

std::string observability_table(const FilterVerdict& verdict) {
  std::string rows;
  for (const ObservedState& state : verdict.states) {
    if (!std::isfinite(state.share)) continue;
    const bool observed = std::isfinite(state.halved_after_s);
    rows += "<tr><th scope=\"row\">" + escape_html(state.name) + "</th>" + figure_cell(show_share(state.share), false) +
            figure_cell(observed ? show_quantity(state.halved_after_s, "s") : "never", false) + "</tr>\n";
  }
  if (rows.empty()) return {};
  return open_table("What the measurements tell of each state", {"1\xCF\x83 at the end", "halved after"}) + "<tbody>" +
         rows + "</tbody></table></div>\n";
}

}  // namespace canyon::report
