#pragma once

#include <algorithm>
#include <vector>

#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/pane.h"
#include "canyon/lidar/beam/signal.h"
#include "canyon/lidar/beam/texture/texture.h"
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
///
/// With the brightness "varied" the diffuse part of what stands still is times value noise of the place (vary()), by
/// the material's lidar_spread and lidar_grain_m and independently for each object and material; moving things keep one
/// brightness. With windows "lattice" a building's wall is of the material "glass" where a window's pane is
/// (on_pane()), unless it lets light through itself; truth says glass. A scene without a material "glass" has no
/// windows.
class Surfaces {
 public:
  Surfaces(const scene::SceneAt& scene, double wavelength_nm, MattReflection reflection = MattReflection::kLambertian,
           const TextureConfig& texture = {});

  /// Of a triangle's own material, where nothing varies within it.
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

  /// What is met at a place on a triangle, as an echo.
  Echo echo_at(std::uint32_t triangle, float range_m, float cos_incidence, const Eigen::Vector3d& p_W) const;
  /// What a ray of a packet met, as an echo; no echo where it met nothing. Origins of rays are relative to `origin_W`.
  Echo echo(const scene::RayPacket& rays, const scene::HitPacket& hit, std::size_t lane,
            const Eigen::Vector3d& origin_W) const;
  /// The same of sixteen rays. Fast where neighbours met the same triangle.
  void echoes(const scene::RayPacket& rays, const scene::HitPacket& hits, const Eigen::Vector3d& origin_W,
              EchoPacket& out) const;
  /// Their reflectivities alone; 0 where nothing was met.
  void reflectivities(const scene::RayPacket& rays, const scene::HitPacket& hits, const Eigen::Vector3d& origin_W,
                      float* out) const;

 private:
  struct Light {
    float reflectance = 0;
    float mirror = 0, slope = 1;
    float retro = 0;
    float through = 0;
    bool plain = true;
    float widest = 0, per_m = 1;   ///< of Grains
    float along = 1, grazing = 0;  ///< A and B of the class's description
    float matt(float cos_incidence) const {
      return along * cos_incidence + grazing * (1.0f - cos_incidence * cos_incidence);
    }
  };
  /// Mirror lobe and retroreflection.
  static float special(const Light& light, float cos_incidence) {
    const float square = cos_incidence * cos_incidence;
    const float tan_square = (1.0f - square) / std::max(square, 1e-12f);
    // Beyond eight standard deviations of slope the mirror sends 1e-14 of its most.
    const bool shines = light.mirror > 0 && tan_square < 64.0f * light.slope * light.slope;
    return (shines ? lobe(light, cos_incidence, tan_square) : 0.0f) + light.retro * cos_incidence;
  }
  static float lobe(const Light& light, float cos_incidence, float tan_square);
  /// The wall of windows that a triangle is of; FacadeIndex::kNone where it has none.
  std::uint32_t wall_of(std::uint32_t triangle, std::uint16_t material) const {
    return walls_ == nullptr || !walls_->any_of(material) || lights_[material].through > 0.0f
               ? scene::FacadeIndex::kNone
               : walls_->of(triangle);
  }
  /// Windows and brightness at the places of sixteen rays, on what each_lane() looks up.
  struct Textured;
  template <class Pane>
  void lay_texture(const scene::RayPacket& rays, const scene::HitPacket& hits, const Eigen::Vector3d& origin_W,
                   Textured& lanes, const Pane& on_pane) const;
  /// Writes the reflectivities, and calls visit(lane, material, object) for each lane, the last time with what it met.
  template <bool kTexture, class Visit>
  void each_lane(const scene::RayPacket& rays, const scene::HitPacket& hits, const Eigen::Vector3d& origin_W,
                 float* out, const Visit& visit) const;
  bool textured() const { return varied_ || walls_ != nullptr; }

  const scene::SceneAt* scene_;
  std::vector<Light> lights_;  ///< by material
  std::uint16_t foliage_ = kNoMaterial, glass_ = kNoMaterial;
  const scene::FacadeIndex* walls_ = nullptr;  ///< null: no windows
  bool varied_ = false;
};

}  // namespace canyon::lidar
