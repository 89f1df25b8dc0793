#include "canyon/gnss/errors/ephemeris_error.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

const GpsTime kErrorStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

SatelliteState at(const Eigen::Vector3d& p_E) {
  SatelliteState s;
  s.p_E = p_E;
  s.v_E = Eigen::Vector3d::UnitY();
  return s;
}

TEST(EphemerisError, PaperAsPrintedAndCorrected) {
  const auto printed = make_paper_printed_ephemeris(), corrected = make_paper_corrected_ephemeris();
  const SatelliteId sv{GnssSystem::kGps, 1};
  const double r = 26550e3;
  const Eigen::Vector3d equator(r, 0, 0);
  const double top = std::sin(55.0 * 3.14159265358979 / 180.0);
  const Eigen::Vector3d north(r * std::sqrt(1 - top * top), 0, r * top), south(north.x(), 0, -north.z());
  // Figures of the paper's formula, to their digits: 10.05 m (7.7 to 11.9 over +-55 deg) and 1.09 m (0.88 to 1.26).
  EXPECT_NEAR(printed->range_m(sv, at(equator), Eigen::Vector3d::UnitZ(), kErrorStart), 10.05, 0.005);
  EXPECT_NEAR(printed->range_m(sv, at(south), Eigen::Vector3d::UnitZ(), kErrorStart), 7.7, 0.05);
  EXPECT_NEAR(printed->range_m(sv, at(north), Eigen::Vector3d::UnitZ(), kErrorStart), 11.9, 0.05);
  EXPECT_NEAR(corrected->range_m(sv, at(equator), Eigen::Vector3d::UnitZ(), kErrorStart), 1.09, 0.005);
  EXPECT_NEAR(corrected->range_m(sv, at(south), Eigen::Vector3d::UnitZ(), kErrorStart), 0.88, 0.005);
  EXPECT_NEAR(corrected->range_m(sv, at(north), Eigen::Vector3d::UnitZ(), kErrorStart), 1.26, 0.005);
}

TEST(EphemerisError, GaussMarkovScalesWithSigma) {
  const auto one = make_gauss_markov_ephemeris(3, 1.0, 3600.0), two = make_gauss_markov_ephemeris(3, 2.0, 3600.0);
  const SatelliteId sv{GnssSystem::kGps, 7};
  EXPECT_DOUBLE_EQ(two->range_m(sv, at(Eigen::Vector3d::Ones()), Eigen::Vector3d::UnitZ(), kErrorStart),
                   2.0 * one->range_m(sv, at(Eigen::Vector3d::Ones()), Eigen::Vector3d::UnitZ(), kErrorStart));
  EXPECT_EQ((*ModelChoice<ephemeris_error_models>("none").make("gnss.ephemeris_error", EphemerisErrorSetup{}))
                ->range_m(sv, at(Eigen::Vector3d::Ones()), Eigen::Vector3d::UnitZ(), kErrorStart),
            0.0);
}

// Second moments over many seeds. Overhead only radial and clock act, var = T^2 + R^2 - 2 rho R T; over receivers
// spread evenly over all that see the satellite, the signal-in-space range error of the day that the model stands for.
// N draws are independent: the relative sigma of a mean square is sqrt(2 / N); 5 sigma.
TEST(EphemerisError, OrbitClockHasItsMoments) {
  constexpr int kN = 6000;
  const SatelliteId sv{GnssSystem::kGps, 7};
  SatelliteState satellite;
  satellite.p_E = {26560e3, 0.0, 0.0};
  satellite.v_E = {0.0, 1900.0, 2300.0};
  const double earth_m = 6371e3, cos_horizon = earth_m / 26560e3;
  double zenith = 0.0, horizon = 0.0, everywhere = 0.0;
  for (int k = 0; k < kN; ++k) {
    const auto model = make_orbit_clock_2010(static_cast<std::uint64_t>(k));
    zenith += std::pow(model->range_m(sv, satellite, {earth_m, 0, 0}, kErrorStart), 2) / kN;
    const double rim = std::sqrt(1.0 - cos_horizon * cos_horizon);
    horizon += std::pow(model->range_m(sv, satellite, {earth_m * cos_horizon, earth_m * rim, 0}, kErrorStart), 2) / kN;
    // Evenly over the cap: the sine of latitude about the satellite's axis is uniform.
    const double c = cos_horizon + (1.0 - cos_horizon) * (k % 100 + 0.5) / 100.0, a = 2.0 * kPi * (k * 0.6180339887);
    const double r = earth_m * std::sqrt(1.0 - c * c);
    everywhere +=
        std::pow(model->range_m(sv, satellite, {earth_m * c, r * std::cos(a), r * std::sin(a)}, kErrorStart), 2) / kN;
  }
  const double at_zenith = 1.13 * 1.13 + 1.07 * 1.07 - 2 * 0.506 * 1.13 * 1.07;
  EXPECT_NEAR(zenith, at_zenith, 5.0 * std::sqrt(2.0 / kN) * at_zenith);
  EXPECT_GT(horizon, 1.05 * zenith);  // a quarter of the along-track error is in the line of sight
  EXPECT_NEAR(everywhere, 1.11 * 1.11, 5.0 * std::sqrt(2.0 / kN) * 1.11 * 1.11);
}

TEST(EphemerisError, OrbitClockOf2021AndInTime) {
  const SatelliteId sv{GnssSystem::kGps, 7}, other{GnssSystem::kGps, 8};
  SatelliteState s;
  s.p_E = {26560e3, 0.0, 0.0};
  s.v_E = {0.0, 1900.0, 2300.0};
  const Eigen::Vector3d here(6371e3, 0, 0);
  const auto then = make_orbit_clock_2010(3), now = make_orbit_clock_2021(3);
  EXPECT_DOUBLE_EQ(now->range_m(sv, s, here, kErrorStart), 0.89 / 1.11 * then->range_m(sv, s, here, kErrorStart));
  EXPECT_NE(then->range_m(sv, s, here, kErrorStart), then->range_m(other, s, here, kErrorStart));
  // Hours of correlation: half a second changes it by millimetres at most.
  EXPECT_NEAR(then->range_m(sv, s, here, kErrorStart), then->range_m(sv, s, here, kErrorStart + 0.5), 2e-3);
}

}  // namespace
}  // namespace canyon::gnss
