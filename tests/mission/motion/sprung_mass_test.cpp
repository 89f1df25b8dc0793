#include "canyon/mission/motion/sprung_mass.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "canyon/core/units.h"

namespace canyon::mission {
namespace {

/// Height and velocity of a sprung mass t after the road under it has stepped up by 1: the step response of
/// (2 zeta w s + w^2) / (s^2 + 2 zeta w s + w^2), written with its two poles (complex below critical damping).
std::complex<double> pole(double w, double zeta, double sign) {
  return w * (-zeta + sign * std::sqrt(std::complex<double>(zeta * zeta - 1.0)));
}
struct Response {
  double x, v;
};
Response step_response(double w, double zeta, double t) {
  const auto a = pole(w, zeta, 1.0), b = pole(w, zeta, -1.0);
  // y = x - 1: y(0) = -1, y'(0) = 2 zeta w = -(a + b); y = c e^(a t) + d e^(b t).
  const std::complex<double> v0 = -(a + b), c = (v0 + b) / (a - b), d = -1.0 - c;
  return {1.0 + (c * std::exp(a * t) + d * std::exp(b * t)).real(),
          (c * a * std::exp(a * t) + d * b * std::exp(b * t)).real()};
}

// 2026-11-22: the explicit step diverged inside the documented ranges (5 Hz, damping 2, 100 Hz: spectral radius 1.42).
// Now any step is exact: the closed form at every allowed stiffness and damping, at steps from 1 ms to 0.1 s. The
// tolerance is rounding: 1e-9 of a step of 1 m is asked for, over some thousand steps 1e-12 is met but near critical
// damping, where the closed form above divides by the difference of two poles (1e-4 w) and is itself good to 1e-10.
TEST(SprungMass, FollowsAStepOfTheRoadExactly) {
  for (const double hz : {0.3, 1.6, 5.0}) {
    for (const double zeta : {0.05, 0.6, 0.99999999, 1.00000001, 2.0}) {
      for (const double dt_s : {0.001, 0.01, 0.04, 0.1}) {
        const double w = 2.0 * kPi * hz;
        SprungMass mass(w, zeta, 0.0);
        mass.advance(1.0, 1.0, dt_s);
        for (int k = 1; k < static_cast<int>(3.0 / dt_s); ++k) {
          const Response truth = step_response(w, zeta, k * dt_s);
          ASSERT_NEAR(mass.state().x, truth.x, 1e-9) << hz << " Hz, damping " << zeta << ", step " << dt_s;
          ASSERT_NEAR(mass.state().v, truth.v, 1e-9 * w);
          mass.advance(1.0, dt_s);
        }
      }
    }
  }
}

TEST(SprungMass, RisesExactlyWithARamp) {
  SprungMass mass(10.0, 0.5, 2.0);
  double u = 2.0;
  for (int k = 0; k < 2000; ++k) mass.advance(u += 0.01, 0.01);
  EXPECT_NEAR(mass.state().x, u, 1e-12 * u * 10);
  EXPECT_NEAR(mass.state().v, 1.0, 1e-12);
  EXPECT_NEAR(mass.state().a, 0.0, 1e-10);
}

// The acceleration is the derivative of the velocity: a central difference over steps of 1 us.
TEST(SprungMass, AccelerationIsTheDerivativeOfTheVelocity) {
  SprungMass mass(2.0 * kPi * 1.6, 0.6, 0.0);
  double u = 0.0;
  for (int k = 0; k < 100; ++k) mass.advance(u += 0.003, 0.01);
  const double before = mass.state().v;
  const double now = mass.advance(u += 3e-7, 1e-6).a;
  const double after = mass.advance(u += 3e-7, 1e-6).v;
  // Error: d^2/6 times the third derivative (1e4), and rounding of v over 2 d: 1e-16 / 1e-6.
  EXPECT_NEAR((after - before) / 2e-6, now, 1e-8);
}

}  // namespace
}  // namespace canyon::mission
