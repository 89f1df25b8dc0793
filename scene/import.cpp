#include "canyon/scene/import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "canyon/core/config/text.h"
#include "canyon/core/earth/geoid.h"
#include "canyon/core/files/files.h"
#include "canyon/core/printable_text.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/scene/elevation/elevation.h"
#include "canyon/scene/ground/ground_surface.h"
#include "canyon/scene/importers/assemble.h"
#include "canyon/scene/importers/far_points.h"
#include "canyon/scene/importers/importer.h"
#include "canyon/scene/importers/raw_points.h"
#include "canyon/scene/projection.h"
#include "canyon/scene/tracing/free_space.h"
#include "canyon/scene/written_scene.h"

namespace canyon::scene {
namespace {

constexpr ModelRow<HeightDatum> kHeights[] = {
    {"auto", HeightDatum::kAuto, "as the coordinate system says, else orthometric"},
    {"orthometric", HeightDatum::kOrthometric, "above the geoid"},
    {"ellipsoidal", HeightDatum::kEllipsoidal, "above the ellipsoid"},
};
constexpr ModelRow<UpAxis> kUpAxes[] = {
    {"auto", UpAxis::kAuto, "y of glTF, z of all else"}, {"y", UpAxis::kY, "y"}, {"z", UpAxis::kZ, "z"}};
constexpr ModelRow<StreetSource> kStreets[] = {
    {"auto", StreetSource::kAuto, "of the file if it has any"},
    {"file", StreetSource::kFile, "of the file"},
    {"free_space", StreetSource::kFreeSpace, "the middle lines of the free space"},
};

}  // namespace

void visit(FieldVisitor& f, ImportConfig& c) {
  f.file("file", c.file, "", "scene file, in place of the built-in city (docs/scenes.md lists the formats)");
  f.files("more_files", c.more_files, "further files of the same place: bridges, streets");
  f.file("terrain", c.terrain, "",
         "elevation model: GeoTIFF, SRTM .hgt, ESRI ASCII grid; else what the files say of the ground");
  f.text("crs", c.crs, "coordinate system, as PROJ knows it, in place of the file's own; axes east, north");
  f.choice("heights", c.heights, ModelTable<HeightDatum>(kHeights),
           "what heights in the files are above; auto: as the coordinate system says, else orthometric");
  f.optional_number(
      "undulation_m", c.undulation_m, -1000.0, {-200.0, 200.0},
      "geoid above the ellipsoid; -1000: of the finest of GeographicLib's geoids that is installed, else of EGM96");
  f.numbers("center_deg", c.center_deg, 0, {-360.0, 360.0},
            "latitude, longitude of W's origin; empty: the middle of the scene");
  f.number("radius_m", c.radius_m, {0.0, 1e6}, "if > 0: only what is that near to W's origin is read");
  f.number("ground_cell_m", c.ground_cell_m, {0.5, 100.0}, "cells of terrain made from heights");
  f.number("margin_m", c.margin_m, {1.0, 5000.0},
           "terrain made around what the files hold, in cells of ground_cell_m; larger cells beyond");
  f.text("height_property", c.height_property, "property with a building's height; empty: those of the known layouts");
  f.text("ground_property", c.ground_property, "property with the height of the ground");
  f.text("storeys_property", c.storeys_property, "property with the number of storeys");
  f.number("storey_m", c.storey_m, {1.0, 10.0}, "height of a storey where only their number is known");
  f.number("default_height_m", c.default_height_m, {0.0, 500.0}, "of buildings that say nothing; 0: they are left out");
  f.choice("up_axis", c.up_axis, ModelTable<UpAxis>(kUpAxes), "of mesh files; auto: y of glTF, z of all else");
  f.text("wall_material", c.wall_material, "of walls that say nothing");
  f.text("roof_material", c.roof_material, "of roofs that say nothing");
  f.text("ground_material", c.ground_material, "of ground that says nothing");
  f.files("materials", c.materials, "the user's own material tables, over the built-in one");
  f.choice(
      "streets", c.streets, ModelTable<StreetSource>(kStreets),
      "streets for the route: of the file, or the middle lines of the free space; auto: of the file if it has any");
}

namespace {

class Import {
 public:
  Import(const ImportConfig& config, const Geodetic& origin, std::int64_t max_triangles)
      : config_(config), origin_(origin), max_triangles_(max_triangles) {}

