#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "canyon/core/math/median.h"
#include "canyon/study/reproduce/reproduction.h"

namespace canyon::study {

/// The median of draws, with the least and the most of more than one. Draws that are no number count for nothing.
inline Ours over_draws(std::string form, std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  Ours out{std::move(form), kNaN, {}};
  if (values.empty()) return out;
  if (values.size() > 1) out.range = {*std::ranges::min_element(values), *std::ranges::max_element(values)};
  out.value = median(std::move(values));
  return out;
}

}  // namespace canyon::study
