#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/gnss/signal.h"
#include "canyon/tests/gnss/rinex/nav_text.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using testing::sample_ephemeris;
using Message = NavigationMessage;

const GpsTime kToe = GpsTime::from_week_sow(2253, 3600.0);

NavigationData data_of(std::vector<KeplerEphemeris> records) {
  NavigationData data;
  data.kepler = std::move(records);
  return data;
}

KeplerEphemeris galileo(int prn, Message message) {
  KeplerEphemeris r = sample_ephemeris(prn, kToe);
  r.sv.system = GnssSystem::kGalileo;
  r.message = message;
  r.sqrt_a = 5440.6;
  r.tgd_s = 3e-9;
  r.tgd2_s = 4e-9;
  const Validity valid = default_validity(r.sv.system, message);
  r.valid_before_s = valid.before_s;
  r.valid_after_s = valid.after_s;
  return r;
}

/// A geostationary satellite over 110.5 deg E, as a D2 message describes it: elements in the frame inclined by 5 deg.
KeplerEphemeris geostationary() {
  KeplerEphemeris r = sample_ephemeris(3, kToe);
  r.sv.system = GnssSystem::kBeidou;
  r.message = Message::kD2;
  const double w = constants_of(GnssSystem::kBeidou).earth_rate_rad_s, mu = constants_of(GnssSystem::kBeidou).mu_m3_s2;
  r.sqrt_a = std::pow(mu / (w * w), 1.0 / 6.0);
  r.e = 0.0;
  // To come out equatorial after Rx(-5 deg) the orbit must rise at -x.
  r.i0_rad = 5.0 * kDegree;
  r.idot_rad_s = r.omega_dot_rad_s = r.delta_n_rad_s = 0.0;
  r.cuc_rad = r.cus_rad = r.crc_m = r.crs_m = r.cic_rad = r.cis_rad = 0.0;
  const double toe_sow_s = (r.toe - 14.0).sow_s();
  r.omega0_rad = kPi + w * toe_sow_s;
  r.argument_of_perigee_rad = 0.0;
  r.m0_rad = (110.5 - 180.0) * kDegree;
  return r;
}

// D2: at rest over its point of the equator for hours, whatever the sense of the small rotation would spoil.
TEST(BroadcastSystems, GeostationaryFrame) {
  const KeplerEphemeris r = geostationary();
  for (const double dt_s : {-3600.0, 0.0, 1000.0, 7200.0}) {
    const SatelliteState s = r.at(kToe + dt_s);
    const Geodetic g = geodetic_from_ecef(s.p_E);
    // A few roundings of 42,164 km at angles of many turns of the week.
    EXPECT_NEAR(g.lat_rad, 0.0, 1e-12);
    EXPECT_NEAR(g.lon_rad, 110.5 * kDegree, 1e-11);
    EXPECT_LT(s.v_E.norm(), 1e-4);
  }
  KeplerEphemeris wrong = r;
  wrong.message = Message::kD1;  // without the frame the same numbers move
  EXPECT_GT(wrong.at(kToe).v_E.norm(), 50.0);
}

// Velocity is the derivative, in every message's arithmetic: rates of A and delta n, the geostationary frame.
TEST(BroadcastSystems, VelocityIsTheDerivative) {
  KeplerEphemeris cnav = sample_ephemeris(5, kToe);
  cnav.message = Message::kCnav;
  cnav.a_dot_m_s = 0.01;
  cnav.delta_n_dot_rad_s2 = 1e-13;
  KeplerEphemeris geo = geostationary();
  geo.e = 0.001;
  geo.cus_rad = 1e-5;
  geo.omega_dot_rad_s = 2e-9;
  for (const KeplerEphemeris& r : {cnav, geo, galileo(4, Message::kInav)})
    for (const double dt_s : {-3000.0, 0.0, 2500.0}) {
      const GpsTime t = r.toe + dt_s;
      const SatelliteState before = r.at(t - 0.5), after = r.at(t + 0.5), now = r.at(t);
      // Third derivative / 24 below 1e-5 m, 1 ns of time 4e-6 m.
      EXPECT_LT((after.p_E - before.p_E - now.v_E).norm(), 3e-5) << name_of(r.message) << " " << dt_s;
      EXPECT_NEAR(after.clock_s - before.clock_s, now.clock_rate, 1e-17);
    }
}

