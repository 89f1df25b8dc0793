// Indices of facets and edges against trying all, maps set down on Earth, and what is true of any built-in city.
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/city/plan.h"
#include "canyon/scene/file_frame.h"
#include "canyon/scene/inspect.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kHalfUlp;
using stress::kInfinity;
using stress::Worst;

/// Boxes all over a kilometre and more, turned and of many heights, some of them hanging or sunk.
std::unique_ptr<Scene> scattered(std::uint64_t seed, double longer_m = 0.0) {
  const RandomStream draw(seed, "stress.boxes");
  SceneParts parts = made::nothing();
  for (std::uint64_t k = 0; k < 150; ++k) {
    MeshBuilder mesh(parts);
    mesh.begin_object("box " + std::to_string(k), ObjectKind::kBuilding);
    const Vector3d half(1.0 + (9.0 + longer_m) * draw.uniform(0, k), 1.0 + 9.0 * draw.uniform(1, k),
                        1.0 + 20.0 * draw.uniform(2, k));
    const Eigen::Matrix3d axes =
        rotation_from({.yaw_rad = longer_m > 0.0 ? 0.3 * draw.uniform(3, k) : 6.0 * draw.uniform(3, k),
                       .pitch_rad = k % 3 == 0 ? 0.5 * draw.uniform(4, k) : 0.0,
                       .roll_rad = 0.0})
            .toRotationMatrix();
    mesh.box({1500.0 * (draw.uniform(5, k) - 0.5), 1500.0 * (draw.uniform(6, k) - 0.5), 30.0 * draw.uniform(7, k)},
             axes, half, mesh.material("brick"));
  }
  return made::scene_of(std::move(parts));
}

/// Facets near a point: those whose ball comes within the radius, all of them and no other, ascending. Mirrors: none
/// left out that could mirror a wave from that high, which for walls is standing above its elevation, for level roofs
/// lying below it; none taken that is beyond reach. A figure counts.
StressFigure facets(std::uint64_t seed) {
  const auto scene = scattered(seed);
  const FacetIndex& index = scene->facets();
  const auto& all = index.facets();
  const RandomStream draw(seed, "stress.places");
  StressFigure out;
  out.figure += all.size() == 6 * 150 ? 0.0 : 1.0;
  std::vector<std::uint32_t> found;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const Vector3d p(1600.0 * (draw.uniform(0, k) - 0.5), 1600.0 * (draw.uniform(1, k) - 0.5),
                     20.0 * draw.uniform(2, k));
    const double radius = k % 4 == 0 ? 0.01 : 200.0 * draw.uniform(3, k);
    index.near(p, radius, found);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < all.size(); ++i)
      if ((all[i].center_W - p).norm() <= all[i].radius_m + radius) expected.push_back(i);
    out.figure += found == expected ? 0.0 : 1.0;

    const double elevation = 0.05 + 1.3 * draw.uniform(4, k), reach = k % 2 == 0 ? kInfinity : 3.0, leaning_m = 300.0;
    index.mirrors(p, elevation, reach, leaning_m, found);
    const std::set<std::uint32_t> listed(found.begin(), found.end());
    out.figure += listed.size() == found.size() ? 0.0 : 1.0;
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      const Facet& f = all[i];
      // Horizontal distances of its corners: what is nearer than the nearest point of its ball is none of it.
      const double middle_m = (f.center_W - p).head<2>().norm(), near_m = worse(middle_m - f.radius_m, 0.0);
      const double far_m = middle_m + f.radius_m, up = f.normal_W.z();
      const bool wall = std::abs(up)<1e-4, roof = up> 1.0 - 1e-7;
      const double top = std::tan(elevation) * near_m, rise_m = f.top_m - p.z();
      const bool within = near_m <= reach * f.area_m2;
      if (wall && within && rise_m > top + 0.01) {
        // From its farthest point too it stands out: surely one of them.
        if (rise_m > std::tan(elevation) * far_m + 0.01) out.figure += listed.count(i) == 1 ? 0.0 : 1.0;
      }
      // An upright one may lean by a milliradian.
      if (wall && rise_m < std::tan(elevation - 2.1e-3) * near_m - 0.1) out.figure += listed.count(i) == 0 ? 0.0 : 1.0;
      if (roof && f.bottom_m - p.z() > 0.01) out.figure += listed.count(i) == 0 ? 0.0 : 1.0;
      if (!(near_m <= reach * f.area_m2 + 0.1)) out.figure += listed.count(i) == 0 ? 0.0 : 1.0;
    }
  }
  return out;
}

