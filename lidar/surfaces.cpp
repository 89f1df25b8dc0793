#include "lidar/surfaces.h"

#include <cmath>

#include "core/units.h"

namespace canyon::lidar {

Surfaces::Surfaces(const scene::SceneAt& scene, double wavelength_nm) : scene_(&scene) {
  for (const scene::Material& m : scene.scene().materials()) {
    Light light;
    light.reflectance = static_cast<float>(m.reflectance(wavelength_nm));
    light.mirror = static_cast<float>(m.lidar_specular);
    light.slope = static_cast<float>(m.lidar_specular_lobe_deg * kDegree);
    light.retro = static_cast<float>(kPi * m.lidar_retro_1_sr);
    light.through = static_cast<float>(m.lidar_transmittance);
    if (m.name == "foliage") foliage_ = static_cast<std::uint16_t>(lights_.size());
    light.plain = light.mirror == 0 && light.retro == 0;
    lights_.push_back(light);
  }
}

float Surfaces::special(const Light& light, float cos_incidence) {
  const float square = cos_incidence * cos_incidence;
  float mirror = 0;
  // Beyond eight standard deviations of slope the mirror sends 1e-14 of its most.
  const float tan_square = (1.0f - square) / std::max(square, 1e-12f);
  if (light.mirror > 0 && tan_square < 64.0f * light.slope * light.slope) {
    const float spread = light.slope * light.slope;
    mirror = light.mirror * std::exp(-tan_square / (2.0f * spread)) / (8.0f * spread * square * square * cos_incidence);
  }
  return mirror + light.retro * cos_incidence;
}

}  // namespace canyon::lidar
