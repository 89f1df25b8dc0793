#include "canyon/scene/import.h"

#include <algorithm>
#include <filesystem>

#include "canyon/core/files/files.h"
#include "canyon/core/printable_text.h"
#include "canyon/scene/file_frame.h"
#include "canyon/scene/ground/imported_ground.h"
#include "canyon/scene/importers/assemble.h"
#include "canyon/scene/importers/far_points.h"
#include "canyon/scene/importers/importer.h"
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
    CANYON_TRY(const FileFrame at, find_frame(files_, config_, origin_, out_.report));
    out_.parts.frame = at.frame;
    out_.parts.undulation_m = at.undulation_m;
    out_.report.file_origin_m = at.file_origin_m;
    int dropped = 0;
    for (std::size_t i = 0; i < files_.scenes.size(); ++i)
      dropped += set_down(files_.scenes[i], files_.projections[i], at);
    if (config_.radius_m > 0.0) clip();
    if (dropped > 0)
      out_.report.warnings.push_back(std::to_string(dropped) +
                                     " points outside the coordinate system's domain: their surfaces are left out");
    CANYON_TRY_STATUS(refuse_far_points(files_.scenes));
    ImportedGround ground(config_, at, max_triangles_);
    CANYON_TRY_STATUS(ground.make(files_.scenes, out_));
    assemble(files_.scenes, config_, out_.parts, out_.report);
    make_streets();
    for (const RawScene& scene : files_.scenes)
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
        files_.projections.emplace_back();
      } else {
        CANYON_TRY(Projection projection, Projection::make(scene.frame, path, "crs"));
        if (out_.report.crs.empty()) out_.report.crs = projection.name(), out_.report.vertical = projection.vertical();
        files_.projections.push_back(std::move(projection));
      }
      files_.scenes.push_back(std::move(scene));
    }
    out_.parts.name = escaped_text(std::filesystem::path(config_.file).filename().string());
    return Ok{};
  }

  /// Leaves out what begins farther from the origin than the radius.
  void clip() {
    const auto far = [&](const auto& p) { return !(p.template head<2>().norm() <= config_.radius_m); };
    const auto all_far = [&](const auto& ring) { return std::all_of(ring.begin(), ring.end(), far); };
    for (RawScene& scene : files_.scenes) {
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
  ImportedScene out_;
  FileScenes files_;
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
