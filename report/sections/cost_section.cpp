#include <algorithm>
#include <cmath>

#include "canyon/core/messages.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {
namespace {

double part_of(const Run& run, const std::string& part) {
  for (const auto& [name, cpu_s] : run.cpu_parts_s) {
    if (name == part) return cpu_s;
  }
  return kNaN;
}

/// All parts of all runs, those that cost most in any run first.
std::vector<std::string> parts_of(const std::vector<Run>& runs, const std::vector<std::size_t>& which) {
  std::vector<std::pair<double, std::string>> parts;
  for (const std::size_t i : which) {
    for (const auto& [name, cpu_s] : runs[i].cpu_parts_s) {
      const auto found =
          std::find_if(parts.begin(), parts.end(), [&name = name](const auto& p) { return p.second == name; });
      const double cost_s = std::isfinite(cpu_s) ? cpu_s : 0.0;
      if (found == parts.end()) {
        parts.emplace_back(cost_s, name);
      } else {
        found->first = std::max(found->first, cost_s);
      }
    }
  }
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> names;
  for (const auto& part : parts) names.push_back(part.second);
  return names;
}

std::string bar(std::size_t run, double cpu_s, double longest_s) {
  const double width = longest_s > 0 && std::isfinite(cpu_s) ? 100 * cpu_s / longest_s : 0.0;
  return "<svg class=\"bar\" viewBox=\"0 0 100 8\" preserveAspectRatio=\"none\" aria-hidden=\"true\"><path "
         "class=\"fill " +
         run_class(run) + " keep\" d=\"M0 0H" + fixed(std::max(width, 0.0), 2) + "V8H0Z\"/></svg>";
}

std::string totals(const Results& results) {
  std::vector<std::string> times;
  if (std::isfinite(results.wall_s)) times.push_back(show_quantity(results.wall_s, "s") + " of wall time");
  if (std::isfinite(results.cpu_s)) times.push_back(show_quantity(results.cpu_s, "s") + " of CPU time");
  if (times.empty()) return {};
  std::string text = "All runs together took " + listed(times);
  if (std::isfinite(results.threads)) text += " on " + count_of(results.threads, "thread", "threads");
  if (std::isfinite(results.peak_memory_mb))
    text += ", with at most " + show_quantity(results.peak_memory_mb, "MB") + " of memory";
  return text + ".";
}

std::string counters(const Results& results, const std::vector<std::size_t>& which) {
  std::vector<std::string> names;
  for (const std::size_t i : which) {
    for (const auto& counter : results.runs[i].counters) {
      if (std::find(names.begin(), names.end(), counter.first) == names.end()) names.push_back(counter.first);
    }
  }
  if (names.empty()) return {};
  std::string out =
      "<h3>Work done</h3>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"Counters\"><table>\n<thead><tr><td></td>";
  for (const std::size_t i : which) out += "<th scope=\"col\">" + run_tag(results.runs, i) + "</th>";
  out += "</tr></thead>\n<tbody>";
  for (const std::string& name : names) {
    std::string label = name;
    std::replace(label.begin(), label.end(), '_', ' ');
    out += "<tr><th scope=\"row\">" + escape_html(label) + "</th>";
    for (const std::size_t i : which) {
      double count = kNaN;
      for (const auto& counter : results.runs[i].counters) {
        if (counter.first == name) count = counter.second;
      }
      out += "<td>" + show_count(count) + "</td>";
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::string cost_section(const Results& results) {
  const std::vector<std::size_t> which = pure_runs(results);
  const std::vector<std::string> parts = parts_of(results.runs, which);
  std::string body;
  if (parts.empty()) {
    body = note("The results hold no CPU times of the parts.");
  } else {
    double longest_s = 0;
    for (const std::size_t i : which) {
      for (const auto& part : results.runs[i].cpu_parts_s) longest_s = std::fmax(longest_s, part.second);
    }
    body =
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"CPU time by part\"><table class=\"bars\">\n"
        "<thead><tr><th scope=\"col\" class=\"text\">part</th><th scope=\"col\" class=\"text\">run</th><th "
        "scope=\"col\">CPU time</th>"
        "<td></td></tr></thead>\n";
    for (const std::string& part : parts) {
      body += "<tbody>";
      for (std::size_t k = 0; k < which.size(); ++k) {
        const double cpu_s = part_of(results.runs[which[k]], part);
        body += "<tr>";
        if (k == 0)
          body +=
              "<th scope=\"rowgroup\" rowspan=\"" + std::to_string(which.size()) + "\">" + escape_html(part) + "</th>";
        body += "<td class=\"text\">" + run_tag(results.runs, which[k]) + "</td><td>" +
                (std::abs(cpu_s) < 5e-4 ? "&lt;\xC2\xA0"
                                          "0.001\xC2\xA0s"
                                        : show_quantity(cpu_s, "s")) +
                "</td><td class=\"bar-cell\">" + bar(which[k], cpu_s, longest_s) + "</td></tr>\n";
      }
      body += "</tbody>\n";
    }
    body += "</table></div>\n";
  }
  return section("cost", "Cost", escape_html(totals(results)), body + counters(results, which));
}

}  // namespace canyon::report
