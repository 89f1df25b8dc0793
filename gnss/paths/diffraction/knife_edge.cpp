#include "canyon/gnss/paths/diffraction/knife_edge.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

using Complex = std::complex<double>;

/// Power series: (j pi / 2)^n x^(2 n + 1) / (n! (2 n + 1)).
Complex series(double x) {
  const Complex step(0.0, 0.5 * kPi * x * x);
  Complex power = x, sum = 0.0;
  for (int n = 0; n < 60; ++n) {
    sum += power / (2.0 * n + 1.0);
    power *= step / (n + 1.0);
  }
  return sum;
}

/// C + jS = (1 + j) / 2 erf(z), z = sqrt(pi) / 2 (1 - j) x; erfc by its continued fraction from the far end.
Complex continued_fraction(double x) {
  const Complex z = 0.5 * std::sqrt(kPi) * Complex(1.0, -1.0) * x;
  Complex tail = z;
  for (int n = 120; n >= 1; --n) tail = z + 0.5 * n / tail;
  const Complex erfc = std::exp(-z * z) / (std::sqrt(kPi) * tail);
  return 0.5 * Complex(1.0, 1.0) * (1.0 - erfc);
}

}  // namespace

Complex fresnel_integral(double x) {
  const double size = std::abs(x);
  const Complex value = size < 2.0 ? series(size) : continued_fraction(size);
  return x < 0.0 ? -value : value;
}

Complex knife_edge_field(double nu) {
  return 0.5 * Complex(1.0, 1.0) * std::conj(Complex(0.5, 0.5) - fresnel_integral(nu));
}

double largest_knife_edge_nu(double weakest_db) {
  // Deep in the shadow the field falls as 0.225 / nu.
  const double weakest = std::pow(10.0, weakest_db / 20.0);
  double nu = 0.0;
  while (std::abs(knife_edge_field(nu)) > weakest && nu < 30.0) nu += 0.01;
  return std::max(nu, kDeepestLitNu);
}

double largest_detour_m(double largest_nu, double wavelength_m) {
  return 0.25 * largest_nu * largest_nu * wavelength_m;
}

double knife_edge_nu(double detour_m, double wavelength_m) {
  return 2.0 * std::sqrt(detour_m / wavelength_m);
}

}  // namespace canyon::gnss
