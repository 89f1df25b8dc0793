#include "canyon/inertial/mems/sensing_element.h"

#include <cmath>
#include <complex>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/inertial/paper_formulas.h"
#include "canyon/tests/inertial/stationary_covariance.h"
#include "canyon/tests/support/four_sigma.h"

namespace canyon::inertial {
namespace {

using canyon::testing::four_sigma_of_variance;

using testing::stationary_covariance;

constexpr double kTemperature_k = 300.0;

ElementFigures quiet(double quality_factor) {
  ElementFigures f;
  f.quality_factor = quality_factor;
  f.pick_off = "piezoresistive";
  f.pick_off_figures.bridge_ohm = 1.0;
  f.pick_off_figures.bias_v = 100.0;  // thermal noise of the mass alone
  f.pick_off_figures.strain_cubic = 0.0;
  f.bandwidth_hz = 40.0;
  return f;
}

SensingElement element(const ElementFigures& f, double step_s, std::uint32_t axis = 0, double electronics_n = 0.0,
                       const std::string& integrator = "exact") {
  return {
      *accelerometer_model(f, kTemperature_k), electronics_n, integrator, step_s, RandomStream(5, "test.mems"), axis};
}

// Equipartition: the mean of k x^2 over many samples is k_B T, from Q = 0.5 to 1e5. Samples are so far apart that they
// are nearly independent (5 time constants; correlation 0.7 %).
TEST(SensingElement, Equipartition) {
  std::uint32_t entity = 0;
  for (const double q : {0.5, 0.7, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5}) {
    ElementFigures f = quiet(q);
    f.filter_order = 0;
    const double w = 2.0 * kPi * f.resonance_hz, step_s = 10.0 * std::max(q, 1.0) / w;
    SensingElement axis = element(f, step_s, entity++);
    const int n = 20000, begin = 20;
    double position2 = 0.0, speed2 = 0.0;
    for (int k = 0; k < begin + n; ++k) {
      axis.advance(k, 0.0);
      if (k < begin) continue;
      position2 += std::pow(axis.mechanics_state()(0), 2);
      speed2 += std::pow(axis.mechanics_state()(1), 2);
    }
    const double thermal = kBoltzmann * kTemperature_k / f.mass_kg;  // of w^2 x^2 and of v^2
    std::printf("Q %8g: k <x^2> / k_B T = %.4f, m <v^2> / k_B T = %.4f (band %.4f)\n", q, position2 / n / thermal,
                speed2 / n / thermal, four_sigma_of_variance(n));
    EXPECT_NEAR(position2 / n / thermal, 1.0, four_sigma_of_variance(n)) << q;
    EXPECT_NEAR(speed2 / n / thermal, 1.0, four_sigma_of_variance(n)) << q;
  }
}

// Point samples of a 5 kHz mass at 125 Hz, without an anti-alias filter, fold all of the resonance into the band: the
// noise grows by sqrt(w0 Q / (2 fs)), 35 times at Q = 10 and 3545 times at Q = 1e5.
TEST(SensingElement, PointSamplingFoldsTheResonanceIn) {
  for (const auto& [q, factor] : {std::pair{10.0, 35.45}, std::pair{1e5, 3545.0}}) {
    ElementFigures f = quiet(q);
    f.filter_order = 0;
    const double step_s = 1.0 / 125.0, w = 2.0 * kPi * f.resonance_hz;
    const double density = accel_thermal_density(kTemperature_k, w, f.mass_kg, q), in_band = density * std::sqrt(62.5);
    // At Q = 1e5 the mass forgets in 2 Q / w = 6.4 s, 800 samples; then every 4000th counts, one exact step away.
    const double stride = std::max(1.0, std::round(10.0 * q / w / step_s));
    const int n = 4000;
    SensingElement axis = element(f, stride * step_s);
    double square = 0.0;
    for (int k = 0; k < n + 4; ++k) {
      const double sample = axis.advance(k, 0.0) / (stride * step_s);
      if (k >= 4) square += sample * sample;
    }
    const double measured = std::sqrt(square / n) / in_band;
    std::printf("Q %g: point samples %.4g times the noise of the band (theory %.4g)\n", q, measured,
                std::sqrt(w * q / 250.0));
    EXPECT_NEAR(std::sqrt(w * q / 250.0) / factor, 1.0, 1e-3);
    EXPECT_NEAR(measured * measured / (w * q / 250.0), 1.0, four_sigma_of_variance(n)) << q;
    // Averaged over the sample behind a filter, the same mass shows its density and nothing else.
    f.filter_order = 2;
    f.bandwidth_hz = 40.0;
    SensingElement filtered = element(f, step_s, 1);
    double sum = 0.0, sum2 = 0.0;
    const int blocks = 400, length = 250;  // 2 s averages: far below the corner
    for (int b = 0; b < blocks; ++b, sum = 0.0) {
      for (int k = 0; k < length; ++k) sum += filtered.advance(b * length + k, 0.0);
      sum2 += std::pow(sum / (length * step_s), 2);
    }
    const double expected = 0.5 * density * density / (length * step_s);  // N = density / sqrt(2)
    EXPECT_NEAR(sum2 / blocks / expected, 1.0, four_sigma_of_variance(blocks)) << q;
  }
}

// A 5 kHz vibration sampled at 125 Hz without a filter is a constant: 5000 = 40 * 125.
TEST(SensingElement, FiveKilohertzAliasesToZero) {
  ElementFigures f = quiet(1e5);
  f.filter_order = 0;
  f.mass_kg = 1e-3;  // thermal noise: 3e-7 of the input per step
  SensingElement axis = element(f, 1.0 / 125.0);
  axis.settle(9.81);
  // Left to ring by a step back to zero: exact sampling sees the ringing stand still, but for its slow decay.
  double previous = 9.81;
  for (int k = 0; k < 50; ++k) {
    const double sample = axis.advance(k, 0.0) * 125.0;
    EXPECT_NEAR(sample / previous, std::exp(-2.0 * kPi * 5000.0 / 2e5 / 125.0), 2e-6) << k;  // 6 sigma
    previous = sample;
  }
}

// An input at resonance is read Q times too large; the gain is that of the equation.
TEST(SensingElement, ResonancePeaks) {
  ElementFigures f = quiet(7.0);
  f.filter_order = 0;
  f.resonance_hz = 1500.0;
  f.mass_kg = 1e-6;  // thermal noise far below
  const double step_s = 1.0 / 150000.0;
  SensingElement axis = element(f, step_s);
  for (const double hz : {100.0, 750.0, 1500.0, 3000.0}) {
    double amplitude = 0.0;
    const int per_period = static_cast<int>(std::lround(150000.0 / hz));
    for (int k = 0; k < 40 * per_period; ++k) {
      // Mean of the sine over the step, which is what a held input must be.
      const double phase = 2.0 * kPi * hz * step_s;
      const double u = (std::cos(phase * k) - std::cos(phase * (k + 1))) / phase;
      const double sample = axis.advance(k, u) / step_s;
      if (k >= 39 * per_period) amplitude = std::max(amplitude, std::abs(sample));
    }
    const double ratio = hz / 1500.0;
    const double theory = 1.0 / std::hypot(1.0 - ratio * ratio, ratio / 7.0);
    EXPECT_NEAR(axis.gain(hz), theory, 1e-9 * theory) << hz;
    // Truncation at n samples to a period: mean and hold of the input (pi / n)^2 / 6 each, the peak (pi / n)^2 / 2.
    EXPECT_NEAR(amplitude / theory, 1.0, 1.5 * std::pow(kPi / per_period, 2) + 1e-3) << hz;
  }
  EXPECT_NEAR(axis.gain(1500.0), 7.0, 1e-9);
}

// The anti-alias filter: -3 dB at its corner, -40 dB a decade above for order 2.
TEST(SensingElement, FilterHasItsCorner) {
  for (int order = 1; order <= 4; ++order) {
    const LinearPlant filter = butterworth(order, 40.0);
    EXPECT_NEAR(filter.gain(1e-6), 1.0, 1e-9) << order;
    for (const double hz : {10.0, 40.0, 400.0})
      EXPECT_NEAR(filter.gain(hz), 1.0 / std::sqrt(1.0 + std::pow(hz / 40.0, 2 * order)), 1e-9) << order << " " << hz;
  }
}

// Constant input, any pick-off that reads at rest: the increments are the input's, but for the pick-off's curve.
TEST(SensingElement, ReadsAConstantInput) {
  ElementFigures f = quiet(1.0);
  f.mass_kg = 1e-3;
  SensingElement linear = element(f, 0.01);
  linear.settle(9.81);
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(linear.advance(k, 9.81), 0.0981, 4e-7);  // 6 sigma of N sqrt(dt)
  f.pick_off = "capacitive";
  f.pick_off_figures = {};
  SensingElement capacitive = element(f, 0.01);
  capacitive.settle(100.0);
  const double w = 2.0 * kPi * f.resonance_hz;  // a mass of 1 g feels nothing of the electrodes' pull
  const double part = 100.0 / (w * w) / f.pick_off_figures.gap_m;
  EXPECT_NEAR(capacitive.advance(0, 100.0), 1.0 / (1.0 - part * part), 1e-4);  // 6 sigma of the amplifier
}

// A piezoelectric pick-off forgets a constant, exp(-2 pi leak t), through a mass that is late by 1 / (w0 Q) and a
// filter that is by sqrt(2) / (2 pi corner). A corner wrong by half a percent shows at 3 s, where the exponent is 1.9.
TEST(SensingElement, PiezoelectricForgetsGravity) {
  ElementFigures f = quiet(1.0);
  f.mass_kg = 1e-3;
  f.pick_off = "piezoelectric";
  f.pick_off_figures = {};
  f.pick_off_figures.loss_tangent = 0.0;
  f.pick_off_figures.charge_c_per_m = 1e-3;
  const double leak = 2.0 * kPi * f.pick_off_figures.leak_hz,
               late_s = std::sqrt(2.0) / (2.0 * kPi * f.bandwidth_hz) + 1.0 / (2.0 * kPi * f.resonance_hz);
  const double step_s = 0.01, noise_n = accelerometer_model(f, kTemperature_k)->pick_off_n;
  SensingElement crystal = element(f, step_s);
  for (int k = 0; k < 500; ++k) {
    const double sample = crystal.advance(k, 9.81), t = (k + 0.5) * step_s - late_s;
    if (k < 20) continue;  // the filter's own step response
    // The delay is that of first order in leak / corner, 0.25 %; its square is 6e-6. Six sigma of the noise.
    EXPECT_NEAR(sample, 9.81 * step_s * std::exp(-leak * t),
                1e-5 * 9.81 * step_s + 6.0 * noise_n * std::sqrt(step_s) + 4e-7)
        << k;
  }
}

// A shock beyond stops and front end: the output stays at the limit, and comes back with the filter's tail alone.
TEST(SensingElement, OverloadClipsAndRecovers) {
  ElementFigures f = quiet(1.0);
  f.mass_kg = 1e-6;
  f.range = 10.0;  // g
  f.bandwidth_hz = 100.0;
  f.filter_order = 1;
  const double step_s = 1.0 / 1000.0, limit = 10.0 * kStandardGravity;
  SensingElement axis = element(f, step_s);
  axis.settle(0.0);
  double most = 0.0;
  for (int k = 0; k < 200; ++k) most = std::max(most, axis.advance(k, 1000.0 * kStandardGravity) / step_s);
  EXPECT_NEAR(most / limit, 1.0, 1e-4);
  EXPECT_EQ(axis.overloads(), 200);
  const double tau_s = 1.0 / (2.0 * kPi * 100.0);
  double before = 0.0;
  for (int k = 200; k < 215; ++k) {
    const double sample = axis.advance(k, 0.0) / step_s;
    // The mass needs some tenths of a millisecond to come back from the stop; then the filter is left to itself. Six
    // sigma of the noise, 1e-6 / step_s, of a tail that is then 5 m/s^2.
    if (k > 201 && k < 206) {
      EXPECT_NEAR(sample / before, std::exp(-step_s / tau_s), 1e-3) << k;
    }
    before = sample;
  }
  EXPECT_LT(axis.overloads(), 203);
  for (int k = 215; k < 300; ++k) axis.advance(k, 5.0);
  EXPECT_NEAR(axis.advance(300, 5.0), 0.005, 1e-6);
}

// Short steps and one exact step are the same system where nothing is hit: a limit just out of reach changes nothing
// but the draws, a limit that is looked for and not met neither.
TEST(SensingElement, ShortStepsAgreeWithTheWhole) {
  ElementFigures f = quiet(5.0);
  f.mass_kg = 1e-3;
  const auto run = [&](double range) {
    ElementFigures g = f;
    g.range = range;
    SensingElement axis = element(g, 0.01);
    axis.settle(0.0);
    double sum = 0.0;
    // Just within the limit; the bound on ringing reaches beyond, so that it must be looked at.
    for (int k = 0; k < 20; ++k) sum += axis.advance(k, k % 2 ? 9.0 : -9.0);
    EXPECT_EQ(axis.overloads() > 0, range > 0.0);
    return sum;
  };
  EXPECT_NEAR(run(2.5), run(0.0), 2e-6);  // 6 sigma of two N sqrt(0.2 s)
}

TEST(SensingElement, PullInIsAnError) {
  ElementFigures f;
  f.pick_off_figures.bias_v = 50.0;
  EXPECT_EQ(
      accelerometer_model(f, 300.0).error().str(),
      "mems.accel.pick_off_figures.bias_v: pulls the mass in: the electrodes' pull exceeds the spring, expected a "
      "lower voltage, a wider gap or a stiffer spring");
}

// The electrodes' pull lowers the resonance: w^2 = w0^2 + k_e / m.
TEST(SensingElement, CapacitiveBiasSoftensTheSpring) {
  ElementFigures f;
  const ElementModel model = *accelerometer_model(f, 300.0);
  const double stiffness = f.mass_kg * std::pow(2.0 * kPi * 5000.0, 2), pull = -2.0 * 1e-13 * 0.25 / 4e-12;
  EXPECT_NEAR(model.fastest_hz / 5000.0, std::sqrt((stiffness + pull) / stiffness), 1e-12);
}

TEST(PickOff, NoiseByHand) {
  const PickOffFigures f;
  EXPECT_NEAR(make_capacitive(f)->noise_m_sqrt_hz(300.0), 2e-6 * 5e-9 * 2.2e-12 / (2e-13 * 0.5), 1e-25);
  // sqrt(4 k_B 300 K 5 kOhm) = 9.1 nV / sqrt(Hz).
  EXPECT_NEAR(make_piezoresistive(f)->noise_m_sqrt_hz(300.0) * 0.5 * 100.0 * 100.0, 9.103e-9, 2e-12);
  EXPECT_NEAR(make_piezoelectric(f)->noise_m_sqrt_hz(300.0),
              std::sqrt(4.0 * kBoltzmann * 300.0 * 1e-13 * 0.002 / (2.0 * kPi * 10.0) +
                        // of the leak, R = 1 / (2 pi 0.1 Hz 0.1 pF): a current, over w a charge
                        4.0 * kBoltzmann * 300.0 * 2.0 * kPi * 0.1 * 1e-13 / std::pow(2.0 * kPi * 10.0, 2)) /
                  1e-6,
              1e-25);
}

/// The whole oscillation of a gyroscope's sense mode, by small Runge-Kutta steps, and its demodulation: what the
/// envelope equations stand for.
double demodulated_rate(const ElementFigures& f, double rate, double seconds) {
  const double w = 2.0 * kPi * f.resonance_hz, split = 2.0 * kPi * f.split_hz, wd = w - split;
  const double g = w / (2.0 * f.quality_factor);
  double y = 0.0, v = 0.0, t = 0.0, in = 0.0, quad = 0.0;
  const double h = 2.0 * kPi / wd / 200.0;
  const auto force = [&](double time) { return -2.0 * rate * f.drive_amplitude_m * wd * std::cos(wd * time); };
  const auto slope = [&](double time, double yy, double vv) { return force(time) - 2.0 * g * vv - w * w * yy; };
  const int steps = static_cast<int>(seconds / h), average = 200 * 50;
  for (int k = 0; k < steps; ++k, t += h) {
    const double k1 = slope(t, y, v), k2 = slope(t + h / 2, y + h / 2 * v, v + h / 2 * k1);
    const double k3 = slope(t + h / 2, y + h / 2 * (v + h / 2 * k1), v + h / 2 * k2);
    const double k4 = slope(t + h, y + h * (v + h / 2 * k2), v + h * k3);
    y += h * v + h * h / 6 * (k1 + k2 + k3);
    v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (k < steps - average) continue;
    in += 2.0 * y * std::cos(wd * (t + h)) / average;
    quad -= 2.0 * y * std::sin(wd * (t + h)) / average;
  }
  // a = A / (j x_d), A = in + j quad; Re(a (g - j d)).
  const double re = quad / f.drive_amplitude_m, im = -in / f.drive_amplitude_m;
  return re * g + im * split;
}

TEST(Gyroscope, EnvelopeIsTheOscillationDemodulated) {
  ElementFigures f;
  f.resonance_hz = 10000.0;
  f.mass_kg = 1e-8;
  f.quality_factor = 200.0;
  for (const double split_hz : {0.0, 100.0}) {
    f.split_hz = split_hz;
    // Rotating-wave: 1 / Q and split / resonance.
    EXPECT_NEAR(demodulated_rate(f, 1.0, 0.1), 1.0, 1.0 / 200.0 + split_hz / 10000.0) << split_hz;
    const ElementModel model = *gyroscope_model(f, 300.0);
    EXPECT_NEAR(model.mechanics.gain(1e-9), 1.0, 1e-12) << split_hz;
  }
  // Split modes resonate at the split.
  f.split_hz = 500.0;
  f.quality_factor = 2000.0;
  const LinearPlant split = gyroscope_model(f, 300.0)->mechanics;
  const std::complex<double> g = kPi * f.resonance_hz / f.quality_factor, d = 2.0 * kPi * 500.0,
                             s = std::complex<double>(0.0, 2.0 * kPi * 500.0);
  const double closed_form = std::abs((g * (s + g) + d * d) / ((s + g) * (s + g) + d * d));
  EXPECT_GT(closed_form, 50.0);
  EXPECT_NEAR(split.gain(500.0) / closed_form, 1.0, 1e-9);
}

// Thermal rate noise: the density of the paper's corrected formula, and the energy k_B T in the sense mode.
TEST(Gyroscope, ThermalNoiseIsTheFormulas) {
  ElementFigures f;
  f.resonance_hz = 10000.0;
  f.mass_kg = 1e-8;
  f.quality_factor = 1000.0;
  f.pick_off = "piezoresistive";
  f.pick_off_figures.bridge_ohm = 1.0;
  f.pick_off_figures.bias_v = 100.0;
  f.bandwidth_hz = 40.0;
  const double w = 2.0 * kPi * 1e4, xd = f.drive_amplitude_m;
  const ElementModel model = *gyroscope_model(f, kTemperature_k);
  EXPECT_NEAR(model.thermal_n / gyro_thermal_density(kTemperature_k, w, 1e-8, 1000.0, xd), 1.0, 1e-12);
  const Eigen::MatrixXd p = stationary_covariance(exact_step(model.mechanics, 0.01));
  // <y^2> = <|A|^2> / 2 = x_d^2 (p11 + p22) / 2.
  EXPECT_NEAR(f.mass_kg * w * w * xd * xd * 0.5 * (p(0, 0) + p(1, 1)) / (kBoltzmann * kTemperature_k), 1.0, 1e-9);
  SensingElement axis(model, 0.0, "exact", 0.01, RandomStream(3, "test.gyro"), 0);
  double sum = 0.0, sum2 = 0.0;
  const int blocks = 1000, length = 100;
  for (int b = 0; b < blocks; ++b, sum = 0.0) {
    for (int k = 0; k < length; ++k) sum += axis.advance(b * length + k, 0.0);
    sum2 += sum * sum;  // angle over 1 s: N^2
  }
  EXPECT_NEAR(sum2 / blocks / (model.thermal_n * model.thermal_n), 1.0, four_sigma_of_variance(blocks));
}

}  // namespace
}  // namespace canyon::inertial
