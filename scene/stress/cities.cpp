// What is true of any built-in city, and what an inspection says of surfaces.
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/city/plan.h"
#include "canyon/scene/inspect.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using Eigen::Vector3d;
using stress::kHalfUlp;
using stress::kInfinity;
using stress::Worst;

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

std::vector<StressCase> city_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "surfaces that are not sound",
           "an edge counted once for each of its senses, a volume of the other sign",
           "each as what it is, areas and heights as built", "wrong"});
  rows.add("cities/soundness_of_boxes", soundness_of_boxes);
  rows.of({StressGroup::kGeometry, "a built-in city of any seed",
           "a house in a street, a wall inside out, a roof without a wall",
           "houses under whole roofs, within walls that face outwards, beside streets and on terrain", "of the bound"});
  for (const std::uint64_t seed : {1U, 2012U})
    rows.add("cities/of_seed_" + std::to_string(seed), [seed] { return any_city(seed); });
  return rows.take();
}

}  // namespace canyon::scene
