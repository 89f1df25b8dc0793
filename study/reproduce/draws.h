#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/math/median.h"
#include "canyon/study/reproduce/reproduction.h"
#include "canyon/study/statistics/sample.h"

namespace canyon::study {

/// The median of draws, with the least and the most of more than one. Draws that are no number count for nothing.
inline Ours over_draws(std::string form, std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  Ours out{std::move(form), kNaN, {}, static_cast<std::int64_t>(values.size())};
  if (values.empty()) return out;
  if (values.size() > 1) out.range = {*std::ranges::min_element(values), *std::ranges::max_element(values)};
  out.value = median(std::move(values));
  return out;
}

/// One form's figure over seeds.
struct OverSeedsOf {
  std::string form;
  std::vector<double> values;  ///< one per seed; NaN: the figure has none there
};

/// A row of figures over the same seeds: of each form the median with its 95 % interval (median_interval: none for
/// fewer than six), then the last form less the first, seed by seed: the mean with Student's.
inline PaperRow over_seeds_row(std::string what, std::string unit, std::vector<OverSeedsOf> forms) {
  PaperRow row{.what = std::move(what), .unit = std::move(unit), .ours = {}};
  std::vector<double> differences;
  for (std::size_t seed = 0; seed < forms.front().values.size(); ++seed)
    differences.push_back(forms.back().values[seed] - forms.front().values[seed]);
  std::erase_if(differences, [](double v) { return !std::isfinite(v); });
  Ours difference{forms.back().form + " less " + forms.front().form, mean(differences), mean_interval(differences),
                  static_cast<std::int64_t>(differences.size())};
  for (OverSeedsOf& one : forms) {
    std::erase_if(one.values, [](double v) { return !std::isfinite(v); });
    const auto n = static_cast<std::int64_t>(one.values.size());
    const Interval interval = median_interval(one.values);
    row.ours.push_back({std::move(one.form), n == 0 ? kNaN : median(std::move(one.values)), interval, n});
  }
  row.ours.push_back(std::move(difference));
  return row;
}

}  // namespace canyon::study
