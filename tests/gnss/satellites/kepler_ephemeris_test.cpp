#include "canyon/gnss/satellites/ephemerides/kepler_ephemeris.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/tests/gnss/rinex/nav_text.h"

namespace canyon::gnss {
namespace {

using testing::broadcast_of;
using testing::sample_ephemeris;

const GpsTime kKeplerToe = GpsTime::from_week_sow(1590, 345600.0);

Eigen::Vector3d inertial_velocity(const SatelliteState& s) {
  return s.v_E + kGpsEarthRate * Eigen::Vector3d::UnitZ().cross(s.p_E);
}

/// Periodic relativity of the satellite clock, -2 r.v / c^2: precise clocks leave it to the user.
double relativity_s(const SatelliteState& s) {
  return -2.0 * s.p_E.dot(inertial_velocity(s)) / (kSpeedOfLight * kSpeedOfLight);
}

// Central differences over 1 s miss 1/24 of the third derivative: at most 4 GM v / r^3 on a Kepler orbit, plus the
// turning of the frame; for the eccentric anomaly 3 (n / (1 - e))^3. Beside it 1 ns of time resolution, and rounding.
TEST(KeplerEphemeris, VelocityAndClockRateAreDerivatives) {
  for (int prn : {1, 5, 30}) {
    KeplerEphemeris r = sample_ephemeris(prn, kKeplerToe);
    const double a_m = r.sqrt_a * r.sqrt_a, n = std::sqrt(kGpsMu / (a_m * a_m * a_m));
    for (const double e : {r.e, 0.3, 0.99}) {
      r.e = e;
      for (const double dt_s : {-7200.0, -100.0, 0.0, 3601.0}) {
        const GpsTime t = kKeplerToe + dt_s;
        const SatelliteState before = r.at(t - 0.5), after = r.at(t + 0.5), now = r.at(t);
        const double v = inertial_velocity(now).norm(), radius_m = now.p_E.norm();
        const double w = kGpsEarthRate, gravity = kGpsMu / (radius_m * radius_m);
        const double jerk = 4.0 * gravity * v / radius_m + w * w * w * radius_m + 3.0 * w * w * v + 3.0 * w * gravity;
        EXPECT_LT((after.p_E - before.p_E - now.v_E).norm(), jerk / 24.0 + 1e-9 * v + 1e-7) << e << " " << dt_s;
        const double clock_jerk = -kGpsRelativity * e * r.sqrt_a * 3.0 * std::pow(n / (1.0 - e), 3);
        EXPECT_NEAR(after.clock_s - before.clock_s, now.clock_rate, clock_jerk / 24.0 + 1e-18);
      }
    }
  }
}

// Without perturbations the orbit is an ellipse: radius from the conic equation, energy conserved in inertial space.
TEST(KeplerEphemeris, UnperturbedOrbitIsKeplerian) {
  KeplerEphemeris r = sample_ephemeris(3, kKeplerToe);
  r.cuc_rad = r.cus_rad = r.crc_m = r.crs_m = r.cic_rad = r.cis_rad = r.idot_rad_s = r.omega_dot_rad_s =
      r.delta_n_rad_s = 0.0;
  for (const double e : {0.0, 0.02, 0.7, 0.99}) {
    r.e = e;
    const double a_m = r.sqrt_a * r.sqrt_a;
    for (double dt_s = -20000.0; dt_s <= 20000.0; dt_s += 1234.5) {
      const SatelliteState s = r.at(kKeplerToe + dt_s);
      const Eigen::Vector3d v_inertial = inertial_velocity(s);
      const double energy = 0.5 * v_inertial.squaredNorm() - kGpsMu / s.p_E.norm();
      // Kinetic and potential energy cancel: eps times the larger of them, a few roundings of E amplified by 1/(1 - e).
      EXPECT_NEAR(energy, -0.5 * kGpsMu / a_m, 1e-14 / (1.0 - e) * kGpsMu / s.p_E.norm()) << e;
      const Eigen::Vector3d h = s.p_E.cross(v_inertial);
      EXPECT_NEAR(h.squaredNorm() / kGpsMu, a_m * (1.0 - e * e), 1e-12 * a_m);
    }
  }
}

TEST(KeplerEphemeris, ClockHasRelativityAndGroupDelay) {
  KeplerEphemeris r = sample_ephemeris(2, kKeplerToe);
  const GpsTime t = kKeplerToe + 1000.0;
  // -2 r.v / c^2 is the same relativistic correction (IS-GPS-200 20.3.3.3.3.1), up to the harmonic terms: 1e-3 of its
  // 20 ns.
  const SatelliteState s = r.at(t);
  EXPECT_NEAR(s.clock_s, r.af0_s + r.af1 * 1000.0 + r.af2_per_s * 1e6 + relativity_s(s), 1e-10);
  EXPECT_NEAR(s.clock_of_band_s(1), s.clock_s - r.tgd_s, 1e-15);
  EXPECT_NEAR(s.clock_of_band_s(2), s.clock_s - r.tgd_s * 77.0 * 77.0 / (60.0 * 60.0), 1e-15);
  EXPECT_GT(std::abs(relativity_s(s)), 1e-9);  // so that the line above tests something
}

TEST(Broadcast, NearestHealthyRecordWithinItsFitInterval) {
  KeplerEphemeris early = sample_ephemeris(1, kKeplerToe), late = sample_ephemeris(1, kKeplerToe + 7200.0),
                  other = sample_ephemeris(2, kKeplerToe);
  early.af0_s = 1e-3;
  late.af0_s = 2e-3;
  other.health = 1;
  const auto constellation = broadcast_of({late, other, early});
  const SatelliteId g01{GnssSystem::kGps, 1}, g02{GnssSystem::kGps, 2};
  EXPECT_EQ(constellation->satellites(), (std::vector<SatelliteId>{g01, g02}));
  const auto clock_at = [&](double dt_s) { return constellation->state(g01, kKeplerToe + dt_s)->clock_s; };
  EXPECT_NEAR(clock_at(3599.0), 1e-3, 1e-6);
  EXPECT_NEAR(clock_at(3601.0), 2e-3, 1e-6);
  EXPECT_TRUE(constellation->state(g01, kKeplerToe + -7200.0).has_value());
  EXPECT_FALSE(constellation->state(g01, kKeplerToe + -7200.001).has_value());
  EXPECT_TRUE(constellation->state(g01, kKeplerToe + 14400.0).has_value());
  EXPECT_FALSE(constellation->state(g01, kKeplerToe + 14400.001).has_value());
  EXPECT_FALSE(constellation->state(g02, kKeplerToe).has_value());
  EXPECT_FALSE(constellation->state({GnssSystem::kGps, 3}, kKeplerToe).has_value());
}

TEST(Broadcast, OfTheSameToeTheLastGivenCounts) {
  KeplerEphemeris first = sample_ephemeris(1, kKeplerToe), second = first;
  second.af0_s = 5e-4;
  const auto constellation = broadcast_of({first, second});
  for (const double dt_s : {-100.0, 0.0, 100.0})
    EXPECT_NEAR(constellation->state(first.sv, kKeplerToe + dt_s)->clock_s, 5e-4, 1e-6) << dt_s;
}

TEST(Broadcast, WeekAndDayBoundaries) {
  const GpsTime toe = GpsTime::from_week_sow(1591, 0.0);
  const KeplerEphemeris r = sample_ephemeris(4, toe);
  const auto constellation = broadcast_of({r});
  const auto before = constellation->state(r.sv, toe + -0.001), after = constellation->state(r.sv, toe + 0.001);
  ASSERT_TRUE(before && after);
  // Smooth across the roll-over: acceleration below 1 m/s^2 leaves less than h^2 = 1e-6 m, and 1 ns of time resolution
  // 4e-6 m.
  EXPECT_LT((after->p_E - before->p_E - 0.002 * before->v_E).norm(), 1e-5);
}

TEST(Transmission, LightTimeAndSagnacRoundTrip) {
  const KeplerEphemeris r = sample_ephemeris(1, kKeplerToe);
  const auto constellation = broadcast_of({r});
  const Eigen::Vector3d p_E = ecef_from_geodetic({32.35 * kDegree, -90.88 * kDegree, 60.0});
  const GpsTime t = kKeplerToe + 1800.25;
  const auto signal = transmission_to(*constellation, r.sv, t, p_E);
  ASSERT_TRUE(signal.has_value());
  // Time is kept to 1 ns, in which the range changes by less than 1e-6 m.
  EXPECT_NEAR((signal->p_E() - p_E).norm(), signal->range_m, 1e-6);
  EXPECT_NEAR(kSpeedOfLight * (t - signal->t), signal->range_m, 0.6e-9 * kSpeedOfLight);
  // Sagnac's closed form, w/c (x_s y_r - y_s x_r), holds to second order: w^2 tau^2 R < 1e-3 m.
  const double straight_m = (signal->state.p_E - p_E).norm();
  const double sagnac_m =
      kGpsEarthRate / kSpeedOfLight * (signal->state.p_E.x() * p_E.y() - signal->state.p_E.y() * p_E.x());
  EXPECT_GT(std::abs(sagnac_m), 1.0);
  EXPECT_NEAR(signal->range_m, straight_m + sagnac_m, 1e-3);

  // A receiver whose clock is 5 ms off still finds the time of transmission.
  const double clock_m = 5e-3 * kSpeedOfLight;
  const auto view = transmission_from_pseudorange(*constellation, r.sv, t + 5e-3,
                                                  signal->range_m + clock_m - kSpeedOfLight * signal->state.clock_s);
  ASSERT_TRUE(view.has_value());
  EXPECT_NEAR(view->t - signal->t, 0.0, 2e-9);
  EXPECT_LT((view->state.p_E - signal->state.p_E).norm(), 1e-5);
}

}  // namespace
}  // namespace canyon::gnss
