// The ground of the built-in city: its slope, its hills by the recursion of B-splines, heights between corners, spans,
// normals and what its cells are painted with.
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/scene/city/terrain.h"
#include "canyon/scene/scene_source.h"
#include "canyon/scene/stress/city/subjects.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/surfaces/foliage_index.h"

namespace canyon::scene {
namespace {

using Eigen::Vector3d;
using stress::kHalfUlp;
using stress::Looks;

/// The uniform cubic B-spline of knots ..., -1, 0, 1, ... by Cox and de Boor's recursion: piece i of degree n at x.
double de_boor(int i, int n, double x) {
  if (n == 0) return x >= i && x < i + 1 ? 1.0 : 0.0;
  return (x - i) / n * de_boor(i, n - 1, x) + (i + n + 1 - x) / n * de_boor(i + 1, n - 1, x);
}

/// Corners of the mesh: a plane and over it hills of twice a spline surface through drawn heights every 250 m, of which
/// the one at the origin is 0. Single precision of 40 m.
StressFigure hills_by_recursion(double slope_percent, double hill_m, std::int64_t seed) {
  Looks looks;
  CityConfig config;
  config.seed = seed, config.extent_m = 1200.0, config.terrain_cell_m = 48.0;
  config.slope_percent = slope_percent, config.hill_height_m = hill_m;
  const RandomStream draws(static_cast<std::uint64_t>(seed), "scene.city.terrain");
  const auto hills = [&](double x, double y) {
    double sum = 0.0;
    const double u = x / 250.0, v = y / 250.0;
    // Drawn height k, counted from -1024, weighs by the piece that begins three knots before its own middle.
    for (int j = -8; j <= 8; ++j)
      for (int i = -8; i <= 8; ++i) {
        const double weight = de_boor(i - 3, 3, u) * de_boor(j - 3, 3, v);
        if (weight != 0.0)
          sum += weight *
                 draws.uniform(-1.0, 1.0, static_cast<std::uint32_t>(i + 1024), static_cast<std::uint64_t>(j + 1024));
      }
    return 2.0 * sum;
  };
  SceneParts parts = made::nothing();
  const city::Terrain terrain(config);
  terrain.add_to(parts);
  looks.right(parts.mesh.vertices.size() == 26 * 26 && parts.mesh.triangles.size() == 2 * 25 * 25);
  for (const auto& corner : parts.mesh.vertices) {
    const Vector3d p = corner.cast<double>();
    const double expected =
        slope_percent / 100.0 * (p.x() + p.y()) / std::sqrt(2.0) + hill_m * (hills(p.x(), p.y()) - hills(0.0, 0.0));
    looks.near(p.z(), expected, 2.0 * kHalfUlp * 64.0);
    looks.near(terrain.height(p.x(), p.y()), expected, 2.0 * kHalfUlp * 64.0);
  }
  return looks.figure();
}

/// The height of any point against the triangle of the mesh that it lies over, beyond the square that of its border;
/// of a plane, the normal and the span of heights under a rectangle, in closed form.
StressFigure between_corners() {
  Looks looks;
  CityConfig config;
  config.seed = 5, config.extent_m = 300.0, config.terrain_cell_m = 13.0;  // 23 cells of 13.04 m
  const city::Terrain terrain(config);
  SceneParts parts = made::nothing();
  terrain.add_to(parts);
  const RandomStream draws(9, "stress.terrains");
  const auto& mesh = parts.mesh;
  looks.right(mesh.triangles.size() == 2 * 23 * 23);
  for (std::uint64_t k = 0; k < 300; ++k) {
    const double x = draws.uniform(-160.0, 160.0, 0, k), y = draws.uniform(-160.0, 160.0, 1, k);
    const double px = x < -150.0 ? -150.0 : x > 150.0 ? 150.0 : x, py = y < -150.0 ? -150.0 : y > 150.0 ? 150.0 : y;
    int over = 0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle t = Triangle::of(mesh, i);
      const Eigen::Vector2d u = (t.b - t.a).head<2>(), v = (t.c - t.a).head<2>(), w(px - t.a.x(), py - t.a.y());
      const double det = u.x() * v.y() - u.y() * v.x(), s = (w.x() * v.y() - w.y() * v.x()) / det,
                   r = (u.x() * w.y() - u.y() * w.x()) / det;
      if (s < -1e-6 || r < -1e-6 || s + r > 1.0 + 1e-6) continue;
      ++over;
      looks.right(det > 0.0);  // each faces up
      looks.near(terrain.height(x, y), t.a.z() + s * (t.b - t.a).z() + r * (t.c - t.a).z(), 16.0 * kHalfUlp * 150.0);
    }
    looks.right(over >= 1);
  }
  config.hill_height_m = 0.0, config.slope_percent = 8.0;
  const city::Terrain plane(config);
  const double rise = 0.08 / std::sqrt(2.0), grain = 2.0 * kHalfUlp * 17.0;
  const auto span = plane.span(-60.0, 20.0, -10.0, 90.0);
  looks.near(span.low_m, rise * -40.0, grain), looks.near(span.high_m, rise * 80.0, grain);
  // Two heights 4 m apart, each to single precision.
  for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(-97.0, 61.0), std::pair(140.0, -120.0)})
    looks.near((plane.normal(x, y) - Vector3d(-rise, -rise, 1.0).normalized()).norm(), 0.0, grain);
  // A ridge's two sides: 2 m before its foot the normal has half of the slope.
  looks.near((plane.normal(150.0, 0.0) - Vector3d(-0.5 * rise, -rise, 1.0).normalized()).norm(), 0.0, grain);
  // A span of hills has its extremes within a sixteenth of the sides of where they are.
  const auto rolling = terrain.span(-100.0, -100.0, 100.0, 100.0);
  double low = stress::kInfinity, high = -low;
  for (int i = 0; i <= 16; ++i)
    for (int j = 0; j <= 16; ++j) {
      const double z = terrain.height(-100.0 + 12.5 * i, -100.0 + 12.5 * j);
      low = z < low ? z : low, high = z > high ? z : high;
    }
  looks.near(rolling.low_m, low, 1e-12), looks.near(rolling.high_m, high, 1e-12);
  return looks.figure();
}

