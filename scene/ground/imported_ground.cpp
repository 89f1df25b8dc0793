#include "canyon/scene/ground/imported_ground.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include "canyon/scene/ground/ground_surface.h"
#include "canyon/scene/importers/assemble.h"
#include "canyon/scene/importers/raw_points.h"

namespace canyon::scene {
namespace {

bool have_terrain(const std::vector<RawScene>& scenes) {
  return std::any_of(scenes.begin(), scenes.end(), [](const RawScene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const SceneObject& o) { return o.kind == ObjectKind::kTerrain; });
  });
}

/// What stands, and where a vehicle drives.
GroundDetail detail_of(const std::vector<RawScene>& scenes) {
  GroundDetail out;
  const auto ring = [&](const auto& corners) {
    for (std::size_t k = 0; k < corners.size(); ++k)
      out.add(corners[k].template head<2>(), corners[(k + 1) % corners.size()].template head<2>());
  };
  for (const RawScene& scene : scenes) {
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

/// Of the elevation model, in W.
std::optional<double> modelled_ground(const TerrainFile& terrain, const FileFrame& at, const Eigen::Vector2d& p) {
  Geodetic g = at.frame.to_geodetic({p.x(), p.y(), 0.0});
  const auto h = terrain.height(g);
  if (!h) return std::nullopt;
  g.h_m = *h + (terrain.ellipsoidal() ? 0.0 : at.undulation_m);
  return at.frame.from_geodetic(g).z();
}

}  // namespace

Status ImportedGround::make(const std::vector<RawScene>& scenes, ImportedScene& out) {
  if (config_.terrain.empty() && have_terrain(scenes)) {
    out.report.ground = "surfaces of the file";
    return expect(scenes, 0.0, out.report);
  }
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
  for (const RawScene& scene : scenes)
    for_corners(scene, [&](const RawPoint& point) {
      if (!point.p.head<2>().allFinite()) return;
      low = low.cwiseMin(point.p.head<2>());
      high = high.cwiseMax(point.p.head<2>());
    });
  if (low.x() > high.x()) {
    out.report.ground = "none";
    return expect(scenes, 0.0, out.report);
  }
  if (config_.radius_m > 0.0) low = low.cwiseMax(-config_.radius_m), high = high.cwiseMin(config_.radius_m);
  low.array() -= config_.margin_m;
  high.array() += config_.margin_m;
  const GroundWish wish{low, high, config_.ground_cell_m, std::max(config_.margin_m, 5.0 * config_.ground_cell_m)};
  return config_.terrain.empty() ? make_of_heights(scenes, wish, out) : make_of_model(scenes, wish, out);
}

Status ImportedGround::expect(const std::vector<RawScene>& scenes, double terrain_triangles, ImportReport& report) {
  double triangles = terrain_triangles;
  for (const RawScene& scene : scenes) triangles += triangles_of(scene);
  report.predicted.triangles = triangles;
  CANYON_TRY_STATUS(
      check_cost(report.predicted, max_triangles_, config_.file,
                 "larger cells (scene.ground_cell_m), less around it (scene.margin_m), a part of it (scene.radius_m)"));
  progress_.emplace("scene of about " + cost_text(report.predicted), 1.0);
  return Ok{};
}

Status ImportedGround::make_of_model(const std::vector<RawScene>& scenes, const GroundWish& wish, ImportedScene& out) {
  std::optional<TerrainFile> read;
  if (!at_.terrain) {
    CANYON_TRY(read, TerrainFile::read(config_.terrain, config_.crs));
  }
  const TerrainFile& terrain = at_.terrain ? *at_.terrain : *read;
  const GroundHeight height = [&](const Eigen::Vector2d& p) { return modelled_ground(terrain, at_, p); };
  const GroundPlan plan(wish, detail_of(scenes), height, 0.5 * static_cast<double>(max_triangles_));
  CANYON_TRY_STATUS(expect(scenes, 2.0 * plan.cells(), out.report));
  GroundMesh ground(plan);
  if (!fill_ground(ground, height))
    return Error{config_.terrain, 0, "", "does not cover the scene", "an elevation model of the same place"};
  out.report.ground = std::filesystem::path(config_.terrain).filename().string();
  add_ground(ground, config_.ground_material, out.parts);
  return Ok{};
}

Status ImportedGround::make_of_heights(const std::vector<RawScene>& scenes, const GroundWish& wish,
                                       ImportedScene& out) {
  const auto heights = ground_points(scenes);
  const GroundFit fit(heights);
  // Between buildings the fit is a guess.
  const GroundPlan plan(wish, detail_of(scenes), {}, 0.5 * static_cast<double>(max_triangles_));
  CANYON_TRY_STATUS(expect(scenes, 2.0 * plan.cells(), out.report));
  GroundMesh ground(plan);
  fill_ground(ground, fit);
  out.report.ground =
      heights.empty() ? "level" : "fitted to " + std::to_string(heights.size()) + " heights of the ground at buildings";
  add_ground(ground, config_.ground_material, out.parts);
  return Ok{};
}

}  // namespace canyon::scene
