#include "canyon/core/math/chi_square.h"

#include <cmath>

#include "canyon/core/check.h"

namespace canyon {
namespace {

/// Both expansions need a few times the standard deviation of the distribution.
int most_terms(double a) {
  return 2000 + static_cast<int>(20.0 * std::sqrt(a));
}

/// Lower regularised incomplete gamma P(a, x) by its series; converges quickly for x < a + 1.
double lower_series(double a, double x) {
  double term = 1.0 / a, sum = term;
  for (int n = 1; n < most_terms(a); ++n) {
    term *= x / (a + n);
    sum += term;
    if (term < 1e-17 * sum) break;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// Upper regularised incomplete gamma Q(a, x) by its continued fraction (modified Lentz); for x >= a + 1.
double upper_fraction(double a, double x) {
  constexpr double kTiny = 1e-300;
  double b = x + 1.0 - a, c = 1.0 / kTiny, d = 1.0 / b, f = d;
  for (int n = 1; n < most_terms(a); ++n) {
    const double an = -n * (n - a);
    b += 2.0;
    d = an * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1.0 / d;
    const double step = c * d;
    f *= step;
    if (std::abs(step - 1.0) < 1e-16) break;
  }
  return f * std::exp(a * std::log(x) - x - std::lgamma(a));
}

}  // namespace

double chi_square_tail(double x, double dof) {
  CANYON_CHECK(dof >= 0.5 && !std::isnan(x), "dof = ", dof, ", x = ", x);
  if (x <= 0.0) return 1.0;
  const double a = 0.5 * dof, half = 0.5 * x;
  return half < a + 1.0 ? 1.0 - lower_series(a, half) : upper_fraction(a, half);
}

double chi_square_threshold(double probability, double dof) {
  CANYON_CHECK(probability > 0.0 && probability < 1.0, "probability = ", probability);
  double low = 0.0, high = dof + 10.0;
  while (chi_square_tail(high, dof) > probability) high *= 2.0;
  // Bisection to the last bit: the tail falls monotonically, and nothing here is in a hurry.
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (chi_square_tail(middle, dof) > probability ? low : high) = middle;
  }
  return high;
}

}  // namespace canyon
