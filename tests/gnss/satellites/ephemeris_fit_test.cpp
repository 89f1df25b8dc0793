#include "canyon/gnss/satellites/ephemerides/ephemeris_fit.h"

#include <gtest/gtest.h>

#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

const GpsTime kFittedToe = GpsTime::from_calendar(2010, 11, 17, 14, 0, 0.0);

// A nominal orbit is Keplerian but for its rates: rounding alone is left, 1e-16 of 2.7e7 m amplified by the
// differences.
TEST(EphemerisFit, NominalOrbitsAreFollowedToRounding) {
  const auto nominal = make_nominal_gps();
  for (const SatelliteId sv : nominal->satellites()) {
    const auto fitted = fit_ephemeris(*nominal, sv, kFittedToe);
    ASSERT_TRUE(fitted.has_value()) << sv.str();
    EXPECT_LT(fitted->max_m, 1e-4) << sv.str();
    const GpsTime t = kFittedToe + 1234.5;
    const SatelliteState a = *nominal->state(sv, t), b = fitted->ephemeris.at(t);
    EXPECT_LT((a.p_E - b.p_E).norm(), 1e-4);
    EXPECT_LT((a.v_E - b.v_E).norm(), 1e-7);
    EXPECT_NEAR(a.clock_s, b.clock_s, 1e-13);  // 0.03 mm: relativity of what eccentricity the rounding left
  }
}

TEST(EphemerisFit, RecordsMakeTheSameConstellationAgain) {
  const auto nominal = make_nominal_gps();
  const NavigationData data =
      fit_navigation_data(*nominal, nominal->satellites(), kFittedToe - 1800.0, kFittedToe + 5400.0);
  const auto again = make_broadcast(data);
  EXPECT_EQ(again->satellites(), nominal->satellites());
  EXPECT_EQ(data.leap_seconds, 15);
  for (double dt = -1800.0; dt <= 5400.0; dt += 600.0)
    for (const SatelliteId sv : nominal->satellites()) {
      const auto state = again->state(sv, kFittedToe + dt);
      ASSERT_TRUE(state.has_value()) << sv.str() << " " << dt;
      EXPECT_LT((state->p_E - nominal->state(sv, kFittedToe + dt)->p_E).norm(), 1e-4);
    }
}

// Real orbits fitted to real ones: broadcast ephemerides (which the fit must meet to rounding too, since it has the
// same parameters), clocks included.
TEST(EphemerisFitReal, BroadcastRecordsAreFoundAgain) {
  CANYON_REAL_DATA(path, "gnss/orbit_2010_182/brdc1820.10n");
  const auto data = read_navigation_file(path);
  ASSERT_TRUE(data.ok());
  int fitted_records = 0;
  for (const KeplerEphemeris& record : data->kepler) {
    if (record.toe != GpsTime::from_calendar(2010, 7, 1, 12, 0, 0.0) || !record.healthy()) continue;
    NavigationData one;
    one.kepler = {record};
    const auto constellation = make_broadcast(one);
    const auto fitted = fit_ephemeris(*constellation, record.sv, record.toe);
    ASSERT_TRUE(fitted.has_value());
    ++fitted_records;
    EXPECT_LT(fitted->max_m, 1e-3) << record.sv.str();
    const GpsTime t = record.toe + 1000.0;
    EXPECT_NEAR(fitted->ephemeris.at(t).clock_s, record.at(t).clock_s, 1e-12);
    EXPECT_DOUBLE_EQ(fitted->ephemeris.tgd_s, record.tgd_s);
  }
  EXPECT_GT(fitted_records, 10);
}

// The built-in satellites of all systems, also those over the equator, whose node is undefined: D2 messages for
// BeiDou's, LNAV for QZSS's.
TEST(EphemerisFit, NominalOrbitsOfAllSystems) {
  const auto nominal = make_nominal("ECJ");
  for (const SatelliteId sv : nominal->satellites()) {
    const auto fitted = fit_ephemeris(*nominal, sv, kFittedToe);
    ASSERT_TRUE(fitted.has_value()) << sv.str();
    EXPECT_LT(fitted->max_m, 1e-3) << sv.str();
    EXPECT_EQ(fitted->ephemeris.geostationary_frame(), sv.system == GnssSystem::kBeidou && sv.prn >= 59);
  }
}

// GLONASS's users integrate the force of the Earth's flattening; second order of it, and what the published node rate
// has from the Moon and the Sun, are left.
TEST(EphemerisFit, StateVectorsOfGlonass) {
  const auto nominal = make_nominal("R");
  double worst_m = 0.0;
  for (const SatelliteId sv : nominal->satellites())
    for (double s = 0.0; s < 43200.0; s += 2700.0) {
      const auto fitted = fit_state_vector(*nominal, sv, kFittedToe + s);
      ASSERT_TRUE(fitted.has_value()) << sv.str();
      worst_m = std::max(worst_m, fitted->max_m);
      EXPECT_EQ(fitted->ephemeris.frequency_channel, nominal->state(sv, kFittedToe)->frequency_channel);
    }
  EXPECT_LT(worst_m, 0.01);  // measured 7 mm
}

TEST(EphemerisFit, WhatCannotBeFitted) {
  const auto nominal = make_nominal_gps();
  EXPECT_FALSE(fit_ephemeris(*nominal, {GnssSystem::kGlonass, 1}, kFittedToe).has_value());
  EXPECT_FALSE(fit_state_vector(*nominal, {GnssSystem::kGps, 1}, kFittedToe).has_value());
  EXPECT_FALSE(fit_state_vector(*nominal, {GnssSystem::kGlonass, 1}, kFittedToe).has_value());
  EXPECT_FALSE(fit_ephemeris(*nominal, {GnssSystem::kGps, 30}, kFittedToe).has_value());
}

}  // namespace
}  // namespace canyon::gnss
