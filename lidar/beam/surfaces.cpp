#include "canyon/lidar/beam/surfaces.h"

#include <cmath>
#include <cstring>

#include "canyon/core/units.h"
#include "canyon/lidar/beam/texture/value_noise.h"
#include "canyon/lidar/beam/texture/windows.h"

namespace canyon::lidar {
namespace {

/// So that things, and what a thing is made of, vary independently of one another.
std::uint32_t grain_key(const scene::SceneAt::Surface& surface) {
  std::uint32_t key = surface.object * 0x27d4eb2fu + surface.material;
  key = (key ^ (key >> 15)) * 0x2c1b3c6du;
  return key ^ (key >> 12);
}

}  // namespace

Surfaces::Surfaces(const scene::SceneAt& scene, double wavelength_nm, MattReflection reflection,
                   const TextureConfig& texture)
    : scene_(&scene), varied_(texture.brightness == Brightness::kVaried) {
  for (const scene::Material& m : scene.scene().materials()) {
    Light light;
    light.reflectance = static_cast<float>(m.reflectance(wavelength_nm));
    light.mirror = static_cast<float>(m.lidar_specular);
    light.slope = static_cast<float>(m.lidar_specular_lobe_deg * kDegree);
    light.retro = static_cast<float>(kPi * m.lidar_retro_1_sr);
    light.through = static_cast<float>(m.lidar_transmittance);
    if (varied_ && m.lidar_spread > 0.0) {
      light.widest = static_cast<float>(m.widest());
      light.per_m = static_cast<float>(1.0 / m.lidar_grain_m);
    }
    if (m.name == "glass") glass_ = static_cast<std::uint16_t>(lights_.size());
    if (m.name == "foliage") foliage_ = static_cast<std::uint16_t>(lights_.size());
    light.plain = light.mirror == 0 && light.retro == 0;
    if (reflection == MattReflection::kRough) {
      const double slope = m.lidar_slope_deg * kDegree, square = slope * slope;
      light.along = static_cast<float>(1.0 - 0.5 * square / (square + 0.33));
      light.grazing = static_cast<float>(0.45 * square / (square + 0.09));
    }
    lights_.push_back(light);
  }
  if (texture.windows == Windows::kLattice && glass_ != kNoMaterial) walls_ = &scene.scene().facades();
}

float Surfaces::lobe(const Light& light, float cos_incidence, float tan_square) {
  const float square = cos_incidence * cos_incidence, spread = light.slope * light.slope;
  return light.mirror * std::exp(-tan_square / (2.0f * spread)) / (8.0f * spread * square * square * cos_incidence);
}

struct Surfaces::Textured {
  Grains grains;
  const Light* lights[EchoPacket::kShots];
  float reflectance[EchoPacket::kShots], along[EchoPacket::kShots], grazing[EchoPacket::kShots];
  bool plain = true, varied = false;
  /// Neighbouring lanes on one wall with windows, from `begin` up to `end`.
  struct Run {
    std::uint32_t wall;
    std::size_t begin, end;
  };
  Run runs[EchoPacket::kShots];
  std::size_t run_count = 0;
};

template <class Pane>
void Surfaces::lay_texture(const scene::RayPacket& rays, const scene::HitPacket& hits, const Eigen::Vector3d& origin_W,
                           Textured& lanes, const Pane& on_pane) const {
  if (!lanes.varied && lanes.run_count == 0) return;
  Places places;
  find_places(rays, hits, origin_W, places);
  for (std::size_t r = 0; r < lanes.run_count; ++r) {
    const Textured::Run& run = lanes.runs[r];
    std::int32_t pane[EchoPacket::kShots];
    find_panes(walls_->facades()[run.wall], places, pane);
    const Light& glass = lights_[glass_];
    for (std::size_t i = run.begin; i < run.end; ++i) {
      if (pane[i] == 0) continue;
      on_pane(i);
      lanes.lights[i] = &glass;
      lanes.reflectance[i] = glass.reflectance, lanes.along[i] = glass.along, lanes.grazing[i] = glass.grazing;
      lanes.grains.widest[i] = glass.widest, lanes.grains.per_m[i] = glass.per_m;
      lanes.plain = lanes.plain && glass.plain;
    }
  }
  if (!lanes.varied) return;
  float factor[EchoPacket::kShots];
  vary(places, lanes.grains, factor);
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) lanes.reflectance[i] *= factor[i];
}

