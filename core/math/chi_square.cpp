#include "canyon/core/math/chi_square.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

/// Both expansions need a few times the standard deviation of the distribution.
int most_terms(double a) {
  return 2000 + static_cast<int>(20.0 * std::sqrt(a));
}

/// m - ln(1 + m) for |m| < 1/2, by the series of ln(1 + m) in r = m / (2 + m), whose first term cancels.
double above_logarithm(double m) {
  const double r = m / (2.0 + m), z = r * r;
  double tail = 0.0;
  for (int k = 27; k >= 3; k -= 2) tail = (tail + 1.0 / k) * z;
  return r * m - 2.0 * r * tail;
}

/// x^a e^-x / Gamma(a). For large a the logarithms of the factors are large and cancel, 1e-9 of the product at a = 1e6;
/// with x = a (1 + m) and Stirling's series they are not formed (Temme 1979).
double gamma_density(double a, double x) {
  if (a < 16.0) return std::exp(a * std::log(x) - x - std::lgamma(a));
  const double m = (x - a) / a, i = 1.0 / a, i2 = i * i;
  const double off = std::abs(m) < 0.5 ? above_logarithm(m) : m - std::log1p(m);
  // The next term is below 2e-16 of the whole.
  const double stirling = i * (1.0 / 12 - i2 * (1.0 / 360 - i2 * (1.0 / 1260 - i2 * (1.0 / 1680 - i2 / 1188))));
  return std::sqrt(a / (2.0 * kPi)) * std::exp(-a * off - stirling);
}

/// Lower regularised incomplete gamma P(a, x) by its series; converges quickly for x < a + 1.
double lower_series(double a, double x) {
  double term = 1.0 / a, sum = term;
  for (int n = 1; n < most_terms(a); ++n) {
    term *= x / (a + n);
    sum += term;
    if (term < 1e-17 * sum) break;
  }
  return sum * gamma_density(a, x);
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
  return f * gamma_density(a, x);
}

}  // namespace

double chi_square_tail(double x, double dof) {
  CANYON_CHECK(dof >= 0.5 && !std::isnan(x), "dof = ", dof, ", x = ", x);
  if (x <= 0.0) return 1.0;
  if (std::isinf(x)) return 0.0;
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
