// Pick-offs and sensing elements by their figures, against the formulas that their models cite.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/mems/sensing_element.h"
#include "canyon/inertial/paper_formulas.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

constexpr double kBoltzmannConstant = 1.380649e-23;

/// Figures that are drawn about usual ones, by up to a factor of two.
PickOffFigures drawn_pick_off(const RandomStream& draws, std::uint64_t k) {
  const auto times = [&](std::uint32_t n) { return std::exp2(draws.uniform(-1.0, 1.0, 0, k, n)); };
  PickOffFigures f;
  f.gap_m = 2e-6 * times(0), f.bias_v = 0.5 * times(1), f.capacitance_f = 1e-13 * times(2),
  f.parasitic_f = 2e-12 * times(3);
  f.amplifier_v_sqrt_hz = 5e-9 * times(4), f.bridge_ohm = 5e3 * times(5), f.gauge_factor = 100.0 * times(6);
  f.strain_per_m = 100.0 * times(7), f.strain_cubic = 0.01 * times(8), f.charge_c_per_m = 1e-6 * times(9);
  f.leak_hz = 0.1 * times(10), f.loss_tangent = 0.002 * times(11);
  return f;
}

/// Readings, noise and pull of each pick-off by its physics: capacitances of two gaps, bridges, charges. Roundings, and
/// of a small difference of capacitances 1 / share of them.
StressFigure pick_off_laws() {
  Looks looks;
  const RandomStream draws(1, "stress.pick_offs");
  for (std::uint64_t k = 0; k < 40; ++k) {
    const PickOffFigures f = drawn_pick_off(draws, k);
    const double kelvin = draws.uniform(200.0, 400.0, 1, k), four_kt = 4.0 * kBoltzmannConstant * kelvin;
    const auto plates = make_capacitive(f), bridge = make_piezoresistive(f), crystal = make_piezoelectric(f);
    for (const double share : {-0.9, -0.4, 0.01, 0.2, 0.6, 0.95}) {
      const double x = share * f.gap_m;
      // Two capacitors of gaps g - x and g + x: their difference over twice their size at rest, in displacements.
      const double near_f = f.capacitance_f * f.gap_m / (f.gap_m - x),
                   far_f = f.capacitance_f * f.gap_m / (f.gap_m + x);
      looks.near(plates->reading_m(x) / ((near_f - far_f) / (2.0 * f.capacitance_f) * f.gap_m), 1.0,
                 64.0 * kEpsilon / std::abs(share));
      looks.close(bridge->reading_m(x), x + f.strain_cubic * x * share * share, 8.0);
      looks.right(crystal->reading_m(x) == x);
    }
    // Voltage noise through the divider of both sides and the parasitic one; the pull is the force's slope.
    const double gain_v_m = f.bias_v / f.gap_m * 2.0 * f.capacitance_f / (2.0 * f.capacitance_f + f.parasitic_f);
    looks.close(plates->noise_m_sqrt_hz(kelvin), f.amplifier_v_sqrt_hz / gain_v_m, 16.0);
    looks.close(plates->added_stiffness_n_m(), -2.0 * f.capacitance_f * std::pow(f.bias_v / f.gap_m, 2), 16.0);
    looks.close(bridge->noise_m_sqrt_hz(kelvin),
                std::sqrt(four_kt * f.bridge_ohm) / (f.bias_v * f.gauge_factor * f.strain_per_m), 16.0);
    const double w = 2.0 * kPi * 100.0 * f.leak_hz, leak_ohm = 1.0 / (2.0 * kPi * f.leak_hz * f.capacitance_f);
    const double charge2 = four_kt * f.capacitance_f * f.loss_tangent / w + four_kt / (leak_ohm * w * w);
    looks.close(crystal->noise_m_sqrt_hz(kelvin), std::sqrt(charge2) / f.charge_c_per_m, 32.0);
    looks.right(crystal->low_corner_hz() == f.leak_hz && plates->low_corner_hz() == 0.0 &&
                bridge->low_corner_hz() == 0.0);
    looks.right(crystal->added_stiffness_n_m() == 0.0 && bridge->added_stiffness_n_m() == 0.0);
  }
  return looks.figure();
}

