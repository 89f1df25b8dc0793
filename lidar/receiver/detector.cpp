#include "canyon/lidar/receiver/detector.h"

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

void fill_shot_normals(const RandomStream& stream, const Volley& volley, std::size_t layer, std::vector<double>& out) {
  out.resize(volley.shots());
  for (std::size_t laser = 0; laser < volley.lasers; ++laser) {
    stream.fill_normal(std::span(out).subspan(laser * Volley::kCycles, Volley::kCycles),
                       static_cast<std::uint32_t>(laser), volley.first_draw, static_cast<std::uint32_t>(layer));
  }
}

}  // namespace canyon::lidar
