#include "canyon/scene/importers/assemble.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "canyon/core/lower_case.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/importers/footprint.h"
#include "canyon/scene/importers/outline.h"
#include "canyon/scene/importers/solid_bottom.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/surfaces/tree.h"
#include "canyon/scene/surfaces/triangulate.h"

namespace canyon::scene {
namespace {

constexpr double kSunk_m = 0.5;  ///< how far walls reach below the lowest ground around them

/// Names of other tables for what ours has.
struct Alias {
  const char* theirs;
  const char* ours;
};
constexpr Alias kAliases[] = {{"very_dry_ground", "ground"}, {"medium_dry_ground", "grass"}};
/// Crowns of imported trees take the upper part of their height.
constexpr double kCrownFrom = 0.3;

class Assembler {
 public:
  Assembler(const ImportConfig& config, SceneParts& parts, ImportReport& report)
      : config_(config), parts_(parts), report_(report), mesh_(parts) {}

  void run(const std::vector<RawScene>& scenes) {
    build_terrain(scenes);
    for (const RawScene& scene : scenes) add(scene);
    for (const auto& [name, count] : unknown_materials_)
      report_.warnings.push_back("material \"" + name + "\" is not in the table: " + std::to_string(count) +
                                 " surfaces take the default");
    if (flattened_ > 0)
      report_.warnings.push_back(std::to_string(flattened_) +
                                 " pitched roofs over concave outlines or courtyards are made flat");
    if (no_area_ > 0) report_.warnings.push_back(std::to_string(no_area_) + " surfaces without area are left out");
  }