/// A box has twelve edges of its three lengths, each between two of its faces and pointing out of it; those that shade
/// a place are those that reach above a direction by no more than the bend that the detour allows: trying all. And a
/// sheet has four borders. A figure counts.
StressFigure edges(std::uint64_t seed, double longer_m) {
  const auto scene = scattered(seed, longer_m);
  const EdgeIndex& index = scene->edges();
  const auto& all = index.edges();
  StressFigure out;
  out.figure += all.size() == 12 * 150 ? 0.0 : 1.0;
  for (const Edge& e : all) {
    const Vector3d along = (e.b_W - e.a_W).normalized();
    // Corners of single precision, 6e-5 m at 800 m, over edges of 2 m.
    constexpr double kSquare = 2e-4;
    const bool square = std::abs(e.normal_1_W.dot(e.normal_2_W)) < kSquare &&
                        std::abs(along.dot(e.normal_1_W)) < kSquare && std::abs(along.dot(e.normal_2_W)) < kSquare;
    out.figure += square && (e.outward_W - (e.normal_1_W + e.normal_2_W).normalized()).norm() < kSquare ? 0.0 : 1.0;
  }
  const RandomStream draw(seed, "stress.shading");
  std::vector<std::uint32_t> found;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const Vector3d p(1600.0 * (draw.uniform(0, k) - 0.5), 1600.0 * (draw.uniform(1, k) - 0.5),
                     20.0 * draw.uniform(2, k));
    const double elevation = 0.05 + 1.2 * draw.uniform(3, k), detour_m = 0.5 * draw.uniform(4, k);
    index.shading(p, elevation, detour_m, found);
    const std::set<std::uint32_t> listed(found.begin(), found.end());
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      // Points along it: one that stands above the direction must be listed; none that is below it by twice the bend of
      // the farthest one.
      bool above = false, far_below = true;
      for (int s = 0; s <= 20; ++s) {
        const Vector3d q = all[i].a_W + s / 20.0 * (all[i].b_W - all[i].a_W) - p;
        const double distance = q.head<2>().norm(), angle = std::atan2(q.z(), distance);
        above = above || angle >= elevation;
        const double half = 0.5 * (all[i].b_W - all[i].a_W).norm();
        const double reach = worse(distance - 2.0 * half, 0.0);
        const double bend =
            std::sqrt(2.0 * detour_m * (q.norm() + 2.0 * half) / std::cos(elevation)) / std::cos(elevation);
        far_below = far_below && q.z() + 2.0 * half + 2.0 * bend < reach * std::tan(elevation);
      }
      if (above) out.figure += listed.count(i) == 1 ? 0.0 : 1.0;
      if (far_below) out.figure += listed.count(i) == 0 ? 0.0 : 1.0;
    }
  }
  SceneParts sheet = made::nothing();
  made::add_wall(sheet, {5, 0, 0}, 3.0);
  const auto one = made::scene_of(std::move(sheet));
  out.figure += one->edges().edges().size() == 4 ? 0.0 : 1.0;
  for (const Edge& e : one->edges().edges())
    out.figure += (e.normal_1_W + e.normal_2_W).norm() < 1e-12 &&
                          e.outward_W.dot(0.5 * (e.a_W + e.b_W) - Vector3d(5, 0, 0)) > 2.99
                      ? 0.0
                      : 1.0;
  return out;
}