  Result<ImportedScene> run() {
    CANYON_TRY_STATUS(read_files());
    CANYON_TRY_STATUS(find_origin());
    for (std::size_t i = 0; i < scenes_.size(); ++i) place(i);
    if (config_.radius_m > 0.0) clip();
    if (count_dropped_ > 0)
      out_.report.warnings.push_back(std::to_string(count_dropped_) +
                                     " points outside the coordinate system's domain: their surfaces are left out");
    CANYON_TRY_STATUS(refuse_far_points(scenes_));
    CANYON_TRY_STATUS(make_terrain());
    assemble(scenes_, config_, out_.parts, out_.report);
    make_streets();
    for (const RawScene& scene : scenes_)
      out_.report.warnings.insert(out_.report.warnings.end(), scene.warnings.begin(), scene.warnings.end());
    return std::move(out_);
  }

 private:
  Status read_files() {
    CANYON_TRY(out_.parts.materials, load_materials(config_.materials));
    const std::pair<const char*, std::string> named[] = {{"scene.wall_material", config_.wall_material},
                                                         {"scene.roof_material", config_.roof_material},
                                                         {"scene.ground_material", config_.ground_material}};
    for (const auto& material : named) {
      const auto& table = out_.parts.materials;
      if (std::none_of(table.begin(), table.end(), [&](const Material& m) { return m.name == material.second; }))
        return Error{"", 0, material.first, "no material \"" + material.second + "\"", "a material of the table"};
    }
    ReadOptions options{config_.height_property, config_.ground_property, config_.storeys_property,
                        config_.up_axis,         config_.storey_m,        config_.default_height_m};
    std::vector<std::string> paths{config_.file};
    paths.insert(paths.end(), config_.more_files.begin(), config_.more_files.end());
    for (const std::string& path : paths) {
      CANYON_TRY(RawScene scene, read_scene_file(path, options));
      if (!config_.crs.empty()) scene.frame = {config_.crs, false};
      if (scene.frame.crs.empty()) {
        projections_.emplace_back();
      } else {
        CANYON_TRY(Projection projection, Projection::make(scene.frame, path, "crs"));
        if (out_.report.crs.empty()) out_.report.crs = projection.name(), out_.report.vertical = projection.vertical();
        projections_.push_back(std::move(projection));
      }
      scenes_.push_back(std::move(scene));
    }
    out_.parts.name = escaped_text(std::filesystem::path(config_.file).filename().string());
    return Ok{};
  }

