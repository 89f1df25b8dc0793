#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "core/chi_square.h"
#include "core/files.h"
#include "core/units.h"
#include "gnss/pseudorange_parts.h"
#include "gnss/receiver/receiver_mode.h"
#include "gnss/sensor.h"
#include "gnss/signal.h"
#include "scene/scene_at.h"
#include "tests/gnss/nav_text.h"
#include "tests/gnss/wall_scene.h"
#include "tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using ::testing::HasSubstr;
using testing::WallScene;

const GpsTime kStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

/// Every error off, clocks and Earth rotation on.
GnssConfig errors_off() {
  GnssConfig c;
  c.mode = "single_uncorrected";
  c.ionosphere = c.troposphere = c.ephemeris_error = "none";
  c.paths = c.multipath_rule = "none";
  c.thermal_noise_scale = 0.0;
  c.mask_deg = 5.0;
  return c;
}

/// Errors on, open sky.
GnssConfig open_sky(const std::string& mode) {
  GnssConfig c;
  c.mode = mode;
  c.paths = c.multipath_rule = "none";
  return c;
}

class PseudorangeSensorTest : public ::testing::Test {
 protected:
  std::unique_ptr<GnssSensor> make(const GnssConfig& config, std::uint64_t seed = 1, GpsTime start = kStart) {
    auto sensor = make_gnss_sensor(config, seed, start, start + 480.0, *scene);
    EXPECT_TRUE(sensor.ok()) << sensor.error().str();
    return *std::move(sensor);
  }
  std::string error_of(const GnssConfig& config) {
    const auto sensor = make_gnss_sensor(config, 1, kStart, kStart + 480.0, *scene);
    return sensor.ok() ? "no error" : sensor.error().str();
  }
  GnssOutput measure(GnssSensor& sensor, std::int64_t index, GpsTime start = kStart) {
    return sensor.measure(index, start + 0.5 * static_cast<double>(index), antenna_W, still, scene::SceneAt(*scene));
  }
  Eigen::Vector3d truth_E() const { return scene->frame().to_E(antenna_W); }

  // A street canyon: walls 12 m to the west and 9 m to the east, open to north and south.
  std::unique_ptr<scene::Scene> scene =
      WallScene().box({-60, -300, 0}, {-12, 300, 30}).box({9, -300, 0}, {60, 300, 18}, "glass").build();
  Eigen::Vector3d antenna_W{0, 0, 2}, still = Eigen::Vector3d::Zero();
};

TEST_F(PseudorangeSensorTest, WithoutErrorsTheFixIsTheTruth) {
  for (const char* clock : {"none", "tcxo"}) {
    GnssConfig c = errors_off();
    c.receiver_clock = clock;
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
  c.solver = "trilateration";
  c.receiver_clock = "none";
  const GnssOutput out = measure(*make(c), 7);
  ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
  EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-4);
  EXPECT_TRUE(std::isnan(out.fix.clock_m));
}

