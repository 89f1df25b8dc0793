#include <algorithm>
#include <cmath>
#include <optional>

#include "gnss/paths/path_model.h"
#include "gnss/signal.h"

namespace canyon::gnss {
namespace {

// Occlusion is traced in single precision against triangles that lie within 1 cm of their facet's plane; starting this
// far in front of the plane keeps the reflector from blocking its own reflection.
constexpr double kClearanceM = 0.02;

class Specular1 final : public PathModel {
 public:
  explicit Specular1(const PathParameters& p) : reach_m_(p.reach_m), visibility_(make_visibility(p)) {}

  void trace(const Eigen::Vector3d& p_A_W, std::span<const Eigen::Vector3d> directions_W, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    visibility_->trace(p_A_W, directions_W, scene, out, counters);

    const auto& facets = scene.scene().facets();
    std::vector<std::uint32_t> near;
    facets.near(p_A_W, reach_m_, near);
    for (const std::uint32_t index : near) {
      const scene::Facet& facet = facets.facets()[index];
      const scene::Material& material = scene.scene().materials()[facet.material];
      if (material.rf_absorbing) continue;
      const double distance_m = facet.normal_W.dot(p_A_W) - facet.offset_m;
      if (distance_m <= 0.0 || distance_m > reach_m_) continue;  // the antenna must be in front of it
      counters.facets_tested += static_cast<std::int64_t>(out.size());
      for (std::size_t i = 0; i < out.size(); ++i) {
        if (auto r = reflect(p_A_W, directions_W[i], facet, distance_m, scene, counters)) {
          const double cos_incidence = directions_W[i].dot(facet.normal_W);
          const Fresnel f = fresnel(material.permittivity(kL1Hz), std::acos(std::min(cos_incidence, 1.0)));
          r->copolar = f.co;
          r->crosspolar = f.cross;
          r->reflections = 1;
          r->facets[0] = index;
          out[i].echoes.push_back(*r);
          ++counters.reflected_paths;
        }
      }
    }
    for (auto& paths : out)
      std::stable_sort(paths.echoes.begin(), paths.echoes.end(),
                       [](const SignalPath& a, const SignalPath& b) { return a.excess_m < b.excess_m; });
  }

 private:
  std::optional<SignalPath> reflect(const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& to_satellite_W,
                                    const scene::Facet& facet, double distance_m, const scene::SceneAt& scene,
                                    GnssCounters& counters) const {
    const double cos_incidence = to_satellite_W.dot(facet.normal_W);
    if (cos_incidence <= 0.0 || distance_m > reach_m_ * cos_incidence)
      return std::nullopt;  // satellite in front, point in reach
    // Mirrored at the plane, the satellite stands in this direction from the antenna.
    const Eigen::Vector3d arrival_W = to_satellite_W - 2.0 * cos_incidence * facet.normal_W;
    const double leg_m = distance_m / cos_incidence;
    const Eigen::Vector3d point_W = p_A_W + leg_m * arrival_W;
    if ((point_W - facet.center_W).squaredNorm() > facet.radius_m * facet.radius_m) return std::nullopt;
    if (!scene::facet_contains(facet, scene.scene(), point_W)) return std::nullopt;

    const Eigen::Vector3d start_W = point_W + kClearanceM * facet.normal_W;
    const Eigen::Vector3d leg_W = start_W - p_A_W;
    const double clear_m = leg_W.norm();
    const Eigen::Vector3d leg_direction_W = leg_W / clear_m;
    counters.occlusion_rays += 1;
    if (scene.blocked_towards(p_A_W, leg_direction_W, clear_m)) return std::nullopt;
    counters.occlusion_rays += 1;
    if (scene.blocked_towards(start_W, to_satellite_W)) return std::nullopt;

    SignalPath r;
    r.excess_m = 2.0 * distance_m * cos_incidence;
    r.arrival_W = arrival_W;
    r.foliage_m = scene.foliage_m(p_A_W, leg_direction_W, clear_m) + scene.foliage_m(start_W, to_satellite_W);
    return r;
  }

  double reach_m_;
  std::unique_ptr<PathModel> visibility_;
};

}  // namespace

std::unique_ptr<PathModel> make_specular1(const PathParameters& p) {
  return std::make_unique<Specular1>(p);
}

}  // namespace canyon::gnss