/// Long roofs about places on the diagonal, each alone in its square of the ground: seen from beyond their ends, where
/// no other coordinate than that along them tells how far they reach. Every edge of which a point stands above the
/// direction is listed. A figure counts those that are not.
StressFigure long_roofs_on_the_diagonal() {
  StressFigure out;
  for (const bool along_x : {true, false}) {
    SceneParts parts = made::nothing();
    for (int k = -3; k <= 3; ++k) {
      MeshBuilder mesh(parts);
      mesh.begin_object("roof " + std::to_string(k), ObjectKind::kBuilding);
      const double at = 25.0 + 700.0 * k;
      mesh.box({at, at, 10.0}, Eigen::Matrix3d::Identity(), along_x ? Vector3d(220, 2, 1) : Vector3d(2, 220, 1),
               mesh.material("brick"));
    }
    const auto scene = made::scene_of(std::move(parts));
    const auto& all = scene->edges().edges();
    std::vector<std::uint32_t> found;
    int above = 0;
    for (int k = -3; k <= 3; ++k)
      for (const double beyond_m : {5.0, 20.0, 60.0})
        for (const double elevation : {0.05, 0.15, 0.4, 0.9}) {
          const double at = 25.0 + 700.0 * k, along = 220.0 + beyond_m;
          const Vector3d p(at + (along_x ? along : 0.5), at + (along_x ? 0.5 : along), 1.0);
          scene->edges().shading(p, elevation, 1e-3, found);
          const std::set<std::uint32_t> listed(found.begin(), found.end());
          for (std::uint32_t i = 0; i < all.size(); ++i) {
            bool stands_out = false;
            for (int s = 0; s <= 40; ++s) {
              const Vector3d q = all[i].a_W + s / 40.0 * (all[i].b_W - all[i].a_W) - p;
              stands_out = stands_out || std::atan2(q.z(), q.head<2>().norm()) >= elevation;
            }
            above += stands_out ? 1 : 0;
            if (stands_out) out.figure += listed.count(i) == 1 ? 0.0 : 1.0;
          }
        }
    out.figure += above > 40 ? 0.0 : 1.0;
  }
  return out;
}

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

/// Of any city: blocks and streets do not overlap, buildings stand beside the streets, on terrain, each under a
/// roof that covers its footprint (single precision at 150 m, 1e-5 of it) and within walls that face outwards. What of
/// metal stands on a roof has its middle where the building has it, and its proportions: single precision of 200 m,
/// twice, over sides of some 2 m.
StressFigure any_city(std::uint64_t seed) {
  CityConfig config;
  config.seed = static_cast<std::int64_t>(seed);
  config.extent_m = 400.0;
  config.terrain_cell_m = 8.0;
  const city::Plan plan = city::make_plan(config);
  Worst worst;
  for (const city::Block& block : plan.blocks) {
    worst.look(block.kerb.width() > 0.0 && block.kerb.depth() > 0.0 ? 0.0 : kInfinity, 1.0);
    for (const StreetGraph::Edge& street : plan.streets.edges) {
      const Eigen::Vector2d a = plan.streets.nodes_W[street.a], b = plan.streets.nodes_W[street.b];
      const Eigen::Vector2d low = a.cwiseMin(b).array() - 0.5 * street.width_m,
                            high = a.cwiseMax(b).array() + 0.5 * street.width_m;
      const double overlap_x = std::min(high.x(), block.kerb.x1) - worse(low.x(), block.kerb.x0),
                   overlap_y = std::min(high.y(), block.kerb.y1) - worse(low.y(), block.kerb.y0);
      worst.look(beyond(std::min(overlap_x, overlap_y), 0.0), 1e-9);
    }
  }
  double narrowest_m = kInfinity;
  for (const StreetGraph::Edge& street : plan.streets.edges) narrowest_m = std::min(narrowest_m, street.width_m);
  const Scene scene(make_city(config));
  worst.look(scene.buildings().size() > 20 ? 0.0 : kInfinity, 1.0);
  const Mesh& mesh = scene.mesh();
  std::vector<double> flow(scene.objects().size(), 0.0), area(scene.objects().size(), 0.0);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = Triangle::of(mesh, i);
    const Vector3d normal = 0.5 * (t.b - t.a).cross(t.c - t.a);
    flow[mesh.object[i]] += (t.a.x() + t.b.x() + t.c.x()) / 3.0 * normal.x();
    if (normal.z() > 0.0) area[mesh.object[i]] += normal.z();
  }
  std::vector<Eigen::AlignedBox2d> metal(scene.objects().size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (scene.materials()[mesh.material[i]].name != "metal") continue;
    for (const std::uint32_t v : mesh.triangles[i])
      metal[mesh.object[i]].extend(mesh.vertices[v].head<2>().cast<double>());
  }
  int on_roofs = 0;
  for (const Building& b : scene.buildings()) {
    if (!metal[b.object].isEmpty()) {
      Eigen::AlignedBox2d bounds;
      for (const Eigen::Vector2d& p : b.footprint_W) bounds.extend(p);
      const Eigen::Vector2d room = metal[b.object].sizes(), house = bounds.sizes();
      worst.look((metal[b.object].center() - bounds.center()).norm(), 4.0 * kHalfUlp * 400.0);
      worst.look(room.x() / house.x() - room.y() / house.y(),
                 8.0 * kHalfUlp * 400.0 / house.minCoeff<Eigen::PropagateNaN>());
      ++on_roofs;
    }
    double footprint = 0.0;
    for (std::size_t k = 0; k < b.footprint_W.size(); ++k) {
      const Eigen::Vector2d &p = b.footprint_W[k], &q = b.footprint_W[(k + 1) % b.footprint_W.size()];
      footprint += 0.5 * (p.x() * q.y() - q.x() * p.y());
      worst.look(scene.ground(p.x(), p.y()).has_value() ? 0.0 : kInfinity, 1.0);
      worst.look(plan.streets.distance_to(p) > 0.5 * narrowest_m ? 0.0 : kInfinity, 1.0);
    }
    worst.look(footprint > 0.0 && b.height_m > 2.0 ? 0.0 : kInfinity, 1.0);
    // What faces upwards covers the footprint, whatever else is on the roof.
    worst.look(area[b.object] > (1.0 - 1e-5) * footprint ? 0.0 : kInfinity, 1.0);
    // Walls face outwards: the flow of x through them is a volume.
    worst.look(flow[b.object] > 0.0 ? 0.0 : kInfinity, 1.0);
  }
  worst.look(on_roofs > 0 ? 0.0 : kInfinity, 1.0);
  worst.look(
      make_city(config).mesh.vertices == scene.parts().mesh.vertices || scene.dropped_triangles() > 0 ? 0.0 : kInfinity,
      1.0);
  return worst.figure();
}

