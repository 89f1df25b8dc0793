#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/gnss/rinex/navigation/navigation_file.h"
#include "canyon/gnss/rinex/navigation/navigation_writer.h"
#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/rinex/observation/observation_writer.h"
#include "canyon/gnss/single_point/single_point.h"
#include "canyon/tests/gnss/rinex/rtklib_runner.h"
#include "canyon/tests/gnss/sensor/synthetic_sky.h"
#include "canyon/tests/support/outside_program.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const Eigen::Vector3d kPlace = ecef_from_geodetic({32.35 * kDegree, -90.88 * kDegree, 60.0});

ObservationWriterOptions all_systems(GpsTime first) {
  ObservationWriterOptions o;
  o.first = first;
  o.interval_s = 30.0;
  o.approx_position_E = kPlace;
  o.bands = {{GnssSystem::kGps, {1, 2}},
             {GnssSystem::kGlonass, {1, 2}},
             {GnssSystem::kGalileo, {1, 5}},
             {GnssSystem::kBeidou, {2, 6}}};
  for (const auto& g : synthetic_navigation().glonass) o.glonass_channels[g.sv.prn] = g.frequency_channel;
  return o;
}

struct Written {
  std::string observations, navigation;
  std::vector<GnssEpoch> epochs;
};

/// Twenty minutes at one place, the receiver clock 12 us fast and drifting.
Written written() {
  const NavigationData data = synthetic_navigation();
  const auto constellation = make_broadcast(data);
  Written out;
  out.navigation = *navigation_file_text(data);
  const GpsTime first = kSyntheticNoon + 60.0;
  const ObservationWriter writer(all_systems(first));
  out.observations = writer.header();
  for (int k = 0; k < 40; ++k) {
    const SyntheticReceiver receiver{*constellation, 5.0, 12e-6 + 1e-9 * k, 1e-9 / 30.0};
    out.epochs.push_back(receiver.at(first + 30.0 * k, kPlace, Eigen::Vector3d::Zero()));
    out.observations += writer.epoch(out.epochs.back());
  }
  return out;
}

TEST(ObservationWriter, WhatIsWrittenIsReadBack) {
  const Written w = written();
  const auto f = parse_observation_file(w.observations, "w.rnx");
  ASSERT_TRUE(f.ok()) << f.error().str();
  EXPECT_THAT(f->warnings, ElementsAre());
  EXPECT_NEAR((*f->header.approx_position_E - kPlace).norm(), 0.0, 1e-4);
  EXPECT_EQ(f->header.glonass_channels.size(), 18u);
  EXPECT_EQ(f->header.glonass_channels.at(1), -6);
  ASSERT_EQ(f->epochs.size(), w.epochs.size());
  for (std::size_t k = 0; k < w.epochs.size(); ++k) {
    EXPECT_NEAR(f->epochs[k].t - w.epochs[k].t, 0.0, 51e-9);  // half of the tag's 100 ns
    ASSERT_EQ(f->epochs[k].satellites.size(), w.epochs[k].observations.size());
    for (std::size_t i = 0; i < w.epochs[k].observations.size(); ++i) {
      const auto& o = w.epochs[k].observations[i];
      const auto& s = f->epochs[k].satellites[i];
      ASSERT_EQ(s.sv, o.sv);
      ASSERT_EQ(s.values.size(), 8u);
      // Half of the last digit, and the rounding of numbers of up to 1.4e8.
      EXPECT_NEAR(s.values[0].value, o.pseudorange_m, 0.0005001);
      EXPECT_NEAR(s.values[1].value, o.carrier_phase_cycles, 0.0005001);
      EXPECT_NEAR(s.values[2].value, o.doppler_hz, 0.0005001);
      EXPECT_EQ(s.values[3].value, 45.0);
      EXPECT_EQ(s.values[0].strength, 7);
      EXPECT_NEAR(s.values[4].value, o.second.pseudorange_m, 0.0005001);
    }
  }
}

