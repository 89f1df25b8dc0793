#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::gnss {
namespace {

constexpr int kOrder = 2;
constexpr double kOff_m = 2e-3;

/// What tells one sequence of mirrors from another before the facets are known: the planes, to 1e-3 and 1 cm.
using PlaneKey = std::array<std::int64_t, 4>;
using Sequence = std::array<PlaneKey, kOrder>;

PlaneKey plane_key(const Eigen::Vector3d& normal_W, const Eigen::Vector3d& point_W) {
  return {std::llround(normal_W.x() * 1e3), std::llround(normal_W.y() * 1e3), std::llround(normal_W.z() * 1e3),
          std::llround(normal_W.dot(point_W) * 1e2)};
}

/// A ray launched from the antenna, up to its last reflection.
struct Launched {
  int bounces = 0;
  std::array<Eigen::Vector3d, kOrder> points_W, normals_W;
  std::array<std::uint32_t, kOrder> triangles;
  double length_m = 0.0;
};

/// Keys of this model.
struct LaunchingParameters {
  std::int64_t launched_rays = 20000;
};
void visit(FieldVisitor& f, LaunchingParameters& c) {
  f.integer("launched_rays", c.launched_rays, {1, 1e8},
            "paths launching: rays over the whole sphere; the cost grows with them");
}

class Launching final : public PathModel {
 public:
  explicit Launching(const PathParameters& p) : p_(p), visibility_(make_visibility(p)) {
    CANYON_CHECK(p.launched_rays > 0, "launched_rays = ", p.launched_rays);
  }

  void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    visibility_->trace(p_A_W, waves, scene, out, counters);
    if (waves.empty()) return;
    std::vector<std::map<Sequence, std::pair<double, Launched>>> caught(out.size());
    const double turn_rad = kPi * (3.0 - std::sqrt(5.0)), count = p_.launched_rays;
    // Each ray stands for 4 pi / count of solid angle; the capture cone is half as wide again, so that no gap is left.
    const double cone = std::cos(std::min(1.5 * std::sqrt(4.0 / count), 0.5 * kPi));
    for (int i = 0; i < p_.launched_rays; ++i) {
      const double z = 1.0 - 2.0 * (i + 0.5) / count, r = std::sqrt(1.0 - z * z);
      launch(p_A_W, {r * std::cos(turn_rad * i), r * std::sin(turn_rad * i), z}, waves.directions_W(), cone, scene,
             caught, counters);
    }
    for (std::size_t k = 0; k < out.size(); ++k) {
      // A wall that lies on a border of the keys' rounding stands under two of them: the nearer ray counts.
      std::vector<const std::pair<double, Launched>*> rays;
      for (const auto& [sequence, best] : caught[k]) rays.push_back(&best);
      std::stable_sort(rays.begin(), rays.end(), [](const auto* a, const auto* b) { return a->first > b->first; });
      for (const auto* ray : rays)
        connect(p_A_W, waves.direction_W(k), waves.carrier_hz(k), ray->second, scene, out[k], counters);
      std::stable_sort(out[k].echoes.begin(), out[k].echoes.end(),
                       [](const SignalPath& a, const SignalPath& b) { return a.excess_m < b.excess_m; });
    }
  }

 private:
  /// Nearest surface that is not a tree.
  static scene::Hit first_solid(const Eigen::Vector3d& from_W, const Eigen::Vector3d& towards_W,
                                const scene::SceneAt& scene, double& range_m, GnssCounters& counters) {
    range_m = 0.0;
    for (int trees = 0; trees < 64; ++trees) {
      const Eigen::Vector3d start_W = from_W + range_m * towards_W;
      const scene::Hit hit = scene.trace({start_W, towards_W.cast<float>()});
      ++counters.occlusion_rays;
      if (!hit.hit()) return hit;
      range_m += hit.range_m;
      if (scene.object(scene.surface(hit.triangle).object).kind != scene::ObjectKind::kTree) return hit;
      range_m += kOff_m;
    }
    return {};
  }

  void launch(const Eigen::Vector3d& p_A_W, Eigen::Vector3d towards_W, std::span<const Eigen::Vector3d> directions_W,
              double cone, const scene::SceneAt& scene,
              std::vector<std::map<Sequence, std::pair<double, Launched>>>& caught, GnssCounters& counters) const {
    Launched ray;
    Sequence sequence{};
    Eigen::Vector3d at_W = p_A_W;
    for (int bounce = 0; bounce < kOrder; ++bounce) {
      double range_m = 0.0;
      const scene::Hit hit = first_solid(at_W, towards_W, scene, range_m, counters);
      if (!hit.hit() || range_m <= 0.0) return;  // zero: the antenna touches it, and what it reflects has no way
      const scene::SceneAt::Surface surface = scene.surface(hit.triangle);
      if (surface.moving) return;  // stands in the way; reflections are those of what stands still
      if (scene.object(surface.object).kind == scene::ObjectKind::kTerrain) return;
      if (scene.scene().materials()[surface.material].rf_absorbing) return;
      const Eigen::Vector3d outward_W =
          scene::Triangle::of(scene.scene().mesh(), hit.triangle).area_normal().normalized();
      if (outward_W.dot(towards_W) >= 0.0) return;  // from behind
      const auto b = static_cast<std::size_t>(bounce);
      ray.points_W[b] = at_W + range_m * towards_W;
      ray.normals_W[b] = outward_W;
      ray.triangles[b] = hit.triangle;
      ray.length_m += range_m;
      ray.bounces = bounce + 1;
      sequence[b] = plane_key(outward_W, ray.points_W[b]);
      towards_W -= 2.0 * outward_W.dot(towards_W) * outward_W;
      at_W = ray.points_W[b] + kOff_m * outward_W;
      for (std::size_t k = 0; k < directions_W.size(); ++k) {
        const double closeness = towards_W.dot(directions_W[k]);
        if (closeness < cone) continue;
        const auto [entry, fresh] = caught[k].try_emplace(sequence, closeness, ray);
        if (!fresh && closeness > entry->second.first) entry->second = {closeness, ray};
      }
    }
  }

