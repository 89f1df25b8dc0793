#include "gnss/receiver/code_discriminator.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "gnss/signal.h"

namespace canyon::gnss {
namespace {

/// Closed form of the coherent early-minus-late multipath error for BPSK(1), infinite bandwidth, in chips (Braasch
/// 1996; van Nee 1993): `a` is the signed relative amplitude (negative = opposite phase), d the early-late spacing, x
/// the delay.
double envelope(double a, double d, double x) {
  if (x <= 0.5 * d * (1.0 + a)) return a * x / (1.0 + a);
  if (x <= 1.0 + 0.5 * d * (a - 1.0)) return 0.5 * a * d;
  if (x <= 1.0 + 0.5 * d) return a / (2.0 - a) * (1.0 + 0.5 * d - x);
  return 0.0;
}

TEST(CodeDiscriminator, EnvelopeAgainstTheClosedForm) {
  for (const double d : {1.0, 0.5, 0.1}) {
    double peak_m = 0.0;
    for (const double a : {0.5, -0.5, 0.1, -0.1, 0.9}) {
      for (double x = 0.0; x <= 1.7; x += 0.003) {
        const EchoSignal echo{x * kCaChipM, std::abs(a), a > 0.0 ? 0.0 : kPi};
        const auto error_m = coherent_early_late_error_m({&echo, 1}, d);
        ASSERT_TRUE(error_m.has_value()) << a << " " << x;
        EXPECT_NEAR(*error_m, envelope(a, d, x) * kCaChipM, 1e-9) << "a = " << a << ", d = " << d << ", x = " << x;
        if (a == 0.5) peak_m = std::max(peak_m, *error_m);
      }
    }
    EXPECT_NEAR(peak_m, 0.25 * d * kCaChipM, 1e-9);  // 73.3 m at one chip
  }
}

TEST(CodeDiscriminator, QuadratureAndNoEchoesDoNothing) {
  EXPECT_EQ(coherent_early_late_error_m({}, 0.5), 0.0);
  const EchoSignal quadrature{30.0, 0.5, kPi / 2};
  EXPECT_NEAR(*coherent_early_late_error_m({&quadrature, 1}, 0.5), 0.0, 1e-9);
  const EchoSignal far{3.0 * kCaChipM, 0.9, 0.0};
  EXPECT_NEAR(*coherent_early_late_error_m({&far, 1}, 0.5), 0.0, 1e-12);
}

// Zero of the composite's discriminator, evaluated anew here by brute force on a fine grid.
TEST(CodeDiscriminator, SeveralEchoes) {
  const EchoSignal echoes[] = {{10.0, 0.3, 0.4}, {60.0, 0.4, 2.9}, {200.0, 0.2, -1.0}};
  const double d = 0.5;
  const auto triangle = [](double x) { return std::max(0.0, 1.0 - std::abs(x)); };
  const auto value = [&](double t) {
    double sum = triangle(t - d / 2) - triangle(t + d / 2);
    for (const auto& e : echoes)
      sum += e.amplitude * std::cos(e.phase_rad) *
             (triangle(t - d / 2 - e.delay_m / kCaChipM) - triangle(t + d / 2 - e.delay_m / kCaChipM));
    return sum;
  };
  const double step = 1e-6;
  double zero = 10.0;
  for (double t = -0.5; t < 0.5; t += step)
    if (value(t) < 0.0 && value(t + step) >= 0.0 && std::abs(t) < std::abs(zero)) zero = t + 0.5 * step;
  EXPECT_NEAR(*coherent_early_late_error_m(echoes, d), zero * kCaChipM, step * kCaChipM);
}

TEST(CodeDiscriminator, CancelledSignalHasNoZero) {
  const EchoSignal echo{0.0, 1.0, kPi};
  EXPECT_FALSE(coherent_early_late_error_m({&echo, 1}, 0.5).has_value());
  EXPECT_NEAR(composite_amplitude({&echo, 1}), 0.0, 1e-15);
}

TEST(CodeDiscriminator, CompositeAmplitude) {
  const EchoSignal in_phase{0.5 * kCaChipM, 0.4, 0.0};
  EXPECT_NEAR(composite_amplitude({&in_phase, 1}), 1.2, 1e-12);  // the echo's correlation has fallen to half
}

}  // namespace
}  // namespace canyon::gnss