TEST(ObservationWriter, HeaderAndRowsWordForWord) {
  ObservationWriterOptions o;
  o.marker = "HERE";
  o.first = GpsTime::from_calendar(2020, 6, 25, 12, 0, 0);
  o.bands = {{GnssSystem::kGps, {1, 2, 5}}, {GnssSystem::kGlonass, {1}}};
  o.glonass_channels = {{1, 1}, {2, -4}};
  const ObservationWriter writer(o);
  const std::string header = writer.header();
  EXPECT_THAT(header, HasSubstr("     3.04           OBSERVATION DATA    M: MIXED            RINEX VERSION / TYPE\n"));
  EXPECT_THAT(header, HasSubstr("G   12 C1C L1C D1C S1C C2L L2L D2L S2L C5Q L5Q D5Q S5Q      SYS / # / OBS TYPES\n"));
  EXPECT_THAT(header, HasSubstr("R    4 C1C L1C D1C S1C                                      SYS / # / OBS TYPES\n"));
  EXPECT_THAT(header, HasSubstr("  2020     6    25    12     0    0.0000000     GPS         TIME OF FIRST OBS\n"));
  EXPECT_THAT(header, HasSubstr("  2 R01  1 R02 -4                                           GLONASS SLOT / FRQ #\n"));
  for (std::size_t at = 0; at < header.size(); at = header.find('\n', at) + 1)
    EXPECT_LE(header.find('\n', at) - at, 80u);

  GnssEpoch epoch;
  epoch.t = o.first + 0.25;
  GnssObservation a;
  a.sv = {GnssSystem::kGps, 5};
  a.pseudorange_m = 20000000.1234;
  a.carrier_phase_cycles = -1.5;
  a.slipped = true;
  a.cn0_dbhz = 38.25;
  GnssObservation b;
  b.sv = {GnssSystem::kGalileo, 5};  // of a system that is not written
  epoch.observations = {a, b};
  EXPECT_EQ(writer.epoch(epoch),
            "> 2020 06 25 12 00  0.2500000  0  1\n"
            "G05  20000000.123 6        -1.50016                        38.250\n");
}

TEST(NavigationWriter, WhatIsWrittenIsReadBack) {
  const NavigationData data = synthetic_navigation();
  const std::string text = *navigation_file_text(data);
  const auto back = parse_navigation_file(text, "w.nav");
  ASSERT_TRUE(back.ok()) << back.error().str();
  EXPECT_THAT(back->warnings, ElementsAre());
  EXPECT_EQ(back->kepler.size(), data.kepler.size());
  EXPECT_EQ(back->glonass.size(), data.glonass.size());
  EXPECT_EQ(back->leap_seconds, 18);
  ASSERT_EQ(back->klobuchar.size(), 1u);
  EXPECT_EQ(back->klobuchar[0].coefficients.alpha, kBuiltInKlobuchar.alpha);
  const auto before = make_broadcast(data), after = make_broadcast(*back);
  ASSERT_EQ(before->satellites(), after->satellites());
  for (const SatelliteId sv : before->satellites())
    for (const double s : {-600.0, 0.0, 900.0}) {
      const auto a = before->state(sv, kSyntheticNoon + s), b = after->state(sv, kSyntheticNoon + s);
      ASSERT_TRUE(a && b) << sv.str();
      EXPECT_LT((a->p_E - b->p_E).norm(), 1e-4) << sv.str();  // 13 digits
      EXPECT_NEAR(a->clock_s, b->clock_s, 1e-15);
      for (int band = 1; band < 9; ++band) EXPECT_NEAR(a->clock_of_band_s(band), b->clock_of_band_s(band), 1e-15);
      EXPECT_EQ(a->frequency_channel, b->frequency_channel);
      EXPECT_EQ(a->accuracy_m == a->accuracy_m, b->accuracy_m == b->accuracy_m);
    }
}

