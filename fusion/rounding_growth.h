#pragma once

#include <optional>
#include <span>

#include "canyon/fusion/dead_reckoning.h"

namespace canyon::fusion {

/// How large an error of free inertial navigation may be that comes from rounding alone, followed step by step.
///
/// Inertial height is unstable: gravity falls with it, so that an error h of height accelerates by k^2 h away from the
/// truth, k^2 = 2 G M / r^3, which is Schuler's frequency times sqrt(2), and grows as e^(k t), 1 / k = 570 s near the
/// ground (Britting 1971, Inertial Navigation Systems Analysis, 4.4). Whatever a step rounds grows with it: by 1e65 in
/// a day. What is followed here is meant to lie above it, not close to it:
/// - attitude: one epsilon each step, all the same way (a body at rest repeats its roundings), which tilts the force:
///   a horizontal error of r times the tilt, and under a drift d a velocity of Schuler's oscillation, up to 2 r d;
/// - position: half a unit in the last place each step, the same way within a second and at random beyond, three
/// sigmas;
/// - height: what that horizontal velocity makes by Coriolis, and the tilt by acceleration, beside the roundings of
///   position and the resolution of the start, all grown by k where the state is;
/// - velocity: k times height and the horizontal velocity.
/// Attitude itself does not depend on position; its rounding stays below 1e-6 degrees for a day.
class RoundingGrowth {
 public:
  explicit RoundingGrowth(const NavState& initial) : last_(initial) {}

  /// To the next state of the integration, in order of time.
  void advance(const NavState& next);
  double position_m() const;
  double velocity_m_s() const;

 private:
  NavState last_;
  double elapsed_s_ = 0.0, tilt_rad_ = 0.0, drift_rad_s_ = 0.0, horizontal_m_s_ = 0.0;
  double walk_m2_ = 0.0;           ///< variance of the position's roundings, not grown
  double height_m_ = 2e-7;         ///< grows as e^(k t); at first what a text file's last digits leave of the start
  double height_variance_m2_ = 0;  ///< of the position's roundings in it
  double k_per_s_ = 0.0;
};

/// Below this no reference tells an error, and rounding is not minded: satellite positioning with carrier phases.
inline constexpr double kReferenceTells_m = 0.01;

/// What is left of a comparison once rounding is minded.
struct HeldErrors {
  std::size_t count = 0;         ///< of the errors, from the first on, that hold
  std::optional<GpsTime> until;  ///< the last instant that holds; empty if all do
  double rounding_m = 0.0;       ///< what rounding may have grown to at the last error; without errors, state
};
/// An error of position or velocity holds until what rounding may have grown to exceeds the largest position error so
/// far and kReferenceTells_m. `states`: of the integration, from its start on; `errors`: of them, both in order of
/// time.
HeldErrors held_errors(std::span<const NavState> states, std::span<const NavError> errors);

}  // namespace canyon::fusion
