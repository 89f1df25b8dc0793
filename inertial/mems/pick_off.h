#pragma once

#include <memory>

#include "canyon/core/config/config.h"
#include "canyon/core/model_table.h"

namespace canyon::inertial {

/// Figures of all pick-offs; each model takes its own.
struct PickOffFigures {
  double gap_m = 2e-6;           ///< between electrodes, or the travel that full strain belongs to
  double bias_v = 0.5;           ///< across electrodes or bridge
  double capacitance_f = 1e-13;  ///< capacitive: of one side at rest; piezoelectric: of crystal and amplifier's input
  // capacitive
  double parasitic_f = 2e-12;         ///< at the amplifier's input
  double amplifier_v_sqrt_hz = 5e-9;  ///< its voltage noise
  // piezoresistive
  double bridge_ohm = 5e3;
  double gauge_factor = 100.0;
  double strain_per_m = 100.0;  ///< at the resistors, per displacement
  double strain_cubic = 0.01;   ///< part that the cubic term adds at full travel: stretching of the beam
  // piezoelectric
  double charge_c_per_m = 1e-6;  ///< charge per displacement
  double leak_hz = 0.1;          ///< 1 / (2 pi R C) of element and amplifier
  double loss_tangent = 0.002;
};
void visit(FieldVisitor& f, PickOffFigures& c);

/// From the displacement of the proof mass to what the electronics read. One-level interface.
class PickOff {
 public:
  virtual ~PickOff() = default;
  /// What a displacement reads as, as a displacement: equal to x near zero. |x| < gap.
  virtual double reading_m(double x_m) const = 0;
  /// Below this frequency the reading fades, -3 dB there; 0: it holds at rest.
  virtual double low_corner_hz() const { return 0.0; }
  /// White noise of the reading, one-sided density, m / sqrt(Hz).
  virtual double noise_m_sqrt_hz(double temperature_k) const = 0;
  /// What the pick-off adds to the spring, N/m; negative: softens it.
  virtual double added_stiffness_n_m() const { return 0.0; }
};

using MakePickOff = std::unique_ptr<PickOff>(const PickOffFigures& figures);
ModelTable<MakePickOff> pick_offs();

/// Models, each in its own file.
std::unique_ptr<PickOff> make_capacitive(const PickOffFigures& figures);
std::unique_ptr<PickOff> make_piezoresistive(const PickOffFigures& figures);
std::unique_ptr<PickOff> make_piezoelectric(const PickOffFigures& figures);

}  // namespace canyon::inertial