TEST(NavigationWriter, RealDayOfAllSystems) {
  CANYON_REAL_DATA(path, "gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_MN.rnx.gz");
  const auto data = read_navigation_file(path);
  ASSERT_TRUE(data.ok());
  const auto back = parse_navigation_file(*navigation_file_text(*data), "w.nav");
  ASSERT_TRUE(back.ok()) << back.error().str();
  EXPECT_THAT(back->warnings, ElementsAre());
  EXPECT_EQ(back->kepler.size(), data->kepler.size());
  EXPECT_EQ(back->glonass.size(), data->glonass.size());
  const auto before = make_broadcast(*data), after = make_broadcast(*back);
  int compared = 0;
  for (const SatelliteId sv : before->satellites())
    for (int hour = 0; hour < 24; ++hour) {
      const GpsTime t = GpsTime::from_calendar(2020, 6, 25, hour, 10, 0);
      const auto a = before->state(sv, t), b = after->state(sv, t);
      ASSERT_EQ(a.has_value(), b.has_value()) << sv.str() << " " << t.iso();
      if (!a) continue;
      ++compared;
      EXPECT_LT((a->p_E - b->p_E).norm(), 1e-4) << sv.str() << " " << t.iso();
      EXPECT_NEAR(a->clock_s, b->clock_s, 1e-15);
    }
  EXPECT_GT(compared, 500);
}

SinglePointConfig without_atmosphere(const char* systems) {
  SinglePointConfig c;
  c.systems = systems;
  c.ionosphere = IonosphereCorrection::kNone;
  c.troposphere = "none";
  c.smoothing_s = c.shared_ionosphere = 0.0;
  return c;
}

// Rounding of the file: 0.5 mm a range, 50 ns a time tag at 1 km/s (0.05 mm), times a PDOP of at most 3.
TEST(WrittenFiles, OurOwnSolverFindsThePlace) {
  const Written w = written();
  const auto observations = parse_observation_file(w.observations, "w.rnx");
  const auto navigation = parse_navigation_file(w.navigation, "w.nav");
  ASSERT_TRUE(observations.ok() && navigation.ok());
  const auto constellation = make_broadcast(*navigation);
  for (const char* systems : {"G", "GR", "GE", "GC", "GREC", "E"})
    for (const Frequencies frequencies : {Frequencies::kSingle, Frequencies::kDual}) {
      auto config = without_atmosphere(systems);
      config.frequencies = frequencies;
      const auto r = solve_observations(*observations, {*constellation, *navigation}, config);
      ASSERT_TRUE(r.ok()) << r.error().str();
      ASSERT_EQ(r->solved(), 40) << systems;
      for (const auto& e : r->epochs) {
        EXPECT_LT((e.fix.p_A_E - kPlace).norm(),
                  0.001 * (config.frequencies == Frequencies::kDual ? 3.0 : 1.0) * e.fix.dop.pdop)
            << systems << (frequencies == Frequencies::kDual ? " dual" : " single");
        EXPECT_EQ(e.excluded, 0);
      }
    }
}

// A stranger: RTKLIB's single point positioning of the same files, all errors but clocks, group delays and Sagnac off.
TEST(WrittenFiles, RnxToRtkpFindsThePlace) {
  CANYON_OUTSIDE_PROGRAM("rnx2rtkp");
  const canyon::testing::ScratchDirectory scratch;
  const Written w = written();
  ASSERT_TRUE(write_text_file(scratch.file("w.rnx"), w.observations).ok());
  ASSERT_TRUE(write_text_file(scratch.file("w.nav"), w.navigation).ok());
  for (const int systems : {1, 1 + 4, 1 + 8, 1 + 32, 45}) {
    const auto positions =
        rtklib_positions(scratch.file("w.rnx"), scratch.file("w.nav"), systems, false, scratch.file("s"));
    EXPECT_EQ(positions.size(), 40u) << systems;
    for (const auto& [ns, p_E] : positions) EXPECT_LT((p_E - kPlace).norm(), 0.05) << systems;
  }
}

}  // namespace
}  // namespace canyon::gnss
