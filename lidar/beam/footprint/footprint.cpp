#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "canyon/core/units.h"
#include "canyon/lidar/beam/footprint/footprint_rays.h"
#include "canyon/lidar/beam/footprint/glint_sum.h"
#include "canyon/lidar/beam/see_through.h"
#include "canyon/lidar/lidar_config.h"

namespace canyon::lidar {
namespace {

struct FootprintParameters {
  Eigen::Vector2d divergence_mrad{3.0, 1.5};  ///< VLP-16 manual: full width, across and along the spin axis
};
void visit(FieldVisitor& f, FootprintParameters& c) {
  f.vector2("divergence_mrad", c.divergence_mrad, {0, 100},
            "full width of the beam at 1/e^2 of its middle: along the turn of the head and along its axis (footprint)");
}

constexpr int kSubRays = FootprintOffsets::kRays;

/// A beam of Gaussian cross-section, sixteen sub-rays of equal energy. `divergence_mrad` is its full width at 1/e^2 of
/// the middle's intensity, so four standard deviations.
///
/// Light that comes back within a pulse's length merges, link by link, into one echo at the energy-weighted mean range:
/// on a tilted plane that is the footprint's middle, at an edge it lies between the two surfaces (a mixed pixel). Light
/// farther apart makes echoes of its own. What a sub-ray sends back falls off with its own range and incidence. Behind
/// panes and leaves (`see_through`) a sub-ray goes on by itself.
class Footprint final : public EchoModel {
 public:
  Footprint(const FootprintParameters& p, const LidarConfig& config, std::uint64_t seed)
      : pulse_m_(static_cast<float>(config.signal.pulse_m)),
        overlap_m2_(full_overlap_m2(config.signal)),
        see_through_(config.see_through, seed),
        offsets_(footprint_offsets(1e-3 * p.divergence_mrad[0] / 4.0, 1e-3 * p.divergence_mrad[1] / 4.0)) {}

  void trace(const Volley& volley, const scene::SceneAt& scene, const Surfaces& surfaces, Echoes& out) const override {
    constexpr std::size_t kBeams = 16;  // at once: what they need stays in the nearest cache
    std::array<scene::RayPacket, kBeams> rays;
    std::array<scene::HitPacket, kBeams> hits;
    std::vector<Echo> glints, met;
    const std::span<EchoPacket> first = out.start(volley.packets());
    for (std::size_t begin = 0; begin < volley.shots(); begin += kBeams) {
      for (std::size_t k = 0; k < kBeams; ++k) {
        const std::size_t shot = begin + k, c = Volley::cycle_of(shot), lane = c % Volley::kLanes;
        const PlacementPacket& placements = volley.placements[c / Volley::kLanes];
        const float up[3] = {placements.R[2][lane], placements.R[5][lane], placements.R[8][lane]};
        spread_beam(volley.rays[shot / Volley::kLanes], lane, up, offsets_, rays[k]);
      }
      scene.trace(rays, hits, volley.origin_W);
      for (std::size_t k = 0; k < kBeams; ++k) {
        const std::size_t shot = begin + k;
        EchoPacket& packet = first[shot / Volley::kLanes];
        const auto whole = see_through_.any() ? std::nullopt : one_echo(rays[k], hits[k], volley.origin_W, surfaces);
        packet.set(shot % Volley::kLanes, whole.value_or(Echo{}));
        if (whole) continue;
        glints.clear();
        for (std::size_t i = 0; i < FootprintOffsets::kRays; ++i) {
          if (!see_through_.any()) {
            if (hits[k].triangle[i] != scene::Hit::kMiss)
              glints.push_back(surfaces.echo(rays[k], hits[k], i, volley.origin_W));
          } else if (rays[k].max_m[i] >= 0) {
            see_through_.follow(
                {ray_of(rays[k], i, volley.origin_W), static_cast<std::uint32_t>(Volley::laser_of(shot)),
                 volley.draw_of(shot), static_cast<std::uint32_t>(i)},
                hits[k], i, scene, surfaces, met);
            glints.insert(glints.end(), met.begin(), met.end());
          }
        }
        gather(glints, shot, out);
      }
    }
  }
  std::size_t rays_per_shot() const override { return kSubRays; }

 private:
  Echo echo_of(const GlintSum& sum, std::uint32_t object, std::uint16_t material) const {
    if (!(sum.power > 0.0f)) return {{sum.nearest_m, 0.0f, material, object}, 0.0f};
    const float range_m = sum.nearest_m + sum.beyond / sum.power;
    const float square_m2 = std::max(range_m * range_m, overlap_m2_);
    return {{range_m, sum.cosine / sum.power, material, object}, sum.power * square_m2 / static_cast<float>(kSubRays)};
  }

  /// The most frequent case, quickly: all that the sub-rays met lies within a pulse's length, or they met nothing.
  std::optional<Echo> one_echo(const scene::RayPacket& rays, const scene::HitPacket& hits,
                               const Eigen::Vector3d& origin_W, const Surfaces& surfaces) const {
    float reflectivity[kSubRays];
    surfaces.reflectivities(rays, hits, origin_W, reflectivity);
    GlintSum sum;
    sum_glints(hits, reflectivity, overlap_m2_, sum);
    if (sum.brightest == kSubRays) return Echo{};
    if (sum.farthest_m - sum.nearest_m > pulse_m_) return std::nullopt;
    const auto brightest = surfaces.echo(rays, hits, static_cast<std::size_t>(sum.brightest), origin_W).truth;
    return echo_of(sum, brightest.object, brightest.material);
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
    GlintSum sum{.nearest_m = glints.front().truth.range_m, .farthest_m = glints.back().truth.range_m};
    float most = -1.0f;
    const Echo* brightest = nullptr;
    for (const Echo& g : glints) {
      const float p = g.reflectivity / std::max(g.truth.range_m * g.truth.range_m, overlap_m2_);
      sum.power += p;
      sum.beyond += p * (g.truth.range_m - sum.nearest_m);
      sum.cosine += p * g.truth.cos_incidence;
      if (p > most) most = p, brightest = &g;
    }
    return echo_of(sum, brightest->truth.object, brightest->truth.material);
  }

  float pulse_m_, overlap_m2_;
  SeeThrough see_through_;
  FootprintOffsets offsets_;
};

}  // namespace

void footprint_parameters(ModelParameters& section) {
  section.add<FootprintParameters>();
}

std::unique_ptr<EchoModel> make_footprint(const ModelParameters& own, const LidarConfig& config, std::uint64_t seed) {
  return std::make_unique<Footprint>(own.get<FootprintParameters>(), config, seed);
}

}  // namespace canyon::lidar
