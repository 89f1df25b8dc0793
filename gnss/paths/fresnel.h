#pragma once

#include <complex>

namespace canyon::gnss {

/// Reflection coefficients (field) of a smooth half-space seen from air.
struct Fresnel {
  std::complex<double> te;     ///< E perpendicular to the plane of incidence
  std::complex<double> tm;     ///< E in the plane of incidence; +TE at grazing, -TE at normal incidence
  std::complex<double> co;     ///< circular, same sense (RHCP stays RHCP): (TE + TM) / 2
  std::complex<double> cross;  ///< circular, sense reversed (RHCP becomes LHCP): (TM - TE) / 2
};

/// `permittivity`: complex relative, eps_r - j 17.98 sigma / f_GHz (time factor e^{+j w t}, imaginary part <= 0);
/// incidence from the normal, [0, pi/2].
Fresnel fresnel(std::complex<double> permittivity, double incidence_rad);

}  // namespace canyon::gnss
