// Triangles, polygons and facets that are hardly any, and what is nearest to a point.
#include <cmath>
#include <cstdio>
#include <limits>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"
#include "canyon/scene/surfaces/edge.h"
#include "canyon/scene/surfaces/triangulate.h"

namespace canyon::scene {
namespace {

using stress::kEpsilon;
constexpr float kNoEnd = std::numeric_limits<float>::infinity();

/// Points, needles, lines, what is not finite: dropped, and counted, and the one good triangle is left, whose range is
/// its own. A figure counts what differs.
StressFigure degenerate(float at_m) {
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  const std::uint32_t object = mesh.begin_object("odd", ObjectKind::kOther);
  const float bad = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Eigen::Vector3f a(at_m, at_m, 8.0f);
  const auto add = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& q, const Eigen::Vector3f& r) {
    const auto first = static_cast<std::uint32_t>(parts.mesh.vertices.size());
    parts.mesh.vertices.insert(parts.mesh.vertices.end(), {p, q, r});
    parts.mesh.triangles.push_back({first, first + 1, first + 2});
    parts.mesh.material.push_back(0);
    parts.mesh.object.push_back(object);
  };
  const Eigen::Vector3f x(16.0f, 0.0f, 0.0f), y(0.0f, 16.0f, 0.0f);
  add(a, a, a);
  add(a, a + x, a);
  add(a, a + x, a + 2.0f * x);
  add(a, a + x, a + y + Eigen::Vector3f(bad, 0.0f, 0.0f));
  add(a, a + x, a + Eigen::Vector3f(0.0f, inf, 0.0f));
  add(a, a + x, a + Eigen::Vector3f(0.0f, 1e30f, 0.0f));
  add(Eigen::Vector3f::Zero(), 4096.0f * x, 2048.0f * x + Eigen::Vector3f(0.0f, 1e-7f, 0.0f));
  add(a - x - y, a + x - y, a + y);
  const auto scene = made::scene_of(std::move(parts));
  StressFigure out;
  out.figure += scene->dropped_triangles() == 7 && scene->mesh().triangles.size() == 1 ? 0.0 : 1.0;
  const Hit hit =
      SceneAt(*scene).trace({a.cast<double>() + Eigen::Vector3d(0.0, 0.0, 4.0), {0.0f, 0.0f, -1.0f}, kNoEnd});
  out.figure += hit.hit() && hit.range_m == 4.0f ? 0.0 : 1.0;
  out.figure += scene->extent().min.allFinite() && scene->extent().max.allFinite() ? 0.0 : 1.0;
  return out;
}

/// A scene of nothing and one of nothing that can be met answer every question with nothing.
StressFigure nothing_at_all() {
  StressFigure out;
  for (const bool needle : {false, true}) {
    SceneParts parts = made::nothing();
    if (needle)
      MeshBuilder(parts).triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0},
                                  (MeshBuilder(parts).begin_object("n", ObjectKind::kTerrain), 0));
    const auto scene = made::scene_of(std::move(parts));
    const SceneAt now(*scene);
    out.figure += now.trace({Eigen::Vector3d::Zero(), Eigen::Vector3f::UnitX(), kNoEnd}).hit() ? 1.0 : 0.0;
    out.figure += now.blocked({0, 0, 0}, {1e6, 0, 0}) || now.blocked_towards({0, 0, 0}, {0, 0, -1}) ? 1.0 : 0.0;
    out.figure += now.nearest({0, 0, 0}, 1e9).triangle == Hit::kMiss ? 0.0 : 1.0;
    out.figure += scene->ground(0.0, 0.0) || scene->ground_beside(0.0, 0.0) ? 1.0 : 0.0;
    out.figure += scene->facets().facets().empty() && scene->edges().edges().empty() ? 0.0 : 1.0;
    out.figure += now.foliage_m({0, 0, 0}, {1, 0, 0}) == 0.0 ? 0.0 : 1.0;
  }
  return out;
}

/// Distance to a box of 64 x 32 x 16 m, from outside and inside, over its faces, edges and corners: closed form.
/// Nearest points are sums of products with weights to some eps: 16 eps of the largest coordinate, here relative to the
/// box.
StressFigure nearest_to_box(double x_m) {
  const Eigen::Vector3d middle(x_m, 0.0, 0.0), half(32.0, 16.0, 8.0);
  SceneParts parts = made::nothing();
  made::add_box(parts, middle, half);
  const auto scene = made::scene_of(std::move(parts));
  StressFigure out{0.0, 16.0 * kEpsilon * (64.0 + std::abs(x_m))};
  for (int k = 0; k < 4000; ++k) {
    const Eigen::Vector3d o(60.0 * std::sin(1.0 * k), 40.0 * std::sin(1.7 * k), 30.0 * std::sin(2.3 * k));
    const Eigen::Vector3d beyond = o.cwiseAbs() - half;
    const double exact = beyond.maxCoeff<Eigen::PropagateNaN>() > 0.0 ? beyond.cwiseMax(0.0).norm()
                                                                      : -beyond.maxCoeff<Eigen::PropagateNaN>();
    const NearestSurface found = SceneAt(*scene).nearest(middle + o, 1000.0);
    take_worst(out, std::abs(found.distance_m - exact));
    take_worst(out, std::abs((found.point_W - middle - o).norm() - exact));
  }
  return out;
}

