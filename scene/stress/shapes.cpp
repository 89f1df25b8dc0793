// What scenes are made of: triangles and their nearest points, crowns, materials, streets as a graph, and the built-in
// city's things, each in the measures that it is said to have.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/city/plan.h"
#include "canyon/scene/city/street_graph.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"
#include "canyon/scene/surfaces/foliage_index.h"
#include "canyon/scene/surfaces/material.h"
#include "canyon/scene/surfaces/tree.h"
#include "canyon/scene/surfaces/triangle.h"
#include "canyon/scene/tracing/nearest_surfaces.h"

namespace canyon::scene {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

const RandomStream kShapes(21, "stress.shapes");
double any(double low, double high, std::uint32_t what, int k) {
  return kShapes.uniform(low, high, what, static_cast<std::uint64_t>(k));
}
Vector3d anywhere(double half_m, std::uint32_t what, int k) {
  return {any(-half_m, half_m, what, k), any(-half_m, half_m, what + 1, k), any(-half_m, half_m, what + 2, k)};
}

/// A point q of a triangle is the nearest to p just where no corner lies on p's side of the plane through q across
/// p - q; and it is a mean of the corners with weights that are none below nothing. 64 eps of the square of 20 m.
StressFigure nearest_points() {
  Looks looks;
  for (int k = 0; k < 3000; ++k) {
    const Triangle t{anywhere(5.0, 0, k), anywhere(5.0, 3, k), anywhere(k % 5 == 0 ? 0.5 : 5.0, 6, k)};
    const Vector3d p = anywhere(10.0, 9, k), q = t.closest_point(p);
    for (const Vector3d& corner : {t.a, t.b, t.c}) {
      const double over = (p - q).dot(corner - q);
      looks.near(over > 0.0 ? over : 0.0, 0.0, 64.0 * kEpsilon * 400.0);
    }
    const Vector3d n = t.area_normal();
    looks.near(n.dot(q - t.a) / n.norm(), 0.0, 64.0 * kEpsilon * 20.0 * (25.0 / n.norm() + 1.0));
    for (const auto& [u, v] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)}) {
      const double side = n.dot((v - u).cross(q - u)) / n.squaredNorm();
      looks.near(side < 0.0 ? side : 0.0, 0.0, 64.0 * kEpsilon * (400.0 / n.norm() + 1.0));
    }
    looks.right(t.usable());
  }
  Triangle thin{{0, 0, 0}, {10, 0, 0}, {5, 0.9e-6, 0}};
  looks.right(!thin.usable());
  thin.c.y() = 1.2e-6;
  looks.right(thin.usable());
  return looks.figure();
}

/// Of many points at once the nearest surface of a crowd of boxes, against every triangle; single precision of 60 m.
StressFigure nearest_of_all() {
  Looks looks;
  SceneParts parts = made::nothing();
  made::add_square(parts, {0, 0, 0}, 40.0);
  for (int k = 0; k < 25; ++k)
    made::add_box(parts, {any(-30, 30, 0, k), any(-30, 30, 1, k), any(0, 6, 2, k)},
                  {any(0.2, 3, 3, k), any(0.2, 3, 4, k), any(0.2, 3, 5, k)});
  const auto scene = made::scene_of(std::move(parts));
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < 600; ++k)
    points.push_back((Vector3d(any(-50, 50, 6, k), any(-50, 50, 7, k), any(-2, 12, 8, k))).cast<float>());
  const auto found = nearest_surfaces(*scene, points, 4.0);
  const Mesh& mesh = scene->mesh();
  for (std::size_t k = 0; k < points.size(); ++k) {
    double nearest = kInfinity;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
      nearest = std::min(
          nearest, (Triangle::of(mesh, i).closest_point(points[k].cast<double>()) - points[k].cast<double>()).norm());
    const double grain = 16.0 * stress::kHalfUlp * 60.0;
    if (std::abs(nearest - 4.0) < grain) continue;
    const bool near = found[k].triangle != Hit::kMiss;
    looks.right(near == (nearest < 4.0));
    if (!near) continue;
    const Vector3d q = Triangle::of(mesh, found[k].triangle).closest_point(points[k].cast<double>());
    looks.near((q - points[k].cast<double>()).norm(), nearest, grain);
  }
  return looks.figure();
}

