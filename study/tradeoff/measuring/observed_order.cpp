#include "canyon/study/tradeoff/measuring/observed_order.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/messages.h"

namespace canyon::study {

namespace {
constexpr double kMostOrder = 30.0;
}  // namespace

double observed_order(double h1, double h2, double h3, double e12, double e23, double rounding) {
  CANYON_CHECK(h1 > h2 && h2 > h3 && h3 > 0.0, "steps ", h1, " ", h2, " ", h3);
  if (!(e12 > rounding) || !(e23 > rounding)) return kNaN;
  const double r12 = h1 / h2, r23 = h2 / h3, wanted = std::log(e12 / e23);
  // e12 / e23 = r23^p (r12^p - 1) / (r23^p - 1), which grows with p: halved between the least and the most.
  const auto excess = [&](double p) {
    if (p == 0.0) return std::log(std::log(r12) / std::log(r23)) - wanted;  // what it goes to
    return p * std::log(r23) + std::log(std::expm1(p * std::log(r12)) / std::expm1(p * std::log(r23))) - wanted;
  };
  double low = -kMostOrder, high = kMostOrder;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double richardson_error(double h1, double h2, double e12, double order) {
  return order > 0.0 ? e12 / (std::pow(h1 / h2, order) - 1.0) : kNaN;
}

double extrapolated_error(double e12, double e23) {
  const double q = e23 / e12;
  return q >= 0.0 && q < 1.0 ? e23 * q / (1.0 - q) : kNaN;
}

}  // namespace canyon::study
