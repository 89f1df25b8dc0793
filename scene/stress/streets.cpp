// Streets found in a scene that comes without any, where it is known how they run.
#include <algorithm>
#include <cmath>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/scene/inspect.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"
#include "canyon/scene/tracing/free_space.h"

namespace canyon::scene {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Ground that rises by `slope` both ways, 200 m square, with four blocks of 70 m around a crossing of streets 30 m
/// wide, and 15 m of ground around them. One of the blocks is a yard with two houses in it: walls all around.
/// Over the arm to the east lies a level slab, `slab_m` above the highest ground under it.
SceneParts crossing(double slope, double slab_m) {
  SceneParts parts = made::nothing();
  MeshBuilder mesh(parts);
  const auto ground_m = [&](double x, double y) { return slope * (x + y); };
  const auto at = [&](double x, double y, double up_m) { return Vector3d(x, y, ground_m(x, y) + up_m); };
  mesh.begin_object("ground", ObjectKind::kTerrain);
  mesh.quad(at(-100, -100, 0), at(100, -100, 0), at(100, 100, 0), at(-100, 100, 0), mesh.material("asphalt"));
  const auto brick = mesh.material("brick");
  const auto walls = [&](const Vector2d& middle, double half_m, bool roof) {
    const auto outline = rectangle(middle.x() - half_m, middle.y() - half_m, middle.x() + half_m, middle.y() + half_m);
    std::vector<double> bottom_m, top_m;
    for (const Vector2d& p : outline) {
      bottom_m.push_back(ground_m(p.x(), p.y()) - 0.5);
      top_m.push_back(ground_m(p.x(), p.y()) + 6.0);
    }
    mesh.walls(outline, bottom_m, top_m, brick);
    if (!roof) return;
    Building house;
    house.footprint_W = outline;
    parts.buildings.push_back(house);
  };
  for (const Vector2d& middle : {Vector2d(50, 50), Vector2d(-50, 50), Vector2d(-50, -50), Vector2d(50, -50)}) {
    mesh.begin_object("block " + std::to_string(parts.objects.size()), ObjectKind::kWall);
    walls(middle, 35.0, middle.x() < 0.0 || middle.y() < 0.0);
  }
  mesh.begin_object("houses in the yard", ObjectKind::kBuilding);
  walls({36.0, 50.0}, 8.0, true);
  walls({64.0, 50.0}, 8.0, true);
  mesh.begin_object("slab", ObjectKind::kOther);
  const double z = Eigen::Vector4d(ground_m(60, -15), ground_m(70, -15), ground_m(70, 15), ground_m(60, 15))
                       .maxCoeff<Eigen::PropagateNaN>() +
                   slab_m;
  mesh.quad({60, -15, z}, {70, -15, z}, {70, 15, z}, {60, 15, z}, brick);
  return parts;
}

/// Middle lines of the crossing's arms and of the way around: off the middle by no more than a cell of 2 m to either
/// side, what a line is straightened by, 1.5 m, and the chamfer's 4 % of 15 m; near corners, where middle lines bend,
/// nothing is asked. No line within 2.5 m less a cell of what stands, none in the yard, of which no way leads out.
/// Under a slab that leaves 3 m one drives, under one that leaves 0.4 m to 2.4 m one does not. A figure counts.
StressFigure streets(double slope, double slab_m) {
  const StreetGraph found = free_space_streets(crossing(slope, slab_m));
  const bool open = slab_m > 2.5;
  int wrong = found.edges.size() < 8 ? 1 : 0;
  bool under_the_slab = false;
  for (const StreetGraph::Edge& edge : found.edges) {
    const Vector2d a = found.nodes_W[edge.a], b = found.nodes_W[edge.b];
    for (double u = 0.0; u <= 1.0; u += 0.05) {
      const Vector2d p = a + u * (b - a), q = p.cwiseAbs();
      const double in_blocks_m = std::min(35.0 - std::abs(q.x() - 50.0), 35.0 - std::abs(q.y() - 50.0));
      wrong += in_blocks_m > -0.5 ? 1 : 0;
      wrong += q.maxCoeff<Eigen::PropagateNaN>() < 98.0 ? 0 : 1;
      const bool near_a_corner = (q.x() < 20.0 && (q.y() < 20.0 || q.y() > 80.0)) || (q.x() > 80.0 && q.y() > 80.0) ||
                                 (q.x() > 80.0 && q.y() < 20.0);
      const double off_m = std::min({q.x(), q.y(), std::abs(q.x() - 92.5), std::abs(q.y() - 92.5)});
      // The slab shuts the arm, or takes nothing from it.
      const bool beside_the_slab = !open && p.x() > 40.0 && p.x() < 90.0 && q.y() < 15.0;
      wrong += near_a_corner || beside_the_slab || off_m < 2.0 + 1.5 + 0.04 * 15.0 ? 0 : 1;
      under_the_slab |= p.x() > 62.0 && p.x() < 68.0 && q.y() < 12.0;
    }
    wrong += edge.width_m >= 2.0 * 2.5 && edge.width_m <= 30.0 ? 0 : 1;
  }
  wrong += under_the_slab == open ? 0 : 1;
  // From one end of the street to the other as the crow flies, 72 m less what a corner is cut by, or around the block.
  const auto way = found.route({20.0, 0.0}, {92.0, 0.0});
  double length_m = 0.0;
  for (std::size_t k = 0; k + 1 < way.size(); ++k) length_m += (way[k + 1] - way[k]).norm();
  wrong += open ? (length_m > 65.0 && length_m < 80.0 ? 0 : 1) : (length_m > 180.0 ? 0 : 1);
  return {1.0 * wrong, 0.0};
}

/// Nothing to drive on: no terrain, none that is level enough to have an area from above, and ground under one roof.
StressFigure none() {
  SceneParts empty = made::nothing(), upright = made::nothing(), covered = made::nothing();
  made::add_wall(upright, {0, 0, 0}, 50.0);
  upright.objects[0].kind = ObjectKind::kTerrain;
  made::add_square(covered, {0, 0, 0}, 40.0);
  made::add_square(covered, {0, 0, 1.5}, 45.0, ObjectKind::kBuilding);
  int lines = 0;
  for (const SceneParts* parts : {&empty, &upright, &covered})
    lines += static_cast<int>(free_space_streets(*parts).edges.size());
  return {1.0 * lines, 0.0};
}

double distance_m(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d way = b - a;
  return (p - a - std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0) * way).norm();
}

