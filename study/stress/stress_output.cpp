#include "canyon/study/stress/stress_output.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "canyon/core/output/json.h"
#include "canyon/core/output/printed.h"
#include "canyon/study/stress/cases.h"
#include "canyon/study/tables/text_table.h"

namespace canyon::study {
namespace {

std::string scientific(double value) {
  if (value == 0.0) return "0";
  return printed("%.3g", value);
}

/// What is no column's border in Markdown.
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, "\\");
  return text;
}

std::string rest(const std::string& name) {
  const auto slash = name.find('/');
  return slash == std::string::npos ? name : name.substr(slash + 1);
}

std::size_t count(const std::vector<CaseResult>& results, CaseVerdict verdict) {
  return static_cast<std::size_t>(std::count_if(
      results.begin(), results.end(), [verdict](const CaseResult& result) { return result.verdict == verdict; }));
}

/// What a reader wants to know of one that does not hold.
std::string explanation(const CaseResult& result) {
  std::string text = "  " + result.stress_case.name + " " + name(result.verdict) + ": ";
  if (!result.thrown.empty()) text += "it threw: " + result.thrown + ". ";
  if (!bound_is_tight(result)) text += "a bound over 1000 times its figure says nothing of it. ";
  text += "expected: " + result.stress_case.expected + ".";
  if (!result.stress_case.open.empty()) text += " To be mended: " + result.stress_case.open + ".";
  return text + "\n";
}

std::string summary_line(const std::vector<CaseResult>& results) {
  std::vector<StressCase> cases;
  double cpu_s = 0.0;
  for (const CaseResult& result : results) {
    cases.push_back(result.stress_case);
    cpu_s += result.cpu_s;
  }
  const std::string text = printed("%zu cases of %zu mechanisms: %zu hold, %zu do not, %zu open; %.1f s of CPU time\n",
                                   results.size(), mechanisms(cases), count(results, CaseVerdict::kHolds),
                                   count(results, CaseVerdict::kFails), count(results, CaseVerdict::kOpen), cpu_s);
  return text;
}

}  // namespace

std::string stress_table(const std::vector<CaseResult>& results) {
  TextTable table({"figure", "bound", "CPU s"}, "unit");
  std::string last;
  for (const CaseResult& result : results) {
    const StressCase& one = result.stress_case;
    if (stress_subject(one.name) != last) table.heading(last = stress_subject(one.name));
    const std::string mark =
        result.verdict == CaseVerdict::kHolds ? "" : std::string(" (") + name(result.verdict) + ")";
    table.line(rest(one.name) + mark,
               {scientific(result.found.figure), scientific(result.found.bound), fixed(result.cpu_s, 3)}, one.unit);
  }
  std::string text = table.str() + "\n";
  for (const CaseResult& result : results)
    if (result.verdict != CaseVerdict::kHolds) text += explanation(result);
  return text + summary_line(results);
}

nlohmann::ordered_json stress_json(const std::vector<CaseResult>& results) {
  Json out = Json::array();
  for (const CaseResult& result : results) {
    const StressCase& one = result.stress_case;
    Json row{{"name", one.name},
             {"group", row_of(stress_groups(), one.group).name},
             {"mechanism", one.mechanism},
             {"figure", or_null(result.found.figure)},
             {"bound", or_null(result.found.bound)},
             {"unit", one.unit},
             {"pass", result.verdict == CaseVerdict::kHolds},
             {"seconds", result.cpu_s}};
    if (!one.open.empty()) row["open"] = one.open;
    if (bound_needs_a_reason(result)) row["loose"] = one.loose;
    if (!result.thrown.empty()) row["thrown"] = result.thrown;
    out.push_back(std::move(row));
  }
  return out;
}

std::string stress_list(const std::vector<StressCase>& cases) {
  std::string text =
      "| subject | group | what may break | how | what is true there | cases |\n|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const StressCase& one = cases[i];
    const auto same = [&one](const StressCase& other) {
      return other.mechanism == one.mechanism && stress_subject(other.name) == stress_subject(one.name);
    };
    if (std::any_of(cases.begin(), cases.begin() + static_cast<std::ptrdiff_t>(i), same)) continue;
    text += "| `" + stress_subject(one.name) + "` | " + row_of(stress_groups(), one.group).name + " | " +
            cell(one.mechanism) + " | " + cell(one.why) + " | " + cell(one.expected) + " | " +
            std::to_string(std::count_if(cases.begin(), cases.end(), same)) + " |\n";
  }
  return text;
}

}  // namespace canyon::study