  /// W's origin: the middle of what was read, at the median of the ground's heights, in whole metres.
  Status find_origin() {
    if (!config_.center_deg.empty() && config_.center_deg.size() != 2)
      return Error{"", 0, "scene.center_deg", std::to_string(config_.center_deg.size()) + " numbers",
                   "latitude, longitude"};
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
    std::vector<double> heights;
    for (std::size_t i = 0; i < scenes_.size(); ++i) {
      if (!projections_[i]) continue;
      for (const RawFootprint& f : scenes_[i].footprints)
        if (std::isfinite(f.ground_m)) heights.push_back(f.ground_m);
      std::vector<double> lowest(scenes_[i].objects.size(), 1e300);
      for (const RawPolygon& polygon : scenes_[i].polygons)
        for (const auto& ring : polygon.rings)
          for (const Eigen::Vector3d& p : ring) lowest[polygon.object] = std::min(lowest[polygon.object], p.z());
      for (const double h : lowest)
        if (h < 1e300 && heights.size() < 1000000 && scenes_[i].footprints.empty()) heights.push_back(h);
      // A few points of a large scene tell its middle well enough only if they are its outermost: all are looked at.
      for_corners(scenes_[i], [&](const RawPoint& point) {
        const auto g = projections_[i]->to_geodetic({point.p.x(), point.p.y(), 0.0});
        if (!g || !(std::abs(g->lat_rad) <= 0.5 * kPi)) return;
        // All on the same side of the date line as the first.
        const double lon_rad =
            low.x() > high.x() ? g->lon_rad : low.y() + std::remainder(g->lon_rad - low.y(), 2 * kPi);
        low = low.cwiseMin(Eigen::Vector2d(g->lat_rad, lon_rad));
        high = high.cwiseMax(Eigen::Vector2d(g->lat_rad, lon_rad));
      });
    }
    const bool local = low.x() > high.x();  // all in metres about the origin that is stated
    if (local) recentre();
    if (local && config_.terrain.empty()) {
      out_.parts.frame = LocalFrame(origin_);
      out_.report.undulation_source = "none";
      return Ok{};
    }
    Geodetic middle = local ? origin_ : Geodetic{0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), 0.0};
    if (!local && config_.center_deg.size() == 2)
      middle = {config_.center_deg[0] * kDegree, config_.center_deg[1] * kDegree, 0.0};
    ellipsoidal_ = config_.heights == HeightDatum::kEllipsoidal ||
                   (config_.heights == HeightDatum::kAuto && out_.report.vertical == "ellipsoid");
    if (out_.report.vertical.empty()) out_.report.vertical = ellipsoidal_ ? "ellipsoid" : "orthometric (assumed)";
    undulation_m_ = 0.0;
    out_.report.undulation_source = "none";
    if (!ellipsoidal_) {
      if (config_.undulation_m) {
        undulation_m_ = *config_.undulation_m;
        out_.report.undulation_source = "stated";
      } else {
        const GeoidHeight geoid = geoid_height(middle);
        undulation_m_ = geoid.undulation_m;
        out_.report.undulation_source = geoid.model;
      }
    }
    out_.parts.undulation_m = undulation_m_;
    if (local) {
      out_.parts.frame = LocalFrame(origin_);
      return Ok{};
    }
    double ground_m = 0.0;
    if (!config_.terrain.empty()) {
      CANYON_TRY_STATUS(read_terrain());
      ground_m = terrain_height(middle).value_or(0.0);
    } else if (!heights.empty()) {
      std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2),
                       heights.end());
      ground_m = heights[heights.size() / 2];
    }
    middle.h_m = std::round(ground_m) + undulation_m_;
    out_.parts.frame = LocalFrame(middle);
    return Ok{};
  }

  static Eigen::Vector3d z_up(const RawScene& scene, const Eigen::Vector3d& p) {
    return scene.y_up ? Eigen::Vector3d(p.x(), -p.z(), p.y()) : p;
  }

  /// Local metres far from the file's own origin are those of a map: W goes to their middle, for single precision is
  /// finest there. An elevation model tells the ground's height; without one the middle of the lowest corners does.
  void recentre() {
    constexpr double kNear_m = 2000.0;
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
    std::vector<double> heights;
    for (const RawScene& scene : scenes_) {
      std::vector<double> lowest(scene.objects.size() + scene.meshes.size(), 1e300);
      for_corners(scene, [&](const RawPoint& point) {
        const Eigen::Vector3d p = z_up(scene, point.p);
        if (!p.head<2>().allFinite()) return;
        low = low.cwiseMin(p.head<2>());
        high = high.cwiseMax(p.head<2>());
        if (point.object < scene.objects.size()) lowest[point.object] = std::min(lowest[point.object], p.z());
      });
      for (const RawMesh& mesh : scene.meshes)
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
          for (const std::uint32_t v : mesh.triangles[i])
            lowest[mesh.object[i]] = std::min(lowest[mesh.object[i]], z_up(scene, mesh.vertices[v]).z());
      for (const double h : lowest)
        if (std::abs(h) < 1e300) heights.push_back(h);
    }
    if (low.x() > high.x()) return;
    const Eigen::Vector2d middle = 0.5 * (low + high);
    if (!(middle.norm() > kNear_m && middle.norm() > 0.5 * (high - low).norm())) return;
    Eigen::Vector3d& at = out_.report.file_origin_m;
    at.head<2>() = middle.array().round();
    if (config_.terrain.empty() && !heights.empty()) {
      const auto half = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
      std::nth_element(heights.begin(), half, heights.end());
      at.z() = std::round(*half);
    }
    char place[200];
    std::snprintf(place, sizeof place, "(%.0f, %.0f, %.0f) of the file is set down at %.6f, %.6f deg, %.1f m", at.x(),
                  at.y(), at.z(), origin_.lat_rad / kDegree, origin_.lon_rad / kDegree, origin_.h_m);
    out_.report.warnings.push_back("no coordinate system is said (scene.crs) and none is local: " + std::string(place) +
                                   " (scene.lat_deg, scene.lon_deg, scene.base_height_m)");
  }

  Status read_terrain() {
    CANYON_TRY(elevation_, read_elevation(config_.terrain));
    if (elevation_.frame.crs.empty() && config_.crs.empty())
      return Error{config_.terrain, 0, "crs", "does not say its coordinate system",
                   "a GeoTIFF that does, a .prj beside it, or scene.crs"};
    const SourceFrame frame =
        elevation_.frame.crs.empty() ? SourceFrame{config_.crs, false} : SourceFrame{elevation_.frame.crs, false};
    CANYON_TRY(terrain_projection_, Projection::make(frame, config_.terrain, "crs"));
    return Ok{};
  }

  std::optional<double> terrain_height(const Geodetic& g) const {
    const auto p = terrain_projection_->from_geodetic(g);
    return p ? elevation_.height(*p) : std::nullopt;
  }

  /// From the file's coordinates to W.
  void place(std::size_t i) {
    RawScene& scene = scenes_[i];
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto to_W = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
      throw_if_cancelled();
      if (!projections_[i]) return z_up(scene, p) - out_.report.file_origin_m;
      const auto g = projections_[i]->to_geodetic(p);
      if (!g || !(std::abs(g->lat_rad) <= 0.5 * kPi)) {
        ++count_dropped_;
        return Eigen::Vector3d::Constant(nan);
      }
      return out_.parts.frame.from_geodetic({g->lat_rad, g->lon_rad, g->h_m + undulation_m_});
    };
    const double level_m = projections_[i] ? out_.parts.frame.origin().h_m - undulation_m_ : 0.0;
    for (RawPolygon& polygon : scene.polygons)
      for (auto& ring : polygon.rings)
        for (Eigen::Vector3d& p : ring) p = to_W(p);
    for (RawMesh& mesh : scene.meshes)
      for (Eigen::Vector3d& p : mesh.vertices) p = to_W(p);
    for (RawFootprint& f : scene.footprints) {
      const bool known = std::isfinite(f.ground_m);
      double sum_m = 0.0;
      for (auto& ring : f.rings) {
        for (Eigen::Vector2d& p : ring) {
          const Eigen::Vector3d p_W = to_W({p.x(), p.y(), known ? f.ground_m : level_m});
          p = p_W.head<2>();
          if (&ring == &f.rings[0]) sum_m += p_W.z();
        }
      }
      if (known) f.ground_m = sum_m / static_cast<double>(f.rings[0].size());
    }
    for (RawStreet& street : scene.streets)
      for (Eigen::Vector2d& p : street.points) p = to_W({p.x(), p.y(), level_m}).head<2>();
    for (RawTree& tree : scene.trees) tree.place = to_W({tree.place.x(), tree.place.y(), level_m}).head<2>();
    const auto lost = [](const auto& ring) {
      return std::any_of(ring.begin(), ring.end(), [](const auto& p) { return !p.allFinite(); });
    };
    std::erase_if(scene.polygons, [&](const RawPolygon& p) {
      return projections_[i] && std::any_of(p.rings.begin(), p.rings.end(), lost);
    });
    std::erase_if(scene.footprints,
                  [&](const RawFootprint& f) { return std::any_of(f.rings.begin(), f.rings.end(), lost); });
    std::erase_if(scene.streets, [&](const RawStreet& s) { return lost(s.points); });
    std::erase_if(scene.trees, [&](const RawTree& t) { return !t.place.allFinite(); });
  }

  /// Leaves out what begins farther from the origin than the radius.
  void clip() {
    const auto far = [&](const auto& p) { return !(p.template head<2>().norm() <= config_.radius_m); };
    const auto all_far = [&](const auto& ring) { return std::all_of(ring.begin(), ring.end(), far); };
    for (RawScene& scene : scenes_) {
      std::erase_if(scene.polygons, [&](const RawPolygon& p) { return all_far(p.rings[0]); });
      std::erase_if(scene.footprints, [&](const RawFootprint& f) { return all_far(f.rings[0]); });
      std::erase_if(scene.streets, [&](const RawStreet& s) { return all_far(s.points); });
      std::erase_if(scene.trees, [&](const RawTree& t) { return far(t.place); });
      for (RawMesh& mesh : scene.meshes) {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
          const auto& t = mesh.triangles[k];
          if (far(mesh.vertices[t[0]]) && far(mesh.vertices[t[1]]) && far(mesh.vertices[t[2]])) continue;
          mesh.triangles[kept] = mesh.triangles[k];
          mesh.object[kept] = mesh.object[k];
          mesh.material[kept++] = mesh.material[k];
        }
        mesh.triangles.resize(kept);
        mesh.object.resize(kept);
        mesh.material.resize(kept);
      }
    }
  }

  bool files_have_terrain() const {
    return std::any_of(scenes_.begin(), scenes_.end(), [](const RawScene& scene) {
      return std::any_of(scene.objects.begin(), scene.objects.end(),
                         [](const SceneObject& o) { return o.kind == ObjectKind::kTerrain; });
    });
  }

  /// What stands, and where a vehicle drives.
  GroundDetail detail() const {
    GroundDetail out;
    const auto ring = [&](const auto& corners) {
      for (std::size_t k = 0; k < corners.size(); ++k)
        out.add(corners[k].template head<2>(), corners[(k + 1) % corners.size()].template head<2>());
    };
    for (const RawScene& scene : scenes_) {
      for (const RawPolygon& polygon : scene.polygons)
        for (const auto& corners : polygon.rings) ring(corners);
      for (const RawFootprint& f : scene.footprints)
        for (const auto& corners : f.rings) ring(corners);
      for (const RawMesh& mesh : scene.meshes) {
        throw_if_cancelled();
        for (const auto& t : mesh.triangles)
          ring(std::array<Eigen::Vector3d, 3>{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
      }
      for (const RawStreet& street : scene.streets)
        for (std::size_t k = 0; k + 1 < street.points.size(); ++k) out.add(street.points[k], street.points[k + 1]);
      for (const RawTree& tree : scene.trees) out.add(tree.place, tree.place);
    }
    return out;
  }

  /// `terrain`: triangles of ground that is made.
  Status expect(double terrain) {
    for (const RawScene& scene : scenes_) terrain += triangles_of(scene);
    out_.report.predicted.triangles = terrain;
    CANYON_TRY_STATUS(check_cost(out_.report.predicted, max_triangles_, config_.file,
                                 "larger cells (scene.ground_cell_m), a part of it (scene.radius_m)"));
    progress_.emplace("scene of about " + cost_text(out_.report.predicted), 1.0);
    return Ok{};
  }

  Status make_terrain() {
    if (config_.terrain.empty() && files_have_terrain()) {
      out_.report.ground = "surfaces of the file";
      return expect(0.0);
    }
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
    for (const RawScene& scene : scenes_)
      for_corners(scene, [&](const RawPoint& point) {
        if (!point.p.head<2>().allFinite()) return;
        low = low.cwiseMin(point.p.head<2>());
        high = high.cwiseMax(point.p.head<2>());
      });
    if (low.x() > high.x()) {
      out_.report.ground = "none";
      return expect(0.0);
    }
    if (config_.radius_m > 0.0) low = low.cwiseMax(-config_.radius_m), high = high.cwiseMin(config_.radius_m);
    low.array() -= config_.margin_m;
    high.array() += config_.margin_m;
    const GroundWish wish{low, high, config_.ground_cell_m, std::max(config_.margin_m, 5.0 * config_.ground_cell_m)};
    const double most_cells = 0.5 * static_cast<double>(max_triangles_);
    if (!config_.terrain.empty()) {
      if (!terrain_projection_) CANYON_TRY_STATUS(read_terrain());
      const GroundHeight height = [this](const Eigen::Vector2d& p) { return modelled_ground(p); };
      const GroundPlan plan(wish, detail(), height, most_cells);
      CANYON_TRY_STATUS(expect(2.0 * plan.cells()));
      GroundMesh ground(plan);
      if (!fill_ground(ground, height))
        return Error{config_.terrain, 0, "", "does not cover the scene", "an elevation model of the same place"};
      out_.report.ground = std::filesystem::path(config_.terrain).filename().string();
      add_ground(ground, config_.ground_material, out_.parts);
      return Ok{};
    }
    const auto heights = ground_points(scenes_);
    const GroundFit fit(heights);
    const GroundPlan plan(wish, detail(), {}, most_cells);  // between buildings the fit is a guess
    CANYON_TRY_STATUS(expect(2.0 * plan.cells()));
    GroundMesh ground(plan);
    fill_ground(ground, fit);
    out_.report.ground = heights.empty()
                             ? "level"
                             : "fitted to " + std::to_string(heights.size()) + " heights of the ground at buildings";
    add_ground(ground, config_.ground_material, out_.parts);
    return Ok{};
  }

  /// Of the elevation model, in W.
  std::optional<double> modelled_ground(const Eigen::Vector2d& p) const {
    const LocalFrame& frame = out_.parts.frame;
    Geodetic g = frame.to_geodetic({p.x(), p.y(), 0.0});
    const auto h = terrain_height(g);
    if (!h) return std::nullopt;
    g.h_m = *h + (terrain_projection_->ellipsoidal() ? 0.0 : undulation_m_);
    return frame.from_geodetic(g).z();
  }

  void make_streets() {
    const bool of_file = !out_.parts.streets.edges.empty();
    if (config_.streets == StreetSource::kFile || (config_.streets == StreetSource::kAuto && of_file)) {
      out_.report.streets = of_file ? "of the file" : "none";
      return;
    }
    out_.parts.streets = free_space_streets(out_.parts);
    out_.report.streets = out_.parts.streets.edges.empty() ? "none" : "middle lines of the free space";
  }

  const ImportConfig& config_;
  Geodetic origin_;
  std::int64_t max_triangles_;
  std::optional<Progress> progress_;
  ImportedScene out_;
  std::vector<RawScene> scenes_;
  std::vector<std::optional<Projection>> projections_;
  bool ellipsoidal_ = false;
  double undulation_m_ = 0.0;
  Elevation elevation_;
  std::optional<Projection> terrain_projection_;
  int count_dropped_ = 0;
};

}  // namespace

Result<ImportedScene> import_scene(const ImportConfig& config, const Geodetic& origin, std::int64_t max_triangles) {
  if (config.file.ends_with(".json")) {
    CANYON_TRY(const std::string text, read_text_file(config.file));
    if (is_written_scene(std::string_view(text).substr(0, 1024))) {
      ImportedScene out;
      CANYON_TRY(out.parts, read_written_scene(config.file));
      out.report = {.crs = {},
                    .vertical = "ellipsoid",
                    .undulation_source = "stated",
                    .ground = "surfaces of the file",
                    .streets = "of the file",
                    .warnings = {}};
      return out;
    }
  }
  return Import(config, origin, max_triangles).run();
}

}  // namespace canyon::scene
