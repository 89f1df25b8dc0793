#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/link_budget.h"
#include "canyon/gnss/receiver/multipath_rule.h"
#include "canyon/gnss/receiver/receiver_antenna.h"
#include "canyon/gnss/receiver/receiver_clock.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

TEST(LinkBudget, ElevationAndFoliage) {
  const LinkBudget link;
  EXPECT_EQ(link.direct_cn0_dbhz(kPi / 2, 0.0), 45.0);
  EXPECT_EQ(link.direct_cn0_dbhz(0.0, 0.0), 38.0);
  // ITU-R P.833: gamma d for a short way, A_m for a long one.
  EXPECT_NEAR(link.foliage_db(0.01), 0.0025, 1e-6);
  EXPECT_NEAR(link.foliage_db(1e4), 28.0, 1e-9);
  EXPECT_EQ(link.foliage_db(0.0), 0.0);
  // Half the field at a shadow boundary costs 20 log10 2.
  EXPECT_NEAR(link.direct_cn0_dbhz(kPi / 2, 0.0, 0.5), 45.0 - 20.0 * std::log10(2.0), 1e-12);
  EXPECT_TRUE(std::isfinite(link.direct_cn0_dbhz(kPi / 2, 0.0, 0.0)));
}

SignalPath reflection(double excess_m, double incidence_deg, std::complex<double> eta) {
  const Fresnel f = fresnel(eta, incidence_deg * kDegree);
  SignalPath r;
  r.excess_m = excess_m;
  r.arrival_W = {1.0, 0.0, 0.0};
  r.copolar = f.co;
  r.crosspolar = f.cross;
  r.reflections = 1;
  return r;
}

