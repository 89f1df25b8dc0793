#include "canyon/lidar/beam/surfaces.h"

#include <cmath>
#include <cstring>

#include "canyon/core/units.h"

namespace canyon::lidar {

Surfaces::Surfaces(const scene::SceneAt& scene, double wavelength_nm, MattReflection reflection) : scene_(&scene) {
  for (const scene::Material& m : scene.scene().materials()) {
    Light light;
    light.reflectance = static_cast<float>(m.reflectance(wavelength_nm));
    light.mirror = static_cast<float>(m.lidar_specular);
    light.slope = static_cast<float>(m.lidar_specular_lobe_deg * kDegree);
    light.retro = static_cast<float>(kPi * m.lidar_retro_1_sr);
    light.through = static_cast<float>(m.lidar_transmittance);
    if (m.name == "foliage") foliage_ = static_cast<std::uint16_t>(lights_.size());
    light.plain = light.mirror == 0 && light.retro == 0;
    if (reflection == MattReflection::kRough) {
      const double slope = m.lidar_slope_deg * kDegree, square = slope * slope;
      light.along = static_cast<float>(1.0 - 0.5 * square / (square + 0.33));
      light.grazing = static_cast<float>(0.45 * square / (square + 0.09));
    }
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

template <class Visit>
void Surfaces::each_lane(const scene::HitPacket& hits, float* out, const Visit& visit) const {
  static constexpr Light kNothing;
  constexpr scene::SceneAt::Surface kNowhere{kNoMaterial, kNoObject, false};
  const Light* lights[EchoPacket::kShots];
  float reflectance[EchoPacket::kShots], along[EchoPacket::kShots], grazing[EchoPacket::kShots];
  bool plain = true;
  std::uint32_t triangle = scene::Hit::kMiss;
  const Light* light = &kNothing;
  scene::SceneAt::Surface met = kNowhere;
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
    if (hits.triangle[i] != triangle) {
      triangle = hits.triangle[i];
      met = triangle == scene::Hit::kMiss ? kNowhere : scene_->surface(triangle);
      light = triangle == scene::Hit::kMiss ? &kNothing : &lights_[met.material];
      plain = plain && light->plain;
    }
    lights[i] = light;
    reflectance[i] = light->reflectance;
    along[i] = light->along;
    grazing[i] = light->grazing;
    visit(i, met);
  }
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
    const float c = hits.cos_incidence[i];
    out[i] = reflectance[i] * (along[i] * c + grazing[i] * (1.0f - c * c));
  }
  if (plain) return;
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i)
    if (!lights[i]->plain) out[i] += special(*lights[i], hits.cos_incidence[i]);
}

void Surfaces::echoes(const scene::HitPacket& hits, EchoPacket& out) const {
  std::memcpy(out.range_m, hits.range_m, sizeof hits.range_m);
  each_lane(hits, out.reflectivity, [&](std::size_t i, const scene::SceneAt::Surface& met) {
    out.truth[i] = {hits.range_m[i], hits.cos_incidence[i], met.material, met.object};
  });
}

void Surfaces::reflectivities(const scene::HitPacket& hits, float* out) const {
  // Most often the rays of one beam meet one plain triangle.
  std::uint32_t others = 0;
  for (const std::uint32_t triangle : hits.triangle) others |= triangle ^ hits.triangle[0];
  if (others == 0 && hits.triangle[0] != scene::Hit::kMiss) {
    const Light& light = lights_[scene_->surface(hits.triangle[0]).material];
    if (light.plain) {
      for (std::size_t i = 0; i < EchoPacket::kShots; ++i)
        out[i] = light.reflectance * light.matt(hits.cos_incidence[i]);
      return;
    }
  }
  each_lane(hits, out, [](std::size_t, const scene::SceneAt::Surface&) {});
}

}  // namespace canyon::lidar
