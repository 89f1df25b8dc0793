#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "lidar/echo_model.h"
#include "lidar/footprint_rays.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kSubRays = FootprintOffsets::kRays;

/// One sub-ray's light.
struct Glint {
  float range_m, power, cos_incidence;  // power: reflectivity / range^2
  std::uint32_t triangle;
};

/// A beam of Gaussian cross-section, sixteen sub-rays of equal energy. `divergence_mrad` is its full width at 1/e^2 of
/// the middle's intensity, so four standard deviations.
///
/// Light that comes back within a pulse's length merges, link by link, into one echo at the energy-weighted mean range:
/// on a tilted plane that is the footprint's middle, at an edge it lies between the two surfaces (a mixed pixel). Light
/// farther apart makes echoes of its own. What a sub-ray sends back falls off with its own range and incidence.
class Footprint final : public EchoModel {
 public:
  explicit Footprint(const LidarConfig& config)
      : pulse_m_(static_cast<float>(config.pulse_m)),
        offsets_(footprint_offsets(1e-3 * config.divergence_mrad[0] / 4.0, 1e-3 * config.divergence_mrad[1] / 4.0)) {}

  void trace(const Volley& volley, const scene::SceneAt& scene, const Surfaces& surfaces,
             EchoList& out) const override {
    std::array<scene::RayPacket, Volley::kLanes> rays;
    std::array<scene::HitPacket, Volley::kLanes> hits;
    out.clear(volley.shots());
    for (std::size_t p = 0; p < volley.packets(); ++p) {
      const PlacementPacket& placements = volley.placements[p % Volley::kPacketsPerLaser];
      for (std::size_t lane = 0; lane < Volley::kLanes; ++lane) {
        const float up[3] = {placements.R[2][lane], placements.R[5][lane], placements.R[8][lane]};
        spread_beam(volley.rays[p], lane, up, offsets_, rays[lane]);
      }
      scene.trace(rays, hits);
      for (const scene::HitPacket& hit : hits) {
        gather(hit, surfaces, out);
        out.end_shot();
      }
    }
  }
  std::size_t rays_per_shot() const override { return kSubRays; }

 private:
  void gather(const scene::HitPacket& hit, const Surfaces& surfaces, EchoList& out) const {
    Glint glints[kSubRays];
    std::size_t count = 0;
    float nearest_m = 1e30f, farthest_m = 0.0f;
    for (std::size_t i = 0; i < kSubRays; ++i) {
      if (hit.triangle[i] == scene::Hit::kMiss) continue;
      const float range_m = hit.range_m[i];
      nearest_m = std::min(nearest_m, range_m);
      farthest_m = std::max(farthest_m, range_m);
      const float reflectivity = surfaces.reflectivity(hit.triangle[i], hit.cos_incidence[i]);
      glints[count++] = {range_m, reflectivity / std::max(range_m * range_m, 1e-6f), hit.cos_incidence[i],
                         hit.triangle[i]};
    }
    if (count == 0) return;
    if (farthest_m - nearest_m <= pulse_m_) {
      out.echoes.push_back(merged(glints, count));
      return;
    }
    // A stable order: equal ranges stay in the order of the sub-rays.
    std::stable_sort(glints, glints + count, [](const Glint& a, const Glint& b) { return a.range_m < b.range_m; });
    std::size_t begin = 0;
    for (std::size_t i = 1; i <= count; ++i) {
      if (i < count && glints[i].range_m - glints[i - 1].range_m <= pulse_m_) continue;
      out.echoes.push_back(merged(glints + begin, i - begin));
      begin = i;
    }
  }

  static Echo merged(const Glint* glints, std::size_t count) {
    const float first_m = glints[0].range_m;
    float power = 0.0f, beyond = 0.0f, cosine = 0.0f;
    const Glint* brightest = glints;
    for (std::size_t i = 0; i < count; ++i) {
      power += glints[i].power;
      beyond += glints[i].power * (glints[i].range_m - first_m);
      cosine += glints[i].power * glints[i].cos_incidence;
      if (glints[i].power > brightest->power) brightest = glints + i;
    }
    if (!(power > 0.0f)) return {.range_m = first_m, .triangle = brightest->triangle};
    const float range_m = first_m + beyond / power;
    return {.range_m = range_m,
            .reflectivity = power * range_m * range_m / static_cast<float>(kSubRays),
            .cos_incidence = cosine / power,
            .triangle = brightest->triangle};
  }

  float pulse_m_;
  FootprintOffsets offsets_;
};

}  // namespace

std::unique_ptr<EchoModel> make_footprint(const LidarConfig& config, std::uint64_t) {
  return std::make_unique<Footprint>(config);
}

}  // namespace canyon::lidar
