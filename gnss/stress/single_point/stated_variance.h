#pragma once

#include <cmath>
#include <string>

#include "canyon/core/units.h"
#include "canyon/gnss/solver/weighting.h"

/// What a range is trusted with, written out: by the cases of weights, and by those of whole recordings.
namespace canyon::gnss {

inline double squared(double x) {
  return x * x;
}

/// The variance that weighting.h and the models' sources state, from the sine of the elevation and the noise power over
/// that at 45 dB-Hz.
inline double stated_variance(const std::string& model, const RangeQuality& q, double zenith_m) {
  const double degrees = q.elevation_rad < 5.0 * kPi / 180.0 ? 5.0 : q.elevation_rad * 180.0 / kPi;
  const double s = std::sin(degrees * kPi / 180.0);
  const double cn0 = q.cn0_dbhz == q.cn0_dbhz ? q.cn0_dbhz : 45.0 - 7.0 * (1.0 - s);
  const double noise = std::exp((45.0 - cn0) * std::log(10.0) / 10.0);
  const double code2 = squared(q.code_factor * zenith_m);
  const bool glonass = q.system == GnssSystem::kGlonass;
  if (model == "uniform") return code2;
  if (model == "elevation") return code2 / (s * s);
  if (model == "cn0") return code2 * noise;
  const double tracking = code2 * (1.0 / (s * s) + noise) / 2.0;
  if (model == "elevation_cn0") return tracking;
  if (model == "budget")
    return q.differential ? tracking
                          : tracking + (glonass ? 4.0 : 0.64) + squared(q.ionosphere_m) / 25.0 +
                                squared(1.0 / (20.0 * (s + 0.01)));
  double satellite = 5.0;
  if (q.system == GnssSystem::kGalileo && q.accuracy_m == q.accuracy_m) {
    satellite = q.accuracy_m;
  } else if (!glonass) {
    // Limits of the classes of IS-GPS-200: 2.4, 3.4, 4.85, ... doubled from 24 m on.
    double limits[15] = {2.4, 3.4, 4.85, 6.85, 9.65, 13.65};
    for (int k = 6; k < 15; ++k) limits[k] = 24.0 * (1 << (k - 6));
    satellite = limits[14];
    const double announced = q.accuracy_m == q.accuracy_m ? q.accuracy_m : 0.0;
    for (int k = 14; k >= 0; --k)
      if (announced <= limits[k]) satellite = limits[k];
  }
  const double factor = glonass ? 1.5 : q.system == GnssSystem::kSbas ? 3.0 : 1.0;
  return squared(0.3 * q.code_factor * factor) * (1.0 + 1.0 / s) + 0.09 + squared(q.ionosphere_m / 2.0) +
         squared(0.3 / (s + 0.1)) + satellite * satellite;
}

}  // namespace canyon::gnss
