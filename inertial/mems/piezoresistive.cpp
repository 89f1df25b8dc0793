#include <cmath>

#include "canyon/core/units.h"
#include "canyon/inertial/mems/pick_off.h"

namespace canyon::inertial {
namespace {

/// A full bridge: V = bias * gauge factor * strain. Strain grows with the displacement, with a cubic term where the
/// beam is stretched. Noise: Johnson, sqrt(4 k_B T R), read as displacement (Senturia, Microsystem Design, 2001). The
/// 1/f noise of the resistors is left to the sensor's bias instability.
class Piezoresistive final : public PickOff {
 public:
  explicit Piezoresistive(const PickOffFigures& f) : f_(f) {}
  double reading_m(double x_m) const override {
    const double part = x_m / f_.gap_m;
    return x_m * (1.0 + f_.strain_cubic * part * part);
  }
  double noise_m_sqrt_hz(double temperature_k) const override {
    return std::sqrt(4.0 * kBoltzmann * temperature_k * f_.bridge_ohm) /
           (f_.bias_v * f_.gauge_factor * f_.strain_per_m);
  }

 private:
  PickOffFigures f_;
};

}  // namespace

std::unique_ptr<PickOff> make_piezoresistive(const PickOffFigures& figures) {
  return std::make_unique<Piezoresistive>(figures);
}

}  // namespace canyon::inertial
