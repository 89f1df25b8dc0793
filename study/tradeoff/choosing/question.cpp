#include "canyon/study/tradeoff/choosing/question.h"

#include <cmath>

#include "canyon/study/results/tolerance.h"

namespace canyon::study {
namespace {

Result<const Figure*> figure_of(const std::string& key, const std::string& option) {
  CANYON_TRY(const auto figures, choose_figures({key}, option));
  if (figures.front()->timing)
    return Error{.file = option, .what = key + " depends on the machine", .expected = "a figure of the run"};
  return figures.front();
}

}  // namespace

Result<std::optional<Question>> read_question(const std::string& tolerance, std::optional<double> budget_cpu_s,
                                              const std::string& figure) {
  if (tolerance.empty() && !budget_cpu_s) return std::optional<Question>{};
  if (!tolerance.empty() && budget_cpu_s)
    return Error{.file = "--budget-cpu", .what = "stands beside --tolerance", .expected = "one of the two"};
  Question question;
  if (budget_cpu_s) {
    if (!(*budget_cpu_s > 0.0) || !std::isfinite(*budget_cpu_s))
      return Error{.file = "--budget-cpu", .what = std::to_string(*budget_cpu_s), .expected = "a positive number"};
    CANYON_TRY(question.figure, figure_of(figure, "--figure"));
    question.budget_cpu_s = *budget_cpu_s;
    return std::optional(question);
  }
  constexpr const char* kOption = "--tolerance";
  CANYON_TRY(const Tolerances asked, tolerances_of({tolerance}, kOption));
  CANYON_TRY(question.figure, figure_of(asked.begin()->first, kOption));
  question.tolerance = asked.begin()->second;
  return std::optional(question);
}

}  // namespace canyon::study
