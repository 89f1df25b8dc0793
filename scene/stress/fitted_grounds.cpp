// The ground of scenes from files: where it is fine, what surface lies through heights, what fills its holes, and the
// whole of it under houses, streets and trees.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/scene/ground/ground_detail.h"
#include "canyon/scene/ground/ground_plan.h"
#include "canyon/scene/ground/ground_surface.h"
#include "canyon/scene/ground/imported_ground.h"
#include "canyon/scene/importers/assemble.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

using SquareAt = std::pair<std::int32_t, std::int32_t>;
SquareAt square_of(const Vector2d& p) {
  return {static_cast<std::int32_t>(std::floor(p.x() / 16.0)), static_cast<std::int32_t>(std::floor(p.y() / 16.0))};
}
/// Between a rectangle and a square of 16 m: of their nearest points, and of the rectangle's farthest from the square.
double apart(const Vector2d& low, const Vector2d& high, const SquareAt& s, bool farthest) {
  const Vector2d a(16.0 * s.first, 16.0 * s.second), b = a.array() + 16.0;
  double square = 0.0;
  for (int k = 0; k < 2; ++k) {
    double gap = 0.0;
    if (!farthest) gap = low[k] > b[k] ? low[k] - b[k] : a[k] > high[k] ? a[k] - high[k] : 0.0;
    if (farthest) gap = worse(worse(a[k] - low[k], high[k] - b[k]), 0.0);
    square += gap * gap;
  }
  return std::sqrt(square);
}

/// Squares that ways pass: all that they pass over 8 m of, and none that they do not; distances of rectangles by their
/// corners, axis by axis.
StressFigure noted_squares() {
  Looks looks;
  const RandomStream draws(1, "stress.squares");
  for (std::uint64_t k = 0; k < 60; ++k) {
    const Vector2d a(draws.uniform(-300, 300, 0, k), draws.uniform(-300, 300, 1, k)),
        b = k % 7 == 0 ? a : Vector2d(draws.uniform(-300, 300, 2, k), draws.uniform(-300, 300, 3, k));
    GroundDetail detail;
    detail.add(a, b);
    std::map<SquareAt, double> passed;  // and how far along the longer axis
    const int steps = 20000;
    for (int i = 0; i <= steps; ++i)
      passed[square_of(a + (b - a) * i / steps)] += (b - a).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / steps;
    std::set<SquareAt> found;
    const auto squares = detail.squares();
    for (std::size_t i = 0; i < squares.size(); ++i) {
      found.insert({squares[i].x, squares[i].y});
      looks.right(passed.count({squares[i].x, squares[i].y}) == 1);
      if (i > 0)
        looks.right(squares[i - 1].y < squares[i].y ||
                    (squares[i - 1].y == squares[i].y && squares[i - 1].x < squares[i].x));
    }
    looks.right(found.size() == squares.size() && found.count(square_of(a)) == 1 && found.count(square_of(b)) == 1);
    for (const auto& [square, way] : passed)
      if (way > 8.01) looks.right(found.count(square) == 1);
    const Vector2d low = a.cwiseMin(b), high = a.cwiseMax(b);
    for (int i = 0; i < 20; ++i) {
      const GroundDetail::Square s{
          static_cast<std::int32_t>(draws.uniform(-30, 30, 4, 20 * k + static_cast<std::uint64_t>(i))),
          static_cast<std::int32_t>(draws.uniform(-30, 30, 5, 20 * k + static_cast<std::uint64_t>(i)))};
      looks.near(nearest_m(low, high, s), apart(low, high, {s.x, s.y}, false), 1e-10);
      looks.near(farthest_m(low, high, s), apart(low, high, {s.x, s.y}, true), 1e-10);
    }
  }
  GroundDetail none;
  none.add({std::numeric_limits<double>::quiet_NaN(), 0.0}, {0.0, 0.0});
  none.add({0.0, 0.0}, {0.0, kInfinity}), none.add({0.0, 2e9}, {0.0, 0.0});
  looks.right(none.squares().empty());
  return looks.figure();
}

