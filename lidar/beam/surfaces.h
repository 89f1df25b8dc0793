#pragma once

#include <vector>

#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/pane.h"
#include "canyon/lidar/beam/signal.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {

/// How much light the scene's surfaces send back at one wavelength.
///
/// Apparent reflectivity: what a Lambertian surface square to the beam would need to send as much. Of a surface met at
/// the angle theta: reflectance * cos(theta) of its diffuse part; of its mirror, of facets whose slopes have the
/// standard deviation s (Torrance and Sparrow 1967, no shadowing), share * exp(-tan(theta)^2 / (2 s^2)) / (8 s^2
/// cos(theta)^5); of a retroreflector pi R_A cos(theta). With the reflection "rough" the diffuse part is that of facets
/// whose slopes have the standard deviation s, seen from where the light comes from (Oren and Nayar, SIGGRAPH 1994,
/// eq. 30 with both angles theta on one side): reflectance * (A cos(theta) + B sin(theta)^2),
/// A = 1 - s^2 / (2 (s^2 + 0.33)), B = 0.45 s^2 / (s^2 + 0.09).
class Surfaces {
 public:
  Surfaces(const scene::SceneAt& scene, double wavelength_nm, MattReflection reflection = MattReflection::kLambertian);

  float reflectivity(std::uint32_t triangle, float cos_incidence) const {
    return of_material(scene_->surface(triangle).material, cos_incidence);
  }
  float of_material(std::uint16_t material, float cos_incidence) const {
    const Light& light = lights_[material];
    const float diffuse = light.reflectance * light.matt(cos_incidence);
    return light.plain ? diffuse : diffuse + special(light, cos_incidence);
  }

  bool transparent(std::uint16_t material) const { return material != kNoMaterial && lights_[material].through > 0.0f; }
  /// Share of the light that a material lets straight through.
  float transmittance(std::uint16_t material, float cos_incidence) const {
    return static_cast<float>(pane_transmittance(lights_[material].through, cos_incidence));
  }
  /// The material "foliage", or kNoMaterial; and how much light a leaf sends back.
  std::uint16_t foliage() const { return foliage_; }
  float leaf(float cos_incidence) const {
    return foliage_ == kNoMaterial ? 0.5f * cos_incidence : of_material(foliage_, cos_incidence);
  }

  /// What a ray met, as an echo; no echo where it met nothing.
  Echo echo(const scene::HitPacket& hit, std::size_t lane) const {
    if (hit.triangle[lane] == scene::Hit::kMiss) return {};
    const scene::SceneAt::Surface met = scene_->surface(hit.triangle[lane]);
    return {{hit.range_m[lane], hit.cos_incidence[lane], met.material, met.object},
            of_material(met.material, hit.cos_incidence[lane])};
  }
  /// The same of sixteen rays. Fast where neighbours met the same triangle.
  void echoes(const scene::HitPacket& hits, EchoPacket& out) const;
  /// Their reflectivities alone; 0 where nothing was met.
  void reflectivities(const scene::HitPacket& hits, float* out) const;

 private:
  struct Light {
    float reflectance = 0;
    float mirror = 0, slope = 1;
    float retro = 0;
    float through = 0;
    bool plain = true;
    float along = 1, grazing = 0;  ///< A and B of the class's description
    float matt(float cos_incidence) const {
      return along * cos_incidence + grazing * (1.0f - cos_incidence * cos_incidence);
    }
  };
  static float special(const Light& light, float cos_incidence);
  /// Calls visit(lane, surface) for each lane and writes the reflectivities.
  template <class Visit>
  void each_lane(const scene::HitPacket& hits, float* out, const Visit& visit) const;

  const scene::SceneAt* scene_;
  std::vector<Light> lights_;  ///< by material
  std::uint16_t foliage_ = kNoMaterial;
};

}  // namespace canyon::lidar