// The truth record accounts for every metre of every pseudorange, in every mode.
TEST_F(PseudorangeSensorTest, ErrorsOfTheTruthRecordAddUp) {
  for (const char* mode : {"single", "single_uncorrected", "dual", "dual_paper", "dgps", "dgps_paper"}) {
    GnssConfig c;
    c.mode = mode;
    c.multipath_rule = "correlator";
    c.antenna = "survey";
    c.antenna_phase_centre = true;
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
  c.multipath_rule = "correlator";
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

// Doppler and carrier against differences of what they stand for: the true range's derivative, and the pseudorange.
TEST_F(PseudorangeSensorTest, DopplerIsTheRateOfTheRange) {
  GnssConfig c = errors_off();
  c.thermal_noise_scale = 0.0;
  const auto sensor = make(c);
  const Eigen::Vector3d v_W{11.0, -7.0, 0.5};
  const double dt_s = 0.5;
  const auto at = [&](std::int64_t k) {
    return make(c)->measure(5, kStart + dt_s * static_cast<double>(k),
                            antenna_W + v_W * (dt_s * static_cast<double>(k)), v_W, scene::SceneAt(*scene));
  };
  const GnssOutput before = at(-1), now = at(0), after = at(1);
  ASSERT_EQ(before.truth.satellites.size(), after.truth.satellites.size());
  for (std::size_t i = 0; i < now.truth.satellites.size(); ++i) {
    const auto& s = now.truth.satellites[i];
    // Central difference over 1 s: the third derivative of the range, below 2e-4 m/s^3, leaves 2e-4 / 24.
    EXPECT_NEAR(s.range_rate_m_s, after.truth.satellites[i].range_m - before.truth.satellites[i].range_m, 1e-5);
    const double rate_m_s = s.range_rate_m_s + now.truth.receiver_clock_rate_m_s;
    EXPECT_NEAR(now.epoch.observations[i].doppler_hz, -rate_m_s / kL1WavelengthM, 1e-9);
  }
}

// Without noise the velocity fix is the truth; with it, within 5 sigma of what it claims (Mahalanobis distance of three
// degrees of freedom, 32 at 5 sigma).
TEST_F(PseudorangeSensorTest, VelocityFromDoppler) {
  const Eigen::Vector3d v_W{11.0, -7.0, 0.5};
  const auto at = [&](const GnssConfig& c, std::int64_t k) {
    return make(c)->measure(k, kStart + 0.5 * static_cast<double>(k), antenna_W, v_W, scene::SceneAt(*scene));
  };
  const GnssOutput clean = at(errors_off(), 3);
  EXPECT_LT((clean.fix.v_A_E - scene->frame().R_EW() * v_W).norm(), 1e-4);
  EXPECT_EQ(clean.truth.v_A_E, scene->frame().R_EW() * v_W);
  for (std::int64_t k = 0; k < 50; ++k) {
    const GnssOutput noisy = at(open_sky("dgps"), k);
    const Eigen::Vector3d e = noisy.fix.v_A_E - noisy.truth.v_A_E;
    EXPECT_LT(e.dot(noisy.fix.velocity_covariance_E.ldlt().solve(e)), 32.0) << e.transpose();
    EXPECT_GT(e.norm(), 1e-4);
  }
}

TEST_F(PseudorangeSensorTest, CarrierFollowsTheRangeWithTheIonosphereReversed) {
  GnssConfig c = open_sky("single");
  const auto sensor = make(c);
  std::vector<double> ambiguity;
  for (std::int64_t k = 0; k < 20; ++k) {
    const GnssOutput out = measure(*sensor, k);
    for (std::size_t i = 0; i < out.epoch.observations.size(); ++i) {
      const auto& o = out.epoch.observations[i];
      const auto& s = out.truth.satellites[i];
      const double carrier_m = kL1WavelengthM * (o.carrier_phase_cycles - s.ambiguity_cycles);
      // 2 mm of noise at 38 dB-Hz, 5 sigma; open sky has no slips.
      EXPECT_NEAR(o.pseudorange_m - s.noise_m - carrier_m, 2.0 * s.ionosphere_delay_m, 0.01);
      EXPECT_EQ(o.slipped, k == 0);
      EXPECT_EQ(s.ambiguity_cycles, std::floor(s.ambiguity_cycles));
      if (k == 0)
        ambiguity.push_back(s.ambiguity_cycles);
      else
        EXPECT_EQ(s.ambiguity_cycles, ambiguity[i]);
    }
  }
}

// The ionosphere-free combination: no ionosphere whatever its size, and the noise of both frequencies amplified,
// sqrt(2.546^2 + 1.546^2) = 2.978 for L1 and L2 of equal noise, sqrt(2.261^2 + 1.261^2) = 2.588 for L5 of equal noise.
TEST_F(PseudorangeSensorTest, DualFrequencyRemovesTheIonosphereAndAmplifiesNoise) {
  GnssConfig c = open_sky("dual");
  c.troposphere = c.ephemeris_error = "none";
  c.vtec_tecu = 100.0;
  c.thermal_noise_scale = 0.0;
  EXPECT_LT((measure(*make(c), 4).fix.p_A_E - truth_E()).norm(), 1e-4);
  c.thermal_noise_scale = 1.0;
  const auto dual = make(c);
  c.mode = "single";
  const auto single = make(c);
  double both = 0.0, one = 0.0;
  int n = 0;
  for (std::int64_t k = 0; k < 40000; k += 100) {
    const GnssOutput d = measure(*dual, k), s = measure(*single, k);
    for (std::size_t i = 0; i < d.truth.satellites.size(); ++i) {
      const auto& truth = d.truth.satellites[i];
      const auto& o = d.epoch.observations[i];
      EXPECT_EQ(o.second.band, 2);
      EXPECT_NEAR(truth.ionosphere_m, 0.0, 1e-6);
      EXPECT_GT(truth.ionosphere_delay_m, 16.0);
      EXPECT_EQ(o.pseudorange_m, s.epoch.observations[i].pseudorange_m);  // the first frequency is untouched
      both += truth.noise_m * truth.noise_m;
      one += std::pow(s.truth.satellites[i].noise_m, 2);
      ++n;
    }
  }
  EXPECT_NEAR(std::sqrt(both / one), 2.978, 5.0 * 2.978 / std::sqrt(n));
}

TEST_F(PseudorangeSensorTest, SecondFrequencies) {
  EXPECT_EQ(error_of([] {
              GnssConfig c;
              c.mode = "dual";
              c.second_frequency = "L5";
              return c;
            }()),
            "no error");
  // B3I, which every BeiDou satellite sends; B2I is of BeiDou-2 alone.
  EXPECT_EQ(second_band(GnssSystem::kBeidou, "L2"), 6);
  EXPECT_EQ(second_band(GnssSystem::kBeidou, "L5"), 5);
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
  c.thermal_noise_scale = 0.0;
  compare(c, "noise");
  c = base;
  c.ephemeris_error = "none";
  compare(c, "ephemeris");
  c = base;
  c.ionosphere = "none";
  compare(c, "ionosphere");
  c = base;
  c.troposphere = "none";
  compare(c, "troposphere");
  c = base;
  c.receiver_clock = "none";
  compare(c, "clock");
  c = base;
  c.paths = "visibility";  // fewer satellites tracked, the same draws for those that are
  const GnssOutput street = measure(*make(c), 5);
  for (std::size_t i = 0; i < street.truth.satellites.size(); ++i)
    if (street.truth.satellites[i].tracked) {
      EXPECT_EQ(street.truth.satellites[i].ephemeris_m, all.truth.satellites[i].ephemeris_m);
    }
}

TEST_F(PseudorangeSensorTest, ModesLeaveWhatTheySay) {
  const GnssOutput raw = measure(*make(open_sky("single_uncorrected")), 3),
                   single = measure(*make(open_sky("single")), 3), dgps = measure(*make(open_sky("dgps")), 3),
                   paper = measure(*make(open_sky("dgps_paper")), 3);
  ASSERT_GE(raw.truth.satellites.size(), 5u);
  for (std::size_t i = 0; i < raw.truth.satellites.size(); ++i) {
    const auto &r = raw.truth.satellites[i], &s = single.truth.satellites[i], &d = dgps.truth.satellites[i],
               &p = paper.truth.satellites[i];
    EXPECT_GT(r.ionosphere_m, 1.9);
    EXPECT_GT(r.troposphere_m, 2.4);
    EXPECT_DOUBLE_EQ(s.ionosphere_m, 0.5 * r.ionosphere_m);
    EXPECT_LT(std::abs(s.troposphere_m), 0.1 * r.troposphere_m);
    EXPECT_EQ(s.ephemeris_m, r.ephemeris_m);
    // 5 km of baseline: 2 mm/km x 5 km x obliquity 3 x 4 sigma; orbit x 5 km / 20,000 km.
    EXPECT_LT(std::abs(d.ionosphere_m), 4 * 0.010 * 3.1);
    EXPECT_LT(std::abs(d.troposphere_m), 4 * 0.005 * 6.0);
    EXPECT_NEAR(d.ephemeris_m, r.ephemeris_m * 5e3 / r.range_m, 1e-9);
    EXPECT_NE(d.ionosphere_m, 0.0);
    EXPECT_EQ(d.noise_m, r.noise_m);
    EXPECT_NE(d.base_m, 0.0);  // the base's own error comes with its correction
    EXPECT_EQ(p.ionosphere_m, 0.0);
    EXPECT_EQ(p.ephemeris_m, 0.0);
    EXPECT_EQ(p.troposphere_m, r.troposphere_m);
  }
  EXPECT_EQ(raw.fix.status, FixStatus::kSingle);
  EXPECT_EQ(dgps.fix.status, FixStatus::kDifferential);
  EXPECT_EQ(paper.fix.status, FixStatus::kDifferential);
}

TEST_F(PseudorangeSensorTest, DgpsResidualsGrowWithTheBaseline) {
  GnssConfig c = open_sky("dgps");
  c.base_error_scale = 0.0;
  c.thermal_noise_scale = 0.0;
  const auto error_at = [&](double baseline_km) {
    c.baseline_km = baseline_km;
    const auto sensor = make(c);
    return (measure(*sensor, 1).fix.p_A_E - truth_E()).norm();
  };
  EXPECT_LT(error_at(0.0), 1e-4);
  const double near_m = error_at(5.0);
  EXPECT_GT(near_m, 1e-3);
  EXPECT_NEAR(error_at(50.0), 10.0 * near_m, 1e-2 * 10.0 * near_m);  // linear, but for the curvature of the ranges
}

// Mean square of the code noise at 45 dB-Hz everywhere against the loop formula, epochs 20 s apart so that they are
// independent: B = 0.13 Hz forgets within 2 s.
TEST_F(PseudorangeSensorTest, CodeNoiseHasItsSigma) {
  GnssConfig c = errors_off();
  c.thermal_noise_scale = 1.0;
  c.antenna = "isotropic";
  const auto sensor = make(c);
  double sum = 0.0;
  int n = 0;
  for (std::int64_t k = 0; k < 16000; k += 40) {
    for (const auto& s : measure(*sensor, k).truth.satellites) {
      sum += s.noise_m * s.noise_m;
      ++n;
    }
  }
  const double cn0_hz = std::pow(10.0, 4.5), T = 0.02, B = 0.13, d = 0.5;
  const double variance =
      kCaChipM * kCaChipM * B * (1 - 0.5 * B * T) * d / (2 * cn0_hz) * (1 + 2 / (T * cn0_hz * (2 - d)));
  EXPECT_NEAR(std::sqrt(variance), 0.3, 0.005);
  EXPECT_NEAR(sum / n, variance, 5.0 * std::sqrt(2.0 / n) * variance);
}

TEST_F(PseudorangeSensorTest, StreetCanyonBlocksAndReflects) {
  GnssConfig c;
  c.multipath_rule = "correlator";
  const auto sensor = make(c);
  int blocked = 0, reflected = 0, nlos = 0;
  double worst_m = 0.0;
  for (std::int64_t k = 0; k < 1000; k += 10) {
    const GnssOutput out = measure(*sensor, k);
    for (const auto& s : out.truth.satellites) {
      blocked += s.line_of_sight ? 0 : 1;
      reflected += s.reflections > 0 ? 1 : 0;
      nlos += !s.line_of_sight && s.tracked ? 1 : 0;
      worst_m = std::max(worst_m, std::abs(s.multipath_m));
      if (!s.line_of_sight && s.tracked) {
        EXPECT_GT(s.multipath_m, 0.0);
      }
      if (!s.tracked) {
        EXPECT_EQ(s.multipath_m, 0.0);
      }
    }
  }
  EXPECT_GT(blocked, 0);
  EXPECT_GT(reflected, 0);
  EXPECT_GT(nlos, 0);
  EXPECT_GT(worst_m, 0.1);
  const GnssCounters counters = sensor->counters();
  EXPECT_EQ(counters.epochs, 100);
  EXPECT_GT(counters.occlusion_rays, 0);
  EXPECT_GT(counters.facets_tested, 0);
  EXPECT_GT(counters.reflected_paths, 0);
}

// The coupling cut: with every surface absorbing, reflections and multipath vanish and only blockage stays.
TEST_F(PseudorangeSensorTest, AbsorbingWallsLeaveNoMultipath) {
  scene =
      WallScene().box({-60, -300, 0}, {-12, 300, 30}, "absorber").box({9, -300, 0}, {60, 300, 18}, "absorber").build();
  for (const char* rule : {"paper_first_return", "correlator"}) {
    GnssConfig c;
    c.multipath_rule = rule;
    const auto sensor = make(c);
    int blocked = 0;
    for (std::int64_t k = 0; k < 500; k += 25) {
      for (const auto& s : measure(*sensor, k).truth.satellites) {
        EXPECT_EQ(s.reflections, 0);
        EXPECT_EQ(s.multipath_m, 0.0);
        EXPECT_EQ(s.tracked, s.line_of_sight);  // epochs measured one by one: nothing is being reacquired
        blocked += s.line_of_sight ? 0 : 1;
      }
    }
    EXPECT_GT(blocked, 0);
    EXPECT_EQ(sensor->counters().reflected_paths, 0);
  }
}

TEST_F(PseudorangeSensorTest, InsideABuildingThereIsNoFix) {
  antenna_W = {-30, 0, 5};
  const GnssOutput out = measure(*make(GnssConfig{}), 0);
  EXPECT_EQ(out.fix.status, FixStatus::kNone);
  EXPECT_EQ(out.fix.reason, "0 satellites, a fix needs 4");
  EXPECT_TRUE(out.epoch.observations.empty());
  EXPECT_GE(out.truth.satellites.size(), 5u);
}

TEST_F(PseudorangeSensorTest, FewSatellitesAreAStatusAndStillObserved) {
  GnssConfig c = errors_off();
  c.mask_deg = 45.0;
  const auto sensor = make(c);
  bool seen = false;
  for (std::int64_t k = 0; k < 200000 && !seen; k += 400) {
    const GnssOutput out = measure(*sensor, k);
    const std::size_t n = out.epoch.observations.size();
    if (n != 3) continue;
    seen = true;
    EXPECT_EQ(out.fix.status, FixStatus::kNone);
    EXPECT_EQ(out.fix.reason, "3 satellites, a fix needs 4");
    for (std::size_t i = 0; i < n; ++i) {
      const auto& o = out.epoch.observations[i];
      EXPECT_FALSE(o.used);
      EXPECT_GT(o.sigma_m, 0.0);
      // A tightly coupled filter can use them all the same: the satellite is known to centimetres even without a fix.
      EXPECT_NEAR((o.p_E - truth_E()).norm(), out.truth.satellites[i].range_m, 0.02);
      EXPECT_TRUE(o.v_E.allFinite());
    }
  }
  EXPECT_TRUE(seen);
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

TEST_F(PseudorangeSensorTest, NavigationFileFromDisk) {
  const GpsTime day = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);
  const std::string path = ::testing::TempDir() + "canyon_sensor_test.10n";
  std::string text = testing::navigation_text(day, 31, 3, false);
  text.resize(text.size() - 100);
  ASSERT_TRUE(write_text_file(path, text).ok());
  GnssConfig c = errors_off();
  c.nav_file = path;
  const auto sensor = make(c, 1, day);
  for (const std::int64_t k : {0, 60, 960}) {
    const GnssOutput out = measure(*sensor, k, day);
    ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
    EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-4);
    for (const auto& o : out.epoch.observations) EXPECT_NE(o.clock_m, 0.0);
  }
  ASSERT_EQ(sensor->warnings().size(), 1u);
  EXPECT_THAT(sensor->warnings()[0], HasSubstr("G31: the record has 7 lines, expected 8; skipped"));
  EXPECT_THAT(
      error_of(c),
      HasSubstr(": gnss.nav_file: covers 2010-06-30T22:00:00 to 2010-07-01T06:00:00 GPS time, not the mission's"));
  std::remove(path.c_str());
  EXPECT_THAT(error_of(c), HasSubstr("canyon_sensor_test.10n"));
}

// Satellites fade out one by one, each when its light time puts the transmission past the fit interval; clocks are off
// by up to 0.3 ms, so that for moments the truth still has an ephemeris and the receiver none.
TEST_F(PseudorangeSensorTest, EphemeridesExpireGracefully) {
  const GpsTime day = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);
  const std::string path = ::testing::TempDir() + "canyon_expiry_test.10n";
  ASSERT_TRUE(write_text_file(path, testing::navigation_text(day, 31, 1, false)).ok());
  GnssConfig c = errors_off();
  c.nav_file = path;
  const auto sensor = make(c, 1, day);
  std::size_t before = 99;
  for (double dt_s = 0.060; dt_s < 0.095; dt_s += 2e-5) {
    const auto out = sensor->measure(0, day + (7200.0 + dt_s), antenna_W, still, scene::SceneAt(*scene));
    EXPECT_LE(out.epoch.observations.size(), before);
    before = out.epoch.observations.size();
  }
  EXPECT_EQ(before, 0u);
  std::remove(path.c_str());
}