// The mean anomaly of CNAV is M0 + (n0 + delta n) t + delta n' t^2 / 2: its derivative tells the right half.
TEST(BroadcastSystems, CnavRates) {
  KeplerEphemeris r = sample_ephemeris(5, kToe);
  r.e = 0.0;
  r.cuc_rad = r.cus_rad = r.crc_m = r.crs_m = r.cic_rad = r.cis_rad = 0.0;
  KeplerEphemeris changed = r;
  changed.a_dot_m_s = 0.02;
  changed.delta_n_dot_rad_s2 = 2e-13;
  const double t_s = 3600.0, a_m = r.sqrt_a * r.sqrt_a;
  const Eigen::Vector3d p = r.at(kToe + t_s).p_E, q = changed.at(kToe + t_s).p_E;
  EXPECT_NEAR(q.norm() - p.norm(), 0.02 * t_s, 1e-7);
  EXPECT_NEAR((q.normalized() - p.normalized()).norm() * a_m, 0.5 * 2e-13 * t_s * t_s * a_m, 1e-5);
}

TEST(BroadcastSystems, GroupDelaysByBand) {
  const double g5 = std::pow(1575.42 / 1176.45, 2), g7 = std::pow(1575.42 / 1207.14, 2);
  const auto inav = galileo(1, Message::kInav).group_delay_s(), fnav = galileo(1, Message::kFnav).group_delay_s();
  EXPECT_DOUBLE_EQ(inav[1], 4e-9);
  EXPECT_DOUBLE_EQ(inav[7], 4e-9 * g7);
  EXPECT_DOUBLE_EQ(fnav[1], 3e-9);
  EXPECT_DOUBLE_EQ(fnav[5], 3e-9 * g5);
  // Both messages must tell users of E1 and E5a the same difference between these two.
  EXPECT_NEAR(inav[5] - inav[1], fnav[5] - fnav[1], 1e-22);
  KeplerEphemeris c = geostationary();
  c.tgd_s = 5e-9;
  c.tgd2_s = -7e-9;
  EXPECT_EQ(c.group_delay_s()[2], 5e-9);
  EXPECT_EQ(c.group_delay_s()[7], -7e-9);
  EXPECT_EQ(c.group_delay_s()[6], 0.0);
  EXPECT_EQ(c.group_delay_s()[1], 5e-9);  // B1C: lent by B1I, and marked
  EXPECT_EQ(c.at(c.toe).borrowed_delay_bands, 1u << 1);
  KeplerEphemeris cnav = sample_ephemeris(5, kToe);
  cnav.message = Message::kCnav;
  cnav.tgd_s = 5e-9;
  cnav.isc_s[1] = 1e-9;
  cnav.isc_s[5] = -2e-9;
  EXPECT_DOUBLE_EQ(cnav.group_delay_s()[1], 4e-9);
  EXPECT_DOUBLE_EQ(cnav.group_delay_s()[5], 7e-9);
}

TEST(BroadcastSystems, HealthOfEachSystem) {
  KeplerEphemeris r = sample_ephemeris(1, kToe);
  r.health = 1;
  EXPECT_FALSE(r.healthy());
  r.sv.system = GnssSystem::kQzss;
  EXPECT_TRUE(r.healthy());  // L1 C/B
  r.health = 2;
  EXPECT_FALSE(r.healthy());
  r.sv.system = GnssSystem::kGps;
  r.message = Message::kCnav;
  EXPECT_FALSE(r.healthy());
  r.health = 1;  // L5 alone
  EXPECT_TRUE(r.healthy());
  KeplerEphemeris e = galileo(1, Message::kInav);
  EXPECT_TRUE(e.healthy());
  e.accuracy_m = -1.0;  // no accuracy prediction
  EXPECT_FALSE(e.healthy());
}

TEST(BroadcastSystems, MessagesArePreferredNotMixed) {
  KeplerEphemeris i = galileo(1, Message::kInav), f = galileo(1, Message::kFnav), only_f = galileo(2, Message::kFnav);
  i.af0_s = 1e-3;
  f.af0_s = 2e-3;
  f.toe = f.toc = kToe + 600.0;
  const NavigationData data = data_of({f, i, only_f});
  const SatelliteId e1{GnssSystem::kGalileo, 1}, e2{GnssSystem::kGalileo, 2};
  const auto usual = make_broadcast(data);
  EXPECT_NEAR(usual->state(e1, kToe + 600.0)->clock_s, 1e-3, 1e-6);  // I/NAV, though F/NAV is nearer
  EXPECT_TRUE(usual->state(e2, kToe).has_value());
  const auto e5a = make_broadcast(data, {.messages = {Message::kFnav}});
  EXPECT_NEAR(e5a->state(e1, kToe)->clock_s, 2e-3, 1e-6);
  EXPECT_TRUE(make_broadcast(data, {.systems = "GRC"})->satellites().empty());
}