/// Triangles of a polygon with holes make up its area, to n eps of the products of its coordinates about its middle.
StressFigure cut_up(const std::vector<std::vector<Eigen::Vector2d>>& rings, double area) {
  std::vector<Eigen::Vector2d> all;
  double reach = 0.0;
  for (const auto& ring : rings) all.insert(all.end(), ring.begin(), ring.end());
  for (const auto& p : all) reach = worse(reach, (p - all.front()).norm());
  double sum = 0.0, least = 0.0;
  for (const auto& t : triangulate(rings)) {
    const Eigen::Vector2d u = all[t[1]] - all[t[0]], v = all[t[2]] - all[t[0]];
    const double half = 0.5 * (u.x() * v.y() - u.y() * v.x());
    sum += half;
    least = std::min(least, half);
  }
  StressFigure out{std::abs(sum - area), 4.0 * static_cast<double>(all.size()) * kEpsilon * (reach * reach + area)};
  take_worst(out, -least);
  return out;
}

/// A comb of n teeth, 1 wide and 100 long, 1 apart: not convex anywhere.
std::vector<Eigen::Vector2d> comb(int n, const Eigen::Vector2d& at) {
  std::vector<Eigen::Vector2d> ring{at + Eigen::Vector2d(0, -1), at + Eigen::Vector2d(2.0 * n - 1.0, -1)};
  for (int k = n - 1; k >= 0; --k) {
    ring.push_back(at + Eigen::Vector2d(2.0 * k + 1.0, 0));
    ring.push_back(at + Eigen::Vector2d(2.0 * k + 1.0, 100));
    ring.push_back(at + Eigen::Vector2d(2.0 * k, 100));
    ring.push_back(at + Eigen::Vector2d(2.0 * k, 0));
  }
  return ring;
}

StressFigure square_with_holes(int n) {
  std::vector<std::vector<Eigen::Vector2d>> rings{rectangle(0, 0, 4.0 * n + 2.0, 8)};
  for (int k = 0; k < n; ++k) rings.push_back(rectangle(4.0 * k + 2.0, 2, 4.0 * k + 4.0, 6));
  return cut_up(rings, (4.0 * n + 2.0) * 8.0 - 8.0 * n);
}

/// Rings without area, of fewer than three corners, all in one place: no triangle of any area, and an end. A figure
/// counts triangles with area.
StressFigure without_area() {
  const std::vector<std::vector<std::vector<Eigen::Vector2d>>> sets{{},
                                                                    {{}},
                                                                    {{{0, 0}}},
                                                                    {{{0, 0}, {1, 1}}},
                                                                    {{{1, 1}, {1, 1}, {1, 1}, {1, 1}}},
                                                                    {{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1, 0}}},
                                                                    {{{0, 0}, {5, 5}, {0, 0}, {5, 5}}}};
  StressFigure out;
  for (const auto& rings : sets) {
    std::vector<Eigen::Vector2d> all;
    for (const auto& ring : rings) all.insert(all.end(), ring.begin(), ring.end());
    for (const auto& t : triangulate(rings)) {
      const Eigen::Vector2d u = all.at(t[1]) - all.at(t[0]), v = all.at(t[2]) - all.at(t[0]);
      out.figure += u.x() * v.y() - u.y() * v.x() == 0.0 ? 0.0 : 1.0;
    }
  }
  return out;
}

/// A round tower of n sides: no corner of a facet is farther from its plane than the documented 1 cm, told in its
/// flatness, and no area is lost: the facets of more than 1 m^2 have all of it. Corners are floats: 1e-6 of the area.
StressFigure tower(int sides, double radius_m) {
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  mesh.begin_object("tower", ObjectKind::kBuilding);
  double area = 0.0;
  for (int k = 0; k < sides; ++k) {
    const double a = 2.0 * kPi * k / sides, b = 2.0 * kPi * ((k + 1) % sides) / sides;
    const auto at = [&](double turn, double z) {
      return Eigen::Vector3d(radius_m * std::cos(turn), radius_m * std::sin(turn), z);
    };
    mesh.quad(at(a, 0), at(b, 0), at(b, 64), at(a, 64), mesh.material("brick"));
    area += 64.0 * 2.0 * radius_m * std::sin(kPi / sides);
  }
  const auto scene = made::scene_of(std::move(parts));
  StressFigure out{0.0, 1.0};
  double sum = 0.0;
  for (const Facet& f : scene->facets().facets()) {
    sum += f.area_m2;
    double farthest = 0.0;
    for (const std::uint32_t i : f.triangles) {
      const Triangle t = Triangle::of(scene->mesh(), i);
      for (const Eigen::Vector3d& p : {t.a, t.b, t.c})
        farthest = worse(farthest, std::abs(f.normal_W.dot(p) - f.offset_m));
    }
    take_worst(out, farthest / 0.01);
    take_worst(out, farthest / (f.flatness_m + 1e-9));
  }
  take_worst(out, std::abs(sum / area - 1.0) / 1e-6);
  return out;
}

