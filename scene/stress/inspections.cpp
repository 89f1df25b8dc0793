// What an inspection says of a scene: edges open above the ground and below it, heights from above, needs of sensors.
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/scene/inspect.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using Eigen::Vector3d;
using stress::kHalfUlp;
using stress::Looks;

double slope_at(double x, double y) {
  return 0.1 * x - 0.05 * y;
}

/// Ground on a slope, but not under x > 100, and on it houses without a bottom: walls and a roof, whose lower rim lies
/// so far over the ground, at its highest corner.
SceneParts without_bottoms(const std::vector<double>& over_m) {
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  mesh.begin_object("ground", ObjectKind::kTerrain);
  const auto at = [](double x, double y) { return Vector3d(x, y, slope_at(x, y)); };
  mesh.quad(at(-200, -100), at(100, -100), at(100, 100), at(-200, 100), mesh.material("asphalt"));
  for (std::size_t k = 0; k < over_m.size(); ++k) {
    mesh.begin_object("house " + std::to_string(k), ObjectKind::kBuilding);
    const double x = -180.0 + 30.0 * static_cast<double>(k);
    const auto outline = rectangle(x, -5.0, x + 10.0, 5.0);
    std::vector<double> low, high;
    for (const auto& p : outline) low.push_back(slope_at(p.x(), p.y()) + over_m[k]), high.push_back(40.0);
    mesh.walls(outline, low, high, mesh.material("brick"));
    mesh.quad({x, -5, 40}, {x + 10, -5, 40}, {x + 10, 5, 40}, {x, 5, 40}, mesh.material("metal"));
  }
  return parts;
}

/// A rim that lies a centimetre over the ground or less is buried, and what is open there says nothing of the inside;
/// one that lies higher has four open edges. Without ground under them, as low as the lowest ground beside them. A
/// house that is inside out and closed is told, one that is open below is not. A figure counts.
StressFigure open_below() {
  StressFigure out;
  const auto is = [&](std::size_t found, std::size_t expected) { out.figure += found == expected ? 0.0 : 1.0; };
  for (const auto& [over_m, open] :
       {std::pair{-2.0, false}, {0.0, false}, {0.0099, false}, {0.0101, true}, {0.5, true}}) {
    const auto scene = made::scene_of(without_bottoms({over_m, -1.0}));
    const Soundness s = soundness(*scene);
    is(s.objects, 2), is(s.open_edges, open ? 4 : 0), is(s.watertight, open ? 1 : 2), is(s.inside_out, 0);
    is(s.crowded_edges, 0), is(s.flipped_edges, 0), is(s.repeated_triangles, 0);
  }
  // Of one corner alone over the ground two edges are open.
  SceneParts tilted = without_bottoms({-1.0});
  for (auto& v : tilted.mesh.vertices)
    if (v.x() == -170.0f && v.y() == 5.0f && v.z() < 30.0f) v.z() += 1.5f;
  is(soundness(*made::scene_of(std::move(tilted))).open_edges, 2);
  // Inside out: buried below it cannot be told; whole it can.
  for (const bool whole : {false, true}) {
    SceneParts parts = whole ? made::nothing() : without_bottoms({-1.0});
    if (whole) made::add_box(parts, {30, 40, 5}, {3, 4, 5});
    const std::uint32_t object = static_cast<std::uint32_t>(parts.objects.size() - 1);
    for (std::size_t i = 0; i < parts.mesh.triangles.size(); ++i)
      if (parts.mesh.object[i] == object) std::swap(parts.mesh.triangles[i][1], parts.mesh.triangles[i][2]);
    const Soundness s = soundness(*made::scene_of(std::move(parts)));
    is(s.watertight, 1), is(s.inside_out, whole ? 1 : 0);
  }
  // Beside the ground: a house beyond x = 100 has none under it, a thing at its rim has it within centimetres.
  SceneParts beyond_it = without_bottoms({});
  MeshBuilder mesh(beyond_it);
  mesh.begin_object("at the rim", ObjectKind::kWall);
  mesh.quad({100.03, -5, 12}, {100.03, 5, 12}, {100.03, 5, 5}, {100.03, -5, 5}, mesh.material("brick"));
  mesh.begin_object("off it", ObjectKind::kWall);
  mesh.quad({100.3, -5, 12}, {100.3, 5, 12}, {100.3, 5, 5}, {100.3, -5, 5}, mesh.material("brick"));
  // The ground lies 9.75 m high there at the lowest: the lower side is buried, the others are not.
  is(soundness(*made::scene_of(std::move(beyond_it))).open_edges, 3 + 4);
  return out;
}

