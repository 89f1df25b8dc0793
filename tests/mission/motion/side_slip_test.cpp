#include "canyon/mission/motion/side_slip.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::mission {
namespace {

constexpr double kCompliance = 0.5 * kDegree;  // rad s^2/m
constexpr double kRound_m_s = 6.0, kTurning_m_s2 = 2.0, kOften_rad_s = 3.0;

// v' = -v / T - u, u = U sin(W t), v(0) = 0: its closed form.
double swaying_m_s(double t_s) {
  const double T = kCompliance * kRound_m_s, x = kOften_rad_s * T;
  const double most = kTurning_m_s2 * T / (1.0 + x * x);
  return -most * (std::sin(kOften_rad_s * t_s) - x * std::cos(kOften_rad_s * t_s) + x * std::exp(-t_s / T));
}

/// The largest error of the velocity over 3 s, at the ends of steps and in their middles.
struct Errors {
  double end = 0.0, middle = 0.0;
};
Errors errors_of(int steps_per_s) {
  SideSlip slip(kCompliance);
  const double h = 1.0 / steps_per_s;
  const auto drive = [](double t_s) {
    return SideSlip::Drive{kRound_m_s, kTurning_m_s2 * std::sin(kOften_rad_s * t_s)};
  };
  Errors worst;
  for (int k = 0; k < 3 * steps_per_s; ++k) {
    const SideSlip::Motion step = slip.advance(drive((k + 1.0 / 3.0) * h), drive((k + 1) * h), h);
    worst.end = std::max(worst.end, std::abs(slip.now().v_0 - swaying_m_s((k + 1) * h)));
    worst.middle = std::max(worst.middle, std::abs(step.velocity(0.5 * h) - swaying_m_s((k + 0.5) * h)));
  }
  return worst;
}

// Third order: errors fall to an eighth with half of the step, but for the next order's part of it, h / (2 T) = 5 %.
// At the vehicle's own step they are 1e-4 of the sway of 10 cm/s.
TEST(SideSlip, FollowsItsLawToThirdOrder) {
  const Errors coarse = errors_of(200), fine = errors_of(400);
  EXPECT_NEAR(coarse.end / fine.end, 8.0, 0.05 * 8.0);
  EXPECT_NEAR(coarse.middle / fine.middle, 8.0, 0.1 * 8.0);
  EXPECT_LT(errors_of(100).end, 1e-5);
}

// On a circle it settles on -k s (s w), nearer with every step, whatever the step is to T = k s: 1e-5 to 0.3 s. For 9
// s, 34 times the longest T, then it is there to a few roundings.
TEST(SideSlip, SettlesOnTheSlipOfASteadyCircle) {
  for (const double speed_m_s : {1e-3, 0.5, 6.0, 30.0}) {
    SideSlip slip(kCompliance);
    const SideSlip::Drive circle{speed_m_s, 1.5};
    const double expected = -kCompliance * speed_m_s * 1.5, rounding = 8.0 * 2.3e-16 * std::abs(expected);
    double off = std::abs(expected);
    for (int k = 0; k < 900; ++k) {
      slip.advance(circle, circle, 0.01);
      const double now = std::abs(slip.now().v_0 - expected);
      ASSERT_LE(now, std::max(0.99 * off, rounding)) << speed_m_s << " m/s, step " << k;
      off = now;
    }
    EXPECT_LE(off, rounding);
    EXPECT_NEAR(slip.now().a_0, 0.0, rounding / (kCompliance * speed_m_s));
  }
}

TEST(SideSlip, NeverSlipsByMoreThanTyresDo) {
  SideSlip slip(2.0 * kDegree);  // T = 1.05 s
  for (int k = 0; k < 5000; ++k) slip.advance({30.0, 5000.0}, {30.0, 5000.0}, 0.01);
  EXPECT_NEAR(slip.now().v_0, -SideSlip::kLargestSlip * 30.0, 1e-13);
}

// What was left of a turn is gone where it stands, at once and for good.
TEST(SideSlip, StandsWhereItDoesNotRoll) {
  SideSlip slip(kCompliance);
  slip.advance({1.0, 3.0}, {1.0, 3.0}, 0.01);
  ASSERT_NE(slip.now().v_0, 0.0);
  slip.advance({0.3, 0.3}, {0.0, 0.0}, 0.01);
  EXPECT_NEAR(slip.now().v_0, 0.0, 1e-17);
  slip.stop();
  slip.advance({0.0, 0.0}, {0.0, 0.0}, 0.01);
  EXPECT_EQ(slip.now().v_0, 0.0);
  EXPECT_EQ(slip.now().a_0, 0.0);
  EXPECT_THROW(SideSlip(-0.1), ProgramError);
}

}  // namespace
}  // namespace canyon::mission
