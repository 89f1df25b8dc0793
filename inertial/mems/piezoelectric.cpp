#include <cmath>

#include "canyon/core/units.h"
#include "canyon/inertial/mems/pick_off.h"

namespace canyon::inertial {
namespace {

/// Charge proportional to displacement, which leaks away through the resistance of crystal and amplifier: a first-order
/// high-pass, so gravity is not seen and a lasting acceleration fades within 1 / (2 pi leak). Noise: thermal charge of
/// the lossy crystal, 4 k_B T C tan(delta) / w, and of the leak's resistance R = 1 / (2 pi leak C), 4 k_B T / (R w^2),
/// C^2 / Hz, one-sided; taken as white at the level of 100 times the lower corner (Levinzon, Piezoelectric
/// Accelerometers with Integral Electronics, 2015).
class Piezoelectric final : public PickOff {
 public:
  explicit Piezoelectric(const PickOffFigures& f) : f_(f) {}
  double reading_m(double x_m) const override { return x_m; }
  double low_corner_hz() const override { return f_.leak_hz; }
  double noise_m_sqrt_hz(double temperature_k) const override {
    const double w = 2.0 * kPi * 100.0 * f_.leak_hz;
    const double loss = f_.loss_tangent + 2.0 * kPi * f_.leak_hz / w;
    return std::sqrt(4.0 * kBoltzmann * temperature_k * f_.capacitance_f * loss / w) / f_.charge_c_per_m;
  }

 private:
  PickOffFigures f_;
};

}  // namespace

std::unique_ptr<PickOff> make_piezoelectric(const PickOffFigures& figures) {
  return std::make_unique<Piezoelectric>(figures);
}

}  // namespace canyon::inertial
