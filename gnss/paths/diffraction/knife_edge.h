#pragma once

#include <complex>

namespace canyon::gnss {

/// Fresnel integrals C(x) + j S(x) = integral from 0 to x of exp(j pi t^2 / 2) dt; |error| < 1e-10.
std::complex<double> fresnel_integral(double x);

/// Field behind a knife edge relative to the free one, ITU-R P.526-15 eq. 30 and 31 (half of the field at nu = 0, about
/// 0.225 / nu deep in the shadow, ripples around 1 on the lit side, nu < 0), time factor exp(+j w t). Its phase is
/// relative to the free way straight through the edge's screen.
std::complex<double> knife_edge_field(double nu);

/// |nu| of a way over an edge that is `detour_m` longer than the straight one: 2 sqrt(detour / wavelength) (P.526-15
/// eq. 28 for small angles).
double knife_edge_nu(double detour_m, double wavelength_m);

/// On the lit side ripples beyond this nu are below 0.7 dB, and left out.
inline constexpr double kDeepestLitNu = 3.0;
/// Beyond this nu a field in the shadow is weaker than `weakest_db` (at most 30: 43 dB), and a lit one undisturbed.
double largest_knife_edge_nu(double weakest_db);
/// A lossy wedge is at most this much stronger than a thin screen, which these reaches are made for.
inline constexpr double kOverScreen_db = 6.0;
/// The detour of that nu: longer ways over an edge are not looked at, m.
double largest_detour_m(double largest_nu, double wavelength_m);

}  // namespace canyon::gnss