TEST_F(PseudorangeSensorTest, RealNavigationFile) {
  CANYON_REAL_DATA(path, "gnss/orbit_2010_182/brdc1820.10n");
  const GpsTime start = GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.0);
  GnssConfig c = errors_off();
  c.nav_file = path;
  const auto sensor = make(c, 1, start);
  std::set<std::size_t> counts;
  for (std::int64_t k = 0; k <= 960; k += 60) {
    const GnssOutput out = measure(*sensor, k, start);
    ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
    EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-4);
    counts.insert(out.epoch.observations.size());
  }
  EXPECT_GE(*counts.begin(), 6u);  // 30 healthy satellites that day
  EXPECT_LE(*counts.rbegin(), 14u);
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

TEST_F(PseudorangeSensorTest, FaultExclusionMeetsNlos) {
  GnssConfig c;
  c.multipath_rule = "correlator";
  c.raim = "greedy";
  c.weighting = "elevation_cn0";
  const auto with = make(c);
  c.raim = "none";
  const auto without = make(c);
  int excluded = 0;
  for (std::int64_t k = 0; k < 20000; k += 20) {
    const GnssOutput a = measure(*with, k), b = measure(*without, k);
    ASSERT_EQ(a.epoch.observations.size(), b.epoch.observations.size());
    int used = 0;
    for (std::size_t i = 0; i < a.epoch.observations.size(); ++i) {
      EXPECT_EQ(a.epoch.observations[i].pseudorange_m, b.epoch.observations[i].pseudorange_m);
      used += a.epoch.observations[i].used ? 1 : 0;
      if (a.fix.status != FixStatus::kNone && !a.epoch.observations[i].used) ++excluded;
    }
    if (a.fix.status != FixStatus::kNone) {
      EXPECT_EQ(used, a.fix.satellites);
    }
  }
  EXPECT_GT(excluded, 0);
}

