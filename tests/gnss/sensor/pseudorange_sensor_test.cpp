#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "canyon/core/units.h"
#include "canyon/gnss/signal.h"
#include "canyon/tests/gnss/sensor/pseudorange_sensor_fixture.h"

namespace canyon::gnss {
namespace {

using testing::errors_off;
using testing::open_sky;
using testing::PseudorangeSensorTest;
using testing::WallScene;

TEST_F(PseudorangeSensorTest, WithoutErrorsTheFixIsTheTruth) {
  for (const char* clock : {"none", "tcxo"}) {
    GnssConfig c = errors_off();
    c.receiver_clock.name = clock;
    const auto sensor = make(c);
    for (const std::int64_t k : {0, 1, 100, 100000}) {
      const GnssOutput out = measure(*sensor, k);
      ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
      // 1 ns of time resolution moves a satellite by 4e-6 m; times the DOP.
      EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-4) << clock << " " << k;
      EXPECT_NEAR(out.fix.clock_m, out.truth.receiver_clock_m, 1e-4);
      EXPECT_EQ(out.fix.t, out.truth.t);
      EXPECT_NEAR(out.epoch.t - out.fix.t, out.truth.receiver_clock_m / kSpeedOfLight, 1e-9);
    }
  }
}

TEST_F(PseudorangeSensorTest, TrilaterationWithoutErrorsIsTheTruth) {
  GnssConfig c = errors_off();
  c.position.solver.name = "trilateration";
  c.receiver_clock.name = "none";
  const GnssOutput out = measure(*make(c), 7);
  ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
  EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-4);
  EXPECT_TRUE(std::isnan(out.fix.clock_m));
}

// The truth record accounts for every metre of every pseudorange, in every mode.
TEST_F(PseudorangeSensorTest, ErrorsOfTheTruthRecordAddUp) {
  for (const char* mode : {"single", "single_uncorrected", "dual", "dual_paper", "dgps", "dgps_paper"}) {
    GnssConfig c;
    c.mode.name = mode;
    c.reception.multipath_rule.name = "correlator";
    c.link.antenna.name = "survey";
    c.link.antenna_phase_centre = true;
    const auto sensor = make(c);
    int checked = 0;
    for (std::int64_t k = 0; k < 20; ++k) {
      const GnssOutput out = measure(*sensor, k);
      std::size_t i = 0;
      for (const auto& truth : out.truth.satellites) {
        if (!truth.tracked) continue;
        const GnssObservation& o = out.epoch.observations[i++];
        ASSERT_EQ(o.sv, truth.sv);
        const double error_m = truth.multipath_m + truth.ionosphere_m + truth.troposphere_m + truth.ephemeris_m +
                               truth.noise_m + truth.base_m + truth.phase_centre_m;
        // eps of 2.5e7 m, and satellites told from the pseudorange: delays of up to 100 m shift them by 0.3 mm along
        // the line.
        EXPECT_NEAR(o.corrected_m() - truth.range_m - out.truth.receiver_clock_m, error_m, 1e-3) << mode << o.sv.str();
        EXPECT_NEAR((o.p_E - out.truth.p_A_E).norm(), truth.range_m,
                    1e-3 + 3e-6 * std::abs(error_m) + 1e-5 * std::abs(truth.multipath_m));
        ++checked;
      }
      EXPECT_EQ(i, out.epoch.observations.size());
    }
    EXPECT_GT(checked, 40) << mode;
  }
}

bool same_bits(const GnssOutput& a, const GnssOutput& b) {
  if (a.epoch.observations.size() != b.epoch.observations.size() || a.fix.status != b.fix.status) return false;
  for (std::size_t i = 0; i < a.epoch.observations.size(); ++i) {
    const GnssObservation &p = a.epoch.observations[i], &q = b.epoch.observations[i];
    if (p.pseudorange_m != q.pseudorange_m || p.carrier_phase_cycles != q.carrier_phase_cycles ||
        p.doppler_hz != q.doppler_hz)
      return false;
  }
  return a.fix.status == FixStatus::kNone || a.fix.p_A_E == b.fix.p_A_E;
}

