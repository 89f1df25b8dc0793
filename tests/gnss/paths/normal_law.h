#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// What is asked of drawn numbers.
namespace canyon::gnss::testing {

/// Share of a standard normal number below z.
inline double below(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

/// Share of values below x, and how far it may be off: 4 sigma of n independent ones (6e-5 a comparison).
inline double share_below(const std::vector<double>& values, double x) {
  return static_cast<double>(std::count_if(values.begin(), values.end(), [&](double v) { return v < x; })) /
         static_cast<double>(values.size());
}
inline double four_sigma(double p, std::size_t n) {
  return 4.0 * std::sqrt(p * (1.0 - p) / static_cast<double>(n));
}

}  // namespace canyon::gnss::testing
