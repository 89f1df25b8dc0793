#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/sky_view.h"
#include "canyon/gnss/solver/position_solver.h"

namespace canyon::gnss {
namespace {

const GpsTime kEpoch = GpsTime::from_calendar(1993, 7, 1, 0, 0, 9.0);  // 00:00:00 UTC

TEST(NominalGps, SlotA1AtTheEpoch) {
  const auto constellation = make_nominal_gps();
  ASSERT_EQ(constellation->satellites().size(), 24u);
  const auto state = constellation->state({GnssSystem::kGps, 1}, kEpoch);
  ASSERT_TRUE(state.has_value());
  // Table 3-1, A1: node 272.847, argument of latitude 268.126; Greenwich 279.060.
  const double node = (272.847 - 279.060) * kDegree, u = 268.126 * kDegree, i = 55.0 * kDegree, r = 26559.7e3;
  const Eigen::Vector3d expected(r * (std::cos(u) * std::cos(node) - std::sin(u) * std::cos(i) * std::sin(node)),
                                 r * (std::cos(u) * std::sin(node) + std::sin(u) * std::cos(i) * std::cos(node)),
                                 r * std::sin(u) * std::sin(i));
  EXPECT_LT((state->p_E - expected).norm(), 1e-7);  // a few eps of 2.7e7 m
  EXPECT_EQ(state->clock_s, 0.0);
  EXPECT_FALSE(constellation->state({GnssSystem::kGps, 25}, kEpoch).has_value());
  EXPECT_FALSE(constellation->state({GnssSystem::kGalileo, 1}, kEpoch).has_value());
}

// Central differences over 1 s: truncation h^2/6 |d3p/dt3| < 1e-4 m/s; also across a day boundary from the epoch,
// decades away.
TEST(NominalGps, VelocityIsTheDerivativeOfPosition) {
  const auto constellation = make_nominal_gps();
  for (const GpsTime t :
       {kEpoch, GpsTime::from_calendar(2010, 11, 17, 0, 0, 9.0), GpsTime::from_calendar(2060, 1, 1, 5, 0, 0.0)}) {
    for (const SatelliteId sv : constellation->satellites()) {
      const Eigen::Vector3d difference =
          0.5 * (constellation->state(sv, t + 1.0)->p_E - constellation->state(sv, t - 1.0)->p_E);
      EXPECT_LT((difference - constellation->state(sv, t)->v_E).norm(), 1e-4) << sv.str();
    }
  }
}

// The ground track repeats every turn of the Earth under the node, whatever the date: 23 h 55 min 55 s or so.
TEST(NominalGps, GroundTrackRepeats) {
  const auto constellation = make_nominal_gps();
  const double turn_s = 2.0 * kPi / (7.2921151467e-5 + 4.4874e-7 * kDegree);
  const GpsTime t = GpsTime::from_calendar(2024, 2, 29, 12, 0, 0.0);
  for (const SatelliteId sv : constellation->satellites())
    EXPECT_LT((constellation->state(sv, t + turn_s)->p_E - constellation->state(sv, t)->p_E).norm(),
              1e-4);  // 1 ns x 3.9 km/s, and eps
}

struct Day {
  double satellites = 0.0, pdop = 0.0;
  std::size_t fewest = 99, most = 0;
};

Day one_day(GpsTime start, double mask_deg) {
  const auto constellation = make_nominal_gps();
  const Eigen::Vector3d p_E = ecef_from_geodetic({32.35 * kDegree, -90.88 * kDegree, 60.0});
  const Horizon horizon(p_E);
  Day day;
  constexpr int kMinutes = 1440;
  for (int minute = 0; minute < kMinutes; ++minute) {
    std::vector<Eigen::Vector3d> lines;
    for (const SatelliteId sv : constellation->satellites()) {
      const GpsTime t = start + 60.0 * minute;
      const auto signal = transmission_to(*constellation, sv, t, p_E);
      if (horizon.view(t, signal->p_E()).elevation_rad >= mask_deg * kDegree)
        lines.push_back((signal->p_E() - p_E).normalized());
    }
    day.satellites += static_cast<double>(lines.size()) / kMinutes;
    day.pdop += dilution_of_precision(lines, horizon.R_E_enu(), true).pdop / kMinutes;
    day.fewest = std::min(day.fewest, lines.size());
    day.most = std::max(day.most, lines.size());
  }
  return day;
}

// An independent computation of the same table gave 7.58 satellites (6 to 11) and mean PDOP 1.87 above 5 deg, 6.70
// and 2.35 above 10 deg. It sampled the day at other instants: each of about 60 rises and sets moves the mean by one
// sample's share, 1/1440, so 0.02 covers a different phase of sampling; PDOP follows within 0.01.
TEST(NominalGps, VicksburgOverADay) {
  for (const GpsTime start :
       {kEpoch, GpsTime::from_calendar(2010, 11, 17, 0, 0, 0.0), GpsTime::from_calendar(2024, 2, 29, 0, 0, 0.0)}) {
    const Day low = one_day(start, 5.0);
    EXPECT_NEAR(low.satellites, 7.58, 0.02);
    EXPECT_NEAR(low.pdop, 1.87, 0.01);
    EXPECT_EQ(low.fewest, 6u);
    EXPECT_EQ(low.most, 11u);
    const Day high = one_day(start, 10.0);
    EXPECT_NEAR(high.satellites, 6.70, 0.02);
    EXPECT_NEAR(high.pdop, 2.35, 0.01);
  }
}

}  // namespace
}  // namespace canyon::gnss
