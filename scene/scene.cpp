#include "canyon/scene/scene.h"

#include <algorithm>
#include <utility>

#include "canyon/core/check.h"
#include "canyon/core/files/file_hash.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/city/site.h"
#include "canyon/scene/surfaces/triangle.h"
#include "canyon/scene/surfaces/triangulate.h"
#include "canyon/scene/tracing/tiled_tracer.h"

namespace canyon::scene {
namespace {

void check_indices(const SceneParts& parts) {
  const Mesh& mesh = parts.mesh;
  CANYON_CHECK(mesh.material.size() == mesh.triangles.size() && mesh.object.size() == mesh.triangles.size(),
               "triangles = ", mesh.triangles.size(), ", material = ", mesh.material.size(),
               ", object = ", mesh.object.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % 65536 == 0) throw_if_cancelled();
    for (const std::uint32_t v : mesh.triangles[i]) {
      CANYON_CHECK(v < mesh.vertices.size(), "triangle ", i, " vertex ", v, " of ", mesh.vertices.size());
    }
    CANYON_CHECK(mesh.material[i] < parts.materials.size(), "triangle ", i, " material ", mesh.material[i]);
    CANYON_CHECK(mesh.object[i] < parts.objects.size(), "triangle ", i, " object ", mesh.object[i]);
  }
  for (const Building& b : parts.buildings) CANYON_CHECK(b.object < parts.objects.size(), b.name, " object ", b.object);
}

Extent extent_of(const Mesh& mesh) {
  Extent extent;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      const Eigen::Vector3d p = mesh.vertices[v].cast<double>();
      extent.min = extent.min.cwiseMin(p);
      extent.max = extent.max.cwiseMax(p);
    }
  }
  return extent;
}

template <class T>
void add_to(Sha256& hash, const T* values, std::size_t count) {
  const std::uint64_t n = count;
  hash.add({reinterpret_cast<const char*>(&n), sizeof n});
  hash.add({reinterpret_cast<const char*>(values), count * sizeof(T)});
}

/// Vectors that grew hold up to twice what they need, and a scene lives as long as its runs.
void shrink_to_fit(Mesh& mesh) {
  mesh.vertices.shrink_to_fit();
  mesh.triangles.shrink_to_fit();
  mesh.material.shrink_to_fit();
  mesh.object.shrink_to_fit();
}

}  // namespace

Scene::Scene(SceneParts parts) : parts_(std::move(parts)) {
  check_indices(parts_);
  dropped_triangles_ = drop_unusable_triangles(parts_.mesh);
  shrink_to_fit(parts_.mesh);
  extent_ = extent_of(parts_.mesh);
  tracer_ = std::make_unique<TiledTracer>(parts_, extent_);
  crowns_ = FoliageIndex(parts_.foliage);
}

Scene::~Scene() = default;

const FacetIndex& Scene::facets() const {
  std::call_once(facets_once_, [this] {
    facets_ = FacetIndex(merge_planar_facets(*this, kMinFacetArea_m2));
    facets_built_.store(true, std::memory_order_release);
  });
  return facets_;
}

const EdgeIndex& Scene::edges() const {
  std::call_once(edges_once_, [this] {
    edges_ = EdgeIndex(convex_edges(*this, kMinEdge_m));
    edges_built_.store(true, std::memory_order_release);
  });
  return edges_;
}

const FacadeIndex& Scene::facades() const {
  std::call_once(facades_once_, [this] { facades_ = FacadeIndex(*this); });
  return facades_;
}

bool Scene::facets_built() const {
  return facets_built_.load(std::memory_order_acquire);
}

Scene::Made Scene::made() const {
  Made made;
  made.tiles = static_cast<std::int64_t>(tracer_->tiles_made());
  made.acceleration_structures = made.tiles + instance_sets_.load();
  if (facets_built()) made.facets = static_cast<std::int64_t>(facets_.facets().size());
  if (edges_built_.load(std::memory_order_acquire)) made.edges = static_cast<std::int64_t>(edges_.edges().size());
  return made;
}

std::optional<Scene::Ground> Scene::ground(double x, double y) const {
  const std::uint32_t index = tracer_->terrain_triangle(x, y);
  if (index == Hit::kMiss) return std::nullopt;
  const Triangle triangle = Triangle::of(parts_.mesh, index);
  Eigen::Vector3d normal = triangle.area_normal().normalized();
  if (normal.z() < 0.0) normal = -normal;
  const double height_m =
      triangle.a.z() - (normal.x() * (x - triangle.a.x()) + normal.y() * (y - triangle.a.y())) / normal.z();
  return Ground{height_m, normal, parts_.mesh.material[index]};
}

std::optional<double> Scene::ground_beside(double x, double y) const {
  constexpr double kBeside_m = 0.05;
  constexpr double kPlaces[][2] = {{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  std::optional<double> lowest_m;
  for (const auto& place : kPlaces)
    if (const auto found = ground(x + kBeside_m * place[0], y + kBeside_m * place[1]))
      lowest_m = std::min(lowest_m.value_or(found->height_m), found->height_m);
  return lowest_m;
}

const Building* Scene::building_at(const Eigen::Vector2d& xy) const {
  return scene::building_at(parts_.buildings, xy);
}

const Building* building_at(const std::vector<Building>& buildings, const Eigen::Vector2d& xy) {
  for (const Building& building : buildings) {
    if (!polygon_contains(building.footprint_W, xy)) continue;
    const auto& yards = building.courtyards_W;
    if (std::none_of(yards.begin(), yards.end(), [&](const auto& yard) { return polygon_contains(yard, xy); }))
      return &building;
  }
  return nullptr;
}

std::string Scene::hash() const {
  const Mesh& mesh = parts_.mesh;
  throw_if_cancelled();
  Sha256 sha;
  add_to(sha, mesh.vertices.data(), mesh.vertices.size());
  add_to(sha, mesh.triangles.data(), mesh.triangles.size());
  add_to(sha, mesh.material.data(), mesh.material.size());
  add_to(sha, mesh.object.data(), mesh.object.size());
  for (const Material& m : parts_.materials) {
    const double values[] = {m.itu_a,
                             m.itu_b,
                             m.itu_c,
                             m.itu_d,
                             m.thickness_m,
                             m.roughness_m,
                             m.scatter_coefficient,
                             static_cast<double>(m.scatter_lobe),
                             m.reflectance(850.0),
                             m.reflectance(905.0),
                             m.reflectance(1550.0),
                             m.lidar_slope_deg,
                             m.lidar_spread,
                             m.lidar_grain_m,
                             m.lidar_specular,
                             m.lidar_specular_lobe_deg,
                             m.lidar_retro_1_sr,
                             m.lidar_transmittance,
                             m.rf_absorbing ? 1.0 : 0.0};
    add_to(sha, m.name.data(), m.name.size());
    add_to(sha, values, std::size(values));
  }
  for (const SceneObject& o : parts_.objects) {
    const auto kind = static_cast<std::uint8_t>(o.kind);
    add_to(sha, o.name.data(), o.name.size());
    add_to(sha, &kind, 1);
  }
  for (const Foliage& f : parts_.foliage) {
    add_to(sha, f.center_W.data(), 3);
    add_to(sha, f.radii_m.data(), 3);
    add_to(sha, &f.leaf_density_m2_m3, 1);
  }
  const Geodetic& origin = parts_.frame.origin();
  const double frame[] = {origin.lat_rad, origin.lon_rad, origin.h_m, parts_.undulation_m};
  add_to(sha, frame, std::size(frame));
  return std::move(sha).hex();
}

}  // namespace canyon::scene