// Real broadcasts of five systems at once, each with its own receiver clock, frequencies and modulation.
TEST_F(PseudorangeSensorTest, RealMultiGnss) {
  CANYON_REAL_DATA(path, "gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_MN.rnx.gz");
  scene = WallScene(Geodetic{55.5 * kDegree, 8.46 * kDegree, 60.0}).wall({0, 0, -5}, {1, 0, 0}, {0, 1, 0}).build();
  const GpsTime start = GpsTime::from_calendar(2020, 6, 25, 12, 0, 0.0);
  GnssConfig c = errors_off();
  c.nav_file = path;
  c.systems = "GREC";
  const auto sensor = make(c, 1, start);
  std::set<GnssSystem> systems;
  for (const std::int64_t k : {0, 400, 900}) {
    const GnssOutput out = measure(*sensor, k, start);
    ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
    // GLONASS is integrated numerically by receiver and truth alike.
    EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-3);
    for (const auto& o : out.epoch.observations) {
      systems.insert(o.sv.system);
      EXPECT_TRUE(o.used);
    }
  }
  EXPECT_EQ(systems.size(), 4u);
  c.mode = "dual";
  const GnssOutput dual = measure(*make(c, 1, start), 0, start);
  EXPECT_LT((dual.fix.p_A_E - truth_E()).norm(), 1e-3);
}

