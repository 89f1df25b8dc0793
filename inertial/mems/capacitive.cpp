#include "canyon/inertial/mems/pick_off.h"

namespace canyon::inertial {
namespace {

/// Two plates with the mass between them, C = C0 / (1 -+ x / g), and a charge amplifier: V ~ C1 - C2, which is
///   (x / g) / (1 - (x / g)^2)
/// of its slope at rest. The bias pulls the mass to the nearer plate: 2 C0 V^2 / g^2 less spring (Senturia, Microsystem
/// Design, 2001). The amplifier's voltage noise reads as displacement through the capacitive
/// divider, g e (2 C0 + Cp) / (2 C0 V).
class Capacitive final : public PickOff {
 public:
  explicit Capacitive(const PickOffFigures& f) : f_(f) {}
  double reading_m(double x_m) const override {
    const double part = x_m / f_.gap_m;
    return x_m / (1.0 - part * part);
  }
  double noise_m_sqrt_hz(double) const override {
    const double both = 2.0 * f_.capacitance_f;
    return f_.gap_m * f_.amplifier_v_sqrt_hz * (both + f_.parasitic_f) / (both * f_.bias_v);
  }
  double added_stiffness_n_m() const override {
    return -2.0 * f_.capacitance_f * f_.bias_v * f_.bias_v / (f_.gap_m * f_.gap_m);
  }

 private:
  PickOffFigures f_;
};

}  // namespace

std::unique_ptr<PickOff> make_capacitive(const PickOffFigures& figures) {
  return std::make_unique<Capacitive>(figures);
}

}  // namespace canyon::inertial
