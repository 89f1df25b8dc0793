#pragma once

namespace canyon::gnss {

/// Lobe of an effective roughness: power per solid angle goes as ((1 + cos psi) / 2)^exponent, psi from the mirror's
/// direction, over the hemisphere before the wall (Degli-Esposti et al. 2007, eq. 9).
struct DirectiveLobe {
  int exponent = 4;  ///< 1 to 20; the larger, the narrower

  /// Its integral over the hemisphere, sr (ibid., eq. 10 to 12): what makes it a share. Cosine of incidence in [0, 1].
  double integral_sr(double cos_incidence) const;
  double at(double cos_psi) const;
};

}  // namespace canyon::gnss