/// Cells as the plan's description has them: those that stand near are single, a larger one lies where nothing stands
/// within full_m + 1.5 edges and heights are even to a milliradian of the distance; and four that could be one are not,
/// unless one of their neighbours were then less than half as large.
StressFigure cells_by_their_rule(double rise_m, double full_m) {
  Looks looks;
  const RandomStream draws(2, "stress.cells");
  GroundDetail detail;
  for (std::uint64_t k = 0; k < 4; ++k) {
    const Vector2d at(draws.uniform(-500, 100, 0, k), draws.uniform(-400, 200, 1, k));
    detail.add(at, at + Vector2d(20.0, 5.0));
  }
  GroundWish wish;
  wish.low = {-603.0, -512.0}, wish.high = {911.0, 707.0}, wish.cell_m = 4.0, wish.full_m = full_m;
  const GroundHeight hill = [=](const Vector2d& p) -> std::optional<double> {
    if (p.x() > 850.0 && p.y() > 600.0) return std::nullopt;
    return rise_m * std::exp(-(p - Vector2d(430.0, 250.0)).squaredNorm() / 40000.0) + 0.02 * p.x();
  };
  const GroundPlan plan(wish, detail, hill, 1e6);
  const auto cells = plan.list();
  looks.near(plan.x(0), 4.0 * std::floor(-603.0 / 4.0), 1e-300), looks.near(plan.y(0), -512.0, 1e-300);
  looks.near(plan.x(7) - plan.x(0), 28.0, 1e-12), looks.near(plan.y(7) - plan.y(0), 28.0, 1e-12);
  const auto squares = detail.squares();
  const auto distance = [&](const GroundPlan::Cell& c, bool farthest) {
    const Vector2d low(plan.x(c.column), plan.y(c.row)), high = low.array() + 4.0 * c.size;
    double least = kInfinity;
    for (const auto& s : squares) least = std::min(least, apart(low, high, {s.x, s.y}, farthest));
    return least;
  };
  const auto is_even = [&](const GroundPlan::Cell& c, double distance_m) {
    const int steps = c.size >= 4 ? 4 : 2;
    const auto z = [&](int i, int j) {
      return hill({plan.x(c.column + i * c.size / steps), plan.y(c.row + j * c.size / steps)});
    };
    const auto sw = z(0, 0), se = z(steps, 0), nw = z(0, steps), ne = z(steps, steps);
    if (!sw || !se || !nw || !ne) return true;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps; ++j) {
        const auto h = z(i, j);
        if (!h) continue;
        const double u = 1.0 * i / steps, v = 1.0 * j / steps;
        // South-east of the diagonal by the corners there, else by the others.
        const double level =
            j <= i ? (1.0 - u) * *sw + (u - v) * *se + v * *ne : (1.0 - v) * *sw + (v - u) * *nw + u * *ne;
        if (std::abs(*h - level) > 1e-3 * distance_m) return false;
      }
    return true;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> size_at;
  for (const auto& c : cells) {
    for (std::int32_t i = 0; i < c.size; ++i)
      for (std::int32_t j = 0; j < c.size; ++j) size_at[{c.column + i, c.row + j}] = c.size;
    if (c.size == 1) continue;
    looks.right(distance(c, false) >= full_m + 1.5 * 4.0 * c.size - 1e-9);
    // It is even itself, or one that had to be divided beside finer ones was.
    bool even = false;
    for (GroundPlan::Cell of = c; !even && of.size <= 512; of = {of.column, of.row, 2 * of.size}) {
      of.column -= of.column % of.size, of.row -= of.row % of.size;
      const double away = distance(of, false);
      even = away >= full_m + 1.5 * 4.0 * of.size - 1e-9 && is_even(of, away);
    }
    looks.right(distance(c, true) > full_m && even);
  }
  std::int32_t largest = 0;
  for (const auto& c : cells) {
    largest = worse(largest, c.size);
    const GroundPlan::Cell parent{c.column, c.row, 2 * c.size};
    if (c.column % parent.size != 0 || c.row % parent.size != 0) continue;
    bool four = true;
    for (const std::int32_t i : {0, c.size})
      for (const std::int32_t j : {0, c.size}) {
        const auto there = size_at.find({c.column + i, c.row + j});
        four = four && there != size_at.end() && there->second == c.size;
      }
    if (!four || distance(parent, false) < full_m + 1.5 * 4.0 * parent.size ||
        !is_even(parent, distance(parent, false)))
      continue;
    bool finer_beside = false;
    for (std::int32_t i = 0; i < parent.size; ++i)
      for (const auto& at : {std::pair{parent.column - 1, parent.row + i},
                             {parent.column + parent.size, parent.row + i},
                             {parent.column + i, parent.row - 1},
                             {parent.column + i, parent.row + parent.size}}) {
        const auto beside = size_at.find(at);
        finer_beside = finer_beside || (beside != size_at.end() && beside->second <= parent.size / 4);
      }
    looks.right(finer_beside);
  }
  looks.right(largest >= 16);
  return looks.figure();
}

