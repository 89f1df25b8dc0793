#include "canyon/mission/motion/road_roughness.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::mission {

const std::vector<std::string>& RoadRoughness::classes() {
  static const std::vector<std::string> kClasses{"none", "A", "B", "C", "D", "E"};
  return kClasses;
}

RoadRoughness::RoadRoughness(const std::string& road_class, std::uint64_t seed) {
  const auto& names = classes();
  const auto found = std::find(names.begin(), names.end(), road_class);
  CANYON_CHECK(found != names.end(), "road class ", road_class);
  const auto grade = found - names.begin();
  if (grade == 0) return;

  constexpr int kWaves = 24;
  constexpr double kReference = 0.1;  // cycles/m
  constexpr double kMin = 0.05, kMax = 1.4;
  const double density = 16e-6 * std::pow(4.0, static_cast<double>(grade - 1));  // m^3 at kReference
  const RandomStream stream(seed, "vehicle.roughness");
  for (int i = 0; i < kWaves; ++i) {
    // Bands of equal ratio: each carries the variance of its part of the spectrum.
    const double low = kMin * std::pow(kMax / kMin, static_cast<double>(i) / kWaves);
    const double high = kMin * std::pow(kMax / kMin, static_cast<double>(i + 1) / kWaves);
    const double variance = density * kReference * kReference * (1.0 / low - 1.0 / high);
    const double n = std::sqrt(low * high);
    const auto entity = static_cast<std::uint32_t>(i);
    const double direction = stream.uniform(0.0, 2.0 * kPi, entity, 0);
    waves_.push_back({2.0 * kPi * n * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                      stream.uniform(0.0, 2.0 * kPi, entity, 1), std::sqrt(2.0 * variance)});
  }
}

double RoadRoughness::height_m(const Eigen::Vector2d& p_W) const {
  double h = 0.0;
  for (const Wave& wave : waves_) h += wave.amplitude_m * std::sin(wave.k_rad_m.dot(p_W) + wave.phase_rad);
  return h;
}

}  // namespace canyon::mission
