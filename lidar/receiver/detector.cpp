#include "canyon/lidar/receiver/detector.h"

#include <algorithm>
#include <span>

namespace canyon::lidar {

ModelTable<MakeDetector> detectors() {
  static constexpr ModelRow<MakeDetector> kRows[] = {
      {"ideal", make_ideal_detector, "every echo is detected, with Gaussian range noise of one size"},
      {"radiometric", make_radiometric_detector,
       "radar equation against a threshold: dropouts, noise that grows as the signal fades, saturation",
       radiometric_parameters},
  };
  return kRows;
}

void visit(FieldVisitor& f, SignalConfig& c) {
  f.number("pulse_m", c.pulse_m, {1e-3, 100}, "length of the pulse as range, half of it in space; nearer echoes merge");
  f.number("range_at_10_percent_m", c.range_at_10_percent_m, {0.1, 1e5},
           "where a 10 % target square to the beam is at the detection threshold (radiometric, false returns)");
  f.number(
      "full_overlap_m", c.full_overlap_m, {0, 1e3},
      "from where on the receiver sees the whole beam; nearer, the signal is constant (radiometric, false returns)");
}

float full_overlap_m2(const SignalConfig& signal) {
  const double overlap_m = signal.full_overlap_m > 0.01 ? signal.full_overlap_m : 0.01;
  return static_cast<float>(overlap_m * overlap_m);
}

double signal_gain(const SignalConfig& signal, double range_m) {
  const double ratio = signal.range_at_10_percent_m / std::max({range_m, signal.full_overlap_m, 0.01});
  return 10.0 * ratio * ratio;
}

void fill_shot_normals(const RandomStream& stream, const Volley& volley, std::size_t layer, std::vector<double>& out) {
  out.resize(volley.shots());
  for (std::size_t laser = 0; laser < volley.lasers; ++laser) {
    stream.fill_normal(std::span(out).subspan(laser * Volley::kCycles, Volley::kCycles),
                       static_cast<std::uint32_t>(laser), volley.first_draw, static_cast<std::uint32_t>(layer));
  }
}

}  // namespace canyon::lidar