// What the broadcast of 1 July 2010 really erred by, on ranges: like the model that was made from it.
TEST_F(PseudorangeSensorTest, RealOrbitErrors) {
  CANYON_REAL_DATA(nav, "gnss/orbit_2010_182/brdc1820.10n");
  CANYON_REAL_DATA(sp3, "gnss/orbit_2010_182/igs15904.sp3");
  CANYON_REAL_DATA(antex, "gnss/antex/igs05.atx.gz");
  const GpsTime start = GpsTime::from_calendar(2010, 7, 1, 4, 0, 0.0);
  GnssConfig c = errors_off();
  c.nav_file = nav;
  c.sp3_files = {sp3};
  c.antex_file = antex;
  c.ephemeris_error = "broadcast_minus_sp3";
  auto sensor = make_gnss_sensor(c, 1, start, start + 14.0 * 3600.0, *scene);
  ASSERT_TRUE(sensor.ok()) << sensor.error().str();
  double square = 0.0;
  int n = 0;
  for (std::int64_t k = 0; k < 56; ++k) {
    const GnssOutput out =
        (*sensor)->measure(k, start + 900.0 * static_cast<double>(k), antenna_W, still, scene::SceneAt(*scene));
    double mean_m = 0.0;
    for (const auto& s : out.truth.satellites)
      mean_m += s.ephemeris_m / static_cast<double>(out.truth.satellites.size());
    for (const auto& s : out.truth.satellites) {
      square += std::pow(s.ephemeris_m - mean_m, 2);  // what is common goes into the receiver's clock
      ++n;
    }
    ASSERT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
    EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 8.0);
  }
  const double rms_m = std::sqrt(square / n);
  RecordProperty("rms_m", std::to_string(rms_m));
  std::printf("broadcast minus SP3 on ranges at Vicksburg, against the epoch's mean: %.2f m RMS of %d\n", rms_m, n);
  EXPECT_GT(rms_m, 0.4);
  EXPECT_LT(rms_m, 1.3);
}

