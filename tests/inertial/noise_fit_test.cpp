#include "inertial/allan/noise_fit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "inertial/allan/noise_terms.h"
#include "inertial/imu_log.h"
#include "tests/support/test_data.h"

namespace canyon::inertial {
namespace {

constexpr int kPerOctave = 4;

class NoiseFitTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto nothing = fit_noise({}, kPerOctave);
    if (nothing.error().what == "this build has no noise fit") GTEST_SKIP() << "built without CANYON_WITH_CERES";
  }
};
class NoiseFitRealTest : public NoiseFitTest {};

/// A curve without statistical error, as a log of `samples` at 100 Hz would give it.
std::vector<DeviationPoint> exact_curve(const std::vector<std::pair<int, double>>& terms, double correlation_s,
                                        std::int64_t samples) {
  std::vector<DeviationPoint> points;
  for (const std::int64_t m : averaging_factors(samples, kPerOctave)) {
    DeviationPoint p;
    p.m = m;
    p.tau_s = 0.01 * static_cast<double>(m);
    double variance = 0.0;
    for (const auto& [term, value] : terms) variance += allan_variance(term, value, correlation_s, p.tau_s);
    p.edf = std::max(1.0, 1.5 * static_cast<double>(samples) / static_cast<double>(m));
    // fit_noise takes off what the logarithm of a chi-square estimate lies low on average.
    p.deviation = std::sqrt(variance * std::exp(-1.0 / p.edf));
    points.push_back(p);
  }
  return points;
}

// Without statistical error the coefficients come back; what is not in the curve is reported as not determined.
TEST_F(NoiseFitTest, FindsWhatTheCurveIsMadeOf) {
  const auto fit = fit_noise(
      exact_curve({{kWhite, 0.05}, {kBiasInstability, 0.01}, {kRateRandomWalk, 0.002}}, 1.0, 1000000), kPerOctave);
  ASSERT_TRUE(fit.ok());
  EXPECT_TRUE(fit->term("white").determined);
  EXPECT_NEAR(fit->term("white").value / 0.05, 1.0, 1e-3);
  EXPECT_NEAR(fit->term("bias_instability").value / 0.01, 1.0, 1e-2);
  EXPECT_NEAR(fit->term("rate_random_walk").value / 0.002, 1.0, 1e-2);
  for (const char* absent : {"quantization", "ramp", "gauss_markov"}) {
    EXPECT_FALSE(fit->term(absent).determined) << absent;
    EXPECT_EQ(fit->term(absent).value, 0.0) << absent;
  }
  EXPECT_NEAR(fit->deviation_at(1.0), std::sqrt(0.0025 + 2.0 * std::log(2.0) / kPi * 1e-4 + 4e-6 / 3.0), 1e-4);
}

TEST_F(NoiseFitTest, QuantizationAndRamp) {
  const auto fit =
      fit_noise(exact_curve({{kQuantization, 1e-3}, {kWhite, 0.02}, {kRamp, 1e-5}}, 1.0, 1000000), kPerOctave);
  ASSERT_TRUE(fit.ok());
  EXPECT_NEAR(fit->term("quantization").value / 1e-3, 1.0, 1e-2);
  EXPECT_NEAR(fit->term("white").value / 0.02, 1.0, 1e-2);
  EXPECT_NEAR(fit->term("ramp").value / 1e-5, 1.0, 3e-2);
}

TEST_F(NoiseFitTest, GaussMarkovHasACorrelationTime) {
  const auto fit = fit_noise(exact_curve({{kWhite, 0.05}, {kGaussMarkov, 0.03}}, 60.0, 4000000), kPerOctave);
  ASSERT_TRUE(fit.ok());
  ASSERT_TRUE(fit->term("gauss_markov").determined);
  EXPECT_NEAR(fit->term("gauss_markov").value / 0.03, 1.0, 2e-2);
  EXPECT_NEAR(fit->correlation_time_s / 60.0, 1.0, 3e-2);
}

TEST_F(NoiseFitTest, TooShortALogIsAnError) {
  const auto fit = fit_noise({}, kPerOctave);
  ASSERT_FALSE(fit.ok());
  EXPECT_EQ(fit.error().str(), "0 points of deviation above zero, expected three or more: a longer log");
}

// A jittered log with gaps: the fit to the same log by another program, 5 %.
TEST_F(NoiseFitRealTest, GyroscopesOfAnMpu6050) {
  CANYON_REAL_DATA(path, "inertial/allan_mpu6050/mpu6050_static_655s.csv");
  const auto log = read_imu_log(path, {"t_us,ax_g*2.44140625e-4,ay_g*2.44140625e-4,az_g*2.44140625e-4,"
                                       "gx_deg_s*0.00763358779,gy_deg_s*0.00763358779,gz_deg_s*0.00763358779"});
  ASSERT_TRUE(log.ok()) << log.error().str();
  const Sampling sampling = sampling_of(log->t_s);
  EXPECT_NEAR(sampling.interval_s, 0.010069, 2e-5);  // 99.317 Hz, though half the samples come 2 ms after another
  const double other[3] = {0.0125448, 0.00905943, 0.00945361};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto points = deviation("overlapping", log->channels[axis], sampling,
                                  averaging_factors(static_cast<std::int64_t>(log->size()), kPerOctave));
    const auto fit = fit_noise(points, kPerOctave);
    ASSERT_TRUE(fit.ok());
    EXPECT_NEAR(fit->term("white").value / kDegree / other[axis], 1.0, 0.05) << "axis " << axis;
  }
}

}  // namespace
}  // namespace canyon::inertial