/// Boxes that are whole, lack a face, have one turned round, are inside out, or have a triangle twice: counted as what
/// they are; areas by material; and from above each as high as it stands. A figure counts.
StressFigure soundness_of_boxes() {
  const auto box = [](SceneParts& parts, double x, const auto& change) {
    made::add_box(parts, {x, 0.0, 2.0}, {1.0, 2.0, 2.0});
    Mesh& mesh = parts.mesh;
    change(mesh, mesh.triangles.size() - 12);
  };
  const auto flip = [](std::array<std::uint32_t, 3>& t) { std::swap(t[1], t[2]); };
  SceneParts parts = made::nothing();
  made::add_square(parts, {0, 0, 0}, 64.0);
  box(parts, 0.0, [](Mesh&, std::size_t) {});
  box(parts, 10.0, [&](Mesh& mesh, std::size_t first) { flip(mesh.triangles[first + 11]); });
  box(parts, 20.0, [&](Mesh& mesh, std::size_t first) {
    for (std::size_t k = first; k < first + 12; ++k) flip(mesh.triangles[k]);
  });
  box(parts, 30.0, [](Mesh& mesh, std::size_t first) {
    mesh.triangles.push_back(mesh.triangles[first + 11]);
    mesh.material.push_back(mesh.material[first]);
    mesh.object.push_back(mesh.object[first]);
  });
  SceneParts sheet = made::nothing();
  made::add_wall(sheet, {5, 0, 10}, 3.0);
  const auto scene = made::scene_of(std::move(parts)), wall = made::scene_of(std::move(sheet));
  StressFigure out;
  const auto is = [&](double found, double expected) { out.figure += std::abs(found - expected) < 1e-9 ? 0.0 : 1.0; };
  const Soundness s = soundness(*scene), w = soundness(*wall);
  is(static_cast<double>(s.objects), 4.0), is(static_cast<double>(s.watertight), 3.0);
  is(static_cast<double>(s.flipped_edges), 3.0), is(static_cast<double>(s.inside_out), 1.0);
  is(static_cast<double>(s.open_edges), 0.0), is(static_cast<double>(s.crowded_edges), 3.0);
  is(static_cast<double>(s.repeated_triangles), 1.0), is(static_cast<double>(w.open_edges), 4.0);
  is(static_cast<double>(w.watertight), 0.0);
  double brick_m2 = 0.0, all_m2 = 0.0;
  for (const MaterialArea& area : material_areas(*scene)) {
    all_m2 += area.area_m2;
    if (area.name == "brick") brick_m2 = area.area_m2;
  }
  // Faces of 4 x 4, 2 x 4 and 2 x 4 m, twice each; half of one of them once more.
  const double box_m2 = 2.0 * (16.0 + 8.0 + 8.0), half = brick_m2 - 4.0 * box_m2;
  out.figure += std::abs(half - 8.0) < 1e-6 || std::abs(half - 4.0) < 1e-6 ? 0.0 : 1.0;
  is(all_m2, brick_m2 + 128.0 * 128.0);
  const Grid grid = heights_from_above(*scene, 0.5);
  double highest = 0.0;
  std::size_t high = 0;
  for (const double h : grid.values)
    if (h > 0.01) highest = worse(highest, h), ++high;
  out.figure += std::abs(highest - 4.0) < 1e-5 ? 0.0 : 1.0;
  // Four roofs of 2 x 4 m, in cells of 0.5 m whose middles lie in them or on their rim.
  out.figure += high >= 4 * 3 * 7 && high <= 4 * 5 * 9 ? 0.0 : 1.0;
  const SensorNeeds needs = sensor_needs(*scene);
  is(static_cast<double>(needs.facets), static_cast<double>(scene->facets().facets().size()));
  is(static_cast<double>(needs.edges), static_cast<double>(scene->edges().edges().size()));
  return out;
}

}  // namespace

