#include "canyon/gnss/paths/scatter/directive_lobe.h"

#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {

double DirectiveLobe::integral_sr(double cos_incidence) const {
  const double sine2 = 1.0 - cos_incidence * cos_incidence;
  double sum = 0.0, choose = 1.0;
  for (int j = 0; j <= exponent; ++j) {
    double part = 2.0 * kPi / (j + 1);
    if (j % 2 == 1) {
      double series = 0.0, term = 1.0;  // C(2 w, w) (sine / 2)^(2 w)
      for (int w = 0; w <= (j - 1) / 2; ++w) {
        series += term;
        term *= (2.0 * w + 1.0) / (2.0 * w + 2.0) * sine2;
      }
      part *= cos_incidence * series;
    }
    sum += choose * part;
    choose *= static_cast<double>(exponent - j) / (j + 1);
  }
  return sum / std::pow(2.0, exponent);
}

double DirectiveLobe::at(double cos_psi) const {
  const double base = 0.5 * (1.0 + cos_psi);
  double value = 1.0;
  for (int i = 0; i < exponent; ++i) value *= base;
  return value;
}

}  // namespace canyon::gnss