 private:
  /// The terrain alone, to ask how high the ground is.
  void build_terrain(const std::vector<RawScene>& scenes) {
    SceneParts ground = parts_;
    ground.buildings.clear();
    MeshBuilder builder(ground);
    builder.begin_object("ground", ObjectKind::kTerrain);
    for (const RawScene& scene : scenes) {
      for (const RawPolygon& polygon : scene.polygons) {
        throw_if_cancelled();
        if (scene.objects[polygon.object].kind != ObjectKind::kTerrain) continue;
        for_triangles(polygon, [&](const auto& a, const auto& b, const auto& c) { builder.triangle(a, b, c, 0); });
      }
      for (const RawMesh& mesh : scene.meshes)
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
          throw_if_cancelled();
          if (scene.objects[mesh.object[i]].kind != ObjectKind::kTerrain) continue;
          const auto& t = mesh.triangles[i];
          builder.triangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], 0);
        }
    }
    terrain_.emplace(std::move(ground));
  }

  template <class Body>
  static std::size_t for_triangles(const RawPolygon& polygon, const Body& body) {
    std::vector<Eigen::Vector3d> points;
    for (const auto& ring : polygon.rings) points.insert(points.end(), ring.begin(), ring.end());
    const auto triangles = triangulate(polygon.rings);
    for (const auto& t : triangles) body(points[t[0]], points[t[1]], points[t[2]]);
    return triangles.size();
  }

  /// Lowest ground on a ring's corners and on the way between them; nullopt without terrain there.
  template <class Point>
  std::optional<double> lowest_ground(const std::vector<Point>& ring) const {
    std::optional<double> low_m;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d a = ring[i].template head<2>(), b = ring[(i + 1) % ring.size()].template head<2>();
      const int steps = std::clamp(static_cast<int>((b - a).norm() / 2.0), 1, 100);
      for (int k = 0; k < steps; ++k) {
        const Eigen::Vector2d p = a + (b - a) * k / steps;
        if (const auto ground_m = terrain_->ground_beside(p.x(), p.y()))
          low_m = std::min(low_m.value_or(*ground_m), *ground_m);
      }
    }
    return low_m;
  }

  std::uint16_t material(const std::string& name, const std::string& otherwise) {
    if (name.empty()) return mesh_.material(otherwise);
    std::string plain = lower_case(name);
    for (const char* prefix : {"mat-", "itu_", "itu-"})
      if (plain.starts_with(prefix)) plain.erase(0, std::char_traits<char>::length(prefix));
    for (const std::string& known : {name, plain}) {
      for (std::size_t i = 0; i < parts_.materials.size(); ++i)
        if (parts_.materials[i].name == known) return static_cast<std::uint16_t>(i);
    }
    for (const Alias& alias : kAliases)
      if (plain == alias.theirs) return mesh_.material(alias.ours);
    ++unknown_materials_[name];
    return mesh_.material(otherwise);
  }

  const std::string& default_material(ObjectKind kind, const Eigen::Vector3d& normal) const {
    if (kind == ObjectKind::kTerrain) return config_.ground_material;
    return kind == ObjectKind::kBuilding && normal.z() > 0.35 * normal.norm() ? config_.roof_material
                                                                              : config_.wall_material;
  }

  void add(const RawScene& scene) {
    const auto first = static_cast<std::uint32_t>(parts_.objects.size());
    for (const SceneObject& object : scene.objects) {
      const int n = ++names_[object.name];
      parts_.objects.push_back({n == 1 ? object.name : object.name + " (" + std::to_string(n) + ")", object.kind});
    }
    solids_.assign(scene.objects.size(), {});
    for (const RawFootprint& footprint : scene.footprints) add_outlined(scene, footprint, first);
    for (const RawPolygon& polygon : scene.polygons) add_polygon(scene, polygon, first);
    for (const RawMesh& mesh : scene.meshes) add_mesh(scene, mesh, first);
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
      throw_if_cancelled();
      if (scene.objects[i].kind == ObjectKind::kBuilding)
        finish_building(first + i, solids_[i]);
      else if (scene.objects[i].kind == ObjectKind::kTree)
        add_crown(solids_[i]);
    }
    for (const RawTree& tree : scene.trees) plant(tree, first);
    for (const RawStreet& street : scene.streets) add_street(street);
  }

  /// What belongs to one building or tree.
  struct Solid {
    std::vector<SolidFace> faces;
    double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
    std::vector<std::vector<Eigen::Vector2d>> footprint;  ///< the largest, with its courtyards
    bool of_parts = false;                                ///< an outline came first, parts follow
    double base_m = 0.0, height_m = 0.0;
  };

  void add_outlined(const RawScene& scene, const RawFootprint& f, std::uint32_t first) {
    throw_if_cancelled();
    mesh_.resume_object(first + f.object);
    Solid& solid = solids_[f.object];
    const std::optional<double> low_m = lowest_ground(f.rings[0]);
    const double base_m = solid.of_parts              ? solid.base_m  // all from the same ground
                          : std::isfinite(f.ground_m) ? f.ground_m
                                                      : low_m.value_or(0.0);
    if (f.only_outline) {
      if (solid.of_parts) return;  // another piece of the same outline
      solid.of_parts = true;
      solid.footprint = f.rings;
      solid.base_m = base_m;
      return;
    }
    const double bottom_m = std::min(low_m.value_or(base_m), base_m) - kSunk_m;
    flattened_ += add_footprint(f, bottom_m, base_m, material(f.wall_material, config_.wall_material),
                                material(f.roof_material, config_.roof_material), mesh_)
                      ? 0
                      : 1;
    if (solid.footprint.empty() || std::abs(twice_area(f.rings[0])) > std::abs(twice_area(solid.footprint[0]))) {
      solid.footprint = f.rings;
      solid.base_m = base_m;
    }
    solid.height_m = std::max(solid.height_m, f.height_m);
    (void)scene;
  }

  void add_polygon(const RawScene& scene, const RawPolygon& polygon, std::uint32_t first) {
    throw_if_cancelled();
    mesh_.resume_object(first + polygon.object);
    const ObjectKind kind = scene.objects[polygon.object].kind;
    std::optional<std::uint16_t> index;
    const std::size_t count = for_triangles(polygon, [&](const auto& a, const auto& b, const auto& c) {
      const Eigen::Vector3d normal = (b - a).cross(c - a);
      if (!index) index = material(scene.materials[polygon.material], default_material(kind, normal));
      mesh_.triangle(a, b, c, *index);
      if (has_solid(kind)) note({a, b, c}, polygon.ground_surface, solids_[polygon.object]);
    });
    no_area_ += count == 0 ? 1 : 0;
  }

  void add_mesh(const RawScene& scene, const RawMesh& raw, std::uint32_t first) {
    Mesh& mesh = parts_.mesh;
    const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3d& p : raw.vertices) mesh.vertices.push_back(p.cast<float>());
    // The same material again and again: looked up once for each default it may take.
    std::map<std::pair<std::uint32_t, const std::string*>, std::uint16_t> known;
    for (std::size_t i = 0; i < raw.triangles.size(); ++i) {
      throw_if_cancelled();
      const auto& t = raw.triangles[i];
      const std::array<Eigen::Vector3d, 3> corners{raw.vertices[t[0]], raw.vertices[t[1]], raw.vertices[t[2]]};
      const ObjectKind kind = scene.objects[raw.object[i]].kind;
      const std::string& otherwise = default_material(kind, (corners[1] - corners[0]).cross(corners[2] - corners[0]));
      const auto [entry, fresh] = known.try_emplace({raw.material[i], &otherwise}, std::uint16_t{0});
      if (fresh) entry->second = material(scene.materials[raw.material[i]], otherwise);
      mesh.triangles.push_back({offset + t[0], offset + t[1], offset + t[2]});
      mesh.material.push_back(entry->second);
      mesh.object.push_back(first + raw.object[i]);
      if (has_solid(kind)) note(corners, false, solids_[raw.object[i]]);
    }
  }

  static bool has_solid(ObjectKind kind) { return kind == ObjectKind::kBuilding || kind == ObjectKind::kTree; }

  /// The crown of a tree that came as triangles: what GNSS signals pass.
  void add_crown(const Solid& solid) {
    if (solid.faces.empty()) return;
    Eigen::Vector2d low = solid.faces[0].corners[0].head<2>(), high = low;
    for (const SolidFace& face : solid.faces)
      for (const Eigen::Vector3d& p : face.corners) low = low.cwiseMin(p.head<2>()), high = high.cwiseMax(p.head<2>());
    const Eigen::Vector2d middle = 0.5 * (low + high), half = 0.5 * (high - low);
    const double height_m = solid.high_m - solid.low_m;
    if (!(half.minCoeff() > 0.0 && height_m > 0.0)) return;
    parts_.foliage.push_back({{middle.x(), middle.y(), solid.low_m + 0.5 * (1.0 + kCrownFrom) * height_m},
                              {half.x(), half.y(), 0.5 * (1.0 - kCrownFrom) * height_m}});
  }

  void plant(const RawTree& tree, std::uint32_t first) {
    throw_if_cancelled();
    const auto ground = terrain_->ground(tree.place.x(), tree.place.y());
    mesh_.resume_object(first + tree.object);
    const double radius_m = 0.5 * tree.crown_m;
    add_tree({tree.place.x(), tree.place.y(), ground ? ground->height_m : 0.0},
             {0.5 * (1.0 + kCrownFrom) * tree.height_m, {radius_m, radius_m, 0.5 * (1.0 - kCrownFrom) * tree.height_m}},
             leaves_, planted_++, mesh_, parts_);
  }

  /// The mesh's last triangle belongs to a solid.
  void note(const std::array<Eigen::Vector3d, 3>& corners, bool bottom, Solid& solid) const {
    if (!corners[0].allFinite() || !corners[1].allFinite() || !corners[2].allFinite()) return;
    solid.faces.push_back({corners, static_cast<std::uint32_t>(parts_.mesh.triangles.size() - 1), bottom});
    for (const Eigen::Vector3d& p : corners) {
      solid.low_m = std::min(solid.low_m, p.z());
      solid.high_m = std::max(solid.high_m, p.z());
    }
  }

  void finish_building(std::uint32_t object, Solid& solid) {
    Building building;
    building.name = parts_.objects[object].name;
    building.object = object;
    if (!solid.footprint.empty()) {
      building.base_m = solid.base_m;
      building.height_m = solid.height_m;
    } else if (!solid.faces.empty()) {
      for (const SolidBottom& bottom : bottoms_of(solid.faces)) {
        sink(object, bottom);
        for (const auto& ring : bottom.rings) {
          std::vector<Eigen::Vector2d> flat;
          for (const Eigen::Vector3d& p : ring) flat.push_back(p.head<2>());
          solid.footprint.push_back(std::move(flat));
        }
      }
      // Bottoms run clockwise seen from above: the outline has the largest area, yards the other sense.
      const auto largest = std::max_element(
          solid.footprint.begin(), solid.footprint.end(),
          [](const auto& a, const auto& b) { return std::abs(twice_area(a)) < std::abs(twice_area(b)); });
      if (largest != solid.footprint.end()) std::iter_swap(solid.footprint.begin(), largest);
      if (solid.footprint.empty()) {
        std::vector<Eigen::Vector2d> corners;
        for (const SolidFace& face : solid.faces)
          for (const Eigen::Vector3d& p : face.corners) corners.emplace_back(p.head<2>());
        solid.footprint = {convex_hull(std::move(corners))};
      }
      const bool outline_positive = twice_area(solid.footprint[0]) > 0.0;
      std::erase_if(solid.footprint, [&](const auto& ring) {
        return &ring != &solid.footprint[0] && (twice_area(ring) > 0.0) == outline_positive;
      });
      building.base_m = solid.low_m;
      building.height_m = solid.high_m - solid.low_m;
    } else {
      return;  // no geometry
    }
    for (std::size_t r = 0; r < solid.footprint.size(); ++r) {
      auto& ring = solid.footprint[r];
      if ((twice_area(ring) > 0.0) != (r == 0)) std::reverse(ring.begin(), ring.end());
      if (r == 0)
        building.footprint_W = std::move(ring);
      else
        building.courtyards_W.push_back(std::move(ring));
    }
    parts_.buildings.push_back(std::move(building));
  }

  /// Where the ground lies lower somewhere around a bottom, that and the walls around it go down into it; where there
  /// is no bottom, one is made there.
  void sink(std::uint32_t object, const SolidBottom& bottom) {
    constexpr double kStep_m = 2.0;  // what is farther above the ground, a chimney, stands on another part
    double hangs_m = 0.0, depth_m = std::numeric_limits<double>::infinity();
    for (const auto& ring : bottom.rings) {
      double low_m = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3d& p : ring) low_m = std::min(low_m, p.z());
      const double ground_m = lowest_ground(ring).value_or(low_m);
      hangs_m = std::max(hangs_m, low_m - ground_m);
      depth_m = std::min(depth_m, std::min(ground_m, low_m) - kSunk_m);
    }
    if (!(hangs_m > 0.0) || (hangs_m > kStep_m && !bottom.sure)) return;
    mesh_.resume_object(object);
    const std::uint16_t wall = mesh_.material(config_.wall_material);
    for (auto ring : bottom.rings) {
      std::reverse(ring.begin(), ring.end());  // outlines counter-clockwise seen from above
      std::vector<Eigen::Vector2d> outline;
      std::vector<double> top_m;
      for (const Eigen::Vector3d& p : ring) {
        outline.push_back(p.head<2>());
        top_m.push_back(p.z());
      }
      mesh_.walls(outline, std::vector<double>(ring.size(), depth_m), top_m, wall);
    }
    if (bottom.triangles.empty()) {
      const auto at_depth = [&](const Eigen::Vector2d& p) { return Eigen::Vector3d(p.x(), p.y(), depth_m); };
      for (const auto& t : floor_of(bottom)) mesh_.triangle(at_depth(t[0]), at_depth(t[1]), at_depth(t[2]), wall);
    }
    Mesh& mesh = parts_.mesh;
    for (const std::uint32_t triangle : bottom.triangles)
      for (std::uint32_t& vertex : mesh.triangles[triangle]) {
        Eigen::Vector3f lowered = mesh.vertices[vertex];
        lowered.z() = static_cast<float>(depth_m);
        vertex = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(lowered);
      }
  }

  /// Streets meet where they have a point in common.
  void add_street(const RawStreet& street) {
    std::optional<std::uint32_t> before;
    for (const Eigen::Vector2d& p : street.points) {
      const auto [entry, fresh] = nodes_.try_emplace({std::llround(p.x() * 1e3), std::llround(p.y() * 1e3)},
                                                     static_cast<std::uint32_t>(parts_.streets.nodes_W.size()));
      if (fresh) parts_.streets.nodes_W.push_back(p);
      if (before && *before != entry->second) parts_.streets.edges.push_back({*before, entry->second, street.width_m});
      before = entry->second;
    }
  }

  const ImportConfig& config_;
  SceneParts& parts_;
  ImportReport& report_;
  MeshBuilder mesh_;
  std::optional<Scene> terrain_;
  std::vector<Solid> solids_;
  std::map<std::string, int> names_;
  std::map<std::string, int> unknown_materials_;
  std::map<std::pair<long long, long long>, std::uint32_t> nodes_;
  const RandomStream leaves_{0, "scene.import.leaves"};
  std::size_t planted_ = 0;
  int flattened_ = 0, no_area_ = 0;
};

}  // namespace

