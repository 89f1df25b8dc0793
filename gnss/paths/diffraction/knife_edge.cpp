#include "canyon/gnss/paths/diffraction/knife_edge.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

using Complex = std::complex<double>;

/// Power series: (j pi / 2)^n x^(2 n + 1) / (n! (2 n + 1)). From n = pi x^2 / 2 on terms fall, real and imaginary ones
/// by turns: two that change nothing are the end.
Complex series(double x) {
  const Complex step(0.0, 0.5 * kPi * x * x);
  Complex power = x, sum = 0.0;
  int idle = 0;
  for (int n = 0; n < 60 && idle < 2; ++n) {
    const Complex before = sum;
    sum += power / (2.0 * n + 1.0);
    idle = n > 6 && sum == before ? idle + 1 : 0;
    power *= step / (n + 1.0);
  }
  return sum;
}

/// C + jS = (1 + j) / 2 erf(z), z = sqrt(pi) / 2 (1 - j) x; erfc by its continued fraction from the far end. What n
/// levels leave out falls as exp(-2 Re(z) sqrt(2 n)): with these it is below 1e-24, so that no bit hangs on their
/// number.
Complex continued_fraction(double x) {
  const Complex z = 0.5 * std::sqrt(kPi) * Complex(1.0, -1.0) * x;
  Complex tail = z;
  for (int n = std::min(120, 12 + static_cast<int>(600.0 / (x * x))); n >= 1; --n) tail = z + 0.5 * n / tail;
  const Complex erfc = std::exp(-z * z) / (std::sqrt(kPi) * tail);
  return 0.5 * Complex(1.0, 1.0) * (1.0 - erfc);
}

/// From 1e3 on two terms of the asymptotic series are exact to 1e-16. The phase pi x^2 / 2 counts modulo 4 in x^2,
/// whose own rounding would be whole turns: its two halves are reduced apart. From 1e10 on nothing is left of the
/// ripples.
Complex far_out(double x) {
  if (x > 1e10) return {0.5, 0.5};
  const double square = x * x, rest = std::fma(x, x, -square);
  const Complex wave = std::polar(1.0, 0.5 * kPi * (std::fmod(square, 4.0) + rest));
  return Complex(0.5, 0.5) - wave * Complex(1.0 / (kPi * kPi * x * x * x), 1.0 / (kPi * x));
}

}  // namespace

Complex fresnel_integral(double x) {
  const double size = std::abs(x);
  const Complex value = size < 2.0 ? series(size) : size < 1e3 ? continued_fraction(size) : far_out(size);
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
