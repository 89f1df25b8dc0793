#include "canyon/scene/inspect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::scene {
namespace {

using Key = std::array<float, 3>;

/// The edges of one object's triangles.
class ObjectEdges {
 public:
  explicit ObjectEdges(const Scene& scene) : scene_(scene) {}

  void add(std::uint32_t triangle) {
    throw_if_cancelled();
    const Mesh& mesh = scene_.mesh();
    std::array<std::uint32_t, 3> ids;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f p = mesh.vertices[mesh.triangles[triangle][k]] + Eigen::Vector3f::Zero();
      const auto [entry, fresh] =
          ids_.try_emplace(Key{p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(places_.size()));
      if (fresh) places_.push_back(p.cast<double>());
      ids[k] = entry->second;
    }
    const Eigen::Vector3d &a = places_[ids[0]], &b = places_[ids[1]], &c = places_[ids[2]];
    six_volumes_m3_ += (a - places_[0]).dot((b - places_[0]).cross(c - places_[0]));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = ids[k], to = ids[(k + 1) % 3];
      Count& count = edges_[{std::min(from, to), std::max(from, to)}];
      ++(from < to ? count.forward : count.backward);
    }
    std::sort(ids.begin(), ids.end());
    repeated_ += triangles_.insert(ids).second ? 0 : 1;
  }

  void sum_up(Soundness& out) const {
    std::size_t open = 0, crowded = 0, flipped = 0;
    const double lowest_ground_m = lowest_ground();
    for (const auto& [ends, count] : edges_) {
      throw_if_cancelled();
      const int n = count.forward + count.backward;
      if (n == 1 && !buried(places_[ends.first], places_[ends.second], lowest_ground_m)) ++open;
      if (n == 2 && count.forward != count.backward) ++flipped;
      if (n > 2) ++crowded;
    }
    ++out.objects;
    out.open_edges += open;
    out.crowded_edges += crowded;
    out.flipped_edges += flipped;
    out.repeated_triangles += repeated_;
    if (open == 0 && crowded == 0) {
      ++out.watertight;
      if (flipped == 0 && six_volumes_m3_ < 0.0 && closed_below()) ++out.inside_out;
    }
  }

 private:
  struct Count {
    int forward = 0, backward = 0;
  };

  /// The lowest terrain beside the object's corners; far down if there is none.
  double lowest_ground() const {
    std::optional<double> lowest_m;
    for (const Eigen::Vector3d& p : places_) {
      throw_if_cancelled();
      if (const auto ground_m = scene_.ground_beside(p.x(), p.y()))
        lowest_m = std::min(lowest_m.value_or(*ground_m), *ground_m);
    }
    return lowest_m.value_or(-1e300);
  }
  /// What a file puts on its ground lies a little above it or below, by the ground's own triangles. Between two
  /// buildings there may be no terrain: what lies below all that is near is buried too.
  static constexpr double kFlush_m = 0.01;
  bool buried(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double lowest_ground_m) const {
    const auto below = [&](const Eigen::Vector3d& p) {
      const auto ground = scene_.ground(p.x(), p.y());
      return p.z() <= (ground ? ground->height_m : lowest_ground_m) + kFlush_m;
    };
    return below(a) && below(b);
  }
  /// The volume of what is open below the ground says nothing.
  bool closed_below() const {
    return std::none_of(edges_.begin(), edges_.end(),
                        [](const auto& e) { return e.second.forward + e.second.backward == 1; });
  }

  const Scene& scene_;
  std::map<Key, std::uint32_t> ids_;
  std::vector<Eigen::Vector3d> places_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Count> edges_;
  std::set<std::array<std::uint32_t, 3>> triangles_;
  std::size_t repeated_ = 0;
  double six_volumes_m3_ = 0.0;
};

/// Squares of the plan whose middles lie within reach of a street; all if there are no streets.
class NearStreets {
 public:
  NearStreets(const Scene& scene, double reach_m) : low_(scene.extent().min.head<2>()) {
    const StreetGraph& streets = scene.streets();
    if (streets.edges.empty() || scene.mesh().triangles.empty()) return;
    const Eigen::Vector2d size = scene.extent().max.head<2>() - low_;
    columns_ = static_cast<int>(size.x() / kCell_m) + 1;
    rows_ = static_cast<int>(size.y() / kCell_m) + 1;
    near_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), false);
    for (const StreetGraph::Edge& edge : streets.edges) {
      throw_if_cancelled();
      const Eigen::Vector2d &a = streets.nodes_W[edge.a], &b = streets.nodes_W[edge.b], way = b - a;
      const Eigen::Vector2d low = a.cwiseMin(b).array() - reach_m, high = a.cwiseMax(b).array() + reach_m;
      for (int r = row(low.y()); r <= row(high.y()); ++r)
        for (int c = column(low.x()); c <= column(high.x()); ++c) {
          const Eigen::Vector2d p = low_ + kCell_m * Eigen::Vector2d(c + 0.5, r + 0.5) - a;
          const double share = std::clamp(p.dot(way) / std::max(way.squaredNorm(), 1e-12), 0.0, 1.0);
          if ((p - share * way).norm() <= reach_m) near_[index(c, r)] = true;
        }
    }
  }

  bool operator()(const Eigen::Vector2d& p) const { return near_.empty() || near_[index(column(p.x()), row(p.y()))]; }

 private:
  static constexpr double kCell_m = 10.0;
  int column(double x) const { return std::clamp(static_cast<int>((x - low_.x()) / kCell_m), 0, columns_ - 1); }
  int row(double y) const { return std::clamp(static_cast<int>((y - low_.y()) / kCell_m), 0, rows_ - 1); }
  std::size_t index(int c, int r) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
  }
  Eigen::Vector2d low_;
  int columns_ = 1, rows_ = 1;
  std::vector<bool> near_;
};

}  // namespace

