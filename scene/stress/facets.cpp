// Mirrors and edges that a scene has, from its triangles alone, and the indices over them, against the definitions.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using stress::kHalfUlp;
using stress::kInfinity;
using stress::Looks;

using Corner = std::array<float, 3>;
Corner corner_of(const Mesh& mesh, std::uint32_t v) {
  const Eigen::Vector3f& p = mesh.vertices[v];
  return {p.x(), p.y(), p.z()};
}
std::pair<Corner, Corner> side_of(const Mesh& mesh, std::uint32_t triangle, std::size_t k) {
  Corner a = corner_of(mesh, mesh.triangles[triangle][k]), b = corner_of(mesh, mesh.triangles[triangle][(k + 1) % 3]);
  return a < b ? std::pair{a, b} : std::pair{b, a};
}

/// Sheets of squares that are bent a little from one to the next, some by less than a tenth of a degree and some by
/// more, some lifted out of the plane, of two materials, with gaps; terrain and trees among them. Corners are repeated.
SceneParts bent_sheets(std::uint64_t seed) {
  const RandomStream draws(seed, "stress.sheets");
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  const std::array<std::uint16_t, 2> materials{mesh.material("brick"), mesh.material("glass")};
  std::uint64_t n = 0;
  for (int sheet = 0; sheet < 40; ++sheet) {
    const auto s = static_cast<std::uint64_t>(sheet);
    mesh.begin_object("sheet " + std::to_string(sheet), sheet % 13 == 5   ? ObjectKind::kTree
                                                        : sheet % 13 == 9 ? ObjectKind::kTerrain
                                                                          : ObjectKind::kBuilding);
    const Pose at{so3_exp(2.0 * draws.normal3(s)), 300.0 * draws.normal3(s, 1)};
    double z[7][5];
    for (int i = 0; i < 7; ++i)
      for (int j = 0; j < 5; ++j) {
        const double kind = draws.uniform(0, ++n);
        z[i][j] = kind < 0.8 ? 0.0 : kind < 0.88 ? 0.002 : kind < 0.94 ? 0.02 : 0.5;
      }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 4; ++j) {
        if (draws.uniform(1, ++n) < 0.1) continue;
        const auto p = [&](int a, int b) { return at * Vector3d(4.0 * a, (sheet % 3 + 1.0) * b, z[a][b]); };
        mesh.quad(p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1), materials[draws.uniform(2, n) < 0.85 ? 0 : 1]);
      }
  }
  return parts;
}

