#include "canyon/gnss/atmosphere/beidou_klobuchar.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/single_point/range_corrections.h"

namespace canyon::gnss {
namespace {

/// Amplitude 30 ns everywhere, period `beta0`.
KlobucharCoefficients even(double beta0) {
  return {{30e-9, 0, 0, 0}, {beta0, 0, 0, 0}};
}

/// At `hours` of BDT of a day, from the equator at Greenwich.
SkyView view(double hours, double elevation_deg, double azimuth_deg = 0.0) {
  return {GpsTime::from_calendar(2020, 6, 25, 0, 0, 14.0) + 3600.0 * hours,
          {0.0, 0.0, 0.0},
          elevation_deg * kDegree,
          azimuth_deg * kDegree};
}

double zenith_ns(double hours, double beta0) {
  return 1e9 * beidou_klobuchar_delay_m(even(beta0), view(hours, 90.0)) / kSpeedOfLight;
}

// BDS-SIS-ICD-B1I 3.0, 5.2.4.7: night 5 ns; a cosine about 14:00 of a quarter period to either side.
TEST(BeidouKlobuchar, DayAtTheZenith) {
  EXPECT_NEAR(zenith_ns(14.0, 100e3), 35.0, 1e-9);
  EXPECT_NEAR(zenith_ns(12.0, 100e3), 5.0 + 30.0 * std::cos(2.0 * kPi * 7200.0 / 100e3), 1e-9);
  EXPECT_NEAR(zenith_ns(14.0 + 24999.0 / 3600.0, 100e3), 5.0 + 30.0 * std::sin(2.0 * kPi / 100e3), 1e-9);
  EXPECT_NEAR(zenith_ns(14.0 + 25001.0 / 3600.0, 100e3), 5.0, 1e-12);
  EXPECT_NEAR(zenith_ns(2.0, 100e3), 5.0, 1e-12);
}

TEST(BeidouKlobuchar, ThePeriodIsHeld) {
  EXPECT_DOUBLE_EQ(zenith_ns(12.0, 10e3), zenith_ns(12.0, 72000.0));
  EXPECT_DOUBLE_EQ(zenith_ns(12.0, 300e3), zenith_ns(12.0, 172800.0));
  EXPECT_LT(zenith_ns(12.0, 172799.0), zenith_ns(12.0, 172800.0));
  KlobucharCoefficients negative = even(100e3);
  negative.alpha[0] = -30e-9;
  EXPECT_DOUBLE_EQ(beidou_klobuchar_delay_m(negative, view(14.0, 90.0)), 5e-9 * kSpeedOfLight);
}

// Due north from the equator the pierce point's latitude is psi itself, in semicircles; due south the same, for only
// its size counts. A shell of 375 km over 6378 km maps the delay.
TEST(BeidouKlobuchar, PiercePointAndMapping) {
  const double e = 20.0 * kDegree, s = 6378.0 / 6753.0 * std::cos(e), psi = 0.5 * kPi - e - std::asin(s);
  KlobucharCoefficients c = even(100e3);
  c.alpha[1] = 200e-9;
  const double expected_m = kSpeedOfLight * (5e-9 + 30e-9 + 200e-9 * psi / kPi) / std::sqrt(1.0 - s * s);
  EXPECT_NEAR(beidou_klobuchar_delay_m(c, view(14.0, 20.0, 0.0)), expected_m, 1e-9);
  EXPECT_NEAR(beidou_klobuchar_delay_m(c, view(14.0, 20.0, 180.0)), expected_m, 1e-9);
  // Due east it is later there by psi.
  const double later_s = psi / kPi * 43200.0;
  EXPECT_NEAR(
      beidou_klobuchar_delay_m(even(100e3), view(12.0, 20.0, 90.0)),
      kSpeedOfLight * (5e-9 + 30e-9 * std::cos(2.0 * kPi * (7200.0 - later_s) / 100e3)) / std::sqrt(1.0 - s * s), 1e-9);
}

// The delay is that of B1I; what is asked for is that of L1.
TEST(BeidouKlobuchar, IsCarriedToL1) {
  const SkyView v = view(11.0, 35.0, 50.0);
  const double ratio = 1561.098 / 1575.42;
  EXPECT_NEAR(klobuchar_correction_m(GnssSystem::kBeidou, even(100e3), v),
              ratio * ratio * beidou_klobuchar_delay_m(even(100e3), v), 1e-12);
  EXPECT_EQ(klobuchar_correction_m(GnssSystem::kQzss, even(100e3), v),
            klobuchar_delay_m(even(100e3), v.t, 0.0, 0.0, v.azimuth_rad, v.elevation_rad));
  const SkyView low = view(11.0, -3.0, 50.0), held = view(11.0, 5.0, 50.0);
  EXPECT_EQ(klobuchar_correction_m(GnssSystem::kBeidou, even(100e3), low),
            klobuchar_correction_m(GnssSystem::kBeidou, even(100e3), held));
}

}  // namespace
}  // namespace canyon::gnss
