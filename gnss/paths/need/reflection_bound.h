#pragma once

#include <array>

#include "canyon/scene/surfaces/material.h"

namespace canyon::gnss {

/// How much of a field a surface mirrors at most, of any polarization, at any carrier that is received (1.15 to 1.62
/// GHz) and at any incidence whose cosine is at least so large:
/// - of a wave of circular components (right, left) a bounce makes [co cross; cross co] of them, whose singular values
///   are |TE| and |TM|, and |TM| <= |TE| off whatever is no magnet: so no more than |TE| is left of it;
/// - |TE| off a half-space grows with the incidence, and with |permittivity|, which falls with the carrier;
/// - off a slab it is r (1 - b) / (1 - r^2 b) with b what comes back from its far face, at most r (1 + |b|) / (1 - r^2
///   |b|): |b| is largest at normal incidence, where the way through is shortest;
/// - roughness takes least at the largest incidence and the longest wave.
class ReflectionBound {
 public:
  /// Of that material, with a further roughness as PathParameters has it.
  ReflectionBound(const scene::Material& material, double further_roughness_m);

  /// In [0, 1]. A cosine below 0 counts as 0.
  double from(double least_cosine) const;

 private:
  static constexpr int kSteps = 256;  // of the cosine: rounded down
  std::array<double, kSteps + 1> at_{};
};

}  // namespace canyon::gnss