TEST(BroadcastSystems, OnlyWhatHadBeenTransmitted) {
  KeplerEphemeris early = sample_ephemeris(1, kToe), late = sample_ephemeris(1, kToe + 7200.0);
  early.af0_s = 1e-3;
  late.af0_s = 2e-3;
  early.transmitted = kToe - 7200.0;
  late.transmitted = kToe + 1800.0;
  const auto receiver = make_broadcast(data_of({early, late}), {.choice = EphemerisChoice::kTransmitted});
  const auto clock = [&](double dt_s) { return receiver->state(early.sv, kToe + dt_s)->clock_s; };
  EXPECT_NEAR(clock(1799.0), 1e-3, 1e-6);
  EXPECT_NEAR(clock(1801.0), 2e-3, 1e-6);
  EXPECT_FALSE(receiver->state(early.sv, kToe - 7201.0).has_value());
}

TEST(BroadcastSystems, ValidityOfEachSystem) {
  struct Case {
    GnssSystem system;
    Message message;
    double before_h, after_h;
  };
  for (const Case& c : {Case{GnssSystem::kGps, Message::kLnav, 2, 2}, Case{GnssSystem::kGps, Message::kCnav, 1.5, 1.5},
                        Case{GnssSystem::kGalileo, Message::kInav, 1, 4}, Case{GnssSystem::kBeidou, Message::kD1, 1, 2},
                        Case{GnssSystem::kQzss, Message::kLnav, 1, 1}}) {
    KeplerEphemeris r = sample_ephemeris(1, kToe);
    r.sv.system = c.system;
    r.message = c.message;
    const Validity v = default_validity(c.system, c.message);
    r.valid_before_s = v.before_s;
    r.valid_after_s = v.after_s;
    const auto constellation = make_broadcast(data_of({r}), {.messages = {c.message}});
    const auto at = [&](double hours) { return constellation->state(r.sv, kToe + 3600.0 * hours).has_value(); };
    EXPECT_TRUE(at(-c.before_h) && at(c.after_h)) << name_of(c.message);
    EXPECT_FALSE(at(-c.before_h - 0.001) || at(c.after_h + 0.001)) << name_of(c.message);
  }
}

TEST(BroadcastSystems, SystemsThatUsersName) {
  EXPECT_TRUE(check_systems("GREC", "--systems").ok());
  EXPECT_EQ(
      check_systems("", "--systems").error().str(),
      "--systems: no satellite system is named, expected letters of G (GPS), R (GLONASS), E (Galileo), C (BeiDou), "
      "J (QZSS), for example GREC");
  EXPECT_EQ(check_systems("GX", "--systems").error().what, "unknown satellite system \"X\"");
  EXPECT_EQ(check_systems("GG", "--systems").error().what, "satellite system \"G\" is named twice");
}

