// Sensing elements by their figures, against the formulas that their models cite; what the masses of a whole unit make
// of noise; and what chains of links say of themselves.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/mems/sensing_element.h"
#include "canyon/inertial/paper_figures.h"
#include "canyon/inertial/paper_formulas.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
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
  constexpr double kStep_s = 0.01;
  SensingElement resting(*model, 0.0, "exact", kStep_s, RandomStream(1, "stress"), 0);
  resting.settle(9.81);
  for (int k = 0; k < 20; ++k) looks.near(resting.advance(k, 9.81) / (9.81 * kStep_s), 0.0, 1e-6);
  SensingElement stepped(*model, 0.0, "exact", kStep_s, RandomStream(1, "stress"), 0);
  const double rate = 2.0 * kPi * 0.5;
  double before = 0.0;
  for (int k = 0; k < 100; ++k) {
    const double now = stepped.advance(k, 3.0) / (3.0 * kStep_s);
    // From the second sample on all but the leak has settled: its means fall by e^(-w h) each.
    if (k > 3) looks.near(now / before, std::exp(-rate * kStep_s), 1e-6);
    before = now;
  }
  looks.right(std::abs(before) < 0.06);
  model->filter_order = 0;
  looks.right(
      stress::not_refused([&] { SensingElement(*model, 0.0, "exact", kStep_s, RandomStream(1, "stress"), 0); }) == 0);
  looks.right(stress::not_refused([&] { stepped.advance(-1, 0.0); }) == 0 &&
              stress::not_refused([&] { stepped.advance(100, std::nan("")); }) == 0);
  return looks.figure();
}

/// A whole unit of masses at rest: sums over m samples have the variance of the sheet's white noise through a low-pass
/// of the second order, N^2 times the integral of (sin(pi f m h) / (pi f))^2 over 1 + (f / corner)^4, whatever of it
/// the masses, the pick-off or the electronics make; at the corner of [mems], else the sheet's, else 0.4 of the rate.
/// Five standard deviations; six samples of a low-pass at a tenth of the rate hang together.
StressFigure noise_of_masses(double own_hz, double sheet_hz) {
  Looks looks;
  constexpr double kRate_hz = 250.0;
  constexpr int kCount = 3600;
  CatalogueEntry entry = *load_catalogue_entry("high_grade_mems");
  entry.mems.accel.bandwidth_hz = entry.mems.gyro.bandwidth_hz = own_hz;
  entry.gyro.bandwidth_hz.value = entry.accel.bandwidth_hz.value = sheet_hz;
  // Flat far beyond the samples, and for that a heavier mass that swings further.
  entry.mems.gyro.split_hz = 2000.0, entry.mems.gyro.quality_factor = 5.0;
  entry.mems.gyro.mass_kg = 1e-6, entry.mems.gyro.drive_amplitude_m = 5e-5;
  entry.mems.gyro.pick_off_figures.amplifier_v_sqrt_hz = 2e-9;
  entry.mems.accel.filter_order = entry.mems.gyro.filter_order = 2;
  std::vector<std::string> others;
  for (const auto& row : error_links()) others.emplace_back(row.name);
  const auto chain = make_error_chain("physics", {.entry = entry, .seed = 5, .rate_hz = kRate_hz, .leave_out = others});
  if (!chain) return {kInfinity, 1.0};
  const ImuNoise sheet = entry.noise();
  looks.close((*chain)->noise().gyro.white_per_sqrt_hz, sheet.gyro.white_per_sqrt_hz, 2.0);
  looks.close((*chain)->noise().accel.white_per_sqrt_hz, sheet.accel.white_per_sqrt_hz, 2.0);
  std::array<std::vector<double>, 6> errors;
  for (int k = 0; k < kCount; ++k) {
    ImuSample s;
    s.dt_s = 1.0 / kRate_hz;
    (*chain)->corrupt(k, s);
    for (std::size_t c = 0; c < 6; ++c)
      errors[c].push_back(c < 3 ? s.dtheta_U[static_cast<Eigen::Index>(c)] : s.dv_U[static_cast<Eigen::Index>(c - 3)]);
  }
  const double corner_hz = own_hz > 0.0 ? own_hz : sheet_hz > 0.0 ? sheet_hz : 0.4 * kRate_hz;
  for (const int m : {1, 2, 5, 60}) {
    const double t = m / kRate_hz;
    // Two-sided: twice the sum over positive frequencies, to fifty corners; the rest is (1 / 50)^4.
    long double integral = 0.0L;
    constexpr int kParts = 20'000;
    const double step = 50.0 * corner_hz / kParts;
    for (int i = 0; i < kParts; ++i) {
      const double hz = (i + 0.5) * step, x = std::sin(kPi * hz * t) / (kPi * hz);
      integral += 2.0 * step * x * x / (1.0 + std::pow(hz / corner_hz, 4));
    }
    for (std::size_t triad = 0; triad < 2; ++triad) {
      const double n = triad == 0 ? sheet.gyro.white_per_sqrt_hz : sheet.accel.white_per_sqrt_hz;
      double square = 0.0, count = 0.0;
      for (std::size_t c = 3 * triad; c < 3 * triad + 3; ++c)
        for (int begin = 12; begin + m <= kCount; begin += m, count += 1.0) {
          double sum = 0.0;
          for (int i = begin; i < begin + m; ++i) sum += errors[c][static_cast<std::size_t>(i)];
          square += sum * sum;
        }
      const double together = std::max(1.0, 0.6 * kRate_hz / corner_hz / m);
      looks.near(square / count / (n * n * static_cast<double>(integral)), 1.0,
                 5.0 * std::sqrt(2.0 * together / count));
    }
  }
  return looks.figure();
}