/// A mirror is as many triangles of one object and material as hang together and lie within a tenth of a degree and a
/// centimetre of its largest: none of its neighbours is left out that fits and is in no larger one's; and all that is
/// said of it follows from them: area, plane, ball, heights, flatness, the smallest rectangle along their edges. Single
/// precision of a kilometre.
StressFigure mirrors_of_triangles(std::uint64_t seed) {
  Looks looks;
  const auto scene = made::scene_of(bent_sheets(seed));
  const Mesh& mesh = scene->mesh();
  const auto facets = merge_planar_facets(*scene, 1.0);
  const auto all = merge_planar_facets(*scene, 0.0);
  std::map<std::pair<Corner, Corner>, std::vector<std::uint32_t>> by_side;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) by_side[side_of(mesh, i, k)].push_back(i);
  std::vector<std::size_t> facet_of(mesh.triangles.size(), all.size());
  std::vector<double> largest(all.size(), 0.0);
  const auto area = [&](std::uint32_t i) { return 0.5 * Triangle::of(mesh, i).area_normal().norm(); };
  std::vector<std::uint32_t> seeds(all.size());
  for (std::size_t f = 0; f < all.size(); ++f)
    for (const std::uint32_t i : all[f].triangles) {
      looks.right(facet_of[i] == all.size());
      facet_of[i] = f;
      if (area(i) > largest[f]) largest[f] = area(i), seeds[f] = i;
    }
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const ObjectKind kind = scene->objects()[mesh.object[i]].kind;
    looks.right((facet_of[i] < all.size()) == (kind == ObjectKind::kBuilding));
  }
  std::size_t large = 0, several = 0;
  for (const Facet& f : all) large += f.area_m2 >= 1.0 ? 1 : 0;
  looks.right(large == facets.size() && large > 20);
  for (std::size_t k = 1; k < facets.size(); ++k)
    looks.right(facets[k - 1].object < facets[k].object ||
                (facets[k - 1].object == facets[k].object && facets[k - 1].triangles[0] < facets[k].triangles[0]));
  const double grain = 8.0 * kHalfUlp * 1000.0;
  for (std::size_t f = 0; f < all.size(); ++f) {
    const Facet& facet = all[f];
    several += facet.triangles.size() > 2 ? 1 : 0;
    const Triangle first = Triangle::of(mesh, seeds[f]);
    const Vector3d about = first.area_normal().normalized();
    // By how much a triangle does not fit, in units of what it may: above 1 it does not.
    const auto off = [&](std::uint32_t i) {
      if (mesh.material[i] != facet.material || mesh.object[i] != facet.object) return 1e9;
      const Triangle t = Triangle::of(mesh, i);
      double worst = std::acos(std::min(1.0, t.area_normal().normalized().dot(about))) / (0.1 * kDegree);
      for (const Vector3d& p : {t.a, t.b, t.c}) worst = worse(worst, std::abs(about.dot(p - first.a)) / 0.01);
      return worst;
    };
    // Of equally large ones either may be the one that it grows from: only where the first stands alone.
    double others = 0.0;
    for (const std::uint32_t i : facet.triangles)
      if (i != seeds[f]) others = worse(others, area(i));
    std::set<std::uint32_t> connected{facet.triangles[0]};
    std::vector<std::uint32_t> front{facet.triangles[0]};
    while (!front.empty()) {
      const std::uint32_t i = front.back();
      front.pop_back();
      for (std::size_t k = 0; k < 3; ++k)
        for (const std::uint32_t j : by_side[side_of(mesh, i, k)])
          if (facet_of[j] == f && connected.insert(j).second) front.push_back(j);
    }
    looks.right(connected.size() == facet.triangles.size());
    const bool told = others < largest[f] * (1.0 - 1e-4);
    for (const std::uint32_t i : facet.triangles) {
      looks.right(!told || off(i) < 1.0 + 1e-3);
      for (std::size_t k = 0; k < 3; ++k)
        for (const std::uint32_t j : by_side[side_of(mesh, i, k)])
          if (told && facet_of[j] != f && facet_of[j] < all.size() && largest[facet_of[j]] < largest[f] * (1.0 - 1e-4))
            looks.right(off(j) > 1.0 - 1e-3);
    }
    Vector3d normal = Vector3d::Zero(), weighted = Vector3d::Zero();
    Vector3d low(kInfinity, kInfinity, kInfinity), high = -low;
    double m2 = 0.0;
    for (const std::uint32_t i : facet.triangles) {
      const Triangle t = Triangle::of(mesh, i);
      normal += 0.5 * t.area_normal(), m2 += area(i), weighted += area(i) * (t.a + t.b + t.c) / 3.0;
      for (const Vector3d& p : {t.a, t.b, t.c}) low = low.cwiseMin(p), high = high.cwiseMax(p);
    }
    normal.normalize();
    looks.near(facet.area_m2, m2, 1e-12 * m2), looks.near((facet.normal_W - normal).norm(), 0.0, 1e-12);
    looks.near(facet.offset_m, normal.dot(weighted) / m2, 1e-10);
    looks.near((facet.center_W - 0.5 * (low + high)).norm(), 0.0, 1e-10);
    looks.near(facet.bottom_m, low.z(), 1e-12), looks.near(facet.top_m, high.z(), 1e-12);
    double radius = 0.0, flatness = 0.0, smallest = kInfinity;
    for (const std::uint32_t i : facet.triangles) {
      const Triangle t = Triangle::of(mesh, i);
      for (const Vector3d& p : {t.a, t.b, t.c}) {
        radius = worse(radius, (p - facet.center_W).norm());
        flatness = worse(flatness, std::abs(normal.dot(p) - facet.offset_m));
      }
    }
    looks.near(facet.radius_m, radius, 1e-10), looks.near(facet.flatness_m, flatness, 1e-9);
    for (std::size_t k = 0; k < 4 && k < facet.triangles.size(); ++k) {
      const Triangle t = Triangle::of(mesh, facet.triangles[k]);
      for (const Vector3d& e : {Vector3d(t.b - t.a), Vector3d(t.c - t.b), Vector3d(t.a - t.c)}) {
        const Vector3d v = normal.cross(e).normalized(), u = v.cross(normal);
        double u0 = kInfinity, u1 = -kInfinity, v0 = kInfinity, v1 = -kInfinity;
        for (const std::uint32_t i : facet.triangles) {
          const Triangle q = Triangle::of(mesh, i);
          for (const Vector3d& p : {q.a, q.b, q.c})
            u0 = std::min(u0, u.dot(p)), u1 = worse(u1, u.dot(p)), v0 = std::min(v0, v.dot(p)),
            v1 = worse(v1, v.dot(p));
        }
        smallest = std::min(smallest, (u1 - u0) * (v1 - v0));
      }
    }
    const auto& r = facet.rectangle_W;
    const Vector3d side = r[1] - r[0], up = r[3] - r[0];
    looks.near(side.cross(up).dot(normal), smallest, 1e-6 * (1.0 + smallest));
    looks.near((r[2] - r[1] - up).norm(), 0.0, 1e-9), looks.near(side.dot(up), 0.0, 1e-7 * (1.0 + smallest));
    for (const Vector3d& p : r) looks.near(normal.dot(p), facet.offset_m, 1e-9);
    const double filled = m2 / smallest;
    if (std::abs(filled - (1.0 - 1e-6)) > 1e-9) looks.right(facet.fills_rectangle == (filled >= 1.0 - 1e-6));
    // Every corner within the rectangle; and what is inside the facet is inside one of its triangles.
    const RandomStream draws(seed, "stress.inside");
    for (std::uint64_t k = 0; k < 12; ++k) {
      const auto at = 12 * static_cast<std::uint64_t>(f) + k;
      const Vector3d p = r[0] + draws.uniform(-0.1, 1.1, 0, at) * side + draws.uniform(-0.1, 1.1, 1, at) * up;
      double inside = -kInfinity;
      for (const std::uint32_t i : facet.triangles) {
        const Triangle t = Triangle::of(mesh, i);
        double least = kInfinity;
        for (const auto& [a, b] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)})
          least = std::min(least, normal.cross(b - a).normalized().dot(p - a));
        inside = worse(inside, least);
      }
      if (std::abs(inside) > 1e-8) looks.right(facet_contains(facet, *scene, p) == (inside > 0.0));
    }
    for (const std::uint32_t i : facet.triangles) {
      const Triangle t = Triangle::of(mesh, i);
      for (const Vector3d& p : {t.a, t.b, t.c}) {
        looks.right(side.dot(p - r[0]) > -grain * side.norm() && side.dot(p - r[1]) < grain * side.norm());
        looks.right(up.dot(p - r[0]) > -grain * up.norm() && up.dot(p - r[3]) < grain * up.norm());
      }
    }
  }
  looks.right(several > 5);
  return looks.figure();
}

