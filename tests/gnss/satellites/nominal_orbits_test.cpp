#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

const GpsTime kNow = GpsTime::from_calendar(2023, 3, 12, 6, 0, 0.0);

std::map<char, int> satellites_of(const Constellation& constellation) {
  std::map<char, int> out;
  for (const SatelliteId sv : constellation.satellites()) ++out[system_letter(sv.system)];
  return out;
}

TEST(NominalOrbits, EverySystemHasItsSatellites) {
  EXPECT_EQ(satellites_of(*make_nominal("GRECJ")),
            (std::map<char, int>{{'G', 24}, {'R', 24}, {'E', 24}, {'C', 30}, {'J', 4}}));
  EXPECT_EQ(satellites_of(*make_nominal("E")), (std::map<char, int>{{'E', 24}}));
  EXPECT_THROW(make_nominal("X"), ProgramError);
}

// Third derivative / 24 below 1e-5 m, 1 ns of time 4e-6 m.
TEST(NominalOrbits, VelocityIsTheDerivative) {
  const auto all = make_nominal("GRECJ");
  for (const SatelliteId sv : all->satellites()) {
    const auto before = all->state(sv, kNow - 0.5), after = all->state(sv, kNow + 0.5), now = all->state(sv, kNow);
    EXPECT_LT((after->p_E - before->p_E - now->v_E).norm(), 2e-5) << sv.str();
  }
}

// Radius and height of the track of each orbit: 25508, 29600.3, 27906.1, 42164 km; inclinations as greatest latitudes.
TEST(NominalOrbits, RadiusAndInclination) {
  const auto all = make_nominal("RECJ");
  for (const SatelliteId sv : all->satellites()) {
    double top = 0.0, low_m = 1e12, high_m = 0.0;
    for (double s = 0.0; s < 86400.0; s += 120.0) {
      const Eigen::Vector3d p_E = all->state(sv, kNow + s)->p_E;
      top = std::max(top, std::abs(std::asin(p_E.z() / p_E.norm())) / kDegree);
      low_m = std::min(low_m, p_E.norm());
      high_m = std::max(high_m, p_E.norm());
    }
    double radius_km = 0.0, inclination_deg = 0.0, e = 0.0;
    switch (sv.system) {
      case GnssSystem::kGlonass:
        radius_km = 25508.0, inclination_deg = 64.8;
        break;
      case GnssSystem::kGalileo:
        radius_km = 29600.318, inclination_deg = 56.0;
        break;
      case GnssSystem::kBeidou:
        radius_km = sv.prn < 38 || (sv.prn > 40 && sv.prn < 59) ? 27906.1 : 42164.2;
        inclination_deg = sv.prn >= 59 ? 0.0 : 55.0;
        break;
      default:
        radius_km = 42165.0, inclination_deg = sv.prn < 7 ? 41.0 : 0.0, e = sv.prn < 7 ? 0.075 : 0.0;
    }
    // Sampled every 2 minutes, at most 1 deg of the orbit: the top is missed by 55 deg (0.5 deg)^2 / 2 at most.
    EXPECT_NEAR(top, inclination_deg, 0.01) << sv.str();
    // GLONASS's wave: J2 R^2 sin^2 i / (4 a) = 353.5 m.
    const double wave_m = sv.system == GnssSystem::kGlonass ? 353.5 : 0.0;
    EXPECT_NEAR(low_m, 1e3 * radius_km * (1.0 - e) - wave_m, 100.0) << sv.str();
    EXPECT_NEAR(high_m, 1e3 * radius_km * (1.0 + e) + wave_m, 100.0) << sv.str();
  }
}

// Published repeat times: the Earth turns under the node 10, 8, 7 and 1 times, a little less than as many days.
TEST(NominalOrbits, GroundTracksRepeat) {
  const auto all = make_nominal("RECJ");
  const std::map<GnssSystem, double> turns = {
      {GnssSystem::kGalileo, 10.0}, {GnssSystem::kGlonass, 8.0}, {GnssSystem::kBeidou, 7.0}, {GnssSystem::kQzss, 1.0}};
  for (const SatelliteId sv : all->satellites()) {
    const auto start = all->state(sv, kNow);
    const bool geosynchronous = start->p_E.norm() > 38e6;
    double best_m = 1e12;
    // The node drifts by 0.01 to 0.04 deg a day, so a turn is a sidereal day less up to 9 s.
    const double n = geosynchronous ? 1.0 : turns.at(sv.system);
    for (double s = n * 86164.0905 - 10.0 * n; s < n * 86164.0905 + 10.0 * n; s += 0.25) {
      const auto later = all->state(sv, kNow + s);
      best_m = std::min(best_m, (later->p_E - start->p_E).norm());
    }
    EXPECT_LT(best_m, 0.125 * start->v_E.norm() + 1.0) << sv.str();
  }
}