std::vector<MaterialArea> material_areas(const Scene& scene) {
  const Mesh& mesh = scene.mesh();
  std::vector<MaterialArea> areas(scene.materials().size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    throw_if_cancelled();
    MaterialArea& area = areas[mesh.material[i]];
    ++area.triangles;
    area.area_m2 += 0.5 * Triangle::of(mesh, i).area_normal().norm();
  }
  for (std::size_t i = 0; i < areas.size(); ++i) areas[i].name = scene.materials()[i].name;
  std::erase_if(areas, [](const MaterialArea& a) { return a.triangles == 0; });
  std::stable_sort(areas.begin(), areas.end(), [](const auto& a, const auto& b) { return a.area_m2 > b.area_m2; });
  return areas;
}

Soundness soundness(const Scene& scene) {
  const Mesh& mesh = scene.mesh();
  std::vector<std::vector<std::uint32_t>> by_object(scene.objects().size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const ObjectKind kind = scene.objects()[mesh.object[i]].kind;
    if (kind != ObjectKind::kTerrain && kind != ObjectKind::kTree) by_object[mesh.object[i]].push_back(i);
  }
  Soundness out;
  for (const auto& members : by_object) {
    if (members.empty()) continue;
    ObjectEdges edges(scene);
    for (const std::uint32_t i : members) edges.add(i);
    edges.sum_up(out);
  }
  return out;
}

SensorNeeds sensor_needs(const Scene& scene) {
  SensorNeeds out;
  const Mesh& mesh = scene.mesh();
  for (const Facet& facet : scene.facets().facets()) {
    ++out.facets;
    const Material& m = scene.materials()[facet.material];
    out.reflecting_facets += !m.rf_absorbing && (m.itu_a > 1.0 || m.itu_c > 0.0);
  }
  out.edges = scene.edges().edges().size();
  NearStreets near(scene, out.lidar_reach_m);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    throw_if_cancelled();
    out.tree_triangles += scene.objects()[mesh.object[i]].kind == ObjectKind::kTree;
    const Triangle t = Triangle::of(mesh, i);
    out.near_triangles += near(((t.a + t.b + t.c) / 3.0).head<2>());
    const Material& m = scene.materials()[mesh.material[i]];
    out.specular = out.specular || m.lidar_specular > 0.0;
    out.retro = out.retro || m.lidar_retro_1_sr > 0.0;
    out.transparent = out.transparent || m.lidar_transmittance > 0.0;
  }
  const auto say = [](std::vector<std::string>& list, bool needed, std::string what, const std::string& else_what) {
    list.push_back(needed ? "needs " + std::move(what) : "does not need " + else_what);
  };
  say(out.gnss, out.reflecting_facets > 0, std::to_string(out.reflecting_facets) + " mirrors for reflections",
      "reflections: nothing mirrors");
  say(out.gnss, out.edges > 0, std::to_string(out.edges) + " edges for diffraction", "diffraction: nothing stands up");
  say(out.gnss, !scene.foliage().empty(), std::to_string(scene.foliage().size()) + " tree crowns for attenuation",
      "attenuation by foliage: there are no crowns");
  if (out.tree_triangles > 0) say(out.gnss, false, "", std::to_string(out.tree_triangles) + " triangles of trees");
  say(out.lidar, true, std::to_string(out.near_triangles) + " triangles within 120 m of a street", "");
  if (out.near_triangles < mesh.triangles.size())
    say(out.lidar, false, "", std::to_string(mesh.triangles.size() - out.near_triangles) + " triangles farther away");
  say(out.lidar, out.specular, "a mirror part of reflectance (glass, metal)",
      "a mirror part of reflectance: no such material");
  say(out.lidar, out.retro, "retro-reflection", "retro-reflection: no such material");
  say(out.lidar, out.transparent, "second returns through glass", "second returns through glass: there is none");
  say(out.lidar, false, "", "mirrors and edges");
  return out;
}

Grid heights_from_above(const Scene& scene, double cell_m) {
  Grid grid;
  const Extent& extent = scene.extent();
  grid.cell_m = std::max(cell_m, (extent.max - extent.min).head<2>().maxCoeff() / 4000.0);
  grid.west_m = extent.min.x(), grid.south_m = extent.min.y();
  grid.columns = std::max(1, static_cast<int>(std::ceil((extent.max.x() - extent.min.x()) / grid.cell_m)));
  grid.rows = std::max(1, static_cast<int>(std::ceil((extent.max.y() - extent.min.y()) / grid.cell_m)));
  grid.values.assign(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), std::nan(""));
  const SceneAt at(scene);
  const double top_m = extent.max.z() + 10.0;
  parallel_for(static_cast<std::size_t>(grid.rows), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const double x = grid.west_m + (column + 0.5) * grid.cell_m,
                     y = grid.south_m + (static_cast<double>(row) + 0.5) * grid.cell_m;
        const auto hit = at.trace({Eigen::Vector3d(x, y, top_m), {0, 0, -1}});
        if (!hit.hit()) continue;
        const auto ground = scene.ground(x, y);
        grid.at(column, static_cast<int>(row)) = top_m - hit.range_m - (ground ? ground->height_m : extent.min.z());
      }
    }
  });
  return grid;
}

}  // namespace canyon::scene
