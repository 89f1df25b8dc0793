#include "canyon/inertial/mems/pick_off.h"

namespace canyon::inertial {
namespace {

constexpr ModelRow<MakePickOff> kPickOffs[] = {
    {"capacitive", make_capacitive, "differential electrodes, charge amplifier: reads at rest, softens the spring"},
    {"piezoresistive", make_piezoresistive, "strained resistors in a bridge: reads at rest, noise of the resistors"},
    {"piezoelectric", make_piezoelectric, "charge of a strained crystal: does not read at rest, as charge leaks away"},
};

}  // namespace

void visit(FieldVisitor& f, PickOffFigures& c) {
  f.number("gap_m", c.gap_m, {1e-9, 1e-3}, "gap between electrodes, or full travel");
  f.number("bias_v", c.bias_v, {1e-3, 100}, "voltage across electrodes or bridge");
  f.number("capacitance_f", c.capacitance_f, {1e-16, 1e-9},
           "capacitive: of one side at rest; piezoelectric: of crystal and amplifier");
  f.number("parasitic_f", c.parasitic_f, {0, 1e-9}, "capacitive: at the amplifier's input");
  f.number("amplifier_v_sqrt_hz", c.amplifier_v_sqrt_hz, {0, 1e-6}, "capacitive: voltage noise of the amplifier");
  f.number("bridge_ohm", c.bridge_ohm, {1, 1e7}, "piezoresistive: of the bridge");
  f.number("gauge_factor", c.gauge_factor, {1, 1e3}, "piezoresistive: relative change of resistance per strain");
  f.number("strain_per_m", c.strain_per_m, {1e-3, 1e6}, "piezoresistive: strain of the resistors per displacement");
  f.number("strain_cubic", c.strain_cubic, {-0.3, 0.3}, "piezoresistive: part that the cubic term adds at full travel");
  f.number("charge_c_per_m", c.charge_c_per_m, {1e-12, 1}, "piezoelectric: charge per displacement");
  f.number("leak_hz", c.leak_hz, {1e-6, 1e4}, "piezoelectric: lower corner, 1 / (2 pi R C)");
  f.number("loss_tangent", c.loss_tangent, {0, 1}, "piezoelectric: of the crystal");
}

ModelTable<MakePickOff> pick_offs() {
  return kPickOffs;
}

}  // namespace canyon::inertial