/// Edges from the sides of triangles alone: where one ends alone, or where two meet convexly at more than 15 degrees,
/// at least so long; ends, both normals, what points outwards and both materials.
StressFigure edges_of_triangles(std::uint64_t seed, double least_m) {
  Looks looks;
  SceneParts parts = bent_sheets(seed);
  const RandomStream draws(seed, "stress.prisms");
  for (std::uint64_t k = 0; k < 25; ++k) {
    MeshBuilder mesh(parts);
    mesh.begin_object("prism " + std::to_string(k), ObjectKind::kBuilding);
    // Of so many sides: up to 20 of them are flatter than 15 degrees at none, 30 at all.
    const int sides = 3 + static_cast<int>(k);
    std::vector<Vector2d> outline;
    for (int i = 0; i < sides; ++i)
      outline.emplace_back(40.0 * static_cast<double>(k) + 6.0 * std::cos(2.0 * kPi * i / sides),
                           500.0 + 6.0 * std::sin(2.0 * kPi * i / sides));
    mesh.block(outline, 0.0, draws.uniform(1.0, 9.0, 0, k), mesh.material("brick"), mesh.material("metal"));
  }
  const auto scene = made::scene_of(std::move(parts));
  const Mesh& mesh = scene->mesh();
  struct Sides {
    std::vector<std::uint32_t> triangles;
    std::vector<Vector3d> third;
  };
  std::map<std::pair<std::uint32_t, std::pair<Corner, Corner>>, Sides> by_side;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const ObjectKind kind = scene->objects()[mesh.object[i]].kind;
    if (kind == ObjectKind::kTerrain || kind == ObjectKind::kTree) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      Sides& s = by_side[{mesh.object[i], side_of(mesh, i, k)}];
      s.triangles.push_back(i);
      s.third.push_back(mesh.vertices[mesh.triangles[i][(k + 2) % 3]].cast<double>());
    }
  }
  const auto point = [](const Corner& c) { return Vector3d(c[0], c[1], c[2]); };
  std::size_t expected = 0;
  const auto found = convex_edges(*scene, least_m);
  std::map<std::pair<Corner, Corner>, const Edge*> at;
  for (const Edge& e : found) {
    const Eigen::Vector3f p = e.a_W.cast<float>(), q = e.b_W.cast<float>();
    Corner a{p.x(), p.y(), p.z()}, b{q.x(), q.y(), q.z()};
    at[a < b ? std::pair{a, b} : std::pair{b, a}] = &e;
  }
  for (const auto& [key, s] : by_side) {
    const Vector3d a = point(key.second.first), b = point(key.second.second), along = (b - a).normalized();
    if ((b - a).norm() < least_m || s.triangles.size() > 2) continue;
    const Vector3d n1 = Triangle::of(mesh, s.triangles[0]).area_normal().normalized();
    const auto out_of = [&](const Vector3d& third) {
      const Vector3d in = third - a;
      return Vector3d(-(in - in.dot(along) * along).normalized());
    };
    const auto e = at.find(key.second);
    if (s.triangles.size() == 1) {
      ++expected;
      looks.right(e != at.end());
      if (e == at.end()) continue;
      looks.near((e->second->normal_1_W - n1).norm(), 0.0, 64.0 * stress::kEpsilon);
      looks.near((e->second->normal_2_W + n1).norm(), 0.0, 64.0 * stress::kEpsilon);
      looks.near((e->second->outward_W - out_of(s.third[0])).norm(), 0.0, 64.0 * stress::kEpsilon);
      looks.right(e->second->material_1 == mesh.material[s.triangles[0]] &&
                  e->second->material_2 == mesh.material[s.triangles[0]]);
      continue;
    }
    const Vector3d n2 = Triangle::of(mesh, s.triangles[1]).area_normal().normalized();
    const double bend = std::acos(std::min(1.0, n1.dot(n2))) / kDegree, beside = n1.dot(s.third[1] - a);
    if (std::abs(bend - 15.0) < 1e-3 || std::abs(beside) < 1e-9) {
      // A rounding decides.
      expected += e != at.end() ? 1 : 0;
      continue;
    }
    const bool is_edge = beside < 0.0 && bend > 15.0;
    looks.right((e != at.end()) == is_edge);
    if (!is_edge || e == at.end()) continue;
    ++expected;
    looks.near((e->second->normal_1_W - n1).norm(), 0.0, 64.0 * stress::kEpsilon);
    looks.near((e->second->normal_2_W - n2).norm(), 0.0, 64.0 * stress::kEpsilon);
    looks.near((e->second->outward_W - (n1 + n2).normalized()).norm(), 0.0, 64.0 * stress::kEpsilon);
    looks.right(e->second->material_1 == mesh.material[s.triangles[0]] &&
                e->second->material_2 == mesh.material[s.triangles[1]]);
  }
  looks.right(expected == found.size() && expected > 300);
  return looks.figure();
}