TEST(Merged, TheFirstThatHasASatelliteTells) {
  KeplerEphemeris a = sample_ephemeris(1, kToe), b = sample_ephemeris(1, kToe), c = sample_ephemeris(2, kToe);
  a.af0_s = 1e-3;
  std::vector<std::unique_ptr<Constellation>> parts;
  parts.push_back(make_broadcast(data_of({a})));
  parts.push_back(make_broadcast(data_of({b, c})));
  const auto merged = make_merged(std::move(parts));
  EXPECT_EQ(merged->satellites().size(), 2u);
  EXPECT_NEAR(merged->state(a.sv, kToe)->clock_s, 1e-3, 1e-6);
  EXPECT_TRUE(merged->state(c.sv, kToe).has_value());
  EXPECT_FALSE(merged->state({GnssSystem::kGps, 3}, kToe).has_value());
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Distances between what two messages say of the same satellites, every 15 minutes of that day.
std::vector<double> distances(const NavigationData& data, const char* systems, Message a, Message b, GpsTime day) {
  const auto first = make_broadcast(data, {.systems = systems, .messages = {a}}),
             second = make_broadcast(data, {.systems = systems, .messages = {b}});
  std::vector<double> out;
  for (double s = 450.0; s < 86400.0; s += 900.0)
    for (const SatelliteId sv : first->satellites()) {
      const auto p = first->state(sv, day + s), q = second->state(sv, day + s);
      if (p && q) out.push_back((p->p_E - q->p_E).norm());
    }
  return out;
}

// A whole day of RINEX 4, all systems: messages made independently of the same orbits agree to what each is good for
// (measured RMS: LNAV and CNAV 0.43 m, QZSS 0.05 m, D1 and B-CNAV1 0.07 m; Galileo's are the same fit).
TEST(BroadcastSystems, MessagesOfOneSatelliteAgree) {
  CANYON_REAL_DATA(path, "gnss/rinex4/BRD400DLR_S_20230710000_01D_MN.rnx.gz");
  const auto data = read_navigation_file(path);
  ASSERT_TRUE(data.ok()) << data.error().str();
  EXPECT_TRUE(data->warnings.empty()) << data->warnings.front();
  std::map<std::string, int> counts;
  for (const auto& r : data->kepler) ++counts[std::string(1, system_letter(r.sv.system)) + " " + name_of(r.message)];
  // As grep counts the lines of that kind.
  EXPECT_EQ(counts, (std::map<std::string, int>{{"C CNV1", 634},
                                                {"C CNV2", 926},
                                                {"C D1", 893},
                                                {"C D2", 168},
                                                {"E FNAV", 2897},
                                                {"E INAV", 2943},
                                                {"G CNAV", 334},
                                                {"G LNAV", 428},
                                                {"J CNAV", 98},
                                                {"J CNV2", 98},
                                                {"J LNAV", 96}}));
  EXPECT_EQ(data->glonass.size(), 1240u);
  EXPECT_EQ(data->klobuchar.size(), 3u + 2u + 15u + 47u + 47u);
  EXPECT_EQ(data->skipped_records, (std::map<std::string, int>{{"EOP C CNVX", 2},
                                                               {"EOP G CNVX", 4},
                                                               {"EOP I LNAV", 1},
                                                               {"EOP J CNVX", 25},
                                                               {"EPH I LNAV", 283},
                                                               {"EPH S SBAS", 9072},
                                                               {"ION C CNVX", 12},
                                                               {"ION E IFNV", 2},
                                                               {"ION I LNAV", 2},
                                                               {"STO C CNVX", 96},
                                                               {"STO C D1D2", 6},
                                                               {"STO E IFNV", 2},
                                                               {"STO G CNVX", 4},
                                                               {"STO G LNAV", 4},
                                                               {"STO I LNAV", 4},
                                                               {"STO J CNVX", 2},
                                                               {"STO R FDMA", 8}}));

  const GpsTime day = GpsTime::from_calendar(2023, 3, 12, 0, 0, 0.0);
  const auto check = [&](const char* system, Message a, Message b, std::size_t at_least, double limit_m) {
    const auto away = distances(*data, system, a, b, day);
    EXPECT_GE(away.size(), at_least) << name_of(a) << " " << name_of(b);
    EXPECT_LT(rms(away), limit_m) << name_of(a) << " " << name_of(b);
  };
  check("G", Message::kLnav, Message::kCnav, 2000, 1.0);
  check("J", Message::kLnav, Message::kCnav, 300, 0.2);
  check("J", Message::kCnav2, Message::kCnav, 300, 0.01);
  check("E", Message::kInav, Message::kFnav, 2000, 0.01);
  check("C", Message::kD1, Message::kBcnav1, 2000, 0.2);
  check("C", Message::kBcnav2, Message::kBcnav1, 2000, 0.05);

  // Clocks of users of E1 alone: I/NAV with BGD(E1, E5b), F/NAV with BGD(E1, E5a).
  const auto inav = make_broadcast(*data, {.systems = "E", .messages = {Message::kInav}}),
             fnav = make_broadcast(*data, {.systems = "E", .messages = {Message::kFnav}});
  std::vector<double> clocks_m;
  for (double s = 450.0; s < 86400.0; s += 900.0)
    for (const SatelliteId sv : inav->satellites()) {
      const auto p = inav->state(sv, day + s), q = fnav->state(sv, day + s);
      if (p && q) clocks_m.push_back(kSpeedOfLight * (p->clock_of_band_s(1) - q->clock_of_band_s(1)));
    }
  EXPECT_LT(rms(clocks_m), 0.3);  // measured 0.22 m; without the delays 0.27 m

  const auto beidou = make_broadcast(*data, {.systems = "C"});
  int geostationary_satellites = 0;
  for (const SatelliteId sv : beidou->satellites()) {
    if (sv.prn > 5 && sv.prn < 59) continue;
    ++geostationary_satellites;
    std::vector<double> longitudes;
    for (double s = 0.0; s < 86400.0; s += 900.0)
      if (const auto state = beidou->state(sv, day + s)) {
        const Geodetic g = geodetic_from_ecef(state->p_E);
        longitudes.push_back(g.lon_rad / kDegree);
        EXPECT_LT(std::abs(g.lat_rad), 2.5 * kDegree) << sv.str();
        EXPECT_LT(state->v_E.norm(), 130.0) << sv.str();
      }
    const auto [low, high] = std::minmax_element(longitudes.begin(), longitudes.end());
    EXPECT_LT(*high - *low, 1.0) << sv.str();
  }
  EXPECT_EQ(geostationary_satellites, 7);
}

}  // namespace
}  // namespace canyon::gnss
