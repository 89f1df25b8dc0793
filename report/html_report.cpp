#include "canyon/report/html_report.h"

#include <algorithm>
#include <filesystem>

#include "canyon/core/files/files.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/progress.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/page.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/drive_check/drive_page.h"
#include "canyon/report/error_budget/budget_page.h"
#include "canyon/report/error_budget/events_page.h"
#include "canyon/report/error_budget/response_page.h"
#include "canyon/report/format.h"
#include "canyon/report/fuse/fuse_page.h"
#include "canyon/report/read/read_results.h"
#include "canyon/report/reproduce/reproduce_page.h"
#include "canyon/report/sections/sections.h"
#include "canyon/report/tradeoff/tradeoff_page.h"

namespace canyon::report {
namespace {

/// Check boxes that show and hide runs; they work by CSS alone, so they stand before everything they govern.
std::string run_boxes(const Results& results) {
  std::string boxes, labels;
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const std::string id = "show-" + run_class(i);
    boxes += "<input class=\"show\" type=\"checkbox\" id=\"" + id + "\" checked aria-label=\"show run " +
             escape_html(results.runs[i].fidelity) + "\">\n";
    labels += "<label for=\"" + id + "\">" + run_tag(results.runs, i) + "</label>\n";
  }
  return boxes + "<div class=\"runbar\"><span class=\"runbar-title\">Show</span>\n" + labels + "</div>\n";
}

std::string contents(bool seeds, bool loops, bool two_by_two) {
  return "<nav aria-label=\"Contents\"><a href=\"#verdict\">Verdict</a> " +
         std::string(seeds ? "<a href=\"#seeds\">Over seeds</a> " : "") + "<a href=\"#figures\">Figures</a> " +
         std::string(loops ? "<a href=\"#loops\">Both loops</a> " : "") +
         "<a "
         "href=\"#scene-section\">From above</a> <a "
         "href=\"#errors\">Error</a> <a href=\"#filter\">Filter</a> <a href=\"#satellites\">Satellites</a> <a "
         "href=\"#multipath\">Multipath</a> <a "
         "href=\"#maps\">Maps</a> <a "
         "href=\"#registration\">Registration</a> " +
         std::string(two_by_two ? "<a href=\"#two-by-two\">GNSS or IMU?</a> " : "") +
         "<a href=\"#cost\">Cost</a> <a href=\"#made\">How it was made</a></nav>\n";
}

std::string page(const Results& results) {
  const std::string two_by_two = two_by_two_section(results);
  std::string out = "<header>\n<p class=\"kicker\">Canyon \xC2\xB7 mission " + escape_html(results.mission.name) +
                    (results.mission.seed.empty() ? "" : " \xC2\xB7 seed " + escape_html(results.mission.seed)) +
                    "</p>\n<h1>" + escape_html(headline(results)) + "</h1>\n" +
                    contents(results.over_seeds.has_value(), results.beside.has_value(), !two_by_two.empty()) +
                    "</header>\n";
  for (const auto part : {verdict_section, seeds_section, figures_section, loops_section, scene_section, error_section,
                          filter_section, satellites_section, multipath_section, maps_section, registration_section}) {
    throw_if_cancelled();
    out += part(results);
  }
  out += two_by_two + cost_section(results) + provenance_section(results);
  return whole_page("Canyon: " + results.mission.name, results.runs.size(), out, run_boxes(results));
}

}  // namespace

Result<std::string> html_report(const std::string& results_dir) {
  std::error_code code;
  if (std::filesystem::exists(results_dir + "/tradeoff.csv", code)) return tradeoff_page(results_dir + "/summary.json");
  if (std::filesystem::exists(results_dir + "/error_budget.csv", code))
    return budget_page(results_dir + "/summary.json");
  if (std::filesystem::exists(results_dir + "/error_events.csv", code))
    return events_page(results_dir + "/summary.json");
  if (std::filesystem::exists(results_dir + "/error_response.csv", code))
    return response_page(results_dir + "/summary.json");
  if (std::filesystem::exists(results_dir + "/paper.csv", code)) return reproduce_page(results_dir + "/summary.json");
  if (std::filesystem::exists(results_dir + "/innovations.csv", code)) return fuse_page(results_dir);
  if (std::filesystem::exists(results_dir + "/signals.csv", code)) return drive_page(results_dir);
  CANYON_TRY(Results results, read_results(results_dir));
  // As they were asked for, which also gives the colours; the mixed runs last.
  std::stable_partition(results.runs.begin(), results.runs.end(), [](const Run& run) { return run.is_pure(); });
  throw_if_cancelled();
  return page(results);
}

Status write_html_report(const std::string& results_dir, const std::string& out_file) {
  CANYON_TRY(const std::string html, html_report(results_dir));
  CANYON_TRY(auto file, StagedFile::create(out_file, true));
  CANYON_TRY_STATUS(file.write(html));
  return file.commit();
}

}  // namespace canyon::report