/// Heights over the ground, seen from above in cells: of the highest thing over each cell's middle; less the scene's
/// lowest place where there is no ground. Rays in single precision of 100 m.
StressFigure from_above(double cell_m) {
  Looks looks;
  SceneParts parts = without_bottoms({-1.0, -1.0});
  made::add_square(parts, {120.0, 20.0, 7.0}, 12.0, ObjectKind::kOther);
  made::add_square(parts, {-100.0, 40.0, 60.0}, 9.0, ObjectKind::kTree);
  const auto scene = made::scene_of(std::move(parts));
  const Grid grid = heights_from_above(*scene, cell_m);
  const Extent& e = scene->extent();
  looks.near(grid.cell_m, cell_m, 1e-300), looks.near(grid.west_m, -200.0, 1e-4),
      looks.near(grid.south_m, -100.0, 1e-4);
  looks.right(grid.columns == static_cast<int>(std::ceil((e.max.x() - e.min.x()) / cell_m)) &&
              grid.rows == static_cast<int>(std::ceil((e.max.y() - e.min.y()) / cell_m)));
  int none = 0, high = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double x = grid.west_m + (column + 0.5) * cell_m, y = grid.south_m + (row + 0.5) * cell_m;
      const bool ground = x < 100.0 && y < 100.0;
      double top = ground ? slope_at(x, y) : -1e9;
      for (const double house : {-180.0, -150.0})
        if (x > house && x < house + 10.0 && std::abs(y) < 5.0) top = 40.0;
      if (std::abs(x - 120.0) < 12.0 && std::abs(y - 20.0) < 12.0) top = worse(top, 7.0);
      if (std::abs(x + 100.0) < 9.0 && std::abs(y - 40.0) < 9.0) top = 60.0;
      const double found = grid.at(column, row);
      if (top < -1e8) {
        looks.right(std::isnan(found));
        ++none;
        continue;
      }
      looks.near(found, top - (ground ? slope_at(x, y) : e.min.z()), 8.0 * kHalfUlp * 128.0);
      high += found > 30.0 ? 1 : 0;
    }
  looks.right(none > 20 && high > 20);
  return looks.figure();
}

/// What sensors need of a scene: by its facets, edges, trees and materials, one material after the other. A figure
/// counts.
StressFigure needs_of_materials() {
  StressFigure out;
  for (const char* name : {"brick", "glass", "metal", "absorber", "asphalt"}) {
    SceneParts parts = made::nothing();
    MeshBuilder mesh(parts);
    mesh.begin_object("wall", ObjectKind::kWall);
    const auto material = mesh.material(name);
    const Material of = parts.materials[material];
    mesh.quad({0, 0, 0}, {9, 0, 0}, {9, 0, 9}, {0, 0, 9}, material);
    mesh.begin_object("tree", ObjectKind::kTree);
    for (int k = 0; k < 7; ++k)
      mesh.triangle({3.0 * k, 20, 0}, {3.0 * k + 1, 20, 0}, {3.0 * k, 20, 2}, mesh.material("brick"));
    const SensorNeeds needs = sensor_needs(*made::scene_of(std::move(parts)));
    const bool mirrors = !of.rf_absorbing && (of.itu_a > 1.0 || of.itu_c > 0.0);
    out.figure += needs.facets == 1 && needs.reflecting_facets == (mirrors ? 1U : 0U) ? 0.0 : 1.0;
    out.figure += needs.edges == 4 && needs.tree_triangles == 7 && needs.near_triangles == 9 ? 0.0 : 1.0;
    out.figure += needs.specular == (of.lidar_specular > 0.0) && needs.retro == (of.lidar_retro_1_sr > 0.0) &&
                          needs.transparent == (of.lidar_transmittance > 0.0)
                      ? 0.0
                      : 1.0;
  }
  return out;
}

}  // namespace

std::vector<StressCase> inspection_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "what an inspection says of a scene",
           "an edge that counts as open because its ground lies beside it, a height over another cell",
           "each as it was built: single precision of heights", "wrong"});
  rows.add("inspections/open_below", open_below).add("inspections/needs_of_materials", needs_of_materials);
  for (const double cell_m : {1.5, 3.7})
    rows.add("inspections/from_above_in_cells_of_" + stress::text(cell_m) + "_m",
             [cell_m] { return from_above(cell_m); });
  return rows.take();
}

}  // namespace canyon::scene