/// The surface through heights by its description: the plane that fits those around best, by weights of 25 m or of as
/// wide as eight of them take, a little against tilting, solved here about the first height with another method; what
/// is around are whole rings of squares. Of many heights, few, on a line, and one. Condition numbers of 1e3, and of 1e5
/// on a line, over an epsilon of 45 m.
StressFigure fitted_surface(int n, bool on_a_line) {
  Looks looks;
  const RandomStream draws(3, "stress.heights");
  std::vector<Vector3d> heights;
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    const double x = draws.uniform(-400, 600, 0, i), y = on_a_line ? 0.2 * x : draws.uniform(-300, 300, 1, i);
    heights.emplace_back(x, y, 40.0 + 0.05 * x - 0.02 * y + draws.uniform(-3, 3, 2, i));
  }
  const GroundFit fit(heights);
  Vector2d low = heights[0].head<2>(), high = low;
  for (const Vector3d& h : heights) low = low.cwiseMin(h.head<2>()), high = high.cwiseMax(h.head<2>());
  const double area = (high - low).x() * (high - low).y(), extent = worse((high - low).x(), (high - low).y());
  const double square_m = worse(50.0, worse(2.0 * std::sqrt(area / n), 2.0 * extent / n));
  const std::size_t enough = std::min<std::size_t>(8, heights.size());
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Vector2d p(draws.uniform(-700, 900, 3, k), draws.uniform(-600, 600, 4, k));
    std::vector<std::pair<double, std::size_t>> all;
    for (std::size_t i = 0; i < heights.size(); ++i) all.emplace_back((heights[i].head<2>() - p).norm(), i);
    std::sort(all.begin(), all.end());
    const double ring = std::ceil(all[enough - 1].first / square_m - 1e-12);
    const double reach = square_m * (ring < 1.0 ? 1.0 : ring);
    const double width = worse(25.0 * 25.0, 0.5 * all[enough - 1].first * all[enough - 1].first);
    const double about = heights[all[0].second].z();
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Vector3d b = Vector3d::Zero();
    bool decided = std::abs(all[enough - 1].first / square_m - std::round(all[enough - 1].first / square_m)) > 1e-9;
    for (const auto& [d, i] : all) {
      if (std::abs(d - reach) < 1e-9) decided = false;
      if (d > reach) continue;
      const double w = std::exp(-d * d / (2.0 * width));
      const Vector3d q(1.0, (heights[i].x() - p.x()) / 25.0, (heights[i].y() - p.y()) / 25.0);
      A += w * q * q.transpose(), b += w * (heights[i].z() - about) * q;
    }
    A(1, 1) += A(0, 0) / 20.0, A(2, 2) += A(0, 0) / 20.0;
    // Far outside the rings that are looked through begin at the first that could hold any.
    const Vector2d beyond_it = (low - p).cwiseMax(p - high).cwiseMax(0.0);
    if (!decided || beyond_it.norm() > square_m) continue;
    looks.near(fit(p), about + A.fullPivLu().solve(b)[0], (on_a_line ? 1e5 : 1e3) * kEpsilon * 45.0);
  }
  looks.near(GroundFit({Vector3d(5.0, 6.0, 7.5)})({900.0, -40.0}), 7.5, 1e-12);
  return looks.figure();
}