/// One wall of two triangles, far from the origin, is one facet of its area, its rectangle filled; and its border has
/// four edges. A figure counts what differs.
StressFigure far_wall(double x_m) {
  SceneParts parts = made::nothing();
  made::add_wall(parts, {x_m, -x_m, 0.0}, 16.0);
  const auto scene = made::scene_of(std::move(parts));
  StressFigure out;
  const auto& facets = scene->facets().facets();
  if (facets.size() != 1) return {1.0, 0.0};
  out.figure += facets[0].area_m2 == 1024.0 && facets[0].normal_W == -Eigen::Vector3d::UnitX() &&
                        facets[0].fills_rectangle && facets[0].offset_m == -x_m
                    ? 0.0
                    : 1.0;
  out.figure +=
      facet_contains(facets[0], *scene, {x_m, -x_m, 0.0}) && facet_contains(facets[0], *scene, {x_m, 16.0 - x_m, 16.0})
          ? 0.0
          : 1.0;
  out.figure += facet_contains(facets[0], *scene, {x_m, 17.0 - x_m, 0.0}) ? 1.0 : 0.0;
  out.figure += scene->edges().edges().size() == 4 ? 0.0 : 1.0;
  return out;
}

}  // namespace

std::vector<StressCase> surface_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "triangles that are none",
           "a normal of 0 / 0, an extent of NaN, a tree that is never left",
           "dropped and counted; the one good triangle is met at 4 m", "wrong"});
  rows.add("surfaces/degenerate_triangles", [] { return degenerate(0.0f); })
      .add("surfaces/degenerate_triangles_at_1e6_m", [] { return degenerate(1e6f); });
  rows.of({StressGroup::kGeometry, "a scene of nothing", "an extent without points, a grid without cells",
           "no answer, no end of the program", "wrong"});
  rows.add("surfaces/scene_of_nothing", nothing_at_all);
  rows.of({StressGroup::kGeometry, "the nearest point over faces, edges and corners",
           "the wrong region of a triangle: a distance to its plane, or to a farther edge",
           "distance to a box, closed form; 16 eps", "m"});
  rows.add("surfaces/nearest_to_a_box", [] { return nearest_to_box(0.0); })
      .add("surfaces/nearest_to_a_box_at_1e6_m", [] { return nearest_to_box(1e6); })
      .loose("the box's coordinates are whole metres, which cancel exactly; the bound is for any");
  rows.of({StressGroup::kGeometry, "polygons with many teeth, holes and far away",
           "an ear that is none; areas of products of coordinates that cancel",
           "the polygon's area to 4 n eps, none of its triangles the wrong way round", "m^2"});
  rows.add("surfaces/square_with_2_holes_in_a_row", [] { return square_with_holes(2); });
  rows.add("surfaces/comb_of_200_teeth",
           [] {
             return cut_up({comb(200, {0, 0})}, 200 * 100.0 + 399.0);
           })
      .add("surfaces/comb_at_1e7_m",
           [] {
             return cut_up({comb(40, {1e7, -1e7})}, 40 * 100.0 + 79.0);
           })
      .add("surfaces/square_with_60_holes", [] { return square_with_holes(60); })
      .add("surfaces/square_beside_its_holes",
           [] {
             // East, above, below and beside a corner: none of them is in it.
             return cut_up({rectangle(0, 0, 4, 4), rectangle(6, 1, 8, 3), rectangle(1, 6, 3, 8),
                            rectangle(1, -4, 3, -2), rectangle(-3, 5, -1, 7)},
                           16.0);
           })
      .add("surfaces/square_of_repeated_and_needless_corners", [] {
        return cut_up({{{0, 0}, {0, 0}, {1, 0}, {2, 0}, {4, 0}, {4, 2}, {4, 2}, {4, 4}, {2, 4}, {0, 4}, {0, 1}}}, 16.0);
      });
  rows.of({StressGroup::kGeometry, "polygons without area", "no ear is found: a search without end",
           "no triangle with area", "triangles"});
  rows.add("surfaces/polygons_without_area", without_area);
  rows.of({StressGroup::kGeometry, "a round wall between facets and none",
           "each neighbour within tolerance of the last: one facet around the whole tower",
           "no corner farther than 1 cm from its facet's plane, no area lost", "of the tolerance"});
  rows.add("surfaces/tower_of_64_sides", [] { return tower(64, 16.0); }).add("surfaces/tower_of_3600_sides", [] {
    return tower(3600, 100.0);
  });
  rows.of({StressGroup::kGeometry, "a wall's facet and edges far from the origin",
           "offsets and areas of coordinates that cancel", "its area, plane, rectangle and four edges, exactly",
           "wrong"});
  rows.add("surfaces/wall_at_0_m", [] { return far_wall(0.0); }).add("surfaces/wall_at_1e7_m", [] {
    return far_wall(1e7);
  });
  return rows.take();
}

}  // namespace canyon::scene
