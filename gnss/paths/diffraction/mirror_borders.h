#pragma once

#include <complex>

#include <Eigen/Core>

#include "canyon/scene/surfaces/facet.h"

namespace canyon::gnss {

/// A plane wave from `towards_W` (unit) as an endless mirror in the facet's plane would send it to an antenna whose
/// image is `image_W`, behind the plane; it meets the plane at `at_W`. Places in W, m.
struct MirroredWave {
  Eigen::Vector3d image_W, towards_W, at_W;
  double wavelength_m = 1.0;
};

/// What the facet mirrors of that wave, relative to what the endless mirror would: Kirchhoff's integral over the facet
/// in Fresnel's approximation, as 1 if the facet holds `at_W` and 0 if not, less what each side of it makes (Maggi and
/// Rubinowicz: finite_edge_factor, of a thin screen's edge, knife_edge_field). Half at a side, a quarter at a right
/// corner, area x cos(incidence) / (wavelength x distance) of a small facet; continuous. Time factor exp(+j w t), phase
/// of the mirrored way. Within 5e-3 for each side, but for sides so far off that an endless edge there would make no
/// more than twice `least`, or a half if that is less: they fade out.
std::complex<double> mirrored_share(const scene::Facet& facet, bool holds, const MirroredWave& wave,
                                    double least = 0.0);
/// |mirrored_share| is no more than this, which is known in a fraction of its time.
double most_mirrored(const scene::Facet& facet, bool holds, const MirroredWave& wave, double least = 0.0);
/// Nor is it more than this: 1.8 of a rectangle, 2 of a disc; zone plates are not built.
inline constexpr double kMostMirrored = 2.0;

/// What a border or an edge changes of an echo by less is not worth following: a twentieth, -26 dB.
inline constexpr double kFaintestBorder = 0.05;
/// Beyond this nu of a side (knife_edge_nu) what it makes is below `weakest_db` of an endless mirror's, or too faint.
double largest_border_nu(double weakest_db);

/// The point of the facet's border that is nearest to a point of its plane; that point if there is no border.
Eigen::Vector3d nearest_of_border(const scene::Facet& facet, const Eigen::Vector3d& at_W);

}  // namespace canyon::gnss