/// Both kinds of element from drawn figures: gains at any frequency, thermal noise by equipartition and its density,
/// the pick-off's in the input's unit, stops, clips and curves. Roundings of a resonance's difference.
StressFigure element_laws() {
  Looks looks;
  const RandomStream draws(2, "stress.elements");
  for (const char* pick_off : {"capacitive", "piezoresistive", "piezoelectric"})
    for (std::uint64_t k = 0; k < 12; ++k) {
      ElementFigures f;
      const auto times = [&](std::uint32_t n) { return std::exp2(draws.uniform(-1.0, 1.0, 0, k, n)); };
      f.mass_kg = 1e-9 * times(0), f.resonance_hz = 5000.0 * times(1), f.quality_factor = 3.0 * times(2);
      f.travel_m = 1e-6 * times(3), f.drive_amplitude_m = 5e-6 * times(4), f.split_hz = 90.0 * times(5);
      f.range = 20.0 * times(6), f.bandwidth_hz = 200.0 * times(7),
      f.filter_order = 1 + static_cast<std::int64_t>(k % 4);
      f.pick_off = pick_off;
      f.pick_off_figures = drawn_pick_off(draws, k + 100);
      f.pick_off_figures.gap_m = 3.0 * f.travel_m;  // so that the pull leaves a spring
      const double kelvin = draws.uniform(200.0, 400.0, 1, k);
      const auto reads = model_row(pick_offs(), pick_off).make(f.pick_off_figures);
      const auto accel = accelerometer_model(f, kelvin), gyro = gyroscope_model(f, kelvin);
      if (!accel || !gyro) return {kInfinity, 1.0};
      const double w0 = 2.0 * kPi * f.resonance_hz, damping = w0 / f.quality_factor;
      const double w2 = w0 * w0 + reads->added_stiffness_n_m() / f.mass_kg, w = std::sqrt(w2);
      for (const double hz : {1.0, 300.0, 0.9 * f.resonance_hz, 1.1 * f.resonance_hz, 5.0 * f.resonance_hz}) {
        const double v = 2.0 * kPi * hz;
        looks.near(accel->mechanics.gain(hz) / (w2 / std::hypot(w2 - v * v, damping * v)), 1.0, 1e-12);
      }
      // Equipartition: the variance of w x and of x' is k T / m, and A P + P A' takes what the noise brings.
      const Eigen::Matrix2d P = kBoltzmannConstant * kelvin / f.mass_kg * Eigen::Matrix2d::Identity();
      const Eigen::MatrixXd left =
          accel->mechanics.A * P + P * accel->mechanics.A.transpose() + accel->mechanics.intensity;
      looks.near(left.norm() / accel->mechanics.intensity.norm(), 0.0, 32.0 * kEpsilon * f.quality_factor * 4.0);
      looks.close(accel->thermal_n, std::sqrt(2.0 * kBoltzmannConstant * kelvin * w0 / (f.mass_kg * f.quality_factor)),
                  16.0);
      looks.close(accel->thermal_n * std::sqrt(2.0), accel_thermal_density(kelvin, w0, f.mass_kg, f.quality_factor),
                  16.0);
      // Two-sided, of a one-sided density of displacements.
      looks.close(accel->pick_off_n, w2 * reads->noise_m_sqrt_hz(kelvin) / std::sqrt(2.0), 16.0);
      looks.close(accel->stop, w * f.travel_m, 16.0), looks.close(accel->fastest_hz, w / (2.0 * kPi), 16.0);
      looks.close(accel->clip, f.range * kStandardGravity, 8.0), looks.close(gyro->clip, f.range * kPi / 180.0, 8.0);
      for (const ElementModel* model : {&*accel, &*gyro}) {
        looks.right(model->filter_order == f.filter_order && model->bandwidth_hz == f.bandwidth_hz);
        const double metres =
            model == &*accel ? 1.0 / w2 : f.drive_amplitude_m / std::hypot(0.5 * damping, 2.0 * kPi * f.split_hz);
        for (const double share : {-1.5, -0.5, 1e-3, 0.8, 2.0}) {
          const double x = std::clamp(share, -0.99, 0.99) * f.pick_off_figures.gap_m;
          looks.close(model->characteristic(share * f.pick_off_figures.gap_m / metres), reads->reading_m(x) / metres,
                      1e4);
        }
      }
      looks.right(accel->low_corner_hz == reads->low_corner_hz() && gyro->low_corner_hz == 0.0);
      // A rate is read as itself at rest, and rings at the split: |g - j d| over the distance to the poles -g + j d.
      const std::complex<double> pole(-0.5 * damping, 2.0 * kPi * f.split_hz);
      for (const double hz : {0.0, 20.0, 80.0, 300.0}) {
        const std::complex<double> s(0.0, 2.0 * kPi * hz);
        // Re(a (g - j d)) of a' = pole a + Omega, by both conjugate halves.
        const std::complex<double> out = 0.5 * (-pole / (s - pole) - std::conj(pole) / (s - std::conj(pole)));
        looks.near(gyro->mechanics.gain(hz) / std::abs(out), 1.0, 1e-12);
      }
      looks.close(gyro->thermal_n, gyro_thermal_density(kelvin, w0, f.mass_kg, f.quality_factor, f.drive_amplitude_m),
                  16.0);
      looks.close(gyro->thermal_n,
                  std::sqrt(kBoltzmannConstant * kelvin / (f.mass_kg * w0 * f.quality_factor)) / f.drive_amplitude_m,
                  16.0);
      looks.near((gyro->mechanics.intensity / std::pow(gyro->thermal_n, 2) - Eigen::Matrix2d::Identity()).norm(), 0.0,
                 16.0 * kEpsilon);
      looks.close(
          gyro->pick_off_n,
          reads->noise_m_sqrt_hz(kelvin) * std::hypot(0.5 * damping, 2.0 * kPi * f.split_hz) / f.drive_amplitude_m,
          32.0);
      looks.close(gyro->fastest_hz, std::hypot(0.5 * damping, 2.0 * kPi * f.split_hz) / (2.0 * kPi), 16.0);
      // With its low-pass, and a crystal's leak before that.
      const SensingElement element(*accel, 0.0, "exact", 0.01, RandomStream(1, "stress"), 0);
      for (const double hz : {0.02, 0.1, 1.0, 200.0, 700.0}) {
        const double low =
            1.0 / std::sqrt(1.0 + std::pow(hz / f.bandwidth_hz, 2.0 * static_cast<double>(f.filter_order)));
        const double leak = accel->low_corner_hz, high = leak > 0.0 ? hz / std::hypot(hz, leak) : 1.0;
        looks.near(element.gain(hz) / (accel->mechanics.gain(hz) * low * high), 1.0, 1e-9);
      }
    }
  // A bias that pulls more than the spring holds.
  ElementFigures soft;
  soft.resonance_hz = 50.0, soft.pick_off_figures.bias_v = 100.0;
  looks.right(!accelerometer_model(soft, 300.0).ok());
  return looks.figure();
}

