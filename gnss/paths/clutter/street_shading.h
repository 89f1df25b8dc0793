#pragma once

#include <Eigen/Core>

#include "canyon/core/time.h"
#include "canyon/gnss/paths/clutter/lattice_noise.h"
#include "canyon/gnss/paths/clutter/two_state_law.h"

namespace canyon::gnss {

/// How far apart shades are alike.
struct ShadingScale {
  double state_m = 14.0, spread_m = 2.0;         ///< cells of the ground: of the state, and of the level about it
  double state_rad = 0.4, spread_rad = 0.15;     ///< the same of directions
  double moving_share = 0.2, coherence_s = 2.0;  ///< of the state's variance, by what moves; its cells of time
};

/// What clutter leaves of a signal that comes from a direction to a place of the street. A standard normal field over
/// place and direction gives the mean level M_A by its quantile (two_state_law.h), another the level about that mean:
/// so their distribution over streets is the law's, and nothing jumps. The state's field is
///
///   sqrt(1 - m) static + sqrt(m) moving,
///
/// static by place, direction and the number of the street alone (stream "gnss.clutter.shade"), moving by direction and
/// time, seeded
/// ("gnss.clutter.passing").
class StreetShading {
 public:
  StreetShading(const TwoStateLaw& law, const ShadingScale& scale, std::uint64_t street, std::uint64_t seed)
      : law_(law), scale_(scale), static_(street, "gnss.clutter.shade"), moving_(seed, "gnss.clutter.passing") {}

  /// Level, dB against what comes to a place without clutter; `from_W` unit. What comes up from the ground is shaded
  /// as what the ground gets from the same side.
  double level_db(const Eigen::Vector3d& p_W, const Eigen::Vector3d& from_W, GpsTime t) const;

 private:
  TwoStateLaw law_;
  ShadingScale scale_;
  LatticeNoise static_, moving_;
};

}  // namespace canyon::gnss
