#include "canyon/report/tradeoff/tradeoff_page.h"

#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/page.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/tradeoff/ladder_section.h"
#include "canyon/report/tradeoff/run_charts.h"

namespace canyon::report {
namespace {

std::string swatch(TradeoffColour colour, const char* words) {
  return "<span class=\"tag keep " + run_class(colour) +
         "\"><svg class=\"swatch\" viewBox=\"0 0 22 8\" aria-hidden=\"true\"><path d=\"M1 4H21\"/></svg>" + words +
         "</span> ";
}

std::string legend() {
  return "<p class=\"legend\">" + swatch(kFront, "on the front") + swatch(kInUse, "in use") +
         swatch(kReference, "reference") + swatch(kDominated, "dominated") + "</p>\n";
}

/// One row a fidelity, after the columns' titles.
std::string fidelity_table(const char* name, const std::vector<std::string>& titles,
                           const std::vector<std::vector<std::string>>& rows) {
  std::string out = std::string("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"") + name +
                    "\"><table>\n<thead><tr><th scope=\"col\" class=\"text\">fidelity</th>";
  for (const std::string& title : titles) out += "<th>" + title + "</th>";
  out += "</tr></thead>\n<tbody>";
  for (const std::vector<std::string>& row : rows) {
    out += "<tr><th scope=\"row\">" + escape_html(row.front()) + "</th>";
    for (std::size_t i = 1; i < row.size(); ++i) out += "<td>" + escape_html(row[i]) + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string error_table(const TradeoffSummary& t) {
  std::vector<std::vector<std::string>> rows;
  for (const TradeoffRun& run : t.runs)
    rows.push_back({run.fidelity, show_number(run.position_m), show_number(run.map_m), show_number(run.registration_m),
                    show_number(run.cpu_s), show_number(run.cpu_low_s) + "\xE2\x80\x93" + show_number(run.cpu_high_s)});
  return fidelity_table("Errors of whole missions",
                        {"position, m", "map, m", "registration, m", "CPU, s per s", "least\xE2\x80\x93most"}, rows);
}

std::string outcome_table(const TradeoffSummary& t) {
  std::vector<std::vector<std::string>> rows;
  for (const TradeoffRun& run : t.runs)
    if (run.driven)
      rows.push_back({run.fidelity,
                      run.seeds > 0 ? show_count(run.success) + " of " + show_count(run.seeds) : "all stopped",
                      show_share(run.success_low) + "\xE2\x80\x93" + show_share(run.success_high), listed(run.outcomes),
                      show_number(run.mission_cpu_s)});
  if (rows.empty()) return "";
  return fidelity_table("Outcomes of whole missions", {"success", "95 %", "how they ended", "CPU, s a mission"}, rows);
}

std::string runs_section(const TradeoffSummary& t) {
  if (t.runs.empty()) return "";
  const TradeoffRun& first = t.runs.front();
  std::string words = "Root mean square errors on the same true motion, " + show_quantity(first.tape_s, "s") +
                      " of it, against what its first " + show_quantity(first.simulated_s, "s") + " cost.";
  const std::string outcomes = outcome_table(t);
  if (!outcomes.empty())
    words += " And how missions end that each drives by itself, over seeds, against what one costs to its end.";
  return section("runs", "The mission as a whole", words,
                 legend() + run_error_charts(t) + error_table(t) + run_outcome_chart(t) + outcomes);
}

std::string choice_section(const TradeoffChoice& c) {
  if (!c.asked) return "";
  std::string asked = std::isfinite(c.tolerance)
                          ? c.figure + " within " + show_quantity(c.tolerance, c.unit)
                          : "at most " + show_number(c.budget_cpu_s) + " CPU seconds per simulated second";
  std::string body;
  for (const std::string& one : c.settings) body += "<p><code>" + escape_html(one) + "</code></p>\n";
  if (c.found) {
    body +=
        "<p>" +
        escape_html(c.figure + " changes by at most " + show_quantity(c.error, c.unit) + " on " +
                    std::to_string(c.seeds) + " seeds that did not choose these settings; CPU " + show_number(c.cpu_s) +
                    " s per simulated second, " + show_number(c.cpu_reference_s) + " without them.") +
        "</p>\n";
    if (c.settings.empty()) body += note("Nothing to change: the fidelity\xE2\x80\x99s own settings.");
  } else {
    body += note("No combination held on seeds that had not chosen it.");
  }
  if (c.refused > 0) body += note(show_count(c.refused) + " that ranked before did not hold on those seeds.");
  return section("chosen", "Asked: " + asked, "", body);
}

std::string contents(const TradeoffSummary& t) {
  std::string out = "<nav aria-label=\"Contents\">";
  for (std::size_t i = 0; i < t.ladders.size(); ++i)
    if (i == 0 || t.ladders[i].part != t.ladders[i - 1].part)
      out += "<a href=\"#ladder-" + std::to_string(i) + "\">" + escape_html(t.ladders[i].part) + "</a> ";
  if (!t.runs.empty()) out += "<a href=\"#runs\">whole runs</a> ";
  return out + "</nav>\n";
}

std::string intro(const TradeoffSummary& t) {
  return "<p class=\"intro\">" +
         escape_html("Each ladder varies one setting of fidelity " + t.fidelity + " on the same true motion (" +
                     t.tape + ") and the same random numbers: up to " + show_count(t.samples) + " samples, " +
                     show_count(t.repetitions) +
                     " repetitions in interleaved random order. Bars: the least and the most time of these, and the "
                     "95 % interval of the error by block bootstrap. Models whose times overlap are tied.") +
         "</p>\n";
}

}  // namespace

Result<std::string> tradeoff_page(const std::string& summary_path) {
  CANYON_TRY(const TradeoffSummary t, read_tradeoff(summary_path));
  std::string out = "<header>\n<p class=\"kicker\">Canyon \xC2\xB7 mission " + escape_html(t.mission) +
                    " \xC2\xB7 seed " + escape_html(t.seed) + "</p>\n<h1>Error against run time</h1>\n" + contents(t) +
                    "</header>\n";
  out += choice_section(t.choice) + runs_section(t);
  if (!t.ladders.empty()) out += intro(t) + legend();
  for (std::size_t i = 0; i < t.ladders.size(); ++i) {
    throw_if_cancelled();
    out += ladder_section(t.ladders[i], "ladder-" + std::to_string(i));
  }
  for (const std::string& one : t.skipped) out += note("Not measured here: " + one);
  return whole_page("Canyon: error against run time", kTradeoffColours, out);
}

}  // namespace canyon::report
