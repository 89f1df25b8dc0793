#pragma once

#include <complex>

namespace canyon::gnss {

/// The transition function of Kouyoumjian & Pathak (Proc. IEEE 62 (1974) 1448, eq. 19), x >= 0: 0 at 0, 1 far from a
/// border.
std::complex<double> wedge_transition(double x);

/// Where a wave meets a straight wedge of faces 0 and n, and how its field is made.
struct WedgeWay {
  double n = 2.0;            ///< exterior angle / pi, (1, 2]; 2 = half-plane
  double phi_in_rad = 0.0;   ///< of where the wave comes from, about the edge from face 0, [0, n pi]
  double phi_out_rad = 0.0;  ///< of where it goes to, likewise
  double sine_beta = 1.0;    ///< of the angle between the ray and the edge, (0, 1]
  double distance_m = 1.0;   ///< from the edge to where it goes, > 0
  double wavelength_m = 1.0;
};

/// The field that a plane wave makes behind the edge of an endless wedge, relative to that wave at the edge, without
/// the phase of the way from there (time factor exp(+j w t)): uniform theory of diffraction, K&P eq. 25 and 26 with L =
/// s sin^2 beta, over sqrt(s); the terms of the two reflections weighed by the faces' coefficients (Luebbers, IEEE
/// Trans. Antennas Propag. 32 (1984) 70). Added to the geometric field it makes it continuous over the borders of the
/// shadow and of both reflections; it is exact for a half-plane. At a border itself the limit from where
/// cos((phi_in - phi_out) / 2), or the sum's, is positive.
class WedgeBorders {
 public:
  /// What both polarizations share, and takes the time.
  explicit WedgeBorders(const WedgeWay& way);
  /// With the reflection coefficients of the faces, for one polarization; a conductor has -1 where the field is
  /// parallel to the edge ("soft") and +1 where it is across ("hard").
  std::complex<double> field(const std::complex<double>& face_0, const std::complex<double>& face_n) const;

 private:
  std::complex<double> shadow_, mirror_0_, mirror_n_, scale_;
  double root_distance_;
};

/// Share of the field of an endless edge that the part of it from u1 to u2 makes: the line integral over the edge to
/// which the surface integral of Kirchhoff reduces (Maggi 1888, Rubinowicz 1917), in Fresnel's approximation,
///
///   integral of exp(-j pi (u^2 + nu^2) / 2) nu / (u^2 + nu^2) du, over the same from -inf to inf,
///
/// u = distance along the edge from the point of the law of diffraction, times sin(beta) sqrt(2 / (wavelength s)), nu
/// >= 0 of the detour (knife_edge_nu). At the shadow's border, nu = 0, it is 1 where the edge holds that point and 0
/// where not, so that shadows of finite walls are continuous, corners included. u1 <= u2; within 1e-3.
std::complex<double> finite_edge_factor(double nu, double u1, double u2);
/// What such a piece makes behind a thin screen, knife_edge_field(nu) of the endless edge times that factor, within
/// 1e-3, for a fifth of the time.
std::complex<double> finite_edge_field(double nu, double u1, double u2);

}  // namespace canyon::gnss
