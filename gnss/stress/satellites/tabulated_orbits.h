#pragma once

#include <vector>

#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/satellites/constellation.h"

namespace canyon::gnss {

/// Of all systems every 5 minutes, with clocks that run evenly.
inline PreciseOrbits tabulated(const Constellation& sky, GpsTime start, int count) {
  PreciseOrbits out;
  out.interval_s = 300.0;
  for (const SatelliteId sv : sky.satellites())
    for (int k = 0; k < count; ++k) {
      PreciseSample sample;
      sample.t = start + 300.0 * k;
      sample.p_E = sky.state(sv, sample.t)->p_E;
      sample.clock_s = 1e-5 * sv.prn + 1e-10 * sv.prn * 300.0 * k;
      out.satellites[sv].push_back(sample);
    }
  return out;
}

}  // namespace canyon::gnss