/// Units of masses that cannot be: without figures, noisier than their sheet, or carried by a scheme that diverges.
StressFigure refused_masses() {
  int passed = 0;
  const CatalogueEntry entry = *load_catalogue_entry("high_grade_mems");
  const auto made = [](const CatalogueEntry& e, double rate_hz) {
    return make_error_chain("physics", {.entry = e, .seed = 1, .rate_hz = rate_hz}).ok() ? 1 : 0;
  };
  passed += 1 - made(entry, 100.0);
  CatalogueEntry other = entry;
  other.mems.given = false;
  passed += made(other, 100.0);
  for (const bool gyro : {true, false}) {
    other = entry;
    (gyro ? other.mems.gyro : other.mems.accel).mass_kg = 1e-14;
    passed += made(other, 100.0);
  }
  other = entry;
  other.mems.integrator = "rk4";
  passed += made(other, 100.0);
  other = entry;
  other.paper.given = false;
  passed += make_error_chain("paper", {.entry = other, .seed = 1, .rate_hz = 100.0}).ok() ? 1 : 0;
  passed += make_error_chain("none", {.entry = entry, .seed = 1, .rate_hz = 100.0, .leave_out = {"ramp"}}).ok() ? 1 : 0;
  passed += make_error_chain("full", {.entry = entry, .seed = 1, .rate_hz = 100.0, .leave_out = {"rump"}}).ok() ? 1 : 0;
  passed += make_error_chain("half", {.entry = entry, .seed = 1, .rate_hz = 100.0}).ok() ? 1 : 0;
  return {1.0 * passed, 0.0};
}

/// Samples of a mass asked for one after the other, and anew from the middle: what it has forgotten is below a double's
/// last digit, so that from where the unit's own memory reaches on the two agree to 64 roundings.
StressFigure masses_forget() {
  Looks looks;
  CatalogueEntry entry = *load_catalogue_entry("high_grade_mems");
  std::vector<std::string> others;
  for (const auto& row : error_links()) others.emplace_back(row.name);
  const ChainSetup setup{.entry = entry, .seed = 5, .rate_hz = 250.0, .leave_out = others};
  const auto whole = make_error_chain("physics", setup), part = make_error_chain("physics", setup);
  if (!whole || !part) return {kInfinity, 1.0};
  const std::int64_t memory = (*whole)->memory();
  looks.right(memory > 2 && memory < 2000);
  const auto sample = [](std::int64_t k) {
    ImuSample s;
    s.dt_s = 0.004;
    s.dtheta_U = 0.004 * Vector3d(std::sin(0.3 * static_cast<double>(k)), 0.5, -0.2);
    s.dv_U = 0.004 * Vector3d(1.0, std::cos(0.2 * static_cast<double>(k)), 9.8);
    return s;
  };
  std::vector<ImuSample> all;
  for (std::int64_t k = 0; k < 2 * memory + 30; ++k) {
    ImuSample s = sample(k);
    (*whole)->corrupt(k, s);
    all.push_back(s);
  }
  for (std::int64_t k = memory; k < 2 * memory + 30; ++k) {
    ImuSample s = sample(k);
    (*part)->corrupt(k, s);
    if (k < 2 * memory) continue;
    const ImuSample& same = all[static_cast<std::size_t>(k)];
    looks.near((s.dtheta_U - same.dtheta_U).norm(), 0.0, 64.0 * kEpsilon * 0.004 * 1.2 + 1e-15);
    looks.near((s.dv_U - same.dv_U).norm(), 0.0, 64.0 * kEpsilon * 0.004 * 10.0 + 1e-14);
  }
  return looks.figure();
}