TEST(LinkBudget, ReflectionLosesByFresnelAndAntenna) {
  LinkBudget link;
  const std::complex<double> metal(1.0, -1e8);
  // A mirror at normal incidence reverses the sense of rotation whole, so that only the antenna's rejection is lost.
  const auto r = receive(reflection(20.0, 0.0, metal), link, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(r.cn0_dbhz, 38.0 - 10.0, 1e-2);
  link.antenna = make_sine_antenna({7.0, 0.0});
  EXPECT_NEAR(receive(reflection(20.0, 0.0, metal), link, Eigen::Vector3d::UnitZ()).cn0_dbhz, 38.0, 1e-2);
  // Concrete at 45 deg: cross-polar 0.388, co-polar 0.125.
  const auto c = receive(reflection(20.0, 45.0, {5.24, -0.752}), LinkBudget{}, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(c.cn0_dbhz, 38.0 + 10.0 * std::log10(0.388 * 0.388 * 0.1 + 0.125 * 0.125), 0.05);
  // Nothing comes back from vacuum, and the figure is finite.
  const auto none = receive(reflection(20.0, 45.0, 1.0), LinkBudget{}, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(std::isfinite(none.cn0_dbhz));
  EXPECT_LT(none.cn0_dbhz, -100.0);
}

TEST(LinkBudget, CarrierPhaseTurnsWithTheExcess) {
  const std::complex<double> metal(1.0, -1e8);
  const auto phase = [&](double excess_m) {
    return receive(reflection(excess_m, 0.0, metal), LinkBudget{}, Eigen::Vector3d::UnitZ()).phase_rad;
  };
  EXPECT_NEAR(std::remainder(phase(10.0) - phase(10.0 + kL1WavelengthM), 2 * kPi), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(std::remainder(phase(10.0) - phase(10.0 + 0.5 * kL1WavelengthM), 2 * kPi)), kPi, 1e-9);
}

const MultipathParameters kRule{45.0, 25.0, {}};

ReceivedSignal direct(double cn0_dbhz) {
  return {0.0, cn0_dbhz, 0.0, 0.0};
}

TEST(MultipathRule, NoneTracksOnlyWhatIsClear) {
  const auto rule = find_model(multipath_rules(), "none")->make({}, kRule);
  const ReceivedSignal strong{20.0, 40.0, 0.0, 0.0};
  EXPECT_FALSE(rule->receive(std::nullopt, {&strong, 1}, kL1WavelengthM).tracked);
  EXPECT_FALSE(rule->receive(direct(24.9), {&strong, 1}, kL1WavelengthM).tracked);
  const Reception r = rule->receive(direct(44.0), {&strong, 1}, kL1WavelengthM);
  EXPECT_TRUE(r.tracked);
  EXPECT_EQ(r.error_m, 0.0);
  EXPECT_EQ(r.cn0_dbhz, 44.0);
  EXPECT_EQ(r.source, -1);
}

TEST(MultipathRule, PaperFirstReturn) {
  const auto rule = make_paper_first_return(kRule);
  const ReceivedSignal weak{5.0, 20.0, 0.0, 0.0}, near{20.0, 30.0, 0.0, 0.0}, late{60.0, 35.0, 0.0, 0.0};
  const ReceivedSignal all[] = {weak, near, late};
  const auto error_m = [&](std::span<const ReceivedSignal> echoes) {
    return rule->receive(direct(44.0), echoes, kL1WavelengthM).error_m;
  };
  // The first return that can be tracked lies within 45 m: its whole excess becomes the error.
  EXPECT_EQ(error_m(all), 20.0);
  EXPECT_EQ(rule->receive(direct(44.0), all, kL1WavelengthM).source, 1);
  // Later than the cut-off: separable, the direct range stands. So does a reflection too weak to track.
  EXPECT_EQ(error_m({&late, 1}), 0.0);
  EXPECT_EQ(error_m({&weak, 1}), 0.0);
  EXPECT_EQ(error_m({}), 0.0);
}

TEST(MultipathRule, NlosOnlyTracksTheStrongest) {
  // The two weaker ones come more than a chip before or after, so that they leave the strongest alone.
  const ReceivedSignal echoes[] = {{5.0, 20.0, 0.0, 0.0}, {20.0, 30.0, 0.0, 0.0}, {900.0, 35.0, 0.0, 2.0}};
  for (const char* name : {"paper_first_return", "correlator"}) {
    const auto rule = find_model(multipath_rules(), name)->make({}, kRule);
    const Reception r = rule->receive(std::nullopt, echoes, kL1WavelengthM);
    EXPECT_TRUE(r.tracked) << name;
    EXPECT_EQ(r.error_m, 900.0) << name;  // whole, beyond the cut-off too: nothing else is there to lock on to
    EXPECT_NEAR(r.cn0_dbhz, 35.0, 1e-12) << name;
    EXPECT_EQ(r.source, 2) << name;
    EXPECT_NEAR(r.range_rate_error_m_s, -2.0 * kL1WavelengthM, 1e-12) << name;
    EXPECT_NEAR(r.carrier_error_m, 900.0, 0.5 * kL1WavelengthM) << name;
    EXPECT_FALSE(rule->receive(std::nullopt, {echoes, 1}, kL1WavelengthM).tracked) << name;
    EXPECT_FALSE(rule->receive(std::nullopt, {}, kL1WavelengthM).tracked) << name;
  }
}

TEST(MultipathRule, CorrelatorWeighsByAmplitude) {
  const auto rule = make_correlator(kRule);
  // 20 dB below, in phase, beyond the first corner: a d / 2 of a chip.
  const ReceivedSignal weak{100.0, 24.0, 0.0, 0.0};
  const Reception r = rule->receive(direct(44.0), {&weak, 1}, kL1WavelengthM);
  EXPECT_NEAR(r.error_m, 0.1 * 0.25 * kCaChipM, 1e-6);
  // The code stands 0.025 chips late: the direct correlates by 0.975, the echo by that much more.
  EXPECT_NEAR(r.cn0_dbhz, 44.0 + 20 * std::log10(0.975 + 0.1 * (1.025 - 100.0 / kCaChipM)), 1e-6);
  EXPECT_NEAR(r.carrier_error_m, 0.0, 1e-12);
  EXPECT_EQ(r.source, -1);
  // An equal echo in opposite phase cancels the signal: lost.
  const ReceivedSignal opposite{0.0, 44.0, kPi, 0.0};
  EXPECT_FALSE(rule->receive(direct(44.0), {&opposite, 1}, kL1WavelengthM).tracked);
}

// An echo in quadrature delays the carrier by atan(a) / 2 pi of a wavelength if it lags, and its turning shows in the
// frequency.
TEST(MultipathRule, CorrelatorsCarrier) {
  const auto rule = make_correlator(kRule);
  const ReceivedSignal lagging{1e-6, 38.0, -kPi / 2, 0.0};
  const double a = std::pow(10.0, -6.0 / 20.0);
  EXPECT_NEAR(rule->receive(direct(44.0), {&lagging, 1}, kL1WavelengthM).carrier_error_m,
              std::atan(a) / (2 * kPi) * kL1WavelengthM, 1e-6);
  // As a reflector recedes by a wavelength, the NLOS carrier range grows by just that, without jumps.
  double before_m = kNaN;
  for (double excess_m = 60.0; excess_m < 60.0 + 2 * kL1WavelengthM; excess_m += 0.1 * kL1WavelengthM) {
    const double turns = excess_m / kL1WavelengthM;
    const ReceivedSignal echo{excess_m, 35.0, 3.0 - 2 * kPi * (turns - std::floor(turns)), 0.0};
    const double now_m = rule->receive(std::nullopt, {&echo, 1}, kL1WavelengthM).carrier_error_m;
    if (std::isfinite(before_m)) {
      EXPECT_NEAR(now_m - before_m, 0.1 * kL1WavelengthM, 1e-9);
    }
    before_m = now_m;
  }
}

TEST(LinkBudget, EchoesTurnAsTheAntennaMoves) {
  // Towards a mirror in the west at 10 m/s, satellite in the east at the horizon: the echo's way shortens, the direct
  // one's grows.
  SignalPath path;
  path.arrival_W = -Eigen::Vector3d::UnitX();
  path.crosspolar = 1.0;
  const auto r = receive(path, LinkBudget{}, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), {-10.0, 0.0, 0.0});
  EXPECT_NEAR(r.doppler_hz, 20.0 / kL1WavelengthM, 1e-9);
}

TEST(ReceiverClock, IsAFunctionOfTheEpoch) {
  const auto a = make_tcxo({7, 0.5}), b = make_tcxo({7, 0.5});
  const double at_100_m = a->offset_m(100);
  a->offset_m(500);
  EXPECT_EQ(a->offset_m(100), at_100_m);
  EXPECT_EQ(b->offset_m(100), at_100_m);
  EXPECT_NE(make_tcxo({8, 0.5})->offset_m(100), at_100_m);
  EXPECT_EQ(find_model(receiver_clock_models(), "none")->make({}, {7, 0.5})->offset_m(100), 0.0);
}

// Second differences of the bias over T: variance of the two-state model is 2 S_f T + 2/3 S_g T^3, S_f = h0/2, S_g = 2
// pi^2 h-2. They are taken 2 T apart, so that white frequency noise shares no samples; random walk correlates
// neighbours by 1/4. N = 4000: the estimate's relative sigma is sqrt(2/N (1 + 2/16)) = 2.4 %; 5 sigma, one false alarm
// in 1.7 million.
TEST(ReceiverClock, TcxoHasItsAllanVariance) {
  const double T = 1.0;
  const auto clock = make_tcxo({11, T});
  double sum = 0.0;
  constexpr int kN = 4000;
  double x0 = clock->offset_m(0), x1, x2;
  for (int k = 0; k < kN; ++k) {
    x1 = clock->offset_m(2 * k + 1);
    x2 = clock->offset_m(2 * k + 2);
    const double d = (x2 - 2.0 * x1 + x0) / kSpeedOfLight;
    sum += d * d;
    x0 = x2;
  }
  const double expected = 2.0 * 1e-19 * T + 2.0 / 3.0 * 2.0 * kPi * kPi * 2e-20 * T * T * T;
  EXPECT_NEAR(sum / kN, expected, 5.0 * std::sqrt(2.0 / kN * 1.125) * expected);
}

}  // namespace
}  // namespace canyon::gnss
