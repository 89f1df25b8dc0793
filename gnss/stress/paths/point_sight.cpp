// Sight of points from between the nodes of a lattice.
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/gnss/paths/sight/point_sight.h"
#include "canyon/gnss/stress/level_ground.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::Looks;

/// Sight from a place as its eight corners have it, each by its share of the cell of 2 m, and a point that is asked for
/// again, by another and after others; half a wall hides half.
StressFigure sight_from_places() {
  Looks looks;
  const RandomStream draws(5, "stress.asked");
  scene::SceneParts parts = level_ground("sight", 60.0, -40.0);
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("wall", scene::ObjectKind::kWall);
  mesh.quad({9, -7, -30}, {9, 5, -30}, {9, 5, 6}, {9, -7, 6}, mesh.material("metal"));
  mesh.quad({-7, 20, -30}, {-7, 9, -30}, {-7, 9, 16}, {-7, 20, 16}, mesh.material("metal"));
  const scene::Scene place(std::move(parts));
  const scene::SceneAt at(place);
  PointSight sight(place);
  std::vector<Vector3d> points;
  for (std::uint64_t k = 0; k < 40; ++k)
    points.push_back({draws.uniform(-30, 30, 0, k), draws.uniform(-30, 30, 1, k), draws.uniform(0, 20, 2, k)});
  int between = 0;
  GnssCounters counters;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const Vector3d p(draws.uniform(-6, 6, 3, k), draws.uniform(-6, 6, 4, k), draws.uniform(0, 4, 5, k));
    const PointSight::From from = sight.from(p);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      double share = 0.0;
      for (int corner = 0; corner < 8; ++corner) {
        Vector3d node;
        double weight = 1.0;
        for (int a = 0; a < 3; ++a) {
          const double low = 2.0 * std::floor(p[a] / 2.0), part = (p[a] - low) / 2.0;
          node[a] = (corner >> a & 1) != 0 ? low + 2.0 : low;
          weight *= (corner >> a & 1) != 0 ? part : 1.0 - part;
        }
        const Vector3d way = points[i] - node;
        if (!at.blocked_towards(node, way.normalized(), way.norm())) share += weight;
      }
      between += share > 0.01 && share < 0.99 ? 1 : 0;
      looks.near(from.share(i, points[i], counters), share, 1e-13);
    }
  }
  looks.right(between > 20 && counters.occlusion_rays > 100);
  const auto rays = counters.occlusion_rays;
  sight.from({0.5, 0.5, 0.5}).share(3, points[3], counters);
  const auto once = counters.occlusion_rays;
  sight.from({0.6, 0.4, 0.7}).share(3, points[3], counters);
  looks.right(counters.occlusion_rays == once && once >= rays);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> point_sight_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "sight from between the nodes of a lattice",
           "a share of the next cell, a corner twice", "eight rays, each with its share: roundings", "of the bound"});
  rows.add("asked/sight_from_places", sight_from_places);
  return rows.take();
}

}  // namespace canyon::gnss