/// Boxes that stand and lean over five kilometres.
std::unique_ptr<Scene> leaning_boxes(std::uint64_t seed) {
  const RandomStream draws(seed, "stress.leaning");
  SceneParts parts = made::nothing();
  for (std::uint64_t k = 0; k < 160; ++k) {
    MeshBuilder mesh(parts);
    mesh.begin_object("box " + std::to_string(k), ObjectKind::kBuilding);
    const Eigen::Matrix3d axes = rotation_from({.yaw_rad = draws.uniform(-3, 3, 0, k),
                                                .pitch_rad = k % 2 == 0 ? draws.uniform(-1.5, 1.5, 1, k) : 0.0,
                                                .roll_rad = k % 4 == 0 ? draws.uniform(-0.5, 0.5, 2, k) : 0.0})
                                     .toRotationMatrix();
    const double wide = k % 3 == 0 ? 2600.0 : 300.0;
    mesh.box({draws.uniform(-wide, wide, 3, k), draws.uniform(-wide, wide, 4, k), draws.uniform(-10, 40, 5, k)}, axes,
             {draws.uniform(1, 15, 6, k), draws.uniform(1, 15, 7, k), draws.uniform(1, 30, 8, k)},
             mesh.material("brick"));
  }
  return made::scene_of(std::move(parts));
}

