#include "canyon/study/tradeoff/choosing/question.h"

#include <charconv>
#include <cmath>

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
  const auto sign = tolerance.find('=');
  if (sign == std::string::npos)
    return Error{.file = kOption, .what = "\"" + tolerance + "\"", .expected = "FIGURE=VALUE"};
  CANYON_TRY(question.figure, figure_of(tolerance.substr(0, sign), kOption));
  const std::string value = tolerance.substr(sign + 1);
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), question.tolerance);
  if (error != std::errc{} || end != value.data() + value.size() || !std::isfinite(question.tolerance) ||
      !(question.tolerance > 0.0))
    return Error{.file = kOption, .what = "\"" + value + "\"", .expected = "a positive number after the ="};
  return std::optional(question);
}

}  // namespace canyon::study
