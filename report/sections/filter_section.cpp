#include <algorithm>

#include "canyon/report/draw/html.h"
#include "canyon/report/sections/filter_verdict.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {

std::string filter_section(const Results& results) {
  const char* const title = "Does the filter know how wrong it is?";
  const std::vector<std::size_t> runs = pure_runs(results);
  const auto said = [&](std::size_t i) { return !results.runs[i].filter_verdict.lines.empty(); };
  if (std::none_of(runs.begin(), runs.end(), said))
    return section("filter", title, {}, note("The results say nothing of what the runs\xE2\x80\x99 filters claimed."));
  std::string body;
  for (const std::size_t i : runs) {
    if (!said(i)) continue;
    const FilterVerdict& verdict = results.runs[i].filter_verdict;
    body += "<h3>" + run_tag(results.runs, i) + "</h3>\n" + filter_words(verdict) +
            "<details><summary>The numbers behind it</summary>\n" + consistency_table(verdict) +
            observability_chart(verdict, i) + "</details>\n";
  }
  return section(
      "filter", title,
      "A filter claims with every estimate how far off it may be. Here its errors, and its surprise at every "
      "measurement, stand against what it claimed; what differs by more than chance and by more than a tenth "
      "is said, the worst first. All that is said of a run together is said of a right filter in one run of a "
      "hundred. What is not observed is no fault: the measurements do not tell it. In the tables \xC3\x97 is how many "
      "times larger than claimed, a root of mean squares.",
      body);
}

}  // namespace canyon::report