/// What a filter is told of a whole unit: roots of sums of squares of what its links leave at rest; and which links act
/// in which chain, by leaving all others out of the whole one: to the bit.
StressFigure told() {
  Looks looks;
  CatalogueEntry entry;
  const RandomStream draws(3, "stress.told");
  const auto size = [&](std::uint32_t n) { return draws.uniform(0.5, 2.0, 0, n); };
  entry.gyro.arw_deg_per_sqrt_hr.value = 0.2 * size(0), entry.accel.vrw_m_s_per_sqrt_hr.value = 0.1 * size(1);
  entry.gyro.turn_on_bias_deg_per_hr.value = 5.0 * size(2), entry.accel.turn_on_bias_mg.value = 0.8 * size(3);
  entry.gyro.in_run_bias_deg_per_hr.value = 2.0 * size(4), entry.accel.in_run_bias_mg.value = 0.1 * size(5);
  entry.gyro.in_run_bias_tau_s.value = 400.0, entry.accel.in_run_bias_tau_s.value = 700.0;
  entry.gyro.scale_ppm.value = 300.0 * size(6), entry.accel.scale_ppm.value = 200.0 * size(7);
  entry.gyro.misalignment_mrad.value = 1.0 * size(8), entry.accel.misalignment_mrad.value = 0.7 * size(9);
  entry.gyro.package_misalignment_mrad.value = 2.0 * size(10),
  entry.accel.package_misalignment_mrad.value = 1.5 * size(11);
  entry.gyro.bias_temperature_deg_per_hr_per_k.value = 0.3 * size(12),
  entry.accel.bias_temperature_mg_per_k.value = 0.05 * size(13);
  entry.gyro.g_sensitivity_deg_per_hr_per_g.value = 4.0 * size(14);
  entry.gyro.vibration_rectification_deg_per_hr_per_g2.value = 0.5 * size(15);
  entry.accel.vibration_rectification_mg_per_g2.value = 0.05 * size(16);
  entry.gyro.bias_instability_deg_per_hr.value = 1.0;
  entry.unit.reference_temperature_c.value = 20.0;
  Environment around;
  around.temperature_times_s = {0.0, 100.0}, around.temperatures_c = {-5.0, 35.0};
  around.vibration_rms_m_s2 = Vector3d(4.0, 12.0, 7.0);
  const double per_hour = kDegree / 3600.0, mg = 1e-3 * 9.80665, g = 9.80665;
  const double of_gyro =
                   std::sqrt(
                       std::pow(entry.gyro.turn_on_bias_deg_per_hr.value, 2) +
                       std::pow(25.0 * entry.gyro.bias_temperature_deg_per_hr_per_k.value, 2) +
                       std::pow(entry.gyro.g_sensitivity_deg_per_hr_per_g.value, 2) +
                       std::pow(entry.gyro.vibration_rectification_deg_per_hr_per_g2.value * 144.0 / (g * g), 2)) *
                   per_hour,
               of_accel =
                   std::sqrt(std::pow(entry.accel.turn_on_bias_mg.value, 2) +
                             std::pow(25.0 * entry.accel.bias_temperature_mg_per_k.value, 2) +
                             std::pow(entry.accel.vibration_rectification_mg_per_g2.value * 144.0 / (g * g), 2)) *
                   mg;
  const auto chain_of = [&](const char* name, const std::vector<std::string>& out) {
    return *make_error_chain(name,
                             {.entry = entry, .seed = 6, .rate_hz = 100.0, .leave_out = out, .environment = around});
  };
  const auto full = chain_of("full", {}), sheet = chain_of("datasheet", {}), white = chain_of("white_only", {});
  looks.close(full->noise().gyro.turn_on_bias_sigma, of_gyro, 32.0),
      looks.close(full->noise().accel.turn_on_bias_sigma, of_accel, 32.0);
  looks.close(full->noise().gyro.misalignment_sigma_rad,
              1e-3 * std::hypot(entry.gyro.misalignment_mrad.value, entry.gyro.package_misalignment_mrad.value), 16.0);
  looks.close(full->noise().accel.misalignment_sigma_rad,
              1e-3 * std::hypot(entry.accel.misalignment_mrad.value, entry.accel.package_misalignment_mrad.value),
              16.0);
  const struct {
    const TriadNoise &full, &sheet, &white;
    double density, bias, in_run, tau, scale, tilt;
  } rows[] = {
      {full->noise().gyro, sheet->noise().gyro, white->noise().gyro,
       entry.gyro.arw_deg_per_sqrt_hr.value * kDegree / 60.0, entry.gyro.turn_on_bias_deg_per_hr.value * per_hour,
       entry.gyro.in_run_bias_deg_per_hr.value * per_hour, 400.0, 1e-6 * entry.gyro.scale_ppm.value,
       1e-3 * entry.gyro.misalignment_mrad.value},
      {full->noise().accel, sheet->noise().accel, white->noise().accel, entry.accel.vrw_m_s_per_sqrt_hr.value / 60.0,
       entry.accel.turn_on_bias_mg.value * mg, entry.accel.in_run_bias_mg.value * mg, 700.0,
       1e-6 * entry.accel.scale_ppm.value, 1e-3 * entry.accel.misalignment_mrad.value}};
  for (const auto& r : rows) {
    for (const TriadNoise* n : {&r.full, &r.sheet}) {
      looks.close(n->white_per_sqrt_hz, r.density, 16.0), looks.close(n->in_run_bias_sigma, r.in_run, 16.0);
      looks.close(n->scale_sigma, r.scale, 16.0), looks.right(n->in_run_bias_tau_s == r.tau);
    }
    looks.close(r.sheet.turn_on_bias_sigma, r.bias, 16.0), looks.close(r.sheet.misalignment_sigma_rad, r.tilt, 16.0);
    looks.close(r.white.white_per_sqrt_hz, r.density, 16.0);
    looks.right(r.white.turn_on_bias_sigma == 0.0 && r.white.in_run_bias_sigma == 0.0 && r.white.scale_sigma == 0.0 &&
                r.white.misalignment_sigma_rad == 0.0 && r.white.in_run_bias_tau_s == 1500.0);
  }
  const auto same = [&](ErrorChain& a, ErrorChain& b) {
    bool all = true;
    for (std::int64_t k = 0; k < 40; ++k) {
      ImuSample x;
      x.dt_s = 0.01;
      x.dtheta_U = Vector3d(0.01, -0.02, 0.005), x.dv_U = Vector3d(0.1, 0.05, 0.098);
      ImuSample y = x;
      a.corrupt(k, x), b.corrupt(k, y);
      all = all && x.dtheta_U == y.dtheta_U && x.dv_U == y.dv_U;
    }
    return all;
  };
  std::vector<std::string> no_sheet, no_white;
  for (const auto& row : error_links()) {
    const std::string name = row.name;
    if (name != "scale_factor" && name != "misalignment" && name != "turn_on_bias" && name != "in_run_bias" &&
        name != "white_noise")
      no_sheet.push_back(name);
    if (name != "white_noise") no_white.push_back(name);
  }
  // The gyroscope's flicker stands for its drifting bias, where the entry says so.
  const auto with_flicker = chain_of("full", {}), without_drift = chain_of("full", {"in_run_bias"});
  looks.right(!same(*with_flicker, *without_drift));  // the accelerometer drifts
  entry.accel.in_run_bias_mg.value = 0.0;
  looks.right(same(*chain_of("full", {}), *chain_of("full", {"in_run_bias"})));
  looks.right(same(*chain_of("white_only", {}), *chain_of("full", no_white)));
  entry.in_run_bias_is_instability = false;
  looks.right(!same(*chain_of("full", {}), *chain_of("full", {"in_run_bias"})));
  looks.right(same(*chain_of("datasheet", {}), *chain_of("full", no_sheet)));
  looks.right(!same(*chain_of("datasheet", {"scale_factor"}), *chain_of("full", no_sheet)));
  entry.unit.latency_ms.value = 25.0, entry.unit.loss_percent.value = 1.0, entry.unit.loss_length.value = 4.0;
  looks.right(chain_of("full", {})->memory() == 3 + 5 && chain_of("full", {"latency"})->memory() == 5);
  return looks.figure();
}

