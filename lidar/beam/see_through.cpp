#include "canyon/lidar/beam/see_through.h"

#include <algorithm>
#include <cmath>

namespace canyon::lidar {
namespace {

constexpr float kOnward_m = 1e-3f;  // so that a ray leaves the surface it comes through
constexpr int kMostSurfaces = 64;
constexpr float kDark = 1e-4f;  // light that is left when it is not worth following

/// True if the middle of a triangle lies in a crown.
bool in_a_crown(std::uint32_t triangle, const scene::SceneAt& scene) {
  const scene::Mesh& mesh = scene.scene().mesh();
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (const std::uint32_t vertex : mesh.triangles[triangle]) middle += mesh.vertices[vertex] / 3.0f;
  thread_local std::vector<scene::CrownPassage> passages;
  scene.crown_passages(middle.cast<double>(), Eigen::Vector3d::UnitZ(), 1e-3, passages);
  return std::any_of(passages.begin(), passages.end(), [](const auto& p) { return p.enter_m < p.leave_m; });
}

Eigen::Vector3d place_along(const scene::Ray& ray, float range_m) {
  return ray.origin + double{range_m} * ray.direction.cast<double>();
}

bool is_crown_leaf(std::uint32_t triangle, const scene::SceneAt::Surface& surface, const scene::SceneAt& scene,
                   const Surfaces& surfaces) {
  return !surface.moving && surface.material == surfaces.foliage() &&
         scene.object(surface.object).kind == scene::ObjectKind::kTree && in_a_crown(triangle, scene);
}

}  // namespace

ModelTable<Transparent> see_through_rows() {
  static constexpr ModelRow<Transparent> kRows[] = {
      {"nothing", {false, false}, "every surface stops the light"},
      {"glass", {true, false}, "light goes on behind panes"},
      {"leaves", {false, true}, "light goes on through the gaps of tree crowns"},
      {"both", {true, true}, "behind panes and through crowns"},
  };
  return kRows;
}

SeeThrough::SeeThrough(Transparent through, std::uint64_t seed)
    : panes_(through.panes), leaves_(through.leaves), stream_(seed, "lidar.leaves") {}

void SeeThrough::follow(const Shot& shot, const scene::HitPacket& first, std::size_t lane, const scene::SceneAt& scene,
                        const Surfaces& surfaces, std::vector<Echo>& out) const {
  out.clear();
  // The first leaf in the way, if any.
  Echo leaf;
  if (leaves_) {
    thread_local std::vector<scene::CrownPassage> passages;
    scene.crown_passages(shot.ray.origin, shot.ray.direction.cast<double>(), shot.ray.max_m, passages);
    std::sort(passages.begin(), passages.end(), [](const auto& a, const auto& b) {
      return a.enter_m != b.enter_m ? a.enter_m < b.enter_m : a.crown < b.crown;
    });
    std::uint32_t n = 32 * shot.sub_ray;
    for (std::size_t k = 0; k < std::min<std::size_t>(passages.size(), 16); ++k, n += 2) {
      const scene::CrownPassage& p = passages[k];
      if (!(p.leaf_density_m2_m3 > 0)) continue;
      const double way_m = -std::log(1.0 - stream_.uniform(shot.laser, shot.draw, n)) / (0.5 * p.leaf_density_m2_m3);
      const auto range_m = static_cast<float>(p.enter_m + way_m);
      if (p.enter_m + way_m >= p.leave_m || range_m >= leaf.truth.range_m) continue;
      const auto cosine = static_cast<float>(std::sqrt(1.0 - stream_.uniform(shot.laser, shot.draw, n + 1)));
      leaf = {{range_m, cosine, surfaces.foliage(), kNoObject}, surfaces.leaf(cosine)};
    }
  }
  float light = 1.0f;  // what is left of it
  std::uint32_t triangle = first.triangle[lane];
  float range_m = first.range_m[lane], cosine = first.cos_incidence[lane];
  for (int k = 0; k < kMostSurfaces && triangle != scene::Hit::kMiss; ++k) {
    if (range_m >= leaf.truth.range_m) break;
    const scene::SceneAt::Surface surface = scene.surface(triangle);
    const bool passed = leaves_ && is_crown_leaf(triangle, surface, scene, surfaces);
    if (!passed) {
      Echo echo = surfaces.echo_at(triangle, range_m, cosine, place_along(shot.ray, range_m));
      echo.reflectivity *= light;
      out.push_back(echo);
      const std::uint16_t material = echo.truth.material;
      const float through = panes_ && surfaces.transparent(material) ? surfaces.transmittance(material, cosine) : 0.0f;
      light *= through * through;
      if (light < kDark) return;
    }
    const float behind_m = range_m + kOnward_m;
    if (behind_m >= shot.ray.max_m) break;
    const scene::Hit hit = scene.trace({shot.ray.origin + double{behind_m} * shot.ray.direction.cast<double>(),
                                        shot.ray.direction, shot.ray.max_m - behind_m});
    triangle = hit.triangle;
    range_m = behind_m + hit.range_m;
    cosine = std::min(1.0f, std::abs(hit.normal.dot(shot.ray.direction)));
  }
  if (leaf.any()) {
    leaf.reflectivity *= light;
    out.push_back(leaf);
  }
}

}  // namespace canyon::lidar