/// Corners without a height take the mean of the known ones with which they share a cell, ring by ring outwards: by
/// sets of corners. Sums of ten heights: 32 eps.
StressFigure filled_holes(std::uint64_t seed) {
  Looks looks;
  const RandomStream draws(seed, "stress.holes");
  GroundDetail detail;
  detail.add({-40.0, -30.0}, {30.0, -20.0});
  GroundWish wish;
  wish.low = {-200.0, -160.0}, wish.high = {240.0, 200.0}, wish.cell_m = 8.0, wish.full_m = 30.0;
  const GroundPlan plan(wish, detail, {}, 1e6);
  GroundMesh ground(plan);
  std::vector<std::optional<double>> known(ground.places.size());
  std::map<std::pair<double, double>, std::size_t> index;
  const Vector2d hole(draws.uniform(-100, 100, 0, 0), draws.uniform(-100, 100, 1, 0));
  for (std::size_t i = 0; i < known.size(); ++i) {
    index[{ground.places[i].x(), ground.places[i].y()}] = i;
    if ((ground.places[i] - hole).norm() > 70.0 && draws.uniform(2, i) > 0.1) known[i] = draws.uniform(10, 60, 3, i);
  }
  const bool filled = fill_ground(ground, [&](const Vector2d& p) { return known[index.at({p.x(), p.y()})]; });
  looks.right(filled);
  std::vector<std::set<std::size_t>> beside(known.size());
  std::size_t first = 0;
  for (const std::uint8_t count : ground.of_cell) {
    std::set<std::size_t> corners;
    for (std::size_t t = first; t < first + count; ++t)
      for (const std::uint32_t c : ground.triangles[t]) corners.insert(c);
    first += count;
    for (const std::size_t c : corners) beside[c].insert(corners.begin(), corners.end());
  }
  looks.right(first == ground.triangles.size());
  int rings = 0;
  for (bool any = true; any;) {
    any = false;
    auto next = known;
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (known[i]) continue;
      double sum = 0.0, count = 0.0;
      for (const std::size_t k : beside[i])
        if (known[k]) sum += *known[k], count += 1.0;
      if (count > 0.0) next[i] = sum / count, any = true;
    }
    known = next;
    rings += any ? 1 : 0;
  }
  for (std::size_t i = 0; i < known.size(); ++i)
    looks.near(ground.height_m[i], known[i].value_or(0.0), 32.0 * kEpsilon * 60.0);
  looks.right(rings > 2);
  // Two triangles a cell, or a fan; they cover the rectangle once, and face upwards.
  double area = 0.0, cells_m2 = 0.0;
  for (const auto& t : ground.triangles) {
    const Vector2d e = ground.places[t[1]] - ground.places[t[0]], f = ground.places[t[2]] - ground.places[t[0]];
    looks.right(e.x() * f.y() - e.y() * f.x() > 0.0);
    area += 0.5 * (e.x() * f.y() - e.y() * f.x());
  }
  for (const auto& c : plan.list()) cells_m2 += 64.0 * c.size * c.size;
  looks.near(area, cells_m2, 1e-6);
  return looks.figure();
}