TEST_F(PseudorangeSensorTest, ConfigurationErrorsWordForWord) {
  GnssConfig c;
  c.model = "gps";
  EXPECT_EQ(error_of(c),
            "gnss.model: \"gps\" is not a model, expected pseudorange, truth_plus_isotropic, "
            "truth_plus_white or satellite_count");
  c = GnssConfig{};
  c.ionosphere = "iri";
  EXPECT_EQ(error_of(c),
            "gnss.ionosphere: \"iri\" is not a model, expected none, single_layer, klobuchar, ionex, paper, "
            "paper_printed");
  c = GnssConfig{};
  c.solver = "trilateration";
  EXPECT_EQ(error_of(c),
            "gnss.receiver_clock: is \"tcxo\", but solver \"trilateration\" has no unknown for it, expected \"none\"");
}

TEST_F(PseudorangeSensorTest, SystemsOfTheBuiltInConstellation) {
  GnssConfig c = errors_off();
  c.systems = "GRECJ";
  const GnssOutput out = measure(*make(c), 0);
  std::set<GnssSystem> systems;
  for (const auto& o : out.epoch.observations) systems.insert(o.sv.system);
  EXPECT_GE(systems.size(), 4u);
  EXPECT_LT((out.fix.p_A_E - truth_E()).norm(), 1e-4);
}