template <bool kTexture, class Visit>
void Surfaces::each_lane(const scene::RayPacket& rays, const scene::HitPacket& hits, const Eigen::Vector3d& origin_W,
                         float* out, const Visit& visit) const {
  static constexpr Light kNothing;
  constexpr scene::SceneAt::Surface kNowhere{kNoMaterial, kNoObject, false};
  Textured lanes;
  std::uint32_t triangle = scene::Hit::kMiss;
  const Light* light = &kNothing;
  scene::SceneAt::Surface met = kNowhere;
  float widest = 0.0f;
  std::uint32_t key = 0, wall = scene::FacadeIndex::kNone;
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
    if (hits.triangle[i] != triangle) {
      triangle = hits.triangle[i];
      const bool any = triangle != scene::Hit::kMiss;
      met = any ? scene_->surface(triangle) : kNowhere;
      light = any ? &lights_[met.material] : &kNothing;
      lanes.plain = lanes.plain && light->plain;
      if constexpr (kTexture) {
        widest = met.moving ? 0.0f : light->widest;
        key = grain_key(met);
        wall = any ? wall_of(triangle, met.material) : scene::FacadeIndex::kNone;
      }
    }
    lanes.lights[i] = light;
    lanes.reflectance[i] = light->reflectance;
    lanes.along[i] = light->along;
    lanes.grazing[i] = light->grazing;
    if constexpr (kTexture) {
      lanes.grains.widest[i] = widest;
      lanes.grains.per_m[i] = light->per_m;
      lanes.grains.key[i] = key;
      lanes.varied = lanes.varied || widest > 0.0f;
      if (wall != scene::FacadeIndex::kNone) {
        const bool same = lanes.run_count > 0 && lanes.runs[lanes.run_count - 1].wall == wall &&
                          lanes.runs[lanes.run_count - 1].end == i;
        if (!same) lanes.runs[lanes.run_count++] = {wall, i, i};
        lanes.runs[lanes.run_count - 1].end = i + 1;
      }
    }
    visit(i, met.material, met.object);
  }
  if constexpr (kTexture)
    lay_texture(rays, hits, origin_W, lanes,
                [&](std::size_t i) { visit(i, glass_, scene_->surface(hits.triangle[i]).object); });
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
    const float c = hits.cos_incidence[i];
    out[i] = lanes.reflectance[i] * (lanes.along[i] * c + lanes.grazing[i] * (1.0f - c * c));
  }
  if (lanes.plain) return;
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i)
    if (!lanes.lights[i]->plain) out[i] += special(*lanes.lights[i], hits.cos_incidence[i]);
}

Echo Surfaces::echo_at(std::uint32_t triangle, float range_m, float cos_incidence, const Eigen::Vector3d& p_W) const {
  scene::SceneAt::Surface met = scene_->surface(triangle);
  const std::uint32_t wall = wall_of(triangle, met.material);
  const std::uint32_t key = grain_key(met);
  if (wall != scene::FacadeIndex::kNone && on_pane(walls_->facades()[wall], p_W)) met.material = glass_;
  const Light& light = lights_[met.material];
  const bool varied = light.widest > 0.0f && !met.moving;
  const float reflectance = varied ? light.reflectance * vary(p_W, light.widest, light.per_m, key) : light.reflectance;
  const float diffuse = reflectance * light.matt(cos_incidence);
  return {{range_m, cos_incidence, met.material, met.object},
          light.plain ? diffuse : diffuse + special(light, cos_incidence)};
}

Echo Surfaces::echo(const scene::RayPacket& rays, const scene::HitPacket& hit, std::size_t lane,
                    const Eigen::Vector3d& origin_W) const {
  if (hit.triangle[lane] == scene::Hit::kMiss) return {};
  const double range_m = hit.range_m[lane];
  return echo_at(hit.triangle[lane], hit.range_m[lane], hit.cos_incidence[lane],
                 {place_on(origin_W.x(), rays.origin_x[lane], range_m, rays.direction_x[lane]),
                  place_on(origin_W.y(), rays.origin_y[lane], range_m, rays.direction_y[lane]),
                  place_on(origin_W.z(), rays.origin_z[lane], range_m, rays.direction_z[lane])});
}

void Surfaces::echoes(const scene::RayPacket& rays, const scene::HitPacket& hits, const Eigen::Vector3d& origin_W,
                      EchoPacket& out) const {
  std::memcpy(out.range_m, hits.range_m, sizeof hits.range_m);
  const auto write = [&](std::size_t i, std::uint16_t material, std::uint32_t object) {
    out.truth[i] = {hits.range_m[i], hits.cos_incidence[i], material, object};
  };
  if (textured())
    each_lane<true>(rays, hits, origin_W, out.reflectivity, write);
  else
    each_lane<false>(rays, hits, origin_W, out.reflectivity, write);
}

void Surfaces::reflectivities(const scene::RayPacket& rays, const scene::HitPacket& hits,
                              const Eigen::Vector3d& origin_W, float* out) const {
  const auto nothing_more = [](std::size_t, std::uint16_t, std::uint32_t) {};
  if (textured()) {
    each_lane<true>(rays, hits, origin_W, out, nothing_more);
    return;
  }
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
  each_lane<false>(rays, hits, origin_W, out, nothing_more);
}

}  // namespace canyon::lidar
