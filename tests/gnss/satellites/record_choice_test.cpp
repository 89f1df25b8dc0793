// Which of a satellite's broadcast records holds at an instant.
#include <gtest/gtest.h>

#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/tests/gnss/sensor/synthetic_sky.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

/// The synthetic records, and those of `later_s` after, whose clocks read a microsecond more: so the clock tells which
/// record was taken.
class RecordChoice : public ::testing::Test {
 protected:
  static constexpr double kMark = 1e-6;

  static NavigationData two_sets(double later_s) {
    NavigationData data = synthetic_navigation();
    const auto kepler = data.kepler;
    for (KeplerEphemeris r : kepler) {
      r.m0_rad += later_s * std::sqrt(3.986005e14 / std::pow(r.sqrt_a, 6));
      r.af0_s += later_s * r.af1 + kMark;
      r.toe = r.toc = r.toe + later_s;
      r.transmitted = *r.transmitted + later_s;
      data.kepler.push_back(r);
    }
    const auto glonass = data.glonass;
    for (GlonassEphemeris r : glonass) {
      const SatelliteState s = r.at(r.toe + later_s);
      r.p_E = s.p_E, r.v_E = s.v_E;
      r.clock_s = s.clock_s + kMark;
      r.toe = r.toe + later_s;
      data.glonass.push_back(r);
    }
    return data;
  }

  /// Does a signal that leaves at `t` and is received at `received` have the later set's clock?
  static bool later(const NavigationData& data, const SatelliteId sv, GpsTime t, GpsTime received) {
    const auto both = make_broadcast(data), first = make_broadcast(synthetic_navigation());
    const auto chosen = both->state_received(sv, t, received), earlier = first->state(sv, t);
    EXPECT_TRUE(chosen && earlier) << sv.str();
    // The sets' orbits differ by the frame's turn, some nanoseconds of relativity at most.
    return chosen->clock_s - earlier->clock_s > 0.5 * kMark;
  }
};

// 2026-11-22: of two records equally near, 12:00 and 14:00 at 13:00:00, the earlier was taken, rnx2rtkp takes the
// later: up to 22 cm of position on 2020-177. The later is the one on the air: GPS sends it from two hours before its
// toe. And the instant that counts is that of reception: the signal itself left 70 ms before, when 12:00 was still
// nearer.
TEST_F(RecordChoice, OfTwoEquallyNearTheLaterAtTheInstantOfReception) {
  for (const SatelliteId sv : {SatelliteId{GnssSystem::kGps, 3}, SatelliteId{GnssSystem::kBeidou, 20}}) {
    const NavigationData data = two_sets(7200.0);
    const GpsTime middle = kSyntheticNoon + 3600.0, sent = middle - 0.07;
    EXPECT_FALSE(later(data, sv, sent, GpsTime{middle.ns - 1})) << sv.str();
    EXPECT_TRUE(later(data, sv, sent, middle)) << sv.str();
  }
  const NavigationData data = two_sets(1800.0);
  const SatelliteId sv{GnssSystem::kGlonass, 4};
  const GpsTime middle = data.glonass.front().toe + 900.0, sent = middle - 0.07;
  EXPECT_FALSE(later(data, sv, sent, GpsTime{middle.ns - 1}));
  EXPECT_TRUE(later(data, sv, sent, middle));
}

// Galileo's toe lies before the transmission: a record cannot have been received at its own toe.
TEST_F(RecordChoice, OfGalileoTheLastWhoseToeIsPast) {
  const NavigationData data = two_sets(600.0);
  const SatelliteId sv{GnssSystem::kGalileo, 5};
  const GpsTime toe = kSyntheticNoon + 600.0, sent = toe - 0.08;
  EXPECT_FALSE(later(data, sv, sent, toe));
  EXPECT_TRUE(later(data, sv, sent, GpsTime{toe.ns + 1}));
  // Before the first: the nearest there is.
  const auto both = make_broadcast(data);
  const auto early = both->state_received(sv, kSyntheticNoon - 60.0, kSyntheticNoon - 60.0);
  ASSERT_TRUE(early);
  EXPECT_LT(early->clock_s - make_broadcast(synthetic_navigation())->state(sv, kSyntheticNoon - 60.0)->clock_s,
            0.5 * kMark);
}

// Simulated and received alike: the transmission that is simulated and the one that its pseudorange tells are one.
TEST_F(RecordChoice, SimulatorAndReceiverChooseAlike) {
  const auto constellation = make_broadcast(two_sets(7200.0));
  const Eigen::Vector3d p_E = ecef_from_geodetic({0.9, 0.1, 60.0});
  for (const double clock_s : {-2e-7, 0.0, 2e-7, 1e-3}) {
    const GpsTime t = kSyntheticNoon + 3600.0, reading = t + clock_s;
    int compared = 0;
    for (const SatelliteId sv : constellation->satellites()) {
      const auto sent = transmission_to(*constellation, sv, t, p_E, reading);
      if (!sent) continue;  // GLONASS's records hold for half an hour
      ++compared;
      const double pseudorange_m = sent->range_m + kSpeedOfLight * (clock_s - sent->state.clock_s);
      const auto seen = transmission_from_pseudorange(*constellation, sv, reading, pseudorange_m);
      ASSERT_TRUE(seen);
      // Times of transmission to a nanosecond, 4 um of way.
      EXPECT_LT((seen->state.p_E - sent->state.p_E).norm(), 1e-5) << sv.str() << " " << clock_s;
    }
    EXPECT_EQ(compared, 60);
  }
}

// The standard's own view on real data: at every odd hour the record that GPS had begun to transmit last has the toe of
// one hour later.
TEST(RecordChoiceOnRealData, AtOddHoursTheRecordOnTheAirIsTheLater) {
  CANYON_REAL_DATA(path, "gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_MN.rnx.gz");
  const auto data = read_navigation_file(path);
  ASSERT_TRUE(data.ok()) << data.error().str();
  const BroadcastOptions on_air{.systems = "G", .choice = EphemerisChoice::kTransmitted};
  const auto nearest = make_broadcast(*data, {.systems = "G"}), transmitted = make_broadcast(*data, on_air);
  int compared = 0, same = 0;
  for (int hour = 3; hour < 23; hour += 2) {
    const GpsTime t = GpsTime::from_calendar(2020, 6, 25, hour, 0, 0.0);
    for (const SatelliteId sv : nearest->satellites()) {
      const auto a = nearest->state(sv, t), b = transmitted->state(sv, t);
      if (!a || !b) continue;
      // Only where both of the records beside the hour are there.
      const auto has = [&](double hours) {
        return std::any_of(data->kepler.begin(), data->kepler.end(), [&](const KeplerEphemeris& r) {
          return r.sv == sv && r.message == NavigationMessage::kLnav && r.toe == t + 3600.0 * hours;
        });
      };
      if (!has(-1.0) || !has(1.0)) continue;
      ++compared;
      same += a->p_E == b->p_E ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 50);
  // The others rose later over the station, whose file tells when it first heard a record.
  EXPECT_GT(same, compared * 3 / 4) << "of " << compared;
}

}  // namespace
}  // namespace canyon::gnss
