#include "canyon/core/math/median.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace canyon {

double median(std::vector<double> values) {
  // Where one is no number there is no order either.
  const bool unordered = std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); });
  if (values.empty() || unordered) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : std::midpoint(values[half - 1], values[half]);
}

}  // namespace canyon
