#pragma once

#include <vector>

namespace canyon::inertial {

/// One Gauss-Markov part of flicker noise.
struct FlickerPart {
  double sigma = 0.0;
  double tau_s = 0.0;
};

/// Flicker noise with the Allan floor `bias_instability` (0.664 B; S(f) = B^2 / (2 pi f) two-sided, IEEE Std 952 annex
/// C) between two corners, as a sum of independent Gauss-Markov processes: their corners 1 / (2 pi tau) lie in the
/// middle of equal logarithmic steps of at most a factor 4 between `low_hz` and `high_hz`, all with the same variance.
/// The density is (2 / pi) (atan(high / f) - atan(low / f)) of 1/f, to 0.3 % far from the corners (0.8 % ten times
/// inside them); it is flat below `low_hz` and falls as 1/f^2 above `high_hz`. The whole variance is B^2 / pi ln(high /
/// low). 0 < low_hz < high_hz.
std::vector<FlickerPart> flicker_parts(double bias_instability, double low_hz, double high_hz);

}  // namespace canyon::inertial