// The contract of GnssSensor::measure: a sequence repeats to the bit; an epoch measured alone depends on its arguments
// alone, whatever was measured before.
TEST_F(PseudorangeSensorTest, SameSeedSameBits) {
  GnssConfig c;
  c.reception.multipath_rule.name = "correlator";
  const auto a = make(c), b = make(c);
  std::vector<GnssOutput> forward;
  for (std::int64_t k = 0; k < 8; ++k) forward.push_back(measure(*a, k));
  for (std::int64_t k = 0; k < 8; ++k)
    EXPECT_TRUE(same_bits(measure(*b, k), forward[static_cast<std::size_t>(k)])) << k;
  for (std::int64_t k = 7; k >= 0; --k) EXPECT_TRUE(same_bits(measure(*b, k), measure(*make(c), k))) << k;
  // Beginning again is beginning anew.
  for (std::int64_t k = 0; k < 8; ++k)
    EXPECT_TRUE(same_bits(measure(*a, k), forward[static_cast<std::size_t>(k)])) << k;
  const GnssOutput other = measure(*make(c, 2), 3);
  EXPECT_NE(other.epoch.observations[0].pseudorange_m, forward[3].epoch.observations[0].pseudorange_m);
}

// Switching any effect off, or on, leaves the others' draws untouched to the bit.
TEST_F(PseudorangeSensorTest, EffectsDrawFromTheirOwnStreams) {
  const GnssConfig base = open_sky("single");
  const GnssOutput all = measure(*make(base), 5);
  const auto compare = [&](GnssConfig c, const char* what) {
    const GnssOutput out = measure(*make(c), 5);
    ASSERT_EQ(out.truth.satellites.size(), all.truth.satellites.size());
    for (std::size_t i = 0; i < out.truth.satellites.size(); ++i) {
      const auto &got = out.truth.satellites[i], &want = all.truth.satellites[i];
      const std::string off = what;
      if (off != "noise") {
        EXPECT_EQ(got.noise_m, want.noise_m) << what;
      }
      if (off != "ephemeris") {
        EXPECT_EQ(got.ephemeris_m, want.ephemeris_m) << what;
      }
      if (off != "ionosphere") {
        EXPECT_EQ(got.ionosphere_m, want.ionosphere_m) << what;
      }
      // The correction is computed at the receiver's own estimate, which feels every error: 1 hPa or 2 mm at the
      // zenith for 8 m of height.
      if (off != "troposphere") {
        EXPECT_NEAR(got.troposphere_m, want.troposphere_m, 2e-3) << what;
      }
    }
    if (std::string(what) != "clock") {
      EXPECT_EQ(out.truth.receiver_clock_m, all.truth.receiver_clock_m) << what;
    }
  };
  GnssConfig c = base;
  c.tracking.thermal_noise_scale = 0.0;
  compare(c, "noise");
  c = base;
  c.ephemeris_error.name = "none";
  compare(c, "ephemeris");
  c = base;
  c.ionosphere.name = "none";
  compare(c, "ionosphere");
  c = base;
  c.troposphere.name = "none";
  compare(c, "troposphere");
  c = base;
  c.receiver_clock.name = "none";
  compare(c, "clock");
  c = base;
  c.propagation.paths.name = "visibility";  // fewer satellites tracked, the same draws for those that are
  const GnssOutput street = measure(*make(c), 5);
  for (std::size_t i = 0; i < street.truth.satellites.size(); ++i)
    if (street.truth.satellites[i].tracked) {
      EXPECT_EQ(street.truth.satellites[i].ephemeris_m, all.truth.satellites[i].ephemeris_m);
    }
}

TEST_F(PseudorangeSensorTest, OpenSkyAccuracyIsAsClaimed) {
  const auto sensor = make(open_sky("dgps"));
  double worst_m = 0.0;
  for (std::int64_t k = 0; k < 100; ++k) {
    const GnssOutput out = measure(*sensor, k);
    ASSERT_EQ(out.fix.status, FixStatus::kDifferential);
    const Eigen::Vector3d e = out.fix.p_A_E - truth_E();
    // Mahalanobis distance of three degrees of freedom; 5 sigma-equivalent is 32, and the claimed sigma (0.5 m at the
    // zenith) is deliberately not smaller than what acts (0.3 m of noise and 0.2 m of the base's).
    EXPECT_LT(e.dot(out.fix.covariance_E.ldlt().solve(e)), 32.0);
    worst_m = std::max(worst_m, e.norm());
    EXPECT_GT(out.fix.dop.gdop, 1.0);
    EXPECT_NEAR(out.fix.dop.gdop, std::hypot(out.fix.dop.pdop, out.fix.dop.tdop), 1e-9);
    EXPECT_EQ(out.fix.satellites, static_cast<int>(out.epoch.observations.size()));
  }
  EXPECT_GT(worst_m, 0.1);
}

