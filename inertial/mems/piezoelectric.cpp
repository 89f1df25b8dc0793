#include <cmath>

#include "core/units.h"
#include "inertial/mems/pick_off.h"

namespace canyon::inertial {
namespace {

/// Charge proportional to displacement, which leaks away through the resistance of crystal and amplifier: a first-order
/// high-pass, so gravity is not seen and a lasting acceleration fades within 1 / (2 pi leak). Noise: thermal charge of
/// the lossy crystal, sqrt(4 k_B T C tan(delta) / w); taken at 100 times the lower corner, where it is white enough
/// (Levinzon, Piezoelectric Accelerometers with Integral Electronics, 2015).
class Piezoelectric final : public PickOff {
 public:
  explicit Piezoelectric(const PickOffFigures& f) : f_(f) {}
  double reading_m(double x_m) const override { return x_m; }
  double low_corner_hz() const override { return f_.leak_hz; }
  double noise_m_sqrt_hz(double temperature_k) const override {
    const double w = 2.0 * kPi * 100.0 * f_.leak_hz;
    return std::sqrt(4.0 * kBoltzmann * temperature_k * f_.capacitance_f * f_.loss_tangent / w) / f_.charge_c_per_m;
  }

 private:
  PickOffFigures f_;
};

}  // namespace

std::unique_ptr<PickOff> make_piezoelectric(const PickOffFigures& figures) {
  return std::make_unique<Piezoelectric>(figures);
}

}  // namespace canyon::inertial