/// Chords through ellipsoids of leaves in closed form, as far as the ray goes, times their density; crowns one by one.
StressFigure chords(int count) {
  Looks looks;
  std::vector<Foliage> crowns;
  for (int k = 0; k < count; ++k) {
    Foliage f;
    f.center_W = {any(-60, 60, 0, k), any(-60, 60, 1, k), any(3, 8, 2, k)};
    f.radii_m = {any(0.5, 4, 3, k), any(0.5, 4, 4, k), any(0.5, 4, 5, k)};
    f.leaf_density_m2_m3 = any(0.2, 3, 6, k);
    crowns.push_back(f);
  }
  const FoliageIndex index(crowns);
  for (int k = 0; k < 400; ++k) {
    const Vector3d p(any(-80, 80, 7, k), any(-80, 80, 8, k), any(0, 10, 9, k));
    const double e = any(-0.3, 1.2, 10, k), a = any(-kPi, kPi, 11, k);
    const Vector3d d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    const double most = k % 3 == 0 ? 30.0 : 1000.0;
    double sum = 0.0;
    std::vector<CrownPassage> expected, found;
    for (std::uint32_t c = 0; c < crowns.size(); ++c) {
      const Vector3d o = (p - crowns[c].center_W).cwiseQuotient(crowns[c].radii_m),
                     u = d.cwiseQuotient(crowns[c].radii_m);
      const double A = u.dot(u), B = u.dot(o), C = o.dot(o) - 1.0, root = B * B - A * C;
      if (root <= 0.0) continue;
      const double enter = (-B - std::sqrt(root)) / A, leave = (-B + std::sqrt(root)) / A;
      const double from = enter > 0.0 ? enter : 0.0, to = leave < most ? leave : most;
      if (to <= from) continue;
      expected.push_back({from, to, crowns[c].leaf_density_m2_m3, c});
      sum += (to - from) * crowns[c].leaf_density_m2_m3;
    }
    // A grazing chord is known to the root of what its square is.
    looks.near(index.chords_m(p, d, most), sum, 1e-6);
    index.passages(p, d, most, found);
    std::erase_if(found, [](const CrownPassage& c) { return c.leave_m - c.enter_m < 1e-3; });
    std::erase_if(expected, [](const CrownPassage& c) { return c.leave_m - c.enter_m < 1e-3; });
    looks.right(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size() && i < expected.size(); ++i) {
      looks.right(found[i].crown == expected[i].crown);
      looks.near(found[i].enter_m, expected[i].enter_m, 1e-8);
      looks.near(found[i].leave_m, expected[i].leave_m, 1e-8);
      looks.near(found[i].leaf_density_m2_m3, expected[i].leaf_density_m2_m3, 1e-15);
    }
  }
  return looks.figure();
}

/// Permittivity by ITU's four numbers; reflectance between three wavelengths, and no light from nowhere.
StressFigure materials() {
  Looks looks;
  looks.right(builtin_materials().size() > 8);
  for (const Material& m : builtin_materials()) {
    for (const double ghz : {1.15, 1.57542, 2.0}) {
      const auto found = m.permittivity(ghz * 1e9);
      const double sigma = m.itu_c > 0.0 ? m.itu_c * std::exp(m.itu_d * std::log(ghz)) : 0.0;
      looks.near(found.real(), m.itu_a * std::exp(m.itu_b * std::log(ghz)), 1e-12 * m.itu_a);
      looks.near(found.imag(), -17.98 * sigma / ghz, 1e-12 * (1.0 + sigma * 20.0));
    }
    const double a = m.lidar_reflectance_850.value_or(m.lidar_reflectance), b = m.lidar_reflectance,
                 c = m.lidar_reflectance_1550.value_or(m.lidar_reflectance);
    for (const auto& [nm, expected] :
         {std::pair(600.0, a), std::pair(850.0, a), std::pair(877.5, 0.5 * (a + b)), std::pair(905.0, b),
          std::pair(1227.5, 0.5 * (b + c)), std::pair(1550.0, c), std::pair(2000.0, c)})
      looks.near(m.reflectance(nm), expected, 1e-14);
  }
  return looks.figure();
}

