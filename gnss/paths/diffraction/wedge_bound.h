#pragma once

#include "canyon/gnss/paths/diffraction/wedge.h"

namespace canyon::gnss {

/// No more than this of |finite_edge_factor(nu, u1, u2)|, which takes a microsecond, for a twentieth of its time.
/// nu >= 0, u1 <= u2.
///
/// The integrand is h(u) = nu / (u^2 + nu^2) times a turn, and the whole edge gives 2 pi K, K = knife_edge_field(nu),
/// |K| >= 1 / (pi sqrt(2 (nu^2 + 0.3))). So a piece is no more than (u2 - u1) h at its nearest point. Beyond u > 0 by
/// parts, f = h / (pi u), which falls: f(u1) at its beginning, f(u2) at its end, and as much as at the beginning for
/// what is left of it; or, by parts once more, twice f(u1) g, g = (1 / u1^2 + 2 / (u1^2 + nu^2)) / pi, for what is
/// left. A piece about u = 0 is the whole without what lies beyond its two ends. 1e-3 is added for the error of
/// finite_edge_factor.
double largest_finite_edge_factor(double nu, double u1, double u2);

/// No more than this of |WedgeBorders(way).field(face_0, face_n)| where neither |coefficient| is above 1.
///
/// Each of the four terms is cot(x) F(k L a), x = off / (2 n) from its border, |x| <= pi / 2, a = 2 sin^2(off / 2).
/// There |cot(x)| <= 1 / |x|, |off| >= sqrt(2 a), and |F(y)| <= min(1, sqrt(pi y)), so that a term is no more than
/// sqrt(2) n min(1 / sqrt(a), sqrt(pi k L)). 1e-4 of it is added for rounding and the error of the Fresnel integrals.
double largest_wedge_field(const WedgeWay& way);

}  // namespace canyon::gnss