std::vector<StressCase> index_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "facets near a place and facets that mirror there",
           "a cell, a block or a class of lean that is left out", "as trying all finds them", "wrong"});
  for (const std::uint64_t seed : {1U, 2U})
    rows.add("indices/facets_" + std::to_string(seed), [seed] { return facets(seed); });
  rows.of({StressGroup::kGeometry, "edges of solids, and those that shade a place",
           "an edge of two coplanar faces, a normal of another, a square of the ground left out",
           "twelve of a box, four of a sheet, and as trying all finds them", "wrong"});
  for (const std::uint64_t seed : {1U, 2U})
    rows.add("indices/edges_" + std::to_string(seed), [seed] { return edges(seed, 0.0); });
  rows.add("indices/edges_of_long_roofs", [] { return edges(4, 250.0); });
  rows.add("indices/edges_of_roofs_on_the_diagonal", long_roofs_on_the_diagonal);
  rows.of({StressGroup::kGeometry, "several files of a scene set down on Earth",
           "the extremes of one file for another's, the other side of the date line, a height of the wrong corner",
           "the middle of all corners at the median foot, and each corner where it is", "of the bound"});
  rows.add("indices/frame_of_metres",
           [] {
             return local_frame({0, 0, 0}, false);
           })
      .add("indices/frame_of_metres_far_away",
           [] {
             return local_frame({5e5, -4e6, 0}, false);
           })
      .add("indices/frame_of_metres_y_up",
           [] {
             return local_frame({3e4, 2e4, 0}, true);
           })
      .add("indices/triangles_in_metres_of_a_map",
           [] {
             return local_frame({5e5, -4e6, 0}, false, true);
           })
      .add("indices/triangles_in_metres_y_up", [] {
        return local_frame({3e4, 2e4, 0}, true, true);
      });
  for (const double lon_deg : {7.0, 179.996, -180.0})
    rows.add("indices/frame_of_degrees_from_" + stress::text(lon_deg), [lon_deg] { return mapped_frame(lon_deg); })
        .loose("corners come back through the frame with fewer roundings than a place on Earth may have");
  rows.of({StressGroup::kData, "surfaces that are not sound",
           "an edge counted once for each of its senses, a volume of the other sign",
           "each as what it is, areas and heights as built", "wrong"});
  rows.add("indices/soundness_of_boxes", soundness_of_boxes);
  rows.of({StressGroup::kGeometry, "a built-in city of any seed",
           "a house in a street, a wall inside out, a roof without a wall",
           "houses under whole roofs, within walls that face outwards, beside streets and on terrain", "of the bound"});
  for (const std::uint64_t seed : {1U, 2012U})
    rows.add("indices/city_" + std::to_string(seed), [seed] { return any_city(seed); });
  return rows.take();
}

}  // namespace canyon::scene