/// A tree: a trunk of six sides, 48 clumps within the crown, each as large as is said; single precision of 100 m.
StressFigure tree() {
  Looks looks;
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  mesh.begin_object("tree", ObjectKind::kTree);
  const Vector3d foot(30.0, -20.0, 4.0), radii(2.0, 2.0, 1.6);
  add_tree(foot, {5.0, radii}, RandomStream(3, "stress.leaves"), 7, mesh, parts);
  looks.right(parts.foliage.size() == 1 && (parts.foliage[0].center_W - Vector3d(30.0, -20.0, 9.0)).norm() < 1e-12 &&
              parts.foliage[0].radii_m == radii);
  const double grain = 8.0 * stress::kHalfUlp * 30.0, size = 0.6;
  int leaves = 0;
  double trunk_m2 = 0.0;
  Vector3d mean = Vector3d::Zero(), square = Vector3d::Zero();
  for (std::uint32_t i = 0; i < parts.mesh.triangles.size(); ++i) {
    const Triangle t = Triangle::of(parts.mesh, i);
    const Vector3d middle = (t.a + t.b + t.c) / 3.0;
    if (parts.materials[parts.mesh.material[i]].name == "foliage") {
      ++leaves;
      const Vector3d in = (middle - parts.foliage[0].center_W).cwiseQuotient(radii);
      looks.right(in.norm() <= 0.85 + 1e-4);
      mean += in / 48.0, square += in.cwiseAbs2() / 48.0;
      for (const Vector3d& corner : {t.a, t.b, t.c}) looks.near((corner - middle).norm(), size, 1e-4 * size + grain);
      for (const auto& [u, v] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)})
        looks.near((u - v).norm(), size * std::sqrt(3.0), 1e-4 * size + 2.0 * grain);
      continue;
    }
    trunk_m2 += 0.5 * t.area_normal().norm();
    for (const Vector3d& corner : {t.a, t.b, t.c}) {
      looks.near((corner - foot).head<2>().norm(), 0.08 * 2.0, 1e-4 * 0.16 + grain);
      looks.right(std::abs(corner.z() - 3.7) < grain || std::abs(corner.z() - 9.0) < grain);
    }
  }
  looks.right(leaves == 48);
  looks.near(trunk_m2, 6.0 * 0.16 * 5.3, 1e-3);
  // Uniform in a ball of 0.85: mean square 0.85^2 / 5 per axis, of 48; 5 deviations, of a square's sqrt(12 / 175).
  for (int a = 0; a < 3; ++a) {
    looks.near(mean[a], 0.0, 5.0 * 0.85 * std::sqrt(0.2 / 48.0));
    looks.near(square[a] / (0.7225 / 5.0), 1.0, 5.0 * std::sqrt(8.0 / 7.0 / 48.0));
  }
  return looks.figure();
}

/// Ways over a graph of streets against all pairs (Floyd and Warshall), from feet on the nearest street.
StressFigure ways_over_streets() {
  Looks looks;
  StreetGraph graph;
  for (int k = 0; k < 24; ++k) graph.nodes_W.emplace_back(any(-200, 200, 0, k), any(-200, 200, 1, k));
  for (std::uint32_t k = 1; k < 22; ++k)
    graph.edges.push_back({k, static_cast<std::uint32_t>(any(0, k, 2, static_cast<int>(k))), 10.0});
  for (int k = 0; k < 12; ++k)
    graph.edges.push_back(
        {static_cast<std::uint32_t>(any(0, 21.9, 3, k)), static_cast<std::uint32_t>(any(0, 21.9, 4, k)), 8.0});
  graph.edges.push_back({22, 23, 8.0});  // an island
  std::erase_if(graph.edges, [](const auto& e) { return e.a == e.b; });
  std::vector<std::vector<double>> d(24, std::vector<double>(24, kInfinity));
  for (std::size_t i = 0; i < 24; ++i) d[i][i] = 0.0;
  for (const auto& e : graph.edges) d[e.a][e.b] = d[e.b][e.a] = (graph.nodes_W[e.a] - graph.nodes_W[e.b]).norm();
  for (std::size_t k = 0; k < 24; ++k)
    for (std::size_t i = 0; i < 24; ++i)
      for (std::size_t j = 0; j < 24; ++j) d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
  struct Foot {
    std::size_t edge = 0;
    Vector2d at{0, 0};
    double off = kInfinity;
  };
  const auto foot = [&](const Vector2d& p) {
    Foot best;
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      const Vector2d a = graph.nodes_W[graph.edges[e].a], b = graph.nodes_W[graph.edges[e].b];
      const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      const Vector2d q = a + s * (b - a);
      if ((q - p).norm() < best.off) best = {e, q, (q - p).norm()};
    }
    return best;
  };
  int none = 0;
  for (int k = 0; k < 300; ++k) {
    const Vector2d from(any(-200, 200, 5, k), any(-200, 200, 6, k)), to(any(-200, 200, 7, k), any(-200, 200, 8, k));
    const Foot f = foot(from), t = foot(to);
    looks.near(graph.distance_to(from), f.off, 1e-11);
    double best = f.edge == t.edge ? (f.at - t.at).norm() : kInfinity;
    for (const std::uint32_t a : {graph.edges[f.edge].a, graph.edges[f.edge].b})
      for (const std::uint32_t b : {graph.edges[t.edge].a, graph.edges[t.edge].b})
        best = std::min(best, (f.at - graph.nodes_W[a]).norm() + d[a][b] + (t.at - graph.nodes_W[b]).norm());
    const auto way = graph.route(from, to);
    if (best == kInfinity) {
      looks.right(way.empty());
      ++none;
      continue;
    }
    if (way.size() < 2) continue;
    double length = 0.0;
    for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
    looks.near(length, best, 1e-10);
    looks.near((way.front() - f.at).norm(), 0.0, 1e-10), looks.near((way.back() - t.at).norm(), 0.0, 1e-10);
  }
  looks.right(none > 0);
  return looks.figure();
}