/// What files hold, in W: houses as outlines, polygons and triangles, with heights of the ground or none; a street,
/// trees.
std::vector<RawScene> made_files(bool heights) {
  const RandomStream draws(4, "stress.files");
  std::vector<RawScene> out(2);
  for (std::uint64_t k = 0; k < 24; ++k) {
    RawScene& scene = out[k % 2];
    const Vector2d at(draws.uniform(-120, 160, 0, k), draws.uniform(-90, 80, 1, k));
    const std::uint32_t object = scene.add_object("house " + std::to_string(k), ObjectKind::kBuilding);
    const double ground = 20.0 + 0.05 * at.x() + draws.uniform(-1, 1, 2, k);
    if (k % 3 == 0 && heights) {
      RawPolygon bottom{.object = object, .material = 0};
      for (const Vector2d& c : {Vector2d(0, 0), Vector2d(0, 6), Vector2d(9, 6), Vector2d(9, 0)})
        bottom.rings.resize(1), bottom.rings[0].push_back({at.x() + c.x(), at.y() + c.y(), ground});
      bottom.ground_surface = true;
      scene.polygons.push_back(bottom);
      continue;
    }
    RawFootprint f;
    f.object = object, f.height_m = 8.0;
    f.rings = {{at, at + Vector2d(10, 0), at + Vector2d(10, 7), at + Vector2d(0, 7)}};
    if (heights) f.ground_m = ground;
    scene.footprints.push_back(f);
  }
  RawMesh mesh;
  const std::uint32_t hall = out[1].add_object("hall", ObjectKind::kOther);
  mesh.vertices = {{200, 40, 25}, {230, 40, 25}, {215, 70, 31}, {900, 900, 900}};  // the last one is not used
  mesh.triangles = {{0, 1, 2}}, mesh.object = {hall}, mesh.material = {0};
  out[1].meshes.push_back(mesh);
  out[0].streets.push_back({{{-100, 0}, {150, 20}, {180, 60}}, 7.0, {}});
  const std::uint32_t tree = out[0].add_object("tree", ObjectKind::kTree);
  out[0].trees.push_back({tree, {-60.0, 55.0}, 9.0, 4.0, {}});
  return out;
}

/// The whole ground under such files: as far as their corners and the margin, or the radius and the margin; fine about
/// everything that stands, the street and the tree; through the heights that are told, or level; and as many triangles
/// as were foretold, of which there may be no more than the limit. Heights as the corners have them, in single
/// precision.
StressFigure under_files(bool heights, double radius_m, double cell_m) {
  Looks looks;
  ImportConfig config;
  config.radius_m = radius_m, config.ground_cell_m = cell_m, config.margin_m = 33.0;
  const FileFrame at;
  const std::vector<RawScene> scenes = made_files(heights);
  ImportedScene out;
  out.parts = made::nothing();
  looks.right(ImportedGround(config, at, kMaxTriangles).make(scenes, out).ok());
  // What stands, edge by edge.
  Vector2d low(kInfinity, kInfinity), high = -low;
  GroundDetail detail;
  double triangles = 0.0;
  const auto ring = [&](const std::vector<Vector2d>& corners, bool reaches) {
    for (std::size_t k = 0; k < corners.size(); ++k) {
      detail.add(corners[k], corners[k + 1 < corners.size() ? k + 1 : 0]);
      if (reaches) low = low.cwiseMin(corners[k]), high = high.cwiseMax(corners[k]);
    }
  };
  for (const RawScene& scene : scenes) {
    triangles += triangles_of(scene);
    for (const RawFootprint& f : scene.footprints) ring(f.rings[0], true);
    for (const RawPolygon& p : scene.polygons) {
      std::vector<Vector2d> corners;
      for (const Vector3d& c : p.rings[0]) corners.emplace_back(c.head<2>());
      ring(corners, true);
    }
  }
  ring({{200, 40}, {230, 40}, {215, 70}}, true);
  detail.add({-100, 0}, {150, 20}), detail.add({150, 20}, {180, 60}), detail.add({-60.0, 55.0}, {-60.0, 55.0});
  if (radius_m > 0.0)
    low = low.cwiseMax(Vector2d(-radius_m, -radius_m)), high = high.cwiseMin(Vector2d(radius_m, radius_m));
  const Vector2d margin(33.0, 33.0);
  const GroundWish wish{low - margin, high + margin, cell_m, 33.0 > 5.0 * cell_m ? 33.0 : 5.0 * cell_m};
  const GroundPlan plan(wish, detail, {}, 1e6);
  const GroundMesh expected(plan);
  looks.near(out.report.predicted.triangles, 2.0 * plan.cells() + triangles, 1e-6);
  looks.right(out.parts.mesh.triangles.size() == expected.triangles.size() &&
              out.parts.mesh.vertices.size() == expected.places.size() && out.parts.objects.size() == 1 &&
              out.parts.objects[0].kind == ObjectKind::kTerrain);
  if (out.parts.mesh.vertices.size() != expected.places.size()) return looks.figure();
  const auto told = ground_points(scenes);
  looks.right(told.empty() != heights);
  const GroundFit fit(told);
  for (std::size_t i = 0; i < expected.places.size(); ++i) {
    const Vector3d v = out.parts.mesh.vertices[i].cast<double>();
    looks.near((v.head<2>() - expected.places[i]).norm(), 0.0, 2.0 * stress::kHalfUlp * 400.0);
    looks.near(v.z(), heights ? fit(expected.places[i]) : 0.0, stress::kHalfUlp * 64.0 + 1e-12);
  }
  for (const auto& t : out.parts.mesh.triangles) looks.right(t[0] < expected.places.size());
  looks.right(out.report.ground ==
              (heights ? "fitted to " + std::to_string(told.size()) + " heights of the ground at buildings"
                       : std::string("level")));
  for (const auto& m : out.parts.mesh.material) looks.right(out.parts.materials[m].name == config.ground_material);
  // One triangle too many is refused; terrain of the files' own, or nothing at all, needs none.
  ImportedScene refused = {made::nothing(), {}}, own = refused, none = refused;
  const auto limit = static_cast<std::int64_t>(std::floor(out.report.predicted.triangles)) - 1;
  looks.right(!ImportedGround(config, at, limit).make(scenes, refused).ok());
  std::vector<RawScene> with_ground = scenes;
  with_ground[1].add_object("ground", ObjectKind::kTerrain);
  looks.right(ImportedGround(config, at, kMaxTriangles).make(with_ground, own).ok() &&
              own.parts.mesh.triangles.empty() && own.report.ground == "surfaces of the file");
  looks.near(own.report.predicted.triangles, triangles, 1e-6);
  looks.right(ImportedGround(config, at, kMaxTriangles).make({RawScene{}}, none).ok() && none.report.ground == "none");
  return looks.figure();
}

}  // namespace

