#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>

#include "core/units.h"
#include "lidar/echo_model.h"
#include "lidar/footprint_rays.h"
#include "lidar/see_through.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kSubRays = FootprintOffsets::kRays;

/// A beam of Gaussian cross-section, sixteen sub-rays of equal energy. `divergence_mrad` is its full width at 1/e^2 of
/// the middle's intensity, so four standard deviations.
///
/// Light that comes back within a pulse's length merges, link by link, into one echo at the energy-weighted mean range:
/// on a tilted plane that is the footprint's middle, at an edge it lies between the two surfaces (a mixed pixel). Light
/// farther apart makes echoes of its own. What a sub-ray sends back falls off with its own range and incidence. Behind
/// panes and leaves (`see_through`) a sub-ray goes on by itself.
class Footprint final : public EchoModel {
 public:
  Footprint(const LidarConfig& config, std::uint64_t seed)
      : pulse_m_(static_cast<float>(config.pulse_m)),
        overlap_m2_(full_overlap_m2(config)),
        see_through_(config, seed),
        offsets_(footprint_offsets(1e-3 * config.divergence_mrad[0] / 4.0, 1e-3 * config.divergence_mrad[1] / 4.0)) {}

  void trace(const Volley& volley, const scene::SceneAt& scene, const Surfaces& surfaces, Echoes& out) const override {
    std::array<scene::RayPacket, Volley::kCycles> rays;
    std::array<scene::HitPacket, Volley::kCycles> hits;
    std::vector<Echo> glints, met;
    const std::span<EchoPacket> first = out.start(volley.packets());
    for (std::size_t laser = 0; laser < volley.lasers; ++laser) {
      for (std::size_t c = 0; c < Volley::kCycles; ++c) {
        const std::size_t lane = c % Volley::kLanes;
        const PlacementPacket& placements = volley.placements[c / Volley::kLanes];
        const float up[3] = {placements.R[2][lane], placements.R[5][lane], placements.R[8][lane]};
        spread_beam(volley.rays[Volley::shot(laser, c) / Volley::kLanes], lane, up, offsets_, rays[c]);
      }
      scene.trace(rays, hits, volley.origin_W);
      for (std::size_t c = 0; c < Volley::kCycles; ++c) {
        const std::size_t shot = Volley::shot(laser, c);
        EchoPacket& packet = first[shot / Volley::kLanes];
        const auto whole = see_through_.any() ? std::nullopt : one_echo(hits[c], scene, surfaces);
        packet.set(shot % Volley::kLanes, whole.value_or(Echo{}));
        if (whole) continue;
        glints.clear();
        for (std::size_t i = 0; i < kSubRays; ++i) {
          if (!see_through_.any()) {
            if (hits[c].triangle[i] != scene::Hit::kMiss) glints.push_back(surfaces.echo(hits[c], i));
          } else if (rays[c].max_m[i] >= 0) {
            see_through_.follow({ray_of(rays[c], i, volley.origin_W), static_cast<std::uint32_t>(laser),
                                 volley.draw_of(shot), static_cast<std::uint32_t>(i)},
                                hits[c], i, scene, surfaces, met);
            glints.insert(glints.end(), met.begin(), met.end());
          }
        }
        gather(glints, shot, out);
      }
    }
  }
  std::size_t rays_per_shot() const override { return kSubRays; }

 private:
  /// A sum of glints, each of a sixteenth of the beam's energy, weighted by what the receiver gets of them.
  struct Sum {
    float overlap_m2, first_m, power = 0.0f, beyond = 0.0f, cosine = 0.0f, most = -1.0f;

    /// True if this is the brightest so far.
    bool add(float range_m, float reflectivity, float cos_incidence) {
      const float p = reflectivity / std::max(range_m * range_m, overlap_m2);
      power += p;
      beyond += p * (range_m - first_m);
      cosine += p * cos_incidence;
      if (!(p > most)) return false;
      most = p;
      return true;
    }
    Echo echo(std::uint32_t object, std::uint16_t material) const {
      if (!(power > 0.0f)) return {{first_m, 0.0f, material, object}, 0.0f};
      const float range_m = first_m + beyond / power;
      const float square_m2 = std::max(range_m * range_m, overlap_m2);
      return {{range_m, cosine / power, material, object}, power * square_m2 / static_cast<float>(kSubRays)};
    }
  };

  /// The most frequent case, quickly: all that the sub-rays met lies within a pulse's length (or they met nothing).
  std::optional<Echo> one_echo(const scene::HitPacket& hit, const scene::SceneAt& scene,
                               const Surfaces& surfaces) const {
    constexpr float kNothing_m = std::numeric_limits<float>::infinity();
    float nearest_m = kNothing_m, farthest_m = 0.0f;
    for (std::size_t i = 0; i < kSubRays; ++i) {
      nearest_m = std::min(nearest_m, hit.range_m[i]);
      farthest_m = std::max(farthest_m, hit.range_m[i] < kNothing_m ? hit.range_m[i] : 0.0f);
    }
    if (nearest_m == kNothing_m) return Echo{};
    if (farthest_m - nearest_m > pulse_m_) return std::nullopt;
    std::size_t first = 0;
    while (hit.triangle[first] == scene::Hit::kMiss) ++first;
    Sum sum{.overlap_m2 = overlap_m2_, .first_m = hit.range_m[first]};
    std::size_t brightest = first;
    for (std::size_t i = first; i < kSubRays; ++i) {
      if (hit.triangle[i] == scene::Hit::kMiss) continue;
      const float cosine = hit.cos_incidence[i];
      if (sum.add(hit.range_m[i], surfaces.reflectivity(hit.triangle[i], cosine), cosine)) brightest = i;
    }
    const auto surface = scene.surface(hit.triangle[brightest]);
    return sum.echo(surface.object, surface.material);
  }

  /// Glints as the echoes of a shot.
  void gather(std::span<Echo> glints, std::size_t shot, Echoes& out) const {
    if (glints.empty()) return;
    // A stable order: equal ranges stay in the order of the sub-rays.
    std::stable_sort(glints.begin(), glints.end(),
                     [](const Echo& a, const Echo& b) { return a.truth.range_m < b.truth.range_m; });
    std::size_t begin = 0;
    for (std::size_t i = 1; i <= glints.size(); ++i) {
      if (i < glints.size() && glints[i].truth.range_m - glints[i - 1].truth.range_m <= pulse_m_) continue;
      out.insert(shot, merged(glints.subspan(begin, i - begin)));
      begin = i;
    }
  }

  Echo merged(std::span<const Echo> glints) const {
    Sum sum{.overlap_m2 = overlap_m2_, .first_m = glints[0].truth.range_m};
    const Echo* brightest = nullptr;
    for (const Echo& g : glints)
      if (sum.add(g.truth.range_m, g.reflectivity, g.truth.cos_incidence)) brightest = &g;
    return sum.echo(brightest->truth.object, brightest->truth.material);
  }

  float pulse_m_, overlap_m2_;
  SeeThrough see_through_;
  FootprintOffsets offsets_;
};

}  // namespace

std::unique_ptr<EchoModel> make_footprint(const LidarConfig& config, std::uint64_t seed) {
  return std::make_unique<Footprint>(config, seed);
}

}  // namespace canyon::lidar
