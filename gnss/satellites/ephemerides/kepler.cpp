#include "canyon/gnss/satellites/ephemerides/kepler.h"

#include <cmath>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::gnss {

double eccentric_anomaly(double mean_anomaly_rad, double eccentricity) {
  CANYON_CHECK(std::isfinite(mean_anomaly_rad), "mean anomaly = ", mean_anomaly_rad);
  CANYON_CHECK(eccentricity >= 0.0 && eccentricity < 1.0, "eccentricity = ", eccentricity);
  const double m = std::remainder(mean_anomaly_rad, 2.0 * kPi);  // in [-pi, pi], exact
  const double a = std::abs(m);
  if (a == 0.0) return mean_anomaly_rad;

  // For M in [0, pi] the root lies in [M, min(M + e, pi)], where the function is increasing and convex.
  double low = a;
  double high = std::fmin(a + eccentricity, kPi);
  double E = std::fmin(a + 0.85 * eccentricity, high);  // Danby (1987)
  constexpr int kMaxIterations = 100;                   // bisection alone would need 53
  for (int i = 0; i < kMaxIterations; ++i) {
    const double f = E - eccentricity * std::sin(E) - a;
    if (f == 0.0) break;
    (f > 0.0 ? high : low) = E;
    double next = E - f / (1.0 - eccentricity * std::cos(E));
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double step = std::abs(next - E);
    E = next;
    if (step <= std::numeric_limits<double>::epsilon() * E) break;
  }
  return mean_anomaly_rad + std::copysign(E - a, m);
}

}  // namespace canyon::gnss
