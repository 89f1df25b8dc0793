#include "canyon/gnss/paths/diffraction/fresnel.h"

#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {

namespace {

Fresnel circular(std::complex<double> te, std::complex<double> tm) {
  return {te, tm, 0.5 * (te + tm), 0.5 * (tm - te)};
}

}  // namespace

Fresnel fresnel(std::complex<double> permittivity, double incidence_rad) {
  // Where nothing changes nothing reflects; at grazing incidence the difference below would be all rounding.
  if (permittivity == 1.0) return circular(0.0, 0.0);
  const double c = std::cos(incidence_rad), s = std::sin(incidence_rad);
  const std::complex<double> root = std::sqrt(permittivity - s * s);
  return circular((c - root) / (c + root), (permittivity * c - root) / (permittivity * c + root));
}

Fresnel fresnel_slab(std::complex<double> permittivity, double thickness_m, double wavelength_m, double incidence_rad) {
  const Fresnel face = fresnel(permittivity, incidence_rad);
  const double s = std::sin(incidence_rad);
  const std::complex<double> q = 2.0 * kPi * thickness_m / wavelength_m * std::sqrt(permittivity - s * s);
  // There and back through the slab; of a conductor nothing is left.
  const std::complex<double> back = std::exp(std::complex<double>(0.0, -2.0) * q);
  const auto whole = [&](std::complex<double> r) { return r * (1.0 - back) / (1.0 - r * r * back); };
  return circular(whole(face.te), whole(face.tm));
}

}  // namespace canyon::gnss