/// The paper's figures: places are sums of mean speeds over each sample, and speeds of what the same chain adds; the
/// text's parameters are those of its figure but for what it prints otherwise.
StressFigure paper_places() {
  Looks looks;
  const auto all = paper_figures();
  looks.right(all.size() == 3);
  const double seconds[] = {1200.0, 600.0, 600.0};
  for (std::size_t i = 0; i < all.size() && i < 3; ++i) looks.right(all[i].seconds == seconds[i]);
  const CatalogueEntry text = all[2].entry(), figure = all[1].entry();
  looks.right(text.paper.gyro.quality_factor == 0.15 && text.paper.accel.quality_factor == 0.15 &&
              text.paper.gyro.white_process == 0.30 && text.paper.accel.white_process == 0.15);
  looks.right(figure.paper.gyro.white_process == 0.15 && figure.paper.accel.white_process == 0.12 &&
              figure.paper.gyro.quality_factor == 0.2);
  for (const char* name : {"paper", "paper_as_printed"}) {
    PaperFigure short_one = all[1];
    short_one.seconds = 20.0;
    const auto found = paper_drift(short_one, name, 4);
    const auto chain = make_error_chain(name, {.entry = figure, .seed = 4, .rate_hz = 125.0});
    if (!found || !chain || found->t_s.size() != 2500) return {kInfinity, 1.0};
    Vector3d speed = Vector3d::Zero(), place = Vector3d::Zero();
    for (std::int64_t k = 0; k < 2500; ++k) {
      ImuSample s;
      s.dt_s = 1.0 / 125.0;
      (*chain)->corrupt(k, s);
      const auto i = static_cast<std::size_t>(k);
      looks.near(found->t_s[i], static_cast<double>(k + 1) / 125.0, 1e-12);
      const Vector3d before = speed;
      speed += s.dv_U;
      place += 0.5 / 125.0 * (before + speed);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        looks.close(found->rate_deg_s[axis][i], s.dtheta_U[a] * 125.0 * 180.0 / kPi, 16.0);
        looks.near(found->position_m[axis][i], place[a], 2500.0 * 8.0 * kEpsilon * (std::abs(place[a]) + 1.0));
      }
    }
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> element_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "sensing elements by their figures",
           "a density of the other side, a spring without its pull, degrees",
           "the formulas that the models cite, of drawn figures: roundings", "of the bound"});
  rows.add("elements/pick_offs", pick_off_laws).add("elements/masses", element_laws).add("elements/crystal", crystal);
  rows.of({StressGroup::kStiff, "the noise of a whole unit of masses", "the sheet's noise twice, or another corner's",
           "the sheet's density through a low-pass, integrated over frequency: five deviations", "of the bound"});
  for (const auto& [own, sheet] : {std::pair(25.0, 80.0), std::pair(0.0, 40.0), std::pair(0.0, 0.0)})
    rows.add("elements/noise_at_" + stress::text(own) + "_and_" + stress::text(sheet) + "_hz",
             [o = own, s = sheet] { return noise_of_masses(o, s); });
  rows.of({StressGroup::kData, "units that cannot be", "a scheme that diverges, noise beyond the sheet's",
           "each refused, and the sound one made", "let through"});
  rows.add("elements/refused", refused_masses);
  rows.of({StressGroup::kStiff, "a mass that forgets", "a memory that is too short, or of another element's",
           "the same from where it ends: roundings", "of the bound"});
  rows.add("elements/forgotten", masses_forget);
  rows.of({StressGroup::kData, "what a chain says of itself, and which links it has",
           "a figure of the other triad, a link of another chain",
           "roots of sums of squares, and the whole chain without the others to the bit", "of the bound"});
  rows.add("elements/told_of_chains", told);
  rows.of({StressGroup::kData, "the paper's figures", "a place by the speed at one end",
           "sums of mean speeds of the same chain: roundings", "of the bound"});
  rows.add("elements/places_of_the_paper", paper_places);
  return rows.take();
}

}  // namespace canyon::inertial
