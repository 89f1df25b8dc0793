#include "canyon/inertial/mems/element_model.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "canyon/core/units.h"

namespace canyon::inertial {
namespace {

/// Static curve of a pick-off for readings proportional to displacement.
std::function<double(double)> curve(std::shared_ptr<const PickOff> pick_off, double metres_per_unit, double gap_m) {
  return [pick_off = std::move(pick_off), metres_per_unit, gap_m](double reading) {
    // Stops lie before the electrodes; without stops the curve must not reach its pole.
    const double x_m = std::clamp(reading * metres_per_unit, -0.99 * gap_m, 0.99 * gap_m);
    return pick_off->reading_m(x_m) / metres_per_unit;
  };
}

void add_electronics(const ElementFigures& f, double unit, ElementModel& out) {
  if (f.range > 0.0) out.clip = f.range * unit;
  out.bandwidth_hz = f.bandwidth_hz;
  out.filter_order = static_cast<int>(f.filter_order);
}

}  // namespace

Result<ElementModel> accelerometer_model(const ElementFigures& f, double temperature_k) {
  const std::shared_ptr<const PickOff> pick_off = model_row(pick_offs(), f.pick_off).make(f.pick_off_figures);
  const double w0 = 2.0 * kPi * f.resonance_hz;
  const double stiffness = f.mass_kg * w0 * w0 + pick_off->added_stiffness_n_m();
  if (!(stiffness > 0.0))
    return Error{.key = "mems.accel.pick_off_figures.bias_v",
                 .what = "pulls the mass in: the electrodes' pull exceeds the spring",
                 .expected = "a lower voltage, a wider gap or a stiffer spring"};
  const double w = std::sqrt(stiffness / f.mass_kg), damping = w0 / f.quality_factor;
  ElementModel out;
  out.mechanics.A = (Eigen::Matrix2d() << 0.0, w, -w, -damping).finished();
  out.mechanics.B = Eigen::Vector2d(0.0, 1.0);
  out.mechanics.C = Eigen::RowVector2d(w, 0.0);
  out.mechanics.intensity = Eigen::Matrix2d::Zero();
  out.mechanics.intensity(1, 1) = 2.0 * kBoltzmann * temperature_k * damping / f.mass_kg;
  out.stop = w * f.travel_m;
  out.fastest_hz = w / (2.0 * kPi);
  out.characteristic = curve(pick_off, 1.0 / (w * w), f.pick_off_figures.gap_m);
  out.thermal_n = std::sqrt(out.mechanics.intensity(1, 1));
  out.pick_off_n = w * w * pick_off->noise_m_sqrt_hz(temperature_k) / std::sqrt(2.0);
  out.low_corner_hz = pick_off->low_corner_hz();
  add_electronics(f, kStandardGravity, out);
  return out;
}

Result<ElementModel> gyroscope_model(const ElementFigures& f, double temperature_k) {
  const std::shared_ptr<const PickOff> pick_off = model_row(pick_offs(), f.pick_off).make(f.pick_off_figures);
  const double w = 2.0 * kPi * f.resonance_hz, g = w / (2.0 * f.quality_factor), d = 2.0 * kPi * f.split_hz;
  const double density =
      kBoltzmann * temperature_k / (f.mass_kg * w * f.quality_factor * f.drive_amplitude_m * f.drive_amplitude_m);
  ElementModel out;
  out.mechanics.A = (Eigen::Matrix2d() << -g, -d, d, -g).finished();
  out.mechanics.B = Eigen::Vector2d(1.0, 0.0);
  out.mechanics.C = Eigen::RowVector2d(g, d);
  out.mechanics.intensity = density * Eigen::Matrix2d::Identity();
  out.fastest_hz = std::hypot(g, d) / (2.0 * kPi);
  // |y| of a rate: x_d / sqrt(g^2 + d^2). Noise about the carrier appears in the demodulated part from both sides.
  const double metres_per_rate = f.drive_amplitude_m / std::hypot(g, d);
  out.characteristic = curve(pick_off, metres_per_rate, f.pick_off_figures.gap_m);
  out.thermal_n = std::sqrt(density);
  out.pick_off_n = pick_off->noise_m_sqrt_hz(temperature_k) / metres_per_rate;
  // The carrier is far above the leak, so that a piezoelectric pick-off reads a constant rate.
  add_electronics(f, kDegree, out);
  return out;
}

}  // namespace canyon::inertial
