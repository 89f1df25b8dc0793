#include "canyon/mission/motion/plan/tyre.h"

#include <cmath>

namespace canyon::mission {
namespace {

constexpr ModelRow<TyreLaw> kTyreLaws[] = {
    {"linear", linear_tyre, "in proportion to its slip angle, up to what friction holds"},
    {"fiala", fiala_tyre, "ever less of it slides along, up to all of it"},
};

}  // namespace

ModelTable<TyreLaw> tyre_laws() {
  return kTyreLaws;
}

TyreForce linear_tyre(double slip, double cornering_1_rad, double friction) {
  const double share = cornering_1_rad * std::atan(slip);
  if (std::abs(share) >= friction) return {-std::copysign(friction, slip), 0.0};
  return {-share, -cornering_1_rad / (1.0 + slip * slip)};
}

TyreForce fiala_tyre(double slip, double cornering_1_rad, double friction) {
  // With x = C |s| / (3 mu): mu (3 x - 3 x^2 + x^3) = mu (1 - (1 - x)^3), all of mu from x = 1 on.
  const double x = cornering_1_rad * std::abs(slip) / (3.0 * friction);
  if (x >= 1.0) return {-std::copysign(friction, slip), 0.0};
  const double left = 1.0 - x;
  return {-std::copysign(friction * (1.0 - left * left * left), slip), -cornering_1_rad * left * left};
}

}  // namespace canyon::mission