/// Cells are painted whose middles lie in a rectangle, its lower borders with it: by their triangles' material. The
/// corners of the city's own ground by the plan: asphalt on streets, concrete on sidewalks and under tall and middling
/// houses, else grass. A figure counts.
StressFigure painted_cells() {
  CityConfig config;
  config.extent_m = 320.0, config.terrain_cell_m = 10.0;
  city::Terrain terrain(config);
  terrain.paint(-160, -160, 160, 160, 3);
  terrain.paint(-45.0, 15.0, 30.0, 50.0, 7);  // borders through middles: of -45 and 15 painted, of 30 none lies there
  terrain.paint(100.1, -155.0, 500.0, -144.9, 9);
  terrain.paint(20.0, 20.0, 20.0, 90.0, 11);  // of no width
  SceneParts parts = made::nothing();
  terrain.add_to(parts);
  int wrong = 0;
  for (std::uint32_t i = 0; i < parts.mesh.triangles.size(); ++i) {
    const Triangle t = Triangle::of(parts.mesh, i);
    const Vector3d low = t.a.cwiseMin(t.b).cwiseMin(t.c);
    const double x = low.x() + 5.0, y = low.y() + 5.0;  // of the cell's middle
    const int expected = x >= -45.0 && x < 30.0 && y >= 15.0 && y < 50.0 ? 7
                         : x > 100.0 && y < -144.0 && y > -156.0         ? 9
                                                                         : 3;
    wrong += parts.mesh.material[i] == expected ? 0 : 1;
  }
  wrong +=
      parts.objects.size() == 1 && parts.objects[0].name == "terrain" && parts.objects[0].kind == ObjectKind::kTerrain
          ? 0
          : 1;
  return {1.0 * wrong, 0.0};
}