std::vector<StressCase> fitted_ground_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "where a ground from files is fine, and where it need not be",
           "a square of the other axis, a distance to the wrong corner, four cells that are never one",
           "its description, cell by cell and square by square", "wrong"});
  rows.add("fitted_grounds/noted_squares", noted_squares);
  for (const double rise_m : {0.0, 2.0, 60.0})
    for (const double full_m : {20.0, 90.0})
      rows.add(
          "fitted_grounds/cells_at_a_hill_of_" + stress::text(rise_m) + "_m_full_to_" + stress::text(full_m) + "_m",
          [=] { return cells_by_their_rule(rise_m, full_m); });
  rows.of({StressGroup::kData, "heights of a ground that is known here and there",
           "a weight of twice the width, a tilt that is held too much, a mean of what is not known yet",
           "the weighted plane solved anew, and means ring by ring: conditioning", "of the bound"});
  for (const int n : {3, 9, 120, 700}) {
    rows.add("fitted_grounds/through_" + std::to_string(n) + "_heights", [n] { return fitted_surface(n, false); });
    rows.add("fitted_grounds/through_" + std::to_string(n) + "_on_a_line", [n] { return fitted_surface(n, true); });
  }
  for (const std::uint64_t seed : {1U, 2U})
    rows.add("fitted_grounds/holes_" + std::to_string(seed), [seed] { return filled_holes(seed); });
  rows.of({StressGroup::kData, "the ground under the houses, streets and trees of files",
           "a margin on one side, an edge that is not closed, heights of another file, a limit that lets one more by",
           "as far, as fine and as high as their corners say: single precision", "of the bound"});
  for (const bool heights : {true, false})
    for (const double radius_m : {0.0, 90.0})
      rows.add(std::string("fitted_grounds/under_files_") + (heights ? "with_heights" : "without_heights") +
                   (radius_m > 0.0 ? "_cut_off" : ""),
               [=] { return under_files(heights, radius_m, radius_m > 0.0 ? 8.0 : 5.0); });
  return rows.take();
}

}  // namespace canyon::scene