std::vector<Eigen::Vector3d> ground_points(const std::vector<RawScene>& scenes) {
  std::vector<Eigen::Vector3d> out;
  for (const RawScene& scene : scenes) {
    for (const RawFootprint& f : scene.footprints) {
      if (!std::isfinite(f.ground_m)) continue;
      Eigen::Vector2d middle = Eigen::Vector2d::Zero();
      for (const Eigen::Vector2d& p : f.rings[0]) middle += p / static_cast<double>(f.rings[0].size());
      out.emplace_back(middle.x(), middle.y(), f.ground_m);
    }
    // Of solids the lowest corner stands for the whole building.
    std::vector<Eigen::Vector3d> lowest(scene.objects.size(),
                                        Eigen::Vector3d(0, 0, std::numeric_limits<double>::infinity()));
    const auto lower = [&](std::uint32_t object, const Eigen::Vector3d& p) {
      if (p.allFinite() && p.z() < lowest[object].z()) lowest[object] = p;
    };
    for (const RawPolygon& polygon : scene.polygons)
      for (const auto& ring : polygon.rings)
        for (const Eigen::Vector3d& p : ring) lower(polygon.object, p);
    for (const RawMesh& mesh : scene.meshes)
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t v : mesh.triangles[i]) lower(mesh.object[i], mesh.vertices[v]);
    for (std::size_t i = 0; i < lowest.size(); ++i)
      if (scene.objects[i].kind == ObjectKind::kBuilding && std::isfinite(lowest[i].z())) out.push_back(lowest[i]);
  }
  return out;
}

double triangles_of(const RawScene& scene) {
  constexpr double kTree = 12.0 + 48.0;  // trunk and leaves
  double sum = kTree * static_cast<double>(scene.trees.size());
  for (const RawPolygon& polygon : scene.polygons)
    for (const auto& ring : polygon.rings) sum += static_cast<double>(ring.size());
  for (const RawMesh& mesh : scene.meshes) sum += static_cast<double>(mesh.triangles.size());
  for (const RawFootprint& f : scene.footprints)
    for (const auto& ring : f.rings) sum += 3.0 * static_cast<double>(ring.size());  // walls and roof
  return sum;
}

void assemble(const std::vector<RawScene>& scenes, const ImportConfig& config, SceneParts& parts,
              ImportReport& report) {
  Assembler(config, parts, report).run(scenes);
}

}  // namespace canyon::scene
