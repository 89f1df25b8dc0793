#pragma once

#include <vector>

#include "canyon/fusion/strapdown.h"

namespace canyon::study {

/// Two motions in closed form, without noise. Calm: an eight of 100 m by 60 m in 30 s with waves of height and roll, as
/// a car drives. Lively: the same with the IMU swinging at 2 Hz by up to 30 degrees and 20 m/s^2, on which the error of
/// a scheme of fourth order stands clear of rounding, which is 1e-8 m in coordinates of 6e6 m; there schemes of lower
/// order show more of what coning and sculling leave than of their order. Increments are exact to 1e-12 rad and m/s
/// (inertial::motion_increments).
enum class SmoothMotion { kCalm, kLively };
struct SmoothDrive {
  std::vector<fusion::Increments> increments;  ///< the first two lie before the start
  std::vector<fusion::NavState> truth;         ///< at the start, and at the end of each whole second
  std::size_t per_second = 0;
};
/// Made once per rate and kept; whole rates only.
const SmoothDrive& smooth_drive(SmoothMotion motion, int rate_hz);

/// Free inertial navigation from the truth with one row of a table of integrators; the states at whole seconds.
std::vector<fusion::NavState> integrate(const fusion::StrapdownRow& row, const SmoothDrive& drive);

}  // namespace canyon::study