TEST_F(PseudorangeSensorTest, IonosphereMaps) {
  GnssConfig c;
  c.ionosphere = "ionex";
  EXPECT_EQ(error_of(c), "gnss.ionosphere: is \"ionex\", but there are no maps, expected gnss.ionex_file");
  CANYON_REAL_DATA(path, "gnss/orbit_2010_182/igrg3380.10i");
  c.ionex_file = path;
  EXPECT_THAT(error_of(c), HasSubstr("igrg3380.10i: gnss.ionex_file: covers 2010-12-04T00:00:1"));
  const GpsTime start = GpsTime::from_calendar(2010, 12, 4, 13, 0, 0.0);
  const GnssOutput out = measure(*make(c, 1, start), 0, start);
  EXPECT_EQ(out.fix.status, FixStatus::kDifferential);
}

TEST_F(PseudorangeSensorTest, MeasuredOrbitErrorsNeedTheirFiles) {
  GnssConfig c;
  c.ephemeris_error = "broadcast_minus_sp3";
  EXPECT_EQ(error_of(c),
            "gnss.ephemeris_error: is \"broadcast_minus_sp3\", but there is no broadcast, expected gnss.nav_file");
  c = GnssConfig{};
  c.systems = "GX";
  EXPECT_THAT(error_of(c), HasSubstr("gnss.systems: "));
}

TEST(GnssConfig, ModesSayWhetherTheyCorrectTheAtmosphere) {
  for (const auto& row : receiver_modes()) {
    const auto mode = row.make({});
    EXPECT_THAT(row.doc, HasSubstr(mode->corrects_atmosphere() ? "residual atmosphere" : "raw atmosphere")) << row.name;
  }
}

