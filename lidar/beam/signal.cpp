#include "canyon/lidar/beam/signal.h"

#include <algorithm>

namespace canyon::lidar {
namespace {

constexpr ModelRow<MattReflection> kReflections[] = {
    {"lambertian", MattReflection::kLambertian, "with the cosine of the incidence"},
    {"rough", MattReflection::kRough, "Oren and Nayar 1994, by the materials' lidar_slope_deg"},
};

}  // namespace

void visit(FieldVisitor& f, SignalConfig& c) {
  f.number("pulse_m", c.pulse_m, {1e-3, 100}, "length of the pulse as range, half of it in space; nearer echoes merge");
  f.number("range_at_10_percent_m", c.range_at_10_percent_m, {0.1, 1e5},
           "where a 10 % target square to the beam is at the detection threshold (radiometric, false returns)");
  f.number(
      "full_overlap_m", c.full_overlap_m, {0, 1e3},
      "from where on the receiver sees the whole beam; nearer, the signal is constant (radiometric, false returns)");
  f.choice(
      "reflection", c.reflection, ModelTable<MattReflection>(kReflections),
      "how matt surfaces spread light: lambertian = with the cosine of the incidence; rough = Oren and Nayar 1994, "
      "by the materials' lidar_slope_deg");
}

float full_overlap_m2(const SignalConfig& signal) {
  const double overlap_m = signal.full_overlap_m > 0.01 ? signal.full_overlap_m : 0.01;
  return static_cast<float>(overlap_m * overlap_m);
}

double signal_gain(const SignalConfig& signal, double range_m) {
  const double ratio = signal.range_at_10_percent_m / std::max({range_m, signal.full_overlap_m, 0.01});
  return 10.0 * ratio * ratio;
}

}  // namespace canyon::lidar
