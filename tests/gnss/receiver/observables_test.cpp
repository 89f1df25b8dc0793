#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "canyon/gnss/signal.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/sensor/pseudorange_sensor_fixture.h"

namespace canyon::gnss {
namespace {

using testing::errors_off;
using testing::kStart;
using testing::open_sky;
using testing::PseudorangeSensorTest;

// Doppler and carrier against differences of what they stand for: the true range's derivative, and the pseudorange.
TEST_F(PseudorangeSensorTest, DopplerIsTheRateOfTheRange) {
  GnssConfig c = errors_off();
  c.tracking.thermal_noise_scale = 0.0;
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
  c.troposphere.name = c.ephemeris_error.name = "none";
  c.ionosphere.own.get<ElectronContent>().vtec_tecu = 100.0;
  c.tracking.thermal_noise_scale = 0.0;
  EXPECT_LT((measure(*make(c), 4).fix.p_A_E - truth_E()).norm(), 1e-4);
  c.tracking.thermal_noise_scale = 1.0;
  const auto dual = make(c);
  c.mode.name = "single";
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
              c.mode.name = "dual";
              c.tracking.second_frequency = SecondFrequency::kL5;
              return c;
            }()),
            "no error");
  // B3I, which every BeiDou satellite sends; B2I is of BeiDou-2 alone.
  EXPECT_EQ(second_band(GnssSystem::kBeidou, SecondFrequency::kL2), 6);
  EXPECT_EQ(second_band(GnssSystem::kBeidou, SecondFrequency::kL5), 5);
}

// Mean square of the code noise at 45 dB-Hz everywhere against the loop formula, epochs 20 s apart so that they are
// independent: B = 0.13 Hz forgets within 2 s.
TEST_F(PseudorangeSensorTest, CodeNoiseHasItsSigma) {
  GnssConfig c = errors_off();
  c.tracking.thermal_noise_scale = 1.0;
  c.link.antenna.name = "isotropic";
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

}  // namespace
}  // namespace canyon::gnss
