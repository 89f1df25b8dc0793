#include "canyon/gnss/satellites/ephemerides/kepler.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

// Residual of Kepler's equation: each of its terms is rounded once, and E once more, so a few eps of their magnitude.
TEST(Kepler, ResidualIsRoundingForEveryEccentricity) {
  for (const double e : {0.0, 1e-12, 0.01, 0.3, 0.7, 0.9, 0.99, 0.999999, 1.0 - kEps}) {
    for (int k = -400; k <= 400; ++k) {
      const double m = k * kPi / 199.7;
      const double E = eccentric_anomaly(m, e);
      EXPECT_NEAR(E - e * std::sin(E), m, 8 * kEps * (1.0 + std::abs(m))) << "e = " << e << ", M = " << m;
    }
  }
}

// Near the pericentre of a nearly parabolic orbit E^3/6 + (1 - e) E = M up to E^5/120, where naive Newton overshoots.
// So E = cbrt(6 M) (1 - 2 (1 - e)/E^2 + E^2/60 + ...).
TEST(Kepler, TinyMeanAnomalyAtHighEccentricity) {
  const double e = 1.0 - 1e-12;
  for (const double m : {1e-15, 1e-12, 1e-9, 1e-6}) {
    const double E = eccentric_anomaly(m, e);
    // E and e sin E cancel: the equation itself is only defined to eps * E.
    EXPECT_NEAR(E - e * std::sin(E), m, 4 * kEps * E) << m;
    EXPECT_NEAR(E, std::cbrt(6.0 * m), E * (2.1 * (1.0 - e) / (E * E) + E * E / 59.0 + 8 * kEps / (E * E))) << m;
  }
}

TEST(Kepler, OddAndKeepsWholeTurns) {
  for (const double e : {0.1, 0.99}) {
    EXPECT_EQ(eccentric_anomaly(0.0, e), 0.0);
    for (const double m : {0.1, 1.0, 3.0}) {
      EXPECT_EQ(eccentric_anomaly(-m, e), -eccentric_anomaly(m, e));
      EXPECT_NEAR(eccentric_anomaly(m + 20.0 * kPi, e), eccentric_anomaly(m, e) + 20.0 * kPi, 1e3 * kEps * 70.0);
    }
  }
}

TEST(Kepler, RefusesWhatIsNotAnEllipse) {
  EXPECT_THROW(eccentric_anomaly(1.0, 1.0), ProgramError);
  EXPECT_THROW(eccentric_anomaly(1.0, -0.1), ProgramError);
  EXPECT_THROW(eccentric_anomaly(std::nan(""), 0.1), ProgramError);
}

}  // namespace
}  // namespace canyon::gnss