TEST(GnssConfig, ReadsAndRefuses) {
  GnssConfig c;
  const auto good = ConfigNode::parse("mode = \"single\"\nmultipath_rule = \"correlator\"\nrate_hz = 5\n", "m.toml");
  ASSERT_TRUE(good.ok());
  EXPECT_TRUE(read_config(&*good, "gnss", c).ok());
  EXPECT_EQ(c.mode, "single");
  EXPECT_EQ(c.rate_hz, 5.0);
  const auto bad = ConfigNode::parse("\nmultipath_rule = \"corelator\"\n", "m.toml");
  const auto status = read_config(&*bad, "gnss", c);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().str(), HasSubstr("m.toml:2: gnss.multipath_rule:"));
  EXPECT_THAT(status.error().str(), HasSubstr("correlator"));
}

// The receiver's own filter: quieter than epochs by themselves, the same bits when measured again, and fixes where the
// epoch alone has none.
TEST_F(PseudorangeSensorTest, AFilteringReceiverIsQuieterAndBridges) {
  GnssConfig c = errors_off();
  c.thermal_noise_scale = 1.0;
  c.code_loop_hz = 5.0;  // independent from epoch to epoch, 2 m
  c.solver_sigma_m = 2.0;
  const auto rms = [&](GnssSensor& sensor) {
    double square = 0.0;
    for (std::int64_t k = 0; k < 120; ++k) {
      const GnssOutput out = measure(sensor, k);
      EXPECT_EQ(out.fix.status, FixStatus::kSingle) << out.fix.reason;
      if (k >= 20) square += (out.fix.p_A_E - truth_E()).squaredNorm();
    }
    return std::sqrt(square / 100.0);
  };
  const auto plain = make(c);
  c.estimator = "kalman";
  c.estimator_acceleration_m_s2 = 0.05;
  const auto filtered = make(c);
  const double filtered_m = rms(*filtered);
  EXPECT_LT(filtered_m, 0.7 * rms(*plain));
  EXPECT_EQ(rms(*filtered), filtered_m);  // index 0 does not follow 119: switched on anew

  // A shaft closes around the antenna: of all satellites a few near the zenith are left.
  c.paths = "visibility";
  const auto shaft = WallScene()
                         .box({-20, -20, 0}, {-6, 20, 12})
                         .box({6, -20, 0}, {20, 20, 12})
                         .box({-6, -20, 0}, {6, -6, 12})
                         .box({-6, 6, 0}, {6, 20, 12})
                         .build();
  const auto sensor = make(c);
  for (std::int64_t k = 0; k < 10; ++k) measure(*sensor, k);
  c.estimator = "least_squares";
  const GnssOutput alone = make(c)->measure(10, kStart + 5.0, antenna_W, still, scene::SceneAt(*shaft));
  const GnssOutput bridged = sensor->measure(10, kStart + 5.0, antenna_W, still, scene::SceneAt(*shaft));
  ASSERT_GT(alone.epoch.observations.size(), 0u);
  ASSERT_LT(alone.epoch.observations.size(), 4u);
  EXPECT_EQ(alone.fix.status, FixStatus::kNone);
  ASSERT_EQ(bridged.fix.status, FixStatus::kSingle) << bridged.fix.reason;
  EXPECT_EQ(bridged.fix.satellites, static_cast<int>(bridged.epoch.observations.size()));
  // As good as it says: chi-square of three degrees, exceeded once in 10,000 times.
  const Eigen::Vector3d error = bridged.fix.p_A_E - truth_E();
  EXPECT_LT(error.dot(bridged.fix.covariance_E.ldlt().solve(error)), chi_square_threshold(1e-4, 3));
}

TEST_F(PseudorangeSensorTest, AFilterNeedsAReceiverClock) {
  GnssConfig c;
  c.estimator = "kalman";
  c.solver = "trilateration";
  c.receiver_clock = "none";
  EXPECT_EQ(error_of(c),
            "gnss.estimator: is \"kalman\", but the solver trilateration has no receiver clock, expected "
            "solver \"least_squares\"");
}

}  // namespace
}  // namespace canyon::gnss
