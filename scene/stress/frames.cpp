// Files of a scene set down on Earth.
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/scene/file_frame.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Worst;

RawScene houses(const std::vector<Vector3d>& places, const std::string& crs) {
  RawScene out;
  out.frame.crs = crs;
  for (const Vector3d& p : places) {
    const std::uint32_t object = out.add_object("house " + std::to_string(out.objects.size()), ObjectKind::kBuilding);
    RawPolygon polygon{.object = object, .material = 0};
    const double e = crs.empty() ? 4.0 : 1e-4;
    polygon.rings = {{p, p + Vector3d(e, 0, 0), p + Vector3d(e, e, 0), p + Vector3d(0, e, 6.0)}};
    out.polygons.push_back(polygon);
  }
  return out;
}

/// The same as triangles, the lowest corner of each in its second one alone.
RawScene meshes(const std::vector<Vector3d>& places) {
  RawScene out;
  RawMesh mesh;
  for (const Vector3d& p : places) {
    const std::uint32_t object = out.add_object("house " + std::to_string(out.objects.size()), ObjectKind::kBuilding);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vector3d& off : {Vector3d(0, 4, 6), Vector3d(4, 4, 3), Vector3d(4, 0, 2), Vector3d(0, 0, 0)})
      mesh.vertices.push_back(p + off);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
    // Of the first house, the other way round: what is lowest there is of no other house.
    if (first == 0) std::swap(mesh.triangles[0], mesh.triangles[1]);
    mesh.object.insert(mesh.object.end(), 2, object);
    mesh.material.insert(mesh.material.end(), 2, 0);
  }
  out.meshes.push_back(mesh);
  return out;
}

/// Files in local metres, near their origin and far from it: near, W is the file; far, W's origin is the middle of all
/// files, at the median of the houses' lowest corners; and a file with y upwards is turned. Exactly.
StressFigure local_frame(const Vector3d& far, bool y_up, bool as_mesh = false) {
  const std::vector<Vector3d> places{{0, 0, 3}, {40, 10, 5}, {-20, 30, 4}}, others{{60, -50, 9}, {10, 5, 8}};
  FileScenes files;
  for (const auto& of : {places, others}) {
    std::vector<Vector3d> moved;
    for (const Vector3d& p : of) moved.push_back(p + far);
    RawScene scene = as_mesh ? meshes(moved) : houses(moved, "");
    if (y_up) {
      scene.y_up = true;
      for (RawPolygon& polygon : scene.polygons)
        for (auto& ring : polygon.rings)
          for (Vector3d& p : ring) p = Vector3d(p.x(), p.z(), -p.y());
      for (RawMesh& mesh : scene.meshes)
        for (Vector3d& p : mesh.vertices) p = Vector3d(p.x(), p.z(), -p.y());
    }
    files.scenes.push_back(scene);
    files.projections.emplace_back();
  }
  ImportReport report;
  const Geodetic origin{0.8, 0.1, 250.0};
  const auto found = find_frame(files, {}, origin, report);
  if (!found) return {kInfinity, 1.0};
  Worst worst;
  const bool moves = far.head<2>().norm() > 2000.0;
  const Vector3d middle = far + Vector3d(std::round(0.5 * (-20.0 + 64.0)), std::round(0.5 * (-50.0 + 34.0)), 5.0);
  worst.look((found->file_origin_m - (moves ? middle : Vector3d(Vector3d::Zero()))).norm(), 0.51 * std::sqrt(2.0));
  worst.look(found->frame.origin().lat_rad - origin.lat_rad + found->frame.origin().h_m - 250.0, 1e-12);
  worst.look(report.warnings.empty() == !moves ? 0.0 : kInfinity, 1.0);
  RawScene second = files.scenes[1];
  worst.look(set_down(second, std::nullopt, *found), 1e-300);
  const Vector3d corner = as_mesh ? second.meshes[0].vertices[3] : second.polygons[0].rings[0][0],
                 expected = Vector3d(60, -50, 9) + far - found->file_origin_m;
  worst.look((corner - expected).norm(), 16.0 * kEpsilon * (1.0 + far.norm()));
  return worst.figure();
}

