#include "canyon/study/statistics/sample.h"

#include <algorithm>

#include "canyon/study/statistics/proportions.h"

namespace canyon::study {

Interval median_interval(std::vector<double> values) {
  const int n = static_cast<int>(values.size());
  int rank = 0;  // 1-based, from either end
  while (2 * (rank + 1) <= n && 2 * fair_coin_tail(rank, n) <= 0.05) ++rank;
  if (rank == 0) return {};
  std::sort(values.begin(), values.end());
  return {values[static_cast<std::size_t>(rank - 1)], values[static_cast<std::size_t>(n - rank)]};
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? kNaN : sum / static_cast<double>(values.size());
}

Interval mean_interval(const std::vector<double>& values) {
  const int n = static_cast<int>(values.size());
  if (n < 2) return {};
  const double centre = mean(values);
  double squares = 0.0;
  for (const double v : values) squares += (v - centre) * (v - centre);
  const double reach = student_975(n - 1) * std::sqrt(squares / (n - 1) / n);
  return {centre - reach, centre + reach};
}

double student_975(int degrees) {
  if (degrees == 1) return 12.7062;
  if (degrees == 2) return 4.30265;
  const double z = 1.959963985, n = degrees;
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

}  // namespace canyon::study
