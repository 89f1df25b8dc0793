#include "gnss/paths/fresnel.h"

#include <cmath>

namespace canyon::gnss {

Fresnel fresnel(std::complex<double> permittivity, double incidence_rad) {
  const double c = std::cos(incidence_rad), s = std::sin(incidence_rad);
  const std::complex<double> root = std::sqrt(permittivity - s * s);
  Fresnel r;
  r.te = (c - root) / (c + root);
  r.tm = (permittivity * c - root) / (permittivity * c + root);
  r.co = 0.5 * (r.te + r.tm);
  r.cross = 0.5 * (r.tm - r.te);
  return r;
}

}  // namespace canyon::gnss
