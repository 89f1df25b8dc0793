#include "canyon/apps/answers/scene_facts.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "canyon/core/units.h"
#include "canyon/report/maps/raster_map.h"

namespace canyon::apps {

namespace {

/// A corner of the scene on the ground's level, on the map.
Geodetic corner_on_earth(const scene::Scene& scene, const Eigen::Vector3d& corner_W) {
  return scene.frame().to_geodetic({corner_W.x(), corner_W.y(), 0.0});
}

/// South-west and north-east: in W, from which vehicle.start_m and waypoints are chosen, and on the Earth, for --at.
Json corners_json(const scene::Scene& scene) {
  if (scene.mesh().triangles.empty()) return nullptr;
  const auto corner = [&](const Eigen::Vector3d& p) -> Json {
    const Geodetic g = corner_on_earth(scene, p);
    return {{"x_m", p.x()},
            {"y_m", p.y()},
            {"z_m", p.z()},
            {"lat_deg", g.lat_rad / kDegree},
            {"lon_deg", g.lon_rad / kDegree}};
  };
  return {{"south_west", corner(scene.extent().min)}, {"north_east", corner(scene.extent().max)}};
}

void print_corners(const scene::Scene& scene) {
  if (scene.mesh().triangles.empty()) return;
  const Eigen::Vector3d &low = scene.extent().min, &high = scene.extent().max;
  const Geodetic sw = corner_on_earth(scene, low), ne = corner_on_earth(scene, high);
  std::printf("  corners in W      (%.1f, %.1f) to (%.1f, %.1f) m, as in vehicle.start_m; heights %.1f to %.1f m\n",
              low.x(), low.y(), high.x(), high.y(), low.z(), high.z());
  std::printf("  corners           %.6f,%.6f to %.6f,%.6f deg, as in --at LAT,LON,H; H of W's origin %.1f m\n",
              sw.lat_rad / kDegree, sw.lon_rad / kDegree, ne.lat_rad / kDegree, ne.lon_rad / kDegree,
              scene.frame().origin().h_m);
}

}  // namespace

SceneFacts::SceneFacts(const scene::Scene& s, const scene::ImportReport& r)
    : scene(s),
      report(r),
      extent(s.extent()),
      materials(scene::material_areas(s)),
      sound(scene::soundness(s)),
      needs(scene::sensor_needs(s)) {
  if (!s.mesh().triangles.empty()) size_m = extent.max - extent.min;
  for (const scene::Building& b : s.buildings()) height_sum_m += b.height_m;
}

Json scene_json(const SceneFacts& f) {
  const scene::Scene& scene = f.scene;
  const scene::ImportReport& report = f.report;
  Json materials = Json::array();
  for (const auto& m : f.materials)
    materials.push_back({{"name", m.name}, {"triangles", m.triangles}, {"area_m2", m.area_m2}});
  const Geodetic& origin = scene.frame().origin();
  return {
      {"name", scene.name()},
      {"buildings", scene.buildings().size()},
      {"building_height_sum_m", f.height_sum_m},
      {"triangles", scene.mesh().triangles.size()},
      {"facets", f.needs.facets},
      {"extent_m", {f.size_m.x(), f.size_m.y(), f.size_m.z()}},
      {"area_m2", f.size_m.x() * f.size_m.y()},
      {"origin", {{"lat_deg", origin.lat_rad / kDegree}, {"lon_deg", origin.lon_rad / kDegree}, {"h_m", origin.h_m}}},
      {"corners", corners_json(scene)},
      {"materials", materials},
      {"crs", report.crs},
      {"file_origin_m", {report.file_origin_m.x(), report.file_origin_m.y(), report.file_origin_m.z()}},
      {"heights_above", report.vertical},
      {"undulation_m", scene.parts().undulation_m},
      {"undulation_source", report.undulation_source},
      {"ground", report.ground},
      {"streets", {{"source", report.streets}, {"edges", scene.streets().edges.size()}}},
      {"predicted", {{"triangles", report.predicted.triangles}, {"memory_mb", report.predicted.memory_mb()}}},
      {"dropped_triangles", scene.dropped_triangles()},
      {"objects", f.sound.objects},
      {"watertight_objects", f.sound.watertight},
      {"open_edges", f.sound.open_edges},
      {"crowded_edges", f.sound.crowded_edges},
      {"flipped_edges", f.sound.flipped_edges},
      {"inside_out_objects", f.sound.inside_out},
      {"repeated_triangles", f.sound.repeated_triangles},
      {"gnss", f.needs.gnss},
      {"lidar", f.needs.lidar},
      {"hash", scene.hash()},
      {"warnings", report.warnings}};
}

void print_scene(const SceneFacts& f) {
  const scene::Scene& scene = f.scene;
  const scene::ImportReport& report = f.report;
  const Geodetic& origin = scene.frame().origin();
  std::printf("%s\n\n", scene.name().c_str());
  std::printf("  origin of W       %.6f, %.6f deg, %.2f m above the ellipsoid\n", origin.lat_rad / kDegree,
              origin.lon_rad / kDegree, origin.h_m);
  std::printf("  coordinates       %s", report.crs.empty() ? "local metres" : report.crs.c_str());
  if (report.crs.empty())
    std::printf("; (%.0f, %.0f, %.0f) of the file is W's origin", report.file_origin_m.x(), report.file_origin_m.y(),
                report.file_origin_m.z());
  std::printf("\n");
  if (!report.crs.empty())
    std::printf("  heights           above %s, undulation %.2f m (%s)\n", report.vertical.c_str(),
                scene.parts().undulation_m, report.undulation_source.c_str());
  std::printf("  extent            %.1f x %.1f x %.1f m\n", f.size_m.x(), f.size_m.y(), f.size_m.z());
  print_corners(scene);
  std::printf("  ground            %s\n", report.ground.c_str());
  std::printf("  streets           %s (%zu pieces)\n", report.streets.c_str(), scene.streets().edges.size());
  std::printf("  buildings         %zu, heights sum to %.1f m\n", scene.buildings().size(), f.height_sum_m);
  std::printf("  triangles         %zu, and %zu that no ray can meet\n", scene.mesh().triangles.size(),
              scene.dropped_triangles());
  std::printf("  planar facets     %zu\n\n", f.needs.facets);
  std::printf("  %-20s %12s %16s\n", "material", "triangles", "area, m^2");
  for (const auto& m : f.materials) std::printf("  %-20s %12zu %16.1f\n", m.name.c_str(), m.triangles, m.area_m2);
  const scene::Soundness& s = f.sound;
  std::printf("\n  watertight        %zu of %zu objects (terrain and trees left out)\n", s.watertight, s.objects);
  std::printf(
      "  edges             %zu open, %zu of more than two triangles, %zu between faces turned against each other\n",
      s.open_edges, s.crowded_edges, s.flipped_edges);
  std::printf("  faces             %zu repeated; %zu objects inside out\n\n", s.repeated_triangles, s.inside_out);
  for (const auto& line : f.needs.gnss) std::printf("  a GNSS run %s\n", line.c_str());
  for (const auto& line : f.needs.lidar) std::printf("  a LIDAR run %s\n", line.c_str());
  for (const auto& warning : report.warnings) std::printf("\n  note: %s", warning.c_str());
  if (!report.warnings.empty()) std::printf("\n");
}

std::string scene_picture(const scene::Scene& scene, double cell_m, const std::string& path) {
  const Grid grid = scene::heights_from_above(scene, cell_m);
  const report::RasterMap map{.title = scene.name(),
                              .subtitle = "height above the ground, from above",
                              .unit = "m",
                              .grid = &grid,
                              .edges = {-0.5, 0.5, 3.0, 8.0, 15.0, 25.0, 50.0, 100.0},
                              .bad_is_low = true};
  return path.ends_with(".png") ? report::raster_png(map) : report::raster_svg(map);
}

}  // namespace canyon::apps
