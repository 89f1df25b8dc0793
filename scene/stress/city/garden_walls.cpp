// Walls of gardens: which sides of which blocks have one, where they begin and end, and that they follow the ground.
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress/looks.h"
#include "canyon/scene/city/furniture.h"
#include "canyon/scene/stress/city/drawn_laws.h"
#include "canyon/scene/stress/city/placed_things.h"
#include "canyon/scene/stress/city/subjects.h"
#include "canyon/scene/stress/made_scenes.h"

namespace canyon::scene {
namespace {

using city::Zone;
using Eigen::Vector2d;
using Eigen::Vector3d;
using made::kCornerGrain_m;
using made::look_at_share;
using made::Span3;
using made::span_of;
using made::tilted_city;
using made::tilted_ground_m;
using made::UniformLaw;
using stress::kInfinity;
using stress::Looks;

/// Blocks of low houses alone have walls, 3.3 m within their kerbs, 24 cm thick and 0.9 to 1.8 m high: on 45 of 100
/// sides, from 2 m behind the corner to 2 m before a gate, which is somewhere between 0.3 and 0.7 of the side, and from
/// 2 m behind it to 2 m before the next corner; in pieces of up to 6 m that reach 0.4 m into the ground.
StressFigure garden_walls() {
  Looks looks;
  city::Plan plan;
  for (int b = 0; b < 120; ++b) plan.blocks.push_back({{-90.0, -70.0, 90.6, 50.6}, Zone::kLow});
  for (const Zone zone : {Zone::kTall, Zone::kMiddle, Zone::kOpen})
    plan.blocks.push_back({{-90.0, -70.0, 90.6, 50.6}, zone});
  SceneParts parts = made::nothing();
  city::add_garden_walls(tilted_city(), plan, city::Terrain(tilted_city()), parts);
  const auto all = made::corners_by_object(parts, "brick");
  looks.right(!all.empty() && all.size() % 2 == 0);
  UniformLaw gate(0.3, 0.7, 1e-5), high(0.9, 1.8, 1e-4);
  const Vector2d corner[4] = {{-86.7, -66.7}, {87.3, -66.7}, {87.3, 47.3}, {-86.7, 47.3}};
  for (std::size_t w = 0; w + 1 < all.size(); w += 2) {
    double gate_m[2] = {0.0, 0.0};
    int side = -1;
    for (std::size_t part = 0; part < 2; ++part) {
      looks.right(parts.objects[w + part].name == "wall " + std::to_string(w + part + 1) &&
                  parts.objects[w + part].kind == ObjectKind::kWall);
      // The side that all of it lies on, the same of both parts.
      Span3 box;
      Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
      Vector3d origin = Vector3d::Zero();
      int lies_on = -1;
      for (int s = 0; s < 4 && lies_on < 0; ++s) {
        const Vector2d way = (corner[(s + 1) % 4] - corner[s]).normalized();
        axes.col(0) << way.x(), way.y(), 0.0;
        axes.col(1) << -way.y(), way.x(), 0.0;
        origin << corner[s].x(), corner[s].y(), 0.0;
        box = span_of(all[w + part], origin, axes);
        if (std::abs(box.low.y() + 0.12) < kCornerGrain_m && std::abs(box.high.y() - 0.12) < kCornerGrain_m)
          lies_on = s;
      }
      if (lies_on < 0 || (part == 1 && lies_on != side)) return {kInfinity, 1.0};
      side = lies_on;
      const double length_m = side % 2 == 0 ? 174.0 : 114.0, way_m = box.high.x() - box.low.x();
      looks.near(part == 0 ? box.low.x() : box.high.x(), part == 0 ? 2.0 : length_m - 2.0, kCornerGrain_m);
      gate_m[part] = part == 0 ? box.high.x() : box.low.x();
      // Pieces of up to 6 m, with four walls and a top of two triangles each.
      looks.near(static_cast<double>(all[w + part].size()), 30.0 * std::ceil(way_m / 6.0), 0.5);
      const double pieces = std::ceil(way_m / 6.0);
      double height_m = 0.0;
      for (const Vector3d& p : all[w + part]) {
        const Vector3d q = axes.transpose() * (p - origin), in_the_middle = origin + axes.col(0) * q.x();
        const double over_m = p.z() - tilted_ground_m(in_the_middle.head<2>());
        if (over_m > 0.0 && height_m == 0.0) height_m = over_m;
        looks.near(over_m, over_m > 0.0 ? height_m : -0.4, 2.0 * kCornerGrain_m);
        const double step = (q.x() - box.low.x()) / way_m * pieces;
        looks.near(step, std::round(step), 2.0 * kCornerGrain_m);
      }
      if (part == 0) high.take(height_m);
    }
    const double length_m = side % 2 == 0 ? 174.0 : 114.0;
    looks.near(gate_m[1] - gate_m[0], 4.0, 2.0 * kCornerGrain_m);
    gate.take(0.5 * (gate_m[0] + gate_m[1]) / length_m);
  }
  look_at_share(looks, 0.5 * static_cast<double>(all.size()), 4.0 * 120.0, 0.45);
  gate.look_at(looks), high.look_at(looks);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> garden_wall_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "walls of gardens on a slope",
           .why = "a gate at the corner, a piece that hangs in the air, walls around houses of another kind",
           .expected = "places and pieces as they are said, single precision of 200 m; shares and drawn numbers by "
                       "their laws to 5 sigma",
           .unit = "of the bound"});
  rows.add("garden_walls/along_blocks", garden_walls);
  return rows.take();
}

}  // namespace canyon::scene