/// Waves that are mirrored in truth: of points of every facet, seen from its front, the wave that comes from there came
/// from the mirrored direction. Where that is as high as is asked for, within reach, the facet is listed, and once;
/// each listed one could, by its lean to a degree.
StressFigure mirrored_waves(std::uint64_t seed) {
  Looks looks;
  const auto scene = leaning_boxes(seed);
  const auto& index = scene->facets();
  const auto& all = index.facets();
  const RandomStream draws(seed, "stress.waves");
  std::vector<std::uint32_t> found;
  int mirrored = 0, left_out = 0;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const double wide = k % 3 == 0 ? 2600.0 : 250.0;
    const Vector3d p(draws.uniform(-wide, wide, 0, k), draws.uniform(-wide, wide, 1, k), draws.uniform(-5, 60, 2, k));
    const double elevation = k % 10 == 9 ? 0.0 : draws.uniform(0.02, 1.55, 3, k);
    const double reach = k % 2 == 0 ? kInfinity : draws.uniform(0.2, 4.0, 4, k),
                 leaning = draws.uniform(10.0, 900.0, 5, k);
    index.mirrors(p, elevation, reach, leaning, found);
    std::set<std::uint32_t> listed(found.begin(), found.end());
    looks.right(listed.size() == found.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      const Facet& f = all[i];
      const auto& r = f.rectangle_W;
      const double own = worse((f.center_W - p).head<2>().norm() - f.radius_m, 0.0);
      const bool back = f.normal_W.z() > 1.1e-3;
      bool mirrors = false;
      for (int u = 0; u <= 4; ++u)
        for (int v = 0; v <= 4; ++v) {
          const Vector3d q = r[0] + 0.25 * u * (r[1] - r[0]) + 0.25 * v * (r[3] - r[0]);
          const Vector3d to = (q - p).normalized();
          if (f.normal_W.dot(p - q) < 1e-6) continue;
          const Vector3d from = to - 2.0 * to.dot(f.normal_W) * f.normal_W;
          mirrors = mirrors || std::asin(std::clamp(from.z(), -1.0, 1.0)) > elevation + 1e-6;
        }
      if (mirrors && own <= reach * f.area_m2 * (1.0 - 1e-6) && (!back || own <= leaning - 1e-3)) {
        looks.right(listed.count(i) == 1);
        ++mirrored;
      }
      if (listed.count(i) == 0) {
        ++left_out;
        continue;
      }
      looks.right(own <= reach * f.area_m2 * (1.0 + 1e-6) + 1e-3);
      // From between elevation - 2 t and 180 deg - elevation - 2 t, by whole degrees of t; of what faces down from no
      // lower than the elevation, and of what faces nearly straight down only from low.
      const double t = std::asin(std::clamp(f.normal_W.z(), -1.0, 1.0)), degree = 1.001 * kDegree;
      const double lowest = elevation - (t > 0.0 ? 2.0 * t + 2.0 * degree : 0.0) - 2.1e-3;
      const double highest = kPi - elevation - (t > 0.0 ? 2.0 * t - 2.0 * degree : 0.0);
      if (lowest > 0.0) looks.right(f.top_m - p.z() + 0.01 >= own * std::tan(std::min(lowest, 1.5705)));
      if (highest < 0.0) looks.right(f.bottom_m - p.z() - 0.01 <= -own * std::tan(std::min(-highest, 1.5705)));
      if (t < -85.1 * kDegree) looks.right(elevation < 5.1 * kDegree);
    }
  }
  looks.right(mirrored > 300 && left_out > 10000);
  return looks.figure();
}

