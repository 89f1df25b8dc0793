#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace canyon::mission {

/// Road roughness as a fixed field over the plane: plane waves of random direction and phase whose displacement
/// spectrum along any line follows ISO 8608, G(n) = G(n0) (n / n0)^-2, n0 = 0.1 cycles/m, for wavelengths from 0.7 to
/// 20 m.
class RoadRoughness {
 public:
  /// `road_class` "A" to "E" (ISO 8608 geometric mean values: 16, 64, 256, 1024, 4096 e-6 m^3), or "none".
  RoadRoughness(const std::string& road_class, std::uint64_t seed);
  static const std::vector<std::string>& classes();

  double height_m(const Eigen::Vector2d& p_W) const;

 private:
  struct Wave {
    Eigen::Vector2d k_rad_m;
    double phase_rad, amplitude_m;
  };
  std::vector<Wave> waves_;
};

}  // namespace canyon::mission