/// What a configuration that says nothing asks for, written out; the triangles that it is going to have, two a cell and
/// 145,000 a square kilometre of what stands; and what it is refused by. A figure counts.
StressFigure city_without_a_word() {
  int wrong = 0;
  const auto is = [&](bool right) { wrong += right ? 0 : 1; };
  const CityConfig c;
  is(c.seed == 2012 && c.lat_deg == 32.35 && c.lon_deg == -90.88 && c.extent_m == 1000.0 && c.base_height_m == 60.0);
  is(c.slope_percent == 3.0 && c.hill_height_m == 6.0 && c.terrain_cell_m == 2.0 && c.block_m == 90.0);
  is(c.street_width_m == 12.0 && !c.empty && !c.absorbing);
  const ImportConfig i;
  is(i.file.empty() && i.heights == HeightDatum::kAuto && !i.undulation_m && i.center_deg.empty() && i.radius_m == 0.0);
  is(i.ground_cell_m == 5.0 && i.margin_m == 60.0 && i.storey_m == 3.0 && i.default_height_m == 9.0);
  is(i.up_axis == UpAxis::kAuto && i.wall_material == "concrete" && i.roof_material == "roofing");
  is(i.ground_material == "asphalt" && i.streets == StreetSource::kAuto && i.materials.empty());
  is(SceneConfig().max_triangles == 20'000'000 && SceneConfig().moving.empty());
  is(Foliage().leaf_density_m2_m3 == 1.0);
  is(predicted_cost(c).triangles == 2.0 * 500.0 * 500.0 + 145e3);
  CityConfig other = c;
  other.extent_m = 1501.0, other.terrain_cell_m = 4.0;  // 375.25 cells: 375
  is(std::abs(predicted_cost(other).triangles - (2.0 * 375.0 * 375.0 + 145e3 * 1.501 * 1.501)) < 1e-6);
  other.empty = true;
  is(predicted_cost(other).triangles == 2.0 * 375.0 * 375.0);
  is(predicted_cost(other).memory_mb() == 2.0 * 375.0 * 375.0 * 300.0 / 1e6);
  SceneConfig small;
  small.city = other, small.city.extent_m = 300.0, small.max_triangles = 2 * 75 * 75;
  is(make_scene(small).ok());
  --small.max_triangles;
  const auto refused = make_scene(small);
  is(!refused.ok() && refused.error().str().find("scene.extent_m, scene.terrain_cell_m, scene.max_triangles") == 0);
  small.max_triangles = 100000, small.city.absorbing = true;
  const auto absorbing = make_scene(small);
  is(absorbing.ok());
  if (!absorbing.ok()) return {1.0 * wrong, 0.0};
  for (const Material& m : absorbing->parts.materials) is(m.rf_absorbing);
  // Nothing but ground: all of it terrain, no more triangles than were said.
  is(absorbing->parts.objects.size() == 1 && absorbing->parts.mesh.triangles.size() == 2 * 75 * 75);
  is(absorbing->report.ground == "built in" && absorbing->report.streets == "built in");
  is(absorbing->report.vertical == "ellipsoid" && absorbing->report.undulation_source == "none");
  const Geodetic g = absorbing->parts.frame.to_geodetic(Vector3d::Zero());
  is(std::abs(g.lat_rad * 180.0 / 3.14159265358979323846 - 32.35) < 1e-11);
  is(std::abs(g.lon_rad * 180.0 / 3.14159265358979323846 + 90.88) < 1e-11 && std::abs(g.h_m - 60.0) < 1e-6);
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> terrain_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "the built-in ground, its slope, hills and cells",
           .why = "a weight of another piece, the other triangle of a cell, a normal over half its base",
           .expected = "the recursion of B-splines, the triangles of its own mesh, planes: single precision of heights",
           .unit = "of the bound"});
  for (const std::int64_t seed : {3, 2012})
    rows.add("terrains/hills_of_seed_" + std::to_string(seed), [seed] { return hills_by_recursion(3.0, 6.0, seed); });
  rows.add("terrains/plane", [] { return hills_by_recursion(8.0, 0.0, 1); })
      .add("terrains/between_corners", between_corners);
  rows.of({.group = StressGroup::kData,
           .mechanism = "what a city is made of where nothing is said",
           .why = "a default that has changed, a cell painted beside its rectangle, a cost of cells and not triangles",
           .expected = "as it is written down, cell by cell and key by key: exact",
           .unit = "wrong"});
  rows.add("terrains/painted_cells", painted_cells).add("terrains/without_a_word", city_without_a_word);
  return rows.take();
}

}  // namespace canyon::scene
