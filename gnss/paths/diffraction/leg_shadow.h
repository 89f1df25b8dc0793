#pragma once

#include <array>
#include <complex>
#include <limits>

#include <Eigen/Core>

#include "canyon/gnss/paths/counters.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/surfaces/facet.h"

namespace canyon::gnss {

/// One straight leg of a mirrored way, along which a plane wave comes in: from the antenna's image by the mirrors
/// before it the whole way to its end is straight. Places in W, m.
struct MirroredLeg {
  Eigen::Vector3d from_W, towards_W;                          ///< its end on the antenna's side, in the air; unit
  double length_m = std::numeric_limits<double>::infinity();  ///< to the satellite: infinite
  double behind_m = 0.0;  ///< how far behind from_W the image lies: what the legs before it are long
  std::array<const scene::Facet*, 2> mirrors{nullptr, nullptr};  ///< at its ends
  double wavelength_m = 1.0;
};

/// What of the wave's field things beside the leg leave, relative to what came without them: 1 in the clear, 0 in the
/// shadow, less or more by what the edges near the leg make (ScreenEdge): things are screens, as thick as they are.
/// Half at the border of a shadow, and continuous there, corners included; not where one thing hides another's edge,
/// nor where a leg ends beside an edge. Edges in the plane of a mirror are its own (mirrored_share), those behind it
/// are nobody's. Things that move hide sharply. Edges so far off that an endless one there would make no more than
/// twice `least`, or a half if that is less, fade out. Where it can be seen to be no more than `needed` before it is
/// known, nothing.
std::complex<double> leg_share(const MirroredLeg& leg, double least, const scene::SceneAt& scene,
                               GnssCounters& counters, double needed = 0.0);

}  // namespace canyon::gnss