TEST(NominalOrbits, HighSatellitesStayOverTheirPlaces) {
  const auto all = make_nominal("CJ");
  const auto longitude = [&](SatelliteId sv, GpsTime t) {
    return geodetic_from_ecef(all->state(sv, t)->p_E).lon_rad / kDegree;
  };
  const std::map<int, double> geo = {{59, 140.0}, {60, 80.0}, {61, 110.5}};
  for (const auto& [prn, lon_deg] : geo)
    EXPECT_NEAR(longitude({GnssSystem::kBeidou, static_cast<std::uint8_t>(prn)}, kNow), lon_deg, 1e-6);
  EXPECT_NEAR(longitude({GnssSystem::kQzss, 7}, kNow), 127.0, 1e-6);
  // Inclined geosynchronous: the equator is crossed at one longitude only, by all three in turn.
  for (const SatelliteId sv : all->satellites()) {
    const bool igso = sv.system == GnssSystem::kBeidou && sv.prn >= 38 && sv.prn <= 40;
    if (!igso) continue;
    for (double s = 0.0; s < 86400.0; s += 10.0) {
      const auto a = all->state(sv, kNow + s), b = all->state(sv, kNow + (s + 10.0));
      if (a->p_E.z() * b->p_E.z() < 0.0) {
        EXPECT_NEAR(longitude(sv, kNow + s), 118.0, 0.05) << sv.str();
      }
    }
  }
  // QZSS: each is above 60 deg of elevation in Tokyo for at least 8 hours, so one of the three always is.
  const Eigen::Vector3d tokyo = ecef_from_geodetic({35.68 * kDegree, 139.77 * kDegree, 40.0});
  for (double s = 0.0; s < 86400.0; s += 600.0) {
    double best = -kPi;
    for (std::uint8_t prn = 1; prn <= 3; ++prn) {
      const Eigen::Vector3d d = all->state({GnssSystem::kQzss, prn}, kNow + s)->p_E - tokyo;
      best = std::max(best, std::asin(d.normalized().dot(tokyo.normalized())));
    }
    EXPECT_GT(best, 60.0 * kDegree) << s;
  }
}

// What the satellites themselves say about their channels: the plan of the table, slot by slot.
TEST(NominalOrbits, GlonassChannelsAreThoseInUse) {
  const auto all = make_nominal("R");
  for (int slot = 1; slot <= 24; ++slot) {
    const auto at = [&](int n) {
      return all->state({GnssSystem::kGlonass, static_cast<std::uint8_t>(n)}, kNow)->frequency_channel;
    };
    EXPECT_EQ(at(slot), at((slot - 1) / 8 * 8 + (slot - 1 + 4) % 8 + 1)) << slot;  // opposite in the plane
  }
  CANYON_REAL_DATA(path, "gnss/rinex4/BRD400DLR_S_20230710000_01D_MN.rnx.gz");
  const auto data = read_navigation_file(path);
  ASSERT_TRUE(data.ok());
  for (const auto& r : data->glonass)
    if (r.sv.prn <= 24 && r.healthy()) {
      EXPECT_EQ(all->state(r.sv, kNow)->frequency_channel, r.frequency_channel) << r.sv.str();
    }
}

// The reference constellation of Galileo against the orbits of 2023: each satellite in a slot is within 3 deg along the
// orbit and across (the OS SDD keeps them within +-2 deg of their slots relative to one another).
TEST(NominalOrbits, GalileoStandsWhereItsSatellitesAre) {
  CANYON_REAL_DATA(path, "gnss/rinex4/BRD400DLR_S_20230710000_01D_MN.rnx.gz");
  const auto data = read_navigation_file(path);
  ASSERT_TRUE(data.ok());
  const auto real = make_broadcast(*data, {.systems = "E"}), nominal = make_nominal("E");
  int near = 0, all = 0;
  for (const SatelliteId sv : real->satellites()) {
    const auto state = real->state(sv, kNow);
    if (!state) continue;
    ++all;
    double best = kPi;
    for (const SatelliteId slot : nominal->satellites()) {
      const Eigen::Vector3d p_E = nominal->state(slot, kNow)->p_E;
      best = std::min(best, std::acos(std::min(1.0, p_E.normalized().dot(state->p_E.normalized()))));
    }
    near += best < 5.0 * kDegree ? 1 : 0;
  }
  RecordProperty("near", near);
  EXPECT_GE(near, 18);  // of 23 to 24 healthy satellites, spares and those still moving aside
  EXPECT_GE(all, 22);
}

}  // namespace
}  // namespace canyon::gnss
