// Skylines: what walls hide that stand behind them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/skyline.h"
#include "canyon/gnss/stress/paths/strewn_boxes.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using scene::Facet;

/// Does the straight line between two points pass through the rectangle?
bool cut(const Facet& wall, const Vector3d& a, const Vector3d& b) {
  const double from = wall.normal_W.dot(a) - wall.offset_m, to = wall.normal_W.dot(b) - wall.offset_m;
  if (from * to >= 0.0) return false;
  const Vector3d point = a + from / (from - to) * (b - a);
  const auto& c = wall.rectangle_W;
  const Vector3d u = c[1] - c[0], v = c[3] - c[0];
  const double x = (point - c[0]).dot(u) / u.squaredNorm(), y = (point - c[0]).dot(v) / v.squaredNorm();
  return x > 0.0 && x < 1.0 && y > 0.0 && y < 1.0;
}

/// What a skyline hides is hidden: every line to 25 points of it passes a wall.
StressFigure skylines(std::uint64_t seed) {
  int wrong = 0;
  std::size_t hidden = 0;
  const auto boxes = strewn_boxes(seed, 130, true);
  const auto& facets = boxes->facets().facets();
  std::vector<std::uint32_t> walls;
  for (std::uint32_t i = 0; i < facets.size(); ++i)
    if (i % 4 != 1) walls.push_back(i);
  for (const Vector3d& p : {Vector3d(0.3, -0.2, 1.5), Vector3d(-6.0, 5.0, 9.0), Vector3d(3.0, 4.0, -2.0)}) {
    const Skyline skyline(p, facets, walls);
    for (const Facet& f : facets) {
      if (!skyline.hides(f)) continue;
      ++hidden;
      const auto& c = f.rectangle_W;
      for (int i = 0; i <= 4; ++i)
        for (int j = 0; j <= 4; ++j) {
          const Vector3d q = c[0] + 0.25 * i * (c[1] - c[0]) + 0.25 * j * (c[3] - c[0]);
          const auto passes = [&](std::uint32_t w) { return cut(facets[w], p, q); };
          wrong += std::any_of(walls.begin(), walls.end(), passes) ? 0 : 1;
        }
    }
  }
  wrong += hidden > 30 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// One wall about the antenna at every bearing, and a small box far behind its middle: hidden; one beside it, above it
/// or before it is not.
StressFigure behind_one_wall() {
  int wrong = 0;
  for (int k = 0; k < 48; ++k) {
    const double bearing = kPi / 24.0 * k + 0.01;
    const AngleAxisd turn(bearing, Vector3d::UnitZ());
    scene::SceneParts parts;
    parts.name = "one wall";
    parts.materials = scene::builtin_materials();
    scene::MeshBuilder mesh(parts);
    const Vector3d p(2.0, -1.0, 1.5);
    const auto at = [&](double x, double y, double z) { return Vector3d(p + turn * Vector3d(x, y, z)); };
    mesh.begin_object("wall", scene::ObjectKind::kWall);
    const double tilt = 3.0 * std::sin(0.7 * k);  // not square to the way there
    mesh.quad(at(10 + tilt, 8, -1.2), at(10 - tilt, -8, -1.2), at(10 - tilt, -8, 6), at(10 + tilt, 8, 6),
              mesh.material("metal"));
    struct Behind {
      Vector3d at;
      bool hidden;
    };
    const Behind boxes[] = {{{30, 0, 1}, true},  {{30, 14, 1}, true},  {{30, -14, 1}, true},  {{60, 20, 3}, true},
                            {{30, 0, 14}, true}, {{30, 0, 21}, false}, {{30, 35, 1}, false},  {{30, -35, 1}, false},
                            {{5, 0, 0}, false},  {{-30, 0, 1}, false}, {{0.5, 30, 1}, false}, {{30, 0, -6}, false}};
    for (const Behind& b : boxes) {
      mesh.begin_object("box", scene::ObjectKind::kBuilding);
      mesh.box(at(b.at.x(), b.at.y(), b.at.z()), turn.toRotationMatrix(), Vector3d::Constant(0.4),
               mesh.material("metal"));
    }
    const scene::Scene scene(std::move(parts));
    const auto& facets = scene.facets().facets();
    std::vector<std::uint32_t> wall;
    for (std::uint32_t i = 0; i < facets.size(); ++i)
      if (facets[i].object == 0) wall.push_back(i);
    const Skyline skyline(p, facets, wall);
    for (const Facet& f : facets)
      if (f.object > 0) wrong += skyline.hides(f) == boxes[f.object - 1].hidden ? 0 : 1;
    for (const std::uint32_t i : wall) wrong += skyline.hides(facets[i]) ? 1 : 0;
    // Only upright rectangles hide, and those that are worth it.
    std::vector<Facet> other = {facets[wall[0]], facets[wall[0]], facets[wall[0]]};
    other[0].fills_rectangle = false;
    other[1].normal_W.z() = 0.01;
    other[2].area_m2 = 1e-5;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::vector<std::uint32_t> one{i};
      const Skyline none(p, other, one);
      for (const Facet& f : facets) wrong += none.hides(f) ? 1 : 0;
    }
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> skyline_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "walls that hide what stands behind them",
           "a sector beside the wall's, a top as low as the far end's",
           "every line to what is hidden passes a wall, and what stands far behind one is hidden", "wrong"});
  for (const std::uint64_t seed : {6U, 7U})
    rows.add("shortcuts/skyline_" + std::to_string(seed), [seed] { return skylines(seed); });
  rows.add("shortcuts/behind_one_wall", behind_one_wall);
  return rows.take();
}

}  // namespace canyon::gnss
