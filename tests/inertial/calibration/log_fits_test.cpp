#include "canyon/inertial/calibration/log_fits.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/inertial/allan/noise_fit.h"

namespace canyon::inertial {
namespace {

/// Channel c of a log is `value(c, t)` at the middle of the interval that ends at each stamp.
template <class Value>
ImuLog log_of(double from_s, double interval_s, std::size_t samples, Value value) {
  ImuLog log;
  for (std::size_t k = 0; k < samples; ++k) {
    log.t_s.push_back(from_s + static_cast<double>(k) * interval_s);
    for (std::size_t c = 0; c < 6; ++c) log.channels[c].push_back(value(c, log.t_s.back() - 0.5 * interval_s));
  }
  return log;
}

double ramp(std::size_t channel, double t_s) {
  return (static_cast<double>(channel) + 1.0) * t_s;
}

// Means of a straight line are its values at the middles of the intervals, and interpolating between such is exact: a
// reference at half the rate says just what the log measures, to rounding of values of 60 (a few 1e-14).
TEST(LogFits, AReferenceAtAnotherRateIsReadAtTheMiddleOfTheInterval) {
  const ImuLog log = log_of(0.0, 0.01, 1000, ramp), truth = log_of(1.0, 0.02, 300, ramp);
  const ReferencePairs pairs = reference_pairs(log, truth);
  // From the first reference's middle, 0.99 s, to the last one's, 6.97 s.
  ASSERT_EQ(pairs.t_s.size(), 598u);
  for (std::size_t k = 0; k < pairs.t_s.size(); ++k)
    for (std::size_t triad = 0; triad < 2; ++triad)
      EXPECT_LT((pairs.measured[triad][k] - pairs.truth[triad][k]).norm(), 1e-12) << pairs.t_s[k];
}

TEST(LogFits, NothingIsPairedAcrossAGapOfTheReference) {
  const ImuLog log = log_of(0.0, 0.01, 1000, ramp);
  ImuLog truth = log_of(0.0, 0.01, 1000, ramp);
  truth.t_s.erase(truth.t_s.begin() + 400, truth.t_s.begin() + 500);
  for (auto& channel : truth.channels) channel.erase(channel.begin() + 400, channel.begin() + 500);
  const ReferencePairs pairs = reference_pairs(log, truth);
  for (const double t : pairs.t_s) EXPECT_TRUE(t < 4.0 - 0.005 || t > 5.0 - 0.005) << t;
  EXPECT_NEAR(static_cast<double>(pairs.t_s.size()), 900.0, 2.0);  // its two ends may fall either way
}

TEST(LogFits, GravityHasASource) {
  EXPECT_EQ(LocalGravity{}.source, "standard gravity, 9.80665 m/s^2");
  EXPECT_EQ(given_gravity(9.81).source, "gravity given as 9.81 m/s^2");
  // WGS84 normal gravity on the equator and at the poles (NIMA TR8350.2, table 3.4).
  EXPECT_NEAR(gravity_at({0.0, 0.0, 0.0}).m_s2, 9.7803253359, 1e-9);
  EXPECT_NEAR(gravity_at({0.5 * kPi, 0.0, 0.0}).m_s2, 9.8321849378, 1e-9);
}

// A resting unit, 0.02 rad/s and 0.05 m/s^2 off: 20,000 samples of white noise of 0.01 leave the mean known to 7e-5;
// five sigmas.
TEST(LogFits, AtRestTheBiasIsWhatIsLeft) {
  if (!can_fit_noise()) GTEST_SKIP() << "built without CANYON_WITH_CERES";
  const RandomStream noise(3, "test.log_fits");
  std::uint64_t k = 0;
  const NamedLog log{log_of(0.0, 0.01, 20000,
                            [&](std::size_t c, double) {
                              const double still = c < 3 ? 0.02 : c == 5 ? kStandardGravity + 0.05 : 0.0;
                              return still + 0.01 * noise.normal(0, k++);
                            }),
                     "folder/mine.csv"};
  const auto unit = fit_at_rest(log, {});
  ASSERT_TRUE(unit.ok()) << unit.error().str();
  EXPECT_EQ(unit->name, "mine");
  EXPECT_EQ(unit->log, "mine.csv");
  EXPECT_NEAR(unit->rate_hz, 100.0, 1e-6);  // stamps of 200 s, rounded to 3e-14
  EXPECT_NEAR(unit->bias[0], 0.02, 5.0 * 7e-5);
  EXPECT_NEAR(unit->bias[1], 0.05, 5.0 * 7e-5);
  EXPECT_EQ(unit->bias_source[1],
            "mean specific force of mine.csv against standard gravity, 9.80665 m/s^2: along the vertical");
}

TEST(LogFits, ChannelsThatAreMissingAreNamed) {
  NamedLog log{log_of(0.0, 0.01, 100, ramp), "a.csv"}, truth{log.log, "b.csv"};
  truth.log.channels[4].clear();
  EXPECT_EQ(fit_to_truth(log, truth).error().str(), "b.csv: no ay, expected all six channels");
  log.log.channels[3].clear();
  EXPECT_EQ(fit_to_positions(log, {}).error().str(), "a.csv: no ax, expected all six channels");
  EXPECT_EQ(fit_at_rest(log, {}).error().what, "no accelerometer");
}

}  // namespace
}  // namespace canyon::inertial