/// Files in geographic degrees, two of them in different quarters of a city, also across the date line: W's origin is
/// the middle of all corners of both, at the median of the houses' feet, and each corner stands where it does on Earth.
StressFigure mapped_frame(double lon_deg) {
  SourceFrame degrees;
  degrees.crs = "EPSG:4326";
  const auto projection = Projection::make(degrees, "made", "scene.crs");
  // A build without map projections has no such frames.
  if (!projection) return {0.0, 1.0};
  const auto lon = [&](double x) { return x > 180.0 ? x - 360.0 : x; };
  const std::vector<Vector3d> places{{lon(lon_deg), 10.000, 30}, {lon(lon_deg + 0.002), 10.004, 32}},
      others{
          {lon(lon_deg + 0.008), 10.001, 50}, {lon(lon_deg + 0.004), 10.006, 40}, {lon(lon_deg + 0.006), 10.003, 41}};
  FileScenes files;
  for (const auto& of : {places, others}) {
    files.scenes.push_back(houses(of, "EPSG:4326"));
    files.projections.emplace_back(*projection);
  }
  ImportConfig config;
  config.heights = HeightDatum::kEllipsoidal;
  ImportReport report;
  const auto found = find_frame(files, config, {0.1, 0.1, 0.0}, report);
  if (!found) return {kInfinity, 1.0};
  Worst worst;
  const Geodetic at = found->frame.origin();
  worst.look(std::remainder(at.lon_rad / kDegree - (lon_deg + 0.5 * 0.0081), 360.0), 4.0 * kEpsilon * 180.0);
  worst.look(at.lat_rad / kDegree - (10.0 + 0.5 * 0.0061), 4.0 * kEpsilon * 90.0);
  worst.look(at.h_m - 40.0, 64.0 * kEpsilon * 40.0);
  worst.look(found->undulation_m, 1e-300);
  for (std::size_t file = 0; file < 2; ++file) {
    RawScene scene = files.scenes[file];
    worst.look(set_down(scene, files.projections[file], *found), 1e-300);
    for (std::size_t k = 0; k < scene.polygons.size(); ++k) {
      const Vector3d& deg = files.scenes[file].polygons[k].rings[0][3];
      const Vector3d exact_E = ecef_from_geodetic({deg.y() * kDegree, deg.x() * kDegree, deg.z()});
      worst.look((found->frame.to_E(scene.polygons[k].rings[0][3]) - exact_E).norm(), 4.0 * kEpsilon * 6.4e6);
    }
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> frame_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "several files of a scene set down on Earth",
           "the extremes of one file for another's, the other side of the date line, a height of the wrong corner",
           "the middle of all corners at the median foot, and each corner where it is", "of the bound"});
  rows.add("frames/of_metres",
           [] {
             return local_frame({0, 0, 0}, false);
           })
      .add("frames/of_metres_far_away",
           [] {
             return local_frame({5e5, -4e6, 0}, false);
           })
      .add("frames/of_metres_y_up",
           [] {
             return local_frame({3e4, 2e4, 0}, true);
           })
      .add("frames/triangles_in_metres_of_a_map",
           [] {
             return local_frame({5e5, -4e6, 0}, false, true);
           })
      .add("frames/triangles_in_metres_y_up", [] {
        return local_frame({3e4, 2e4, 0}, true, true);
      });
  for (const double lon_deg : {7.0, 179.996, -180.0})
    rows.add("frames/of_degrees_from_" + stress::text(lon_deg), [lon_deg] { return mapped_frame(lon_deg); })
        .loose("corners come back through the frame with fewer roundings than a place on Earth may have");
  return rows.take();
}

}  // namespace canyon::scene
