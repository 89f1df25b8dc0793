#include "canyon/study/results/tolerance.h"

#include <charconv>
#include <cmath>

#include "canyon/study/results/figures.h"

namespace canyon::study {

Result<Tolerances> tolerances_of(const std::vector<std::string>& texts, const std::string& option) {
  Tolerances tolerances;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const std::string figure = text.substr(0, equals);
    if (equals == std::string::npos)
      return Error{.file = option,
                   .what = "\"" + text + "\" has no value",
                   .expected = "FIGURE=VALUE, as position_error_rms_m=0.05"};
    CANYON_TRY_STATUS(choose_figures({figure}, option));
    const std::string value_text = text.substr(equals + 1);
    double value = 0.0;
    const auto end = std::from_chars(value_text.data(), value_text.data() + value_text.size(), value);
    const bool read = end.ec == std::errc() && end.ptr == value_text.data() + value_text.size();
    if (!read || !(value > 0.0) || !std::isfinite(value))
      return Error{.file = option, .key = figure, .what = "\"" + value_text + "\"", .expected = "a number above 0"};
    if (!tolerances.emplace(figure, value).second)
      return Error{.file = option, .key = figure, .what = "stands there twice", .expected = "one value for a figure"};
  }
  return tolerances;
}

}  // namespace canyon::study
