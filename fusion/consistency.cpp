#include "canyon/fusion/consistency.h"

#include <cmath>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::fusion {
namespace {

/// Standard normal quantile: bisection on erfc is slow but exact to rounding, and this is no hot path.
double normal_quantile(double upper_tail) {
  double low = -40.0, high = 40.0;
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (low + high);
    (0.5 * std::erfc(mid / std::sqrt(2.0)) > upper_tail ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

}  // namespace

double chi_square_tail(double x, int dof) {
  CANYON_CHECK(dof >= 1 && dof <= 100 && x >= 0.0, "dof = ", dof, ", x = ", x);
  // Q(k/2, x/2) by its finite recurrence, Abramowitz & Stegun 26.4.4 and 26.4.5.
  if (std::isinf(x)) return 0.0;
  const double h = 0.5 * x;
  double tail, term;
  if (dof % 2 == 0) {
    term = std::exp(-h);
    tail = term;
    for (int j = 1; j < dof / 2; ++j) tail += term *= h / j;
  } else {
    tail = std::erfc(std::sqrt(h));
    term = 2.0 * std::sqrt(h / kPi) * std::exp(-h);
    for (int j = 1; j <= (dof - 1) / 2; ++j) {
      tail += term;
      term *= h / (j + 0.5);
    }
  }
  return tail;
}

double normal_two_sided_tail(double sigma) {
  return std::erfc(sigma / std::sqrt(2.0));
}

Band mean_chi_square_band(int dof, std::int64_t count, double false_alarm) {
  CANYON_CHECK(dof >= 1 && count >= 1 && false_alarm > 0.0 && false_alarm < 1.0, "dof = ", dof, ", count = ", count,
               ", false_alarm = ", false_alarm);
  const double n = static_cast<double>(dof) * static_cast<double>(count);
  const double z = normal_quantile(0.5 * false_alarm);
  const auto quantile = [&](double side) {
    const double root = 1.0 - 2.0 / (9.0 * n) + side * z * std::sqrt(2.0 / (9.0 * n));
    return n * root * root * root / static_cast<double>(count);
  };
  return {.low = quantile(-1.0), .high = quantile(1.0)};
}

void ConsistencyMean::add(double normalized, int dof) {
  ++count_;
  sum_ += normalized;
  dof_ += dof;
}

double ConsistencyMean::per_state() const {
  return count_ == 0 ? std::numeric_limits<double>::quiet_NaN() : sum_ / dof_;
}

}  // namespace canyon::fusion