/// Edges that shade a place, by what the index says of each: within the bend of the detour at its nearest; none else.
StressFigure shading_edges(std::uint64_t seed) {
  Looks looks;
  const auto scene = leaning_boxes(seed);
  const auto& index = scene->edges();
  const auto& all = index.edges();
  const RandomStream draws(seed, "stress.shade");
  std::vector<EdgeIndex::Outline> outlines;
  std::vector<std::uint32_t> found;
  int listed_ones = 0;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const double wide = k % 3 == 0 ? 2600.0 : 250.0;
    const Vector3d p(draws.uniform(-wide, wide, 0, k), draws.uniform(-wide, wide, 1, k), draws.uniform(-5, 60, 2, k));
    const double elevation = k % 9 == 8 ? 0.0 : draws.uniform(0.02, 1.5, 3, k), detour = draws.uniform(0.0, 0.4, 4, k);
    index.shading(p, elevation, detour, found);
    index.shading(p, elevation, detour, outlines);
    looks.right(found.size() == outlines.size());
    std::set<std::uint32_t> listed;
    for (std::size_t i = 0; i < found.size() && i < outlines.size(); ++i) {
      const Edge& e = all[found[i]];
      looks.right(outlines[i].edge == found[i] && listed.insert(found[i]).second);
      looks.near((outlines[i].middle_W - 0.5 * (e.a_W + e.b_W)).norm(), 0.0, 1e-10);
      looks.near(outlines[i].half_m, 0.5 * (e.b_W - e.a_W).norm(), 1e-10);
    }
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      const Edge& e = all[i];
      const Vector3d middle = 0.5 * (e.a_W + e.b_W);
      const double top = worse(e.a_W.z(), e.b_W.z()) - p.z();
      const double way = (middle - p).head<2>().norm() - 0.5 * (e.b_W - e.a_W).head<2>().norm();
      const double away = way > 0.0 ? way : 0.0;
      const double bend = std::sqrt(2.0 * detour * (away / std::cos(elevation) + std::abs(top)));
      const double over = top + bend / std::cos(elevation) - away * std::tan(elevation);
      if (std::abs(over) > 1e-7) looks.right((listed.count(i) == 1) == (over > 0.0));
    }
    listed_ones += static_cast<int>(found.size());
  }
  looks.right(listed_ones > 2000);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> facet_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "mirrors and edges, from triangles alone",
           "a neighbour across the wrong side, an angle or a height of another limit, a rectangle of one of its axes",
           "what their definitions say of every triangle and side: single precision", "of the bound"});
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    rows.add("facets/mirrors_of_triangles_" + std::to_string(seed), [seed] { return mirrors_of_triangles(seed); });
    rows.add("facets/edges_of_triangles_" + std::to_string(seed),
             [seed] { return edges_of_triangles(seed, 0.5 * static_cast<double>(seed)); });
  }
  rows.of({StressGroup::kGeometry, "mirrors and edges that matter at a place, of five kilometres of leaning boxes",
           "a square that reaches less far than what is in it, a lean of the other sign, rows that end too soon",
           "waves mirrored in truth, and the index's own words for every edge", "wrong"});
  for (const std::uint64_t seed : {1U, 2U}) {
    rows.add("facets/mirrored_waves_" + std::to_string(seed), [seed] { return mirrored_waves(seed); });
    rows.add("facets/shading_edges_" + std::to_string(seed), [seed] { return shading_edges(seed); });
  }
  return rows.take();
}

}  // namespace canyon::scene