/// The plan and the things of a level city, in the measures that its parts have; single precision of 250 m.
StressFigure city_things(std::uint64_t seed) {
  Looks looks;
  CityConfig config;
  config.seed = static_cast<std::int64_t>(seed);
  config.extent_m = 500.0, config.slope_percent = config.hill_height_m = 0.0;
  config.terrain_cell_m = 10.0;
  const city::Plan plan = city::make_plan(config);
  // Streets from rim to rim, 30 m from the edges; blocks between them.
  double low = kInfinity, high = -kInfinity;
  for (const Vector2d& n : plan.streets.nodes_W)
    for (const double v : {n.x(), n.y()}) low = std::min(low, v), high = worse(high, v);
  looks.near(low, -220.0, 1e-9), looks.near(high, 220.0, 1e-9);
  looks.near(plan.quarter.width(), 150.0, 1e-9), looks.near(plan.quarter.depth(), 150.0, 1e-9);
  looks.near(std::abs(plan.quarter.center().x()), 85.0, 1e-9),
      looks.near(std::abs(plan.quarter.center().y()), 85.0, 1e-9);
  looks.right(plan.blocks.size() == 25);
  double widths = 0.0;
  for (std::size_t k = 0; k < plan.blocks.size(); ++k) {
    const auto& block = plan.blocks[k];
    if (k < 5) widths += block.kerb.width();
    // Sides of 0.8 to 1.2 of the mean at least and at most 1.5 times one another, less a street.
    looks.right(block.kerb.width() > 440.0 / 5.0 / 1.5 - 12.0 && block.kerb.width() < 440.0 / 5.0 * 1.5 - 12.0);
    const Vector2d off = (block.kerb.center() - plan.quarter.center()).cwiseAbs() / 75.0;
    const double far = worse(off.x(), off.y());
    looks.right((block.zone == city::Zone::kTall) == (far < 1.0));
    if (block.zone == city::Zone::kMiddle) looks.right(far < 2.4);
    if (block.zone == city::Zone::kLow) looks.right(far >= 1.8);
    looks.right(plan.zone_near(block.kerb.center()) == block.zone);
    looks.right(plan.zone_near({block.kerb.x0 - 1.0, block.kerb.center().y()}) == block.zone);
  }
  looks.near(widths, 440.0 - 5.0 * 12.0, 1e-9);
  const auto scene = made::scene_of(make_city(config));
  const Mesh& mesh = scene->mesh();
  std::map<std::uint32_t, std::pair<Vector3d, Vector3d>> boxes;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = Triangle::of(mesh, i);
    auto& [from, to] =
        boxes.try_emplace(mesh.object[i], Vector3d::Constant(1e9), Vector3d::Constant(-1e9)).first->second;
    for (const Vector3d& p : {t.a, t.b, t.c}) from = from.cwiseMin(p), to = to.cwiseMax(p);
  }
  const double ground = scene->ground(0.0, 0.0)->height_m, grain = 8.0 * stress::kHalfUlp * 300.0;
  std::map<std::string, int> kinds;
  const auto street_m = [&](const Vector2d& p) { return plan.streets.distance_to(p); };
  for (const auto& [object, box] : boxes) {
    const std::string name = scene->objects()[object].name.substr(0, scene->objects()[object].name.find(' '));
    ++kinds[name];
    const Vector3d size = box.second - box.first, middle = 0.5 * (box.first + box.second);
    if (name == "pole") {
      looks.near(size.x(), 0.14, grain), looks.near(size.y(), 0.14, grain), looks.near(size.z(), 8.3, grain);
      looks.near(box.second.z(), ground + 8.0, grain);
      looks.near(street_m(middle.head<2>()), 6.6, grain);
    } else if (name == "vehicle") {
      const bool along_x = size.x() > size.y();
      looks.near(along_x ? size.x() : size.y(), 4.5, grain), looks.near(along_x ? size.y() : size.x(), 1.8, grain);
      looks.near(box.first.z(), ground + 0.2, grain), looks.near(box.second.z(), ground + 1.5, grain);
      const double off = street_m(middle.head<2>());
      looks.right(off > 6.0 - 0.9 - 0.17 && off < 6.0 - 0.9 - 0.07);
    } else if (name == "wall") {
      looks.near(std::min(size.x(), size.y()), 0.24, grain);
      looks.right(box.second.z() - ground > 0.89 && box.second.z() - ground < 1.81);
      looks.near(box.first.z(), ground - 0.4, grain);
      // Beside a street, or where one has been left out farther from the next.
      const double off = street_m(middle.head<2>());
      looks.right(off > 9.299 && (off < 9.301 || off > 12.0));
    } else if (name == "tree") {
      const Foliage& crown =
          scene->foliage().at(static_cast<std::size_t>(std::stoi(scene->objects()[object].name.substr(5)) - 1));
      const double up = crown.center_W.z() - ground;
      const bool street = crown.radii_m.x() < 1.75;
      looks.right(street ? up > 4.89 && up < 5.61 : up > 5.49 && up < 7.01);
      looks.right(street ? crown.radii_m.x() >= 1.3 && crown.radii_m.z() >= 1.6 && crown.radii_m.z() <= 2.0
                         : crown.radii_m.x() >= 1.8 && crown.radii_m.x() <= 3.5 && crown.radii_m.z() >= 2.0 &&
                               crown.radii_m.z() <= 3.2);
      if (street) looks.near(street_m(crown.center_W.head<2>()), 7.3, 1e-3);
    }
  }
  looks.right(kinds["pole"] > 50 && kinds["vehicle"] > 20 && kinds["wall"] > 0 && kinds["tree"] > 40);
  for (const Building& b : scene->buildings()) {
    Vector2d middle = Vector2d::Zero(), from = b.footprint_W[0], to = from;
    for (const Vector2d& p : b.footprint_W) from = from.cwiseMin(p), to = to.cwiseMax(p);
    middle = 0.5 * (from + to);
    const city::Zone zone = plan.zone_near(middle);
    looks.near(b.base_m, ground, grain);
    looks.right(zone == city::Zone::kTall     ? b.height_m >= 25.0 - grain && b.height_m <= 80.0 + grain
                : zone == city::Zone::kMiddle ? b.height_m >= 10.0 - grain && b.height_m <= 22.0 + grain
                                              : b.height_m >= 4.0 - grain && b.height_m <= 9.0 + grain);
    looks.right(std::min((to - from).x(), (to - from).y()) >= 6.0 - 1e-9);
    const auto& box = boxes.at(b.object);
    looks.near(box.first.z(), ground - 0.5, grain);
    // A machine room of 3 m on high roofs.
    const double over = box.second.z() - ground - b.height_m;
    looks.right(std::abs(over) < grain || (zone == city::Zone::kTall && std::abs(over - 3.0) < grain));
    const double setback = street_m(middle) - 0.5 * std::min((to - from).x(), (to - from).y());
    looks.right(setback > 6.0 + 3.0 - 1e-6);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> shape_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "nearest points, chords and shapes of what a scene is made of",
           .why = "a region of a triangle with another's formula, a radius for a diameter, a crown of another row",
           .expected = "conditions of the nearest, closed forms, and all tried in turn: roundings",
           .unit = "of the bound",
           .loose = "some bounds are those of grazing rays and of the thinnest triangles"});
  rows.add("shapes/nearest_points_of_triangles", nearest_points)
      .add("shapes/nearest_of_all_surfaces", nearest_of_all)
      .add("shapes/materials", materials)
      .add("shapes/tree", tree);
  for (const int count : {1, 30, 400})
    rows.add("shapes/chords_of_" + std::to_string(count) + "_crowns", [count] { return chords(count); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "streets as a graph, and what stands along them",
           .why = "a way over the other end of a street, a thing of another size, on the road, or of another zone",
           .expected = "all pairs of nodes; measures as they are said: single precision of coordinates",
           .unit = "of the bound"});
  rows.add("shapes/ways_over_streets", ways_over_streets);
  for (const std::uint64_t seed : {3U, 5U})
    rows.add("shapes/things_of_city_" + std::to_string(seed), [seed] { return city_things(seed); });
  return rows.take();
}

}  // namespace canyon::scene
