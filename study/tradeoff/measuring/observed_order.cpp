#include "canyon/study/tradeoff/measuring/observed_order.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/messages.h"

namespace canyon::study {

double observed_order(double h1, double h2, double h3, double e12, double e23, double rounding) {
  CANYON_CHECK(h1 > h2 && h2 > h3 && h3 > 0.0, "steps ", h1, " ", h2, " ", h3);
  if (!(e12 > rounding) || !(e23 > rounding)) return kNaN;
  const double r12 = h1 / h2, r23 = h2 / h3;
  // e12 / e23 = r23^p (r12^p - 1) / (r23^p - 1).
  double p = std::log(e12 / e23) / std::log(r23);
  for (int i = 0; i < 200; ++i) {
    const double q = std::log((std::pow(r12, p) - 1.0) / (std::pow(r23, p) - 1.0));
    const double next = (std::log(e12 / e23) - q) / std::log(r23);
    if (!std::isfinite(next)) return kNaN;
    if (std::abs(next - p) < 1e-12) return next;
    p = next;
  }
  return p;
}

double richardson_error(double h1, double h2, double e12, double order) {
  return order > 0.0 ? e12 / (std::pow(h1 / h2, order) - 1.0) : kNaN;
}

double extrapolated_error(double e12, double e23) {
  const double q = e23 / e12;
  return q >= 0.0 && q < 1.0 ? e23 * q / (1.0 - q) : kNaN;
}

}  // namespace canyon::study
