#include "canyon/inertial/paper_formulas.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/inertial/errors/markov_process.h"

namespace canyon::inertial {
namespace {

/// Spread of the recursion after it has run for a while, from one long run.
double printed_spread(double tau_s, double white, int steps) {
  const RandomStream stream(7, "test.recursion");
  double sigma_t = 0.0, sum2 = 0.0;
  for (int k = 1; k <= steps; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    sigma_t = recursion_as_printed(sigma_t + white * stream.normal(0, i, 0), tau_s, white * stream.normal(0, i, 1));
    sum2 += sigma_t * sigma_t;
  }
  return std::sqrt(sum2 / steps);
}

TEST(PaperFormulas, RecursionDivergesBelowOneSecond) {
  // Each step multiplies by 1 / tau: 200 steps at tau = 0.5 s multiply by 2^200 whatever the sample rate.
  double sigma_t = 1.0;
  for (int k = 0; k < 200; ++k) sigma_t = recursion_as_printed(sigma_t, 0.5, 0.0);
  EXPECT_EQ(sigma_t, std::ldexp(1.0, 200));
  EXPECT_GT(printed_spread(0.5, 0.15, 200), 1e50);
  EXPECT_LT(printed_spread(2.0, 0.15, 20000), 1.0);
}

TEST(PaperFormulas, RecursionForgetsInMillisecondsNotTenSeconds) {
  EXPECT_NEAR(recursion_correlation_time_s(10.0, 1.0 / 125.0), 3.474e-3, 1e-6);
  EXPECT_LT(recursion_correlation_time_s(0.5, 1.0 / 125.0), 0.0);

  // Measured: correlation of successive values is 1 / tau = 0.1; of the corrected process exp(-dt / tau) = 0.9992.
  const int n = 200000;
  const RandomStream stream(11, "test.recursion");
  MarkovProcess corrected = MarkovProcess::gauss_markov(11, "test.corrected", 0, 0.15, 10.0, 1.0 / 125.0);
  double printed = 0.0, lag = 0.0, square = 0.0, corrected_lag = 0.0, corrected_square = 0.0;
  double previous = corrected.at(0).x();
  for (int k = 1; k <= n; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    const double next =
        recursion_as_printed(printed + 0.15 * stream.normal(0, i, 0), 10.0, 0.15 * stream.normal(0, i, 1));
    lag += printed * next;
    square += next * next;
    printed = next;
    const double value = corrected.at(k).x();
    corrected_lag += previous * value;
    corrected_square += value * value;
    previous = value;
  }
  EXPECT_NEAR(lag / square, 0.1, 4.0 / std::sqrt(n));  // 4 sigma: false alarm 6e-5
  const double phi = std::exp(-1.0 / 1250.0);
  EXPECT_NEAR(corrected_lag / corrected_square, phi, 4.0 * std::sqrt((1.0 - phi * phi) / n));  // same
}

TEST(PaperFormulas, RecursionDependsOnTheSampleRate) {
  // tau = 10 s stands for 3.5 ms at 125 Hz and for 0.43 s at 1 Hz: no property of the sensor.
  EXPECT_NEAR(recursion_correlation_time_s(10.0, 1.0) / recursion_correlation_time_s(10.0, 0.008), 125.0, 1e-9);
}

TEST(PaperFormulas, PrintedGyroNoiseIsADisplacement) {
  // Divided by the displacement per unit rate at resonance, x = 2 m omega_0 x_d Q / k, it becomes the corrected rate
  // density.
  const double q = 1000.0, m = 1e-8, w0 = 2.0 * kPi * 1e4, t = 290.0, xd = 5e-6, b = 100.0;
  const double stiffness = m * w0 * w0, resistance = m * w0 / q;
  const double metres = gyro_thermal_as_printed_m(q, stiffness, t, resistance, b);
  const double metres_per_rad_s = 2.0 * m * w0 * xd * q / stiffness;
  const double rate = gyro_thermal_density(t, w0, m, q, xd) * std::sqrt(b);
  EXPECT_NEAR(metres / metres_per_rad_s / rate, 1.0, 1e-14);  // few eps
  // So as an angular rate the printed number is off by that factor: here a displacement of picometres against 1e-4
  // rad/s.
  EXPECT_LT(metres / rate, 1e-6);
}

TEST(PaperFormulas, AccelerometerDensityInMicroG) {
  // By hand: 1 ug of mass, 5 kHz, Q = 1, 290 K: sqrt(4 * 1.380649e-23 * 290 * 31415.93 / 1e-9) = 7.093e-4 m/s^2 = 72.3
  // ug.
  const double density = accel_thermal_density(290.0, 2.0 * kPi * 5000.0, 1e-9, 1.0);
  EXPECT_NEAR(density / kStandardGravity * 1e6, 72.33, 0.01);
}

TEST(PaperFormulas, PrintedQuantizationShrinksWithRunTime) {
  EXPECT_NEAR(quantization_as_printed(0.2, 1.0 / 6.0), 0.01745 * std::sqrt(0.72), 1e-15);
  EXPECT_NEAR(quantization_as_printed(0.2, 4.0) / quantization_as_printed(0.2, 1.0), 0.5, 1e-15);
}

}  // namespace
}  // namespace canyon::inertial
