#include "canyon/gnss/receiver/signal_lock.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/gnss/receiver/carrier_noise.h"
#include "canyon/gnss/receiver/loop_noise.h"

namespace canyon::gnss {
namespace {

const SatelliteId kSv{GnssSystem::kGps, 7};

SignalLockParameters parameters() {
  SignalLockParameters p;
  p.seed = 3;
  p.interval_s = 0.5;
  return p;
}

class Track {
 public:
  explicit Track(const SignalLockParameters& p) : locks_(p) {}
  SignalLocks::State at(double cn0_dbhz, std::uint64_t source = 1) {
    locks_.begin_epoch(index_++);
    return locks_.update(kSv, cn0_dbhz, source);
  }
  void skip() { locks_.begin_epoch(index_++); }
  SignalLocks& locks() { return locks_; }

 private:
  SignalLocks locks_;
  std::int64_t index_ = 10;
};

TEST(SignalLocks, ARunningReceiverHasWhatStandsAboveTheThreshold) {
  Track track(parameters());
  const auto s = track.at(25.0);
  EXPECT_TRUE(s.tracked);
  EXPECT_TRUE(s.slipped);  // nothing before to continue
  EXPECT_FALSE(Track(parameters()).at(24.9).tracked);
  EXPECT_FALSE(Track(parameters()).at(std::nan("")).tracked);
}

TEST(SignalLocks, LossAndReacquisition) {
  Track track(parameters());
  const double first = track.at(40.0).ambiguity_cycles;
  EXPECT_EQ(track.at(40.0).ambiguity_cycles, first);
  EXPECT_TRUE(track.at(25.5).tracked);  // between threshold and acquisition it is held
  EXPECT_FALSE(track.at(24.0).tracked);
  EXPECT_FALSE(track.at(27.5).tracked);  // too weak to be found again
  EXPECT_FALSE(track.at(28.5).tracked);  // found, but 1 s has to pass
  EXPECT_FALSE(track.at(27.0).tracked);  // and starts again
  EXPECT_FALSE(track.at(40.0).tracked);
  EXPECT_FALSE(track.at(40.0).tracked);
  const auto back = track.at(40.0);
  EXPECT_TRUE(back.tracked);
  EXPECT_TRUE(back.slipped);
  EXPECT_NE(back.ambiguity_cycles, first);
  EXPECT_FALSE(track.at(40.0).slipped);
}

TEST(SignalLocks, OutOfViewIsForgottenAndRestartBeginsAnew) {
  Track track(parameters());
  track.at(40.0);
  track.skip();  // below the mask
  EXPECT_FALSE(track.at(40.0).tracked);
  track.locks().restart();
  EXPECT_TRUE(track.at(40.0).tracked);
}

TEST(SignalLocks, AnotherPeakIsAnotherAmbiguity) {
  Track track(parameters());
  const double direct = track.at(40.0, 1).ambiguity_cycles;
  const auto echo = track.at(40.0, 99);
  EXPECT_TRUE(echo.tracked);
  EXPECT_TRUE(echo.slipped);
  EXPECT_NE(echo.ambiguity_cycles, direct);
}

// 20,000 epochs at 22.5 dB-Hz: slips are a Bernoulli sequence of the stated probability; 5 sigma of the count.
TEST(SignalLocks, SlipsComeAsOftenAsTheLoopTheorySays) {
  SignalLockParameters p = parameters();
  p.threshold_dbhz = 20.0;
  Track track(p);
  track.at(22.5);
  int slips = 0;
  constexpr int kEpochs = 20000;
  double cycles = track.at(22.5).ambiguity_cycles;
  for (int k = 0; k < kEpochs; ++k) {
    const auto s = track.at(22.5);
    EXPECT_EQ(std::abs(s.ambiguity_cycles - cycles), s.slipped ? 1.0 : 0.0);
    cycles = s.ambiguity_cycles;
    slips += s.slipped ? 1 : 0;
  }
  const double q = 1.0 - std::exp(-0.5 / mean_time_to_slip_s(22.5, 15.0, 0.02));
  EXPECT_GT(q, 1e-3);
  EXPECT_NEAR(slips, kEpochs * q, 5.0 * std::sqrt(kEpochs * q * (1.0 - q)));
}

TEST(SignalLocks, MeanTimeToSlip) {
  // Written out at 25 dB-Hz, B = 15 Hz, T = 20 ms: sigma^2 = 0.04743 x 1.0791, rho = 4.884, I0 by its series.
  const double sigma2 = std::pow(carrier_phase_noise_rad(25.0, 15.0, 0.02), 2);
  EXPECT_NEAR(sigma2, 0.05118, 5e-5);
  const double rho = 0.25 / sigma2;
  EXPECT_NEAR(mean_time_to_slip_s(25.0, 15.0, 0.02),
              M_PI * M_PI * rho * std::pow(std::cyl_bessel_i(0.0, rho), 2) / 30.0,
              1e-6 * mean_time_to_slip_s(25.0, 15.0, 0.02));
  const double high = 0.25 / std::pow(carrier_phase_noise_rad(30.0, 15.0, 0.02), 2);
  EXPECT_NEAR(std::log(mean_time_to_slip_s(30.0, 15.0, 0.02)),
              std::log(M_PI * M_PI * high / 30.0) + 2.0 * std::log(std::cyl_bessel_i(0.0, high)), 1e-4);
  EXPECT_TRUE(std::isfinite(mean_time_to_slip_s(60.0, 15.0, 0.02)));
}

TEST(CarrierNoise, TextbookValues) {
  // Kaplan & Hegarty: B = 15 Hz at 45 dB-Hz, 1.25 deg; velocity of a 20 ms frequency discriminator, 6.6 cm/s.
  EXPECT_NEAR(carrier_phase_noise_rad(45.0, 15.0, 0.02), 0.02179, 1e-4);
  EXPECT_NEAR(doppler_noise_hz(45.0, 15.0, 0.02), 0.3469, 1e-3);
}

// Unit variance and the loop's correlation from epoch to epoch; N = 20,000 with a correlation of rho: the estimates'
// sigma is sqrt((1 + rho^2) / (1 - rho^2) 2 / N), 5 sigma.
TEST(LoopNoise, VarianceAndCorrelation) {
  const LoopNoise noise(5, "test.loop", 0.13, 0.5);
  const double rho = noise.correlation();
  EXPECT_NEAR(rho, std::exp(-0.26), 1e-15);
  constexpr int kN = 20000;
  double square = 0.0, lag = 0.0, before = noise.at(9, 0);
  for (int k = 1; k <= kN; ++k) {
    const double now = noise.at(9, k);
    square += now * now;
    lag += now * before;
    before = now;
  }
  const double sigma = std::sqrt((1 + rho * rho) / (1 - rho * rho) * 2.0 / kN);
  EXPECT_NEAR(square / kN, 1.0, 5.0 * sigma);
  EXPECT_NEAR(lag / kN, rho, 5.0 * sigma);
  EXPECT_EQ(noise.at(9, 100), LoopNoise(5, "test.loop", 0.13, 0.5).at(9, 100));
  // A wide loop hands the draw itself on.
  EXPECT_EQ(LoopNoise(5, "test.loop", 20.0, 1.0).at(9, 100), RandomStream(5, "test.loop").normal(9, 100));
}

}  // namespace
}  // namespace canyon::gnss
