#pragma once

namespace canyon::scene {

/// Coordinates in W beyond this are no places, m: the ray tracer takes numbers up to 1.8e18 and ends the process at
/// others.
inline constexpr double kFarthest_m = 1e18;

}  // namespace canyon::scene