/// A crystal at rest in gravity: it reads nothing, and a step fades by e^(-w t) of its leak; where there is no filter a
/// leak is refused. The resonance follows to (w h)^2 of the sample's own fading; noise is put off.
StressFigure crystal() {
  Looks looks;
  ElementFigures f;
  f.pick_off = "piezoelectric", f.mass_kg = 1e3, f.resonance_hz = 5000.0, f.filter_order = 2, f.bandwidth_hz = 400.0;
  f.pick_off_figures.leak_hz = 0.5, f.travel_m = 1e-3;
  auto model = accelerometer_model(f, 300.0);
  if (!model) return {kInfinity, 1.0};
  model->pick_off_n = 0.0;
  constexpr double kSample_s = 0.01;
  SensingElement resting(*model, 0.0, "exact", kSample_s, RandomStream(1, "stress"), 0);
  resting.settle(9.81);
  for (int k = 0; k < 20; ++k) looks.near(resting.advance(k, 9.81) / (9.81 * kSample_s), 0.0, 1e-6);
  SensingElement stepped(*model, 0.0, "exact", kSample_s, RandomStream(1, "stress"), 0);
  const double rate = 2.0 * kPi * 0.5;
  double before = 0.0;
  for (int k = 0; k < 100; ++k) {
    const double now = stepped.advance(k, 3.0) / (3.0 * kSample_s);
    // From the second sample on all but the leak has settled: its means fall by e^(-w h) each.
    if (k > 3) looks.near(now / before, std::exp(-rate * kSample_s), 1e-6);
    before = now;
  }
  looks.right(std::abs(before) < 0.06);
  model->filter_order = 0;
  looks.right(
      stress::not_refused([&] { SensingElement(*model, 0.0, "exact", kSample_s, RandomStream(1, "stress"), 0); }) == 0);
  looks.right(stress::not_refused([&] { stepped.advance(-1, 0.0); }) == 0 &&
              stress::not_refused([&] { stepped.advance(100, std::nan("")); }) == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> sensing_element_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "sensing elements by their figures",
           "a density of the other side, a spring without its pull, degrees",
           "the formulas that the models cite, of drawn figures: roundings", "of the bound"});
  rows.add("elements/pick_offs", pick_off_laws).add("elements/masses", element_laws).add("elements/crystal", crystal);
  return rows.take();
}

}  // namespace canyon::inertial