  /// The satellite's end of the way: a ray from it to the last reflection point.
  void connect(const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& s, double carrier_hz, const Launched& ray,
               const scene::SceneAt& scene, SignalPaths& out, GnssCounters& counters) const {
    const auto last = static_cast<std::size_t>(ray.bounces - 1);
    SignalPath path;
    path.excess_m = std::max(ray.length_m - (ray.points_W[last] - p_A_W).dot(s), 0.0);
    if (out.line_of_sight && path.excess_m > p_.cutoff_m) return;
    std::array<Bounce, kOrder> bounces;
    std::vector<std::uint32_t> near;
    Eigen::Vector3d incoming_W = -s;
    for (std::size_t j = last + 1; j-- > 0;) {
      const auto facet = facet_of(ray.points_W[j], ray.triangles[j], scene, near);
      if (!facet) return;
      path.facets[j] = *facet;
      const scene::Facet& f = scene.scene().facets().facets()[*facet];
      const Eigen::Vector3d from_W = j == 0 ? p_A_W : ray.points_W[j - 1];
      Bounce& b = bounces[last - j];
      const scene::Material& material = scene.scene().materials()[f.material];
      b = bounce_off(material, incoming_W, ray.normals_W[j], p_.roughness_m, carrier_hz);
      b.factor *= mirror_factor(ray.normals_W[j], p_.scattered_share.of(material));
      if (p_.finite_facets) {
        const double cosine = std::clamp(-incoming_W.dot(ray.normals_W[j]), 0.0, 1.0);
        const double before_m = j == 0 ? 0.0 : (ray.points_W[0] - p_A_W).norm();
        const double distance_m = before_m + (ray.points_W[j] - from_W).norm();
        b.factor *= finite_facet_factor(f.area_m2, cosine, kSpeedOfLight / carrier_hz, distance_m);
      }
      incoming_W -= 2.0 * incoming_W.dot(b.normal_W) * b.normal_W;
    }
    path.reflections = ray.bounces;
    const bool known = std::any_of(out.echoes.begin(), out.echoes.end(), [&](const SignalPath& e) {
      return e.reflections == path.reflections && e.facets == path.facets;
    });
    if (known) return;
    const CircularField field = reflected_field({bounces.data(), last + 1});
    const double weakest_db = out.line_of_sight ? p_.weakest_db : p_.weakest_nlos_db;
    if (std::norm(field.copolar) + std::norm(field.crosspolar) < std::pow(10.0, weakest_db / 10.0)) return;
    const Eigen::Vector3d end_W = ray.points_W[last] + kOff_m * ray.normals_W[last];
    ++counters.occlusion_rays;
    if (scene.blocked_towards(end_W, s)) return;
    path.copolar = field.copolar;
    path.crosspolar = field.crosspolar;
    path.arrival_W = (ray.points_W[0] - p_A_W).normalized();
    path.foliage_m = scene.foliage_m(end_W, s);
    Eigen::Vector3d at_W = p_A_W;
    for (std::size_t j = 0; j <= last; ++j) {
      const Eigen::Vector3d leg_W = ray.points_W[j] - at_W;
      const double leg_m = leg_W.norm();
      path.foliage_m += scene.foliage_m(at_W, leg_W / leg_m, leg_m);
      at_W = ray.points_W[j];
    }
    out.echoes.push_back(path);
    ++counters.reflected_paths;
  }

  static std::optional<std::uint32_t> facet_of(const Eigen::Vector3d& point_W, std::uint32_t triangle,
                                               const scene::SceneAt& scene, std::vector<std::uint32_t>& near) {
    const auto& index = scene.scene().facets();
    index.near(point_W, 0.01, near);
    for (const std::uint32_t i : near) {
      const auto& triangles = index.facets()[i].triangles;
      if (std::binary_search(triangles.begin(), triangles.end(), triangle)) return i;
    }
    return std::nullopt;
  }

  PathParameters p_;
  std::unique_ptr<PathModel> visibility_;
};

}  // namespace

std::unique_ptr<PathModel> make_launching(const PathParameters& p) {
  return std::make_unique<Launching>(p);
}

std::unique_ptr<PathModel> make_configured_launching(const ModelParameters& own, const PathParameters& p) {
  PathParameters launched = p;
  launched.launched_rays = static_cast<int>(own.get<LaunchingParameters>().launched_rays);
  return make_launching(launched);
}

void launching_parameters(ModelParameters& section) {
  section.add<LaunchingParameters>();
}

}  // namespace canyon::gnss