// The poles, the antimeridian, below the sea, high in the air: without errors the fix is the truth everywhere.
TEST_F(PseudorangeSensorTest, AnywhereOnEarth) {
  const double places[][3] = {{90, 0, 0},         {-90, 0, 2800},       {89.9999, 180, 0},
                              {0, 180, 0},        {0, -180, 0},         {-16, 179.99999, 20},
                              {31.5, 35.5, -400}, {27.98, 86.92, 8848}, {32, -90, 20000}};
  for (const auto& p : places) {
    scene = WallScene(Geodetic{p[0] * kDegree, p[1] * kDegree, p[2]}).wall({0, 0, -5}, {1, 0, 0}, {0, 1, 0}).build();
    const auto clean = make(errors_off());
    const auto real = make(open_sky("single"));
    for (const std::int64_t k : {0, 5000, 50000}) {
      const GnssOutput out = measure(*clean, k);
      ASSERT_EQ(out.fix.status, FixStatus::kSingle) << p[0] << " " << p[1] << " " << out.fix.reason;
      EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-4) << p[0] << " " << p[1];
      const GnssOutput noisy = measure(*real, k);
      ASSERT_EQ(noisy.fix.status, FixStatus::kSingle) << p[0] << " " << p[1] << " " << noisy.fix.reason;
      // Five sigma of a range that is uncorrected for half of a 2 m zenith ionosphere, 1 m of orbit and clock, and 0.3
      // m of noise, at 5 deg elevation; weather is carried to the height.
      EXPECT_LT((noisy.fix.p_A_E - truth_E()).norm(), 5.0 * 3.0 * noisy.fix.dop.pdop)
          << p[0] << " " << p[1] << " " << p[2];
    }
  }
}

// A week's rollover, a leap second (end of 2008, 2016), a day's and a year's end: GPS time runs through them all, and
// so do range, carrier and clock.
TEST_F(PseudorangeSensorTest, EpochsAcrossBoundaries) {
  for (const GpsTime boundary :
       {GpsTime::from_week_sow(1612, 0.0), GpsTime::from_week_sow(1024, 0.0), GpsTime::from_week_sow(2048, 0.0),
        GpsTime::from_calendar(2010, 11, 18, 0, 0, 0.0), GpsTime::from_calendar(2009, 1, 1, 0, 0, 15.0),
        GpsTime::from_calendar(2017, 1, 1, 0, 0, 18.0), GpsTime::from_calendar(2012, 2, 29, 0, 0, 0.0)}) {
    GnssConfig c = errors_off();
    const auto sensor = make(c, 1, boundary - 10.0);
    const GpsTime start = boundary - 2.0;
    std::vector<GnssOutput> outs;
    for (std::int64_t k = 0; k < 9; ++k) outs.push_back(measure(*sensor, k, start));
    for (std::size_t k = 0; k < outs.size(); ++k) {
      ASSERT_EQ(outs[k].fix.status, FixStatus::kSingle) << boundary.iso();
      EXPECT_LT((outs[k].fix.p_A_E - truth_E()).norm(), 1e-4) << boundary.iso() << " " << k;
      if (k == 0 || outs[k].truth.satellites.size() != outs[k - 1].truth.satellites.size()) continue;
      for (std::size_t i = 0; i < outs[k].truth.satellites.size(); ++i) {
        // Range rates over half a second; second derivatives are below 0.2 m/s^2.
        const auto &now = outs[k].truth.satellites[i], &before = outs[k - 1].truth.satellites[i];
        EXPECT_NEAR(now.range_m - before.range_m, 0.25 * (now.range_rate_m_s + before.range_rate_m_s), 1e-4);
        EXPECT_EQ(now.ambiguity_cycles, before.ambiguity_cycles);
      }
    }
  }
}

}  // namespace
}  // namespace canyon::gnss
