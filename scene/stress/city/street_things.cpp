// What stands along streets and in blocks: poles, parked vehicles and trees, on streets of any direction over a
// slope, each at the place and in the measures that it is said to have.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/furniture.h"
#include "canyon/scene/city/kerb.h"
#include "canyon/scene/stress/city/drawn_laws.h"
#include "canyon/scene/stress/city/placed_things.h"
#include "canyon/scene/stress/city/subjects.h"
#include "canyon/scene/stress/made_scenes.h"

namespace canyon::scene {
namespace {

using city::Zone;
using Eigen::Vector2d;
using Eigen::Vector3d;
using made::corners_by_object;
using made::kCornerGrain_m;
using made::look_at_share;
using made::Span3;
using made::span_of;
using made::tilted_city;
using made::tilted_ground_m;
using made::UniformLaw;
using stress::kInfinity;
using stress::Looks;

constexpr double kWay_m = 262.0, kBetween_m = 13.0, kStreetEdge_m = 12.0;

/// `count` streets of 262 m through the middle, each in another direction, in a zone of one kind.
city::Plan star_of_streets(int count, Zone zone) {
  city::Plan plan;
  for (int k = 0; k < count; ++k) {
    const double a = 0.1 + 2.0 * kPi * k / count;
    const Vector2d half = 0.5 * kWay_m * Vector2d(std::cos(a), std::sin(a));
    plan.streets.nodes_W.push_back(-half), plan.streets.nodes_W.push_back(half);
    const auto n = static_cast<std::uint32_t>(2 * k);
    plan.streets.edges.push_back({n, n + 1, kStreetEdge_m});
  }
  plan.blocks.push_back({{-1.0, -1.0, 1.0, 1.0}, zone});
  plan.quarter = {0, 0, 0, 0};
  return plan;
}
/// Along a side of a street, and across it from its middle line; even sides lie to the left.
Vector2d beside(const city::Plan& plan, std::size_t side, double along_m, double across_m) {
  const StreetGraph::Edge& e = plan.streets.edges[side / 2];
  const Vector2d a = plan.streets.nodes_W[e.a], way = (plan.streets.nodes_W[e.b] - a).normalized();
  return a + along_m * way + (side % 2 == 0 ? 1.0 : -1.0) * across_m * Vector2d(-way.y(), way.x());
}
/// Two sides a street, the left one first; the zone of a side is that of the block behind it, a street's width off its
/// middle, or of the nearest block.
StressFigure sides_of_streets() {
  Looks looks;
  city::Plan plan;
  plan.streets.nodes_W = {{10.0, 5.0}, {40.0, 45.0}, {10.0, 95.0}};
  plan.streets.edges = {{0, 1, 12.0}, {2, 1, 20.0}};
  // Middles of the streets at (25, 25) and (25, 70); lefts (-0.8, 0.6) and (0.857, 0.514), rights opposite.
  plan.blocks = {{{10, 28, 20, 40}, Zone::kTall}, {{30, 10, 45, 22}, Zone::kLow}, {{38, 72, 48, 90}, Zone::kMiddle}};
  const auto sides = city::kerbs(plan);
  looks.right(sides.size() == 4);
  if (sides.size() != 4) return looks.figure();
  const double w = std::sqrt(30.0 * 30.0 + 50.0 * 50.0);
  const Vector2d ways[2] = {{0.6, 0.8}, {30.0 / w, -50.0 / w}};
  const Zone zones[4] = {Zone::kTall, Zone::kLow, Zone::kMiddle, Zone::kTall};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector2d way = ways[k / 2], left(-way.y(), way.x());
    looks.near((sides[k].start - plan.streets.nodes_W[k / 2 == 0 ? 0 : 2]).norm(), 0.0, 1e-12);
    looks.near((sides[k].along - way).norm(), 0.0, 1e-14);
    looks.near((sides[k].across - (k % 2 == 0 ? left : Vector2d(-left))).norm(), 0.0, 1e-14);
    looks.near(sides[k].length_m, k < 2 ? 50.0 : w, 1e-12);
    looks.right(sides[k].zone == zones[k]);
    looks.near((sides[k].at(7.0, 3.0) - beside(plan, k, 7.0, 3.0)).norm(), 0.0, 1e-12);
  }
  return looks.figure();
}

/// A pole every 26 m from 12 m on, on the right side 13 m later, as long as 12 m of the side are left; 0.6 m beyond the
/// kerb, 14 cm square, from 0.3 m in the ground to 8 m above it.
StressFigure poles() {
  Looks looks;
  const city::Plan plan = star_of_streets(7, Zone::kOpen);
  SceneParts parts = made::nothing();
  city::add_poles(tilted_city(), plan, city::Terrain(tilted_city()), parts);
  std::uint32_t object = 0;
  const auto corners = corners_by_object(parts, "metal");
  for (std::size_t side = 0; side < 14; ++side)
    // 12, 38, ... 246 and 25, 51, ... 233: both end before 250.
    for (int j = 0; j < (side % 2 == 0 ? 10 : 9); ++j, ++object) {
      if (object >= parts.objects.size()) return {kInfinity, 1.0};
      const Vector2d at = beside(plan, side, (side % 2 == 0 ? 12.0 : 25.0) + 26.0 * j, 7.0 + 0.6);
      const double ground_m = tilted_ground_m(at);
      const Span3 box = span_of(corners[object], {at.x(), at.y(), ground_m}, Eigen::Matrix3d::Identity());
      looks.near((box.low - Vector3d(-0.07, -0.07, -0.3)).norm(), 0.0, kCornerGrain_m);
      looks.near((box.high - Vector3d(0.07, 0.07, 8.0)).norm(), 0.0, kCornerGrain_m);
      looks.right(parts.objects[object].name == "pole " + std::to_string(object + 1) &&
                  parts.objects[object].kind == ObjectKind::kPole);
    }
  looks.right(object == parts.objects.size());
  return looks.figure();
}

/// A slot every 6.5 m from 15 m on, as many as end before the last 15 m: 35. A vehicle in as many as the zone says,
/// within 0.6 m of the slot's middle, 8 to 16 cm from the kerb, upright to the ground, its cabin 0.2 m aft.
StressFigure parked_vehicles(Zone zone, double share) {
  Looks looks;
  constexpr int kStreets = 24, kSlots = 35;
  const city::Plan plan = star_of_streets(kStreets, zone);
  SceneParts parts = made::nothing();
  city::add_vehicles(tilted_city(), plan, city::Terrain(tilted_city()), parts);
  const auto bodies = corners_by_object(parts, "painted_metal"), cabins = corners_by_object(parts, "glass");
  UniformLaw off_middle(-0.6, 0.6, 1e-4), off_kerb(0.08, 0.16, 1e-4);
  const Vector3d up = Vector3d(-0.04 * std::sqrt(0.5), -0.04 * std::sqrt(0.5), 1.0).normalized();
  std::size_t object = 0;
  for (std::size_t side = 0; side < 2 * kStreets; ++side)
    for (int slot = 0; slot < kSlots && object < bodies.size(); ++slot) {
      const auto& corners = bodies[object];
      if (corners.empty()) return {kInfinity, 1.0};
      Vector3d middle = Vector3d::Zero();  // each corner of a box is in three quads; four or five triangles
      const Span3 around = span_of(corners, Vector3d::Zero(), Eigen::Matrix3d::Identity());
      middle = 0.5 * (around.low + around.high) - 0.55 * up;
      const Vector2d start = beside(plan, side, 0.0, 0.0), way = beside(plan, side, 1.0, 0.0) - start,
                     across = beside(plan, side, 0.0, 1.0) - start, off = middle.head<2>() - start;
      const double along_m = off.dot(way) - (15.0 + 6.5 * (slot + 0.5)), across_m = off.dot(across);
      if (!(std::abs(along_m) < 0.601 && std::abs(across_m - 6.0) < 0.5)) continue;  // none in this slot
      off_middle.take(along_m), off_kerb.take(7.0 - 0.9 - across_m);
      looks.near(middle.z(), tilted_ground_m(middle.head<2>()), kCornerGrain_m);
      Eigen::Matrix3d axes;
      axes.col(1) = up.cross(Vector3d(way.x(), way.y(), 0.0)).normalized();
      axes.col(2) = up, axes.col(0) = axes.col(1).cross(up);
      // The slope of the ground is told by heights in single precision, 4 m apart.
      const double grain_m = 2.0 * kCornerGrain_m;
      const Span3 body = span_of(corners, middle, axes), cabin = span_of(cabins[object], middle, axes);
      looks.near((body.low - Vector3d(-2.25, -0.9, 0.2)).norm(), 0.0, grain_m);
      looks.near((body.high - Vector3d(2.25, 0.9, 0.9)).norm(), 0.0, grain_m);
      looks.near((cabin.low - Vector3d(-1.4, -0.78, 0.9)).norm(), 0.0, grain_m);
      looks.near((cabin.high - Vector3d(1.0, 0.78, 1.5)).norm(), 0.0, grain_m);
      looks.right(parts.objects[object].name == "vehicle " + std::to_string(object + 1) &&
                  parts.objects[object].kind == ObjectKind::kVehicle);
      ++object;
    }
  looks.right(object == parts.objects.size());
  look_at_share(looks, static_cast<double>(object), 2.0 * kStreets * kSlots, share);
  off_middle.look_at(looks), off_kerb.look_at(looks);
  return looks.figure();
}

/// A place every 13 m from 12 m on, 18 of them, a tree at as many as the zone says: 1.3 m beyond the kerb, its crown
/// 4.9 to 5.6 m above the ground, 1.3 to 1.7 m wide and 1.6 to 2 m high.
StressFigure street_trees(Zone zone, double share) {
  Looks looks;
  constexpr int kStreets = 30, kPlaces = 18;
  const city::Plan plan = star_of_streets(kStreets, zone);  // a block of 2 m has no room for trees
  SceneParts parts = made::nothing();
  city::add_trees(tilted_city(), plan, city::Terrain(tilted_city()), parts);
  UniformLaw wide(1.3, 1.7, 1e-9), tall(1.6, 2.0, 1e-9), up(4.9, 5.6, 1e-6);
  std::size_t tree = 0;
  for (std::size_t side = 0; side < 2 * kStreets; ++side)
    for (int j = 0; j < kPlaces && tree < parts.foliage.size(); ++j) {
      const Foliage& crown = parts.foliage[tree];
      const Vector2d at = beside(plan, side, 12.0 + kBetween_m * (j + 0.5), 7.0 + 1.3);
      if ((crown.center_W.head<2>() - at).norm() > 1e-9) continue;
      up.take(crown.center_W.z() - tilted_ground_m(at));
      wide.take(crown.radii_m.x()), tall.take(crown.radii_m.z());
      looks.right(crown.radii_m.x() == crown.radii_m.y());
      looks.right(parts.objects[tree].name == "tree " + std::to_string(tree + 1) &&
                  parts.objects[tree].kind == ObjectKind::kTree);
      ++tree;
    }
  looks.right(tree == parts.foliage.size() && tree == parts.objects.size());
  look_at_share(looks, static_cast<double>(tree), 2.0 * kStreets * kPlaces, share);
  wide.look_at(looks), tall.look_at(looks), up.look_at(looks);
  return looks.figure();
}

/// Blocks of 91 m by 71 m have 80 m by 60 m for trees, one for so much of it, anywhere in it. With a house in the way
/// those are left out whose crown comes within half a metre of it, and no other.
StressFigure trees_of_blocks(Zone zone, int each) {
  Looks looks;
  city::Plan plan;
  constexpr int kBlocks = 12;
  const auto west_m = [](int b) { return -190.0 + 100.0 * (b % 4); };
  const auto south_m = [](int b) { return -150.0 + 100.0 * (b / 4); };
  for (int b = 0; b < kBlocks; ++b)
    plan.blocks.push_back({{west_m(b), south_m(b), west_m(b) + 91.0, south_m(b) + 71.0}, zone});
  const city::Terrain terrain(tilted_city());
  SceneParts free = made::nothing(), built = made::nothing();
  for (int b = 0; b < kBlocks; ++b) {
    Building house;
    house.footprint_W = {
        {west_m(b) + 30, south_m(b) + 20}, {west_m(b) + 52, south_m(b) + 14}, {west_m(b) + 60, south_m(b) + 40}};
    built.buildings.push_back(house);
  }
  city::add_trees(tilted_city(), plan, terrain, free), city::add_trees(tilted_city(), plan, terrain, built);
  looks.near(static_cast<double>(free.foliage.size()), each * kBlocks, 0.5);
  UniformLaw x(0.0, 80.0, 1e-9), y(0.0, 60.0, 1e-9), wide(1.8, 3.5, 1e-9), tall(2.0, 3.2, 1e-9), up(5.5, 7.0, 1e-6);
  std::size_t left = 0;
  for (std::size_t k = 0; k < free.foliage.size(); ++k) {
    const Foliage& crown = free.foliage[k];
    const int b = static_cast<int>(k) / each;
    const Vector2d at = crown.center_W.head<2>(), in = at - Vector2d(west_m(b), south_m(b));
    x.take(in.x() - 5.5), y.take(in.y() - 5.5);
    wide.take(crown.radii_m.x()), tall.take(crown.radii_m.z());
    up.take(crown.center_W.z() - tilted_ground_m(at));
    looks.right(crown.radii_m.x() == crown.radii_m.y());
    // Of the rectangle around the house of its block; the others are 9 m and more away.
    const double dx = in.x() < 30.0   ? 30.0 - in.x()
                      : in.x() > 60.0 ? in.x() - 60.0
                                      : 0.0,
                 dy = in.y() < 14.0   ? 14.0 - in.y()
                      : in.y() > 40.0 ? in.y() - 40.0
                                      : 0.0;
    if (std::hypot(dx, dy) < crown.radii_m.x() + 0.5) continue;
    looks.right(left < built.foliage.size() && built.foliage[left].center_W == crown.center_W &&
                built.foliage[left].radii_m == crown.radii_m);
    ++left;
  }
  looks.right(left == built.foliage.size() && left < free.foliage.size());
  if (each * kBlocks >= 60)
    x.look_at(looks), y.look_at(looks), wide.look_at(looks), tall.look_at(looks), up.look_at(looks);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> street_thing_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "what stands along streets of any direction",
           .why = "a place counted from the other end or side, a measure or share of another zone, x for y",
           .expected = "places and measures as they are said, single precision of 200 m; shares and drawn numbers by "
                       "their laws to 5 sigma, their ends to 16 mean distances",
           .unit = "of the bound",
           .loose = "some bounds are those of laws, others of roundings"});
  const struct {
    const char* name;
    Zone zone;
    double vehicles, trees;
    int in_a_block;
  } zones[] = {{"tall", Zone::kTall, 0.45, 0.25, 1},
               {"middle", Zone::kMiddle, 0.35, 0.4, 5},
               {"low", Zone::kLow, 0.2, 0.5, 9},
               {"open", Zone::kOpen, 0.05, 0.4, 18}};
  rows.add("street_things/sides", sides_of_streets).add("street_things/poles", poles);
  for (const auto& z : zones) {
    rows.add(std::string("street_things/vehicles_in_a_zone_") + z.name,
             [z] { return parked_vehicles(z.zone, z.vehicles); });
    rows.add(std::string("street_things/street_trees_in_a_zone_") + z.name,
             [z] { return street_trees(z.zone, z.trees); });
    rows.add(std::string("street_things/trees_of_blocks_in_a_zone_") + z.name,
             [z] { return trees_of_blocks(z.zone, z.in_a_block); });
  }
  return rows.take();
}

}  // namespace canyon::scene