/// Small triangles every 50 m over 2000 x 400 m, or 400 x 2000 m, with a street across at one end and one along the
/// border at the other. The triangles that count as near a street are those within its reach of 120 m, by the middle of
/// a square of 10 m, half a diagonal off at most; no place of the lattice has a distance within that of the reach, so
/// that the count is exact.
StressFigure near_streets(bool turned) {
  const auto at = [turned](double along, double across) {
    return turned ? Vector2d(across, along) : Vector2d(along, across);
  };
  SceneParts parts = made::nothing();
  parts.streets.nodes_W = {at(-950, -150), at(-950, 150), at(500, -200), at(1000, -200)};
  parts.streets.edges = {{.a = 0, .b = 1}, {.a = 2, .b = 3}};
  MeshBuilder mesh(parts);
  mesh.begin_object("plates", ObjectKind::kTerrain);
  const auto asphalt = mesh.material("asphalt");
  const double reach_m = SensorNeeds().lidar_reach_m, half_diagonal_m = 5.0 * std::sqrt(2.0);
  std::size_t near = 0, undecided = 0;
  for (double along = -1000.0; along <= 1000.0; along += 50.0)
    for (double across = -200.0; across <= 200.0; across += 50.0) {
      const Vector2d p = at(along, across);
      const auto corner = [&p](double x, double y) { return Vector3d(p.x() + x, p.y() + y, 0.0); };
      mesh.triangle(corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.0, 1.0), asphalt);
      double least_m = stress::kInfinity;
      for (const StreetGraph::Edge& edge : parts.streets.edges)
        least_m = std::min(least_m, distance_m(p, parts.streets.nodes_W[edge.a], parts.streets.nodes_W[edge.b]));
      near += least_m < reach_m ? 1 : 0;
      undecided += std::abs(least_m - reach_m) > half_diagonal_m ? 0 : 1;
    }
  const std::size_t found = sensor_needs(*made::scene_of(std::move(parts))).near_triangles;
  return {std::abs(static_cast<double>(found) - static_cast<double>(near)) + static_cast<double>(undecided), 0.0};
}

}  // namespace

std::vector<StressCase> street_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "streets of a scene that comes without any",
           "heights of another corner, so that a bridge shuts the street under it; a yard without a way out",
           "the middle lines of a crossing, to cells and chamfer; under what leaves headroom, not under what does not",
           "wrong"});
  for (const double slope : {0.0, 0.05, -0.05})
    for (const double slab_m : {3.0, 0.4})
      rows.add("streets/crossing_on_a_slope_of_" + stress::text(slope) + "_slab_at_" + stress::text(slab_m) + "_m",
               [=] { return streets(slope, slab_m); });
  rows.of({StressGroup::kData, "ground on which nothing drives", "an extent without cells, a thinning without end",
           "no street", "streets"});
  rows.add("streets/none", none);
  rows.of({StressGroup::kGeometry, "what lies near the streets of a plan that is not square",
           "columns and rows for one another: all of a street beyond the shorter side is left out",
           "as many as lie within reach, none of which a square's half diagonal could decide", "wrong"});
  rows.add("streets/near_those_of_a_wide_plan", [] { return near_streets(false); })
      .add("streets/near_those_of_a_long_plan", [] { return near_streets(true); });
  return rows.take();
}

}  // namespace canyon::scene
