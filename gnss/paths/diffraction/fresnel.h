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
/// The same of a slab of that thickness in air, all reflections between its faces added up (ITU-R P.2040-3 eq. 43 to
/// 45); phases relative to the front face. An endless thickness gives the half-space.
Fresnel fresnel_slab(std::complex<double> permittivity, double thickness_m, double wavelength_m, double incidence_rad);

}  // namespace canyon::gnss
