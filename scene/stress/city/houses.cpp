// Houses on blocks of each kind, many at once: how plots are cut, how far houses stand from streets and neighbours,
// their shapes, heights and materials.
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/stress/looks.h"
#include "canyon/scene/city/buildings.h"
#include "canyon/scene/stress/city/drawn_laws.h"
#include "canyon/scene/stress/city/subjects.h"
#include "canyon/scene/stress/made_scenes.h"

namespace canyon::scene {
namespace {

using city::Zone;
using Eigen::Vector2d;
using Eigen::Vector3d;
using made::look_at_share;
using made::UniformLaw;
using stress::kHalfUlp;
using stress::kInfinity;
using stress::Looks;

/// What a zone is said to have.
struct ZoneOfHouses {
  const char* name;
  Zone zone;
  double setback_low, setback_high;  ///< from the sidewalk
  double gap_low, gap_high;          ///< from the border of the plot
  double l_share, built_share;
  std::map<std::string, double> walls;
  const char* roof;
};
const ZoneOfHouses kHouseZones[] = {
    {"tall",
     Zone::kTall,
     0.0,
     1.5,
     0.8,
     2.5,
     0.2,
     1.0,
     {{"glass", 0.45}, {"concrete", 0.4}, {"metal", 0.15}},
     "concrete"},
    {"middle",
     Zone::kMiddle,
     0.0,
     4.0,
     1.5,
     4.0,
     0.35,
     0.92,
     {{"concrete", 0.4}, {"brick", 0.35}, {"plasterboard", 0.1}, {"marble", 0.08}, {"glass", 0.07}},
     "roofing"},
    {"low", Zone::kLow, 4.0, 9.0, 3.0, 8.0, 0.2, 0.8, {{"brick", 0.55}, {"wood", 0.45}}, "roofing"}};

/// Blocks whose land, 3 m within the kerb, is 81 x 108 m: of plots of about 38, 33 or 30 m, two or three by three or
/// four. All in one place: what a block draws depends on its number alone.
constexpr int kHouseBlocks = 150;
constexpr double kLandX_m = 81.0, kLandY_m = 108.0, kWestOfLand_m = -40.0, kSouthOfLand_m = -50.0;
city::Plan blocks_of(Zone zone) {
  city::Plan plan;
  for (int k = 0; k < kHouseBlocks; ++k)
    plan.blocks.push_back(
        {{kWestOfLand_m - 3.0, kSouthOfLand_m - 3.0, kWestOfLand_m + kLandX_m + 3.0, kSouthOfLand_m + kLandY_m + 3.0},
         zone});
  plan.quarter = {0, 0, 0, 0};
  return plan;
}
CityConfig level_ground() {
  CityConfig config;
  config.seed = 77, config.extent_m = 300.0, config.terrain_cell_m = 20.0;
  config.slope_percent = config.hill_height_m = 0.0;
  return config;
}
struct Outline {
  Vector2d low, high;
};
Outline outline_of(const Building& b) {
  Outline out{b.footprint_W[0], b.footprint_W[0]};
  for (const Vector2d& p : b.footprint_W) out.low = out.low.cwiseMin(p), out.high = out.high.cwiseMax(p);
  return out;
}
/// Which of `count` plots along an axis something from `low` to `high` stands on: that of its middle.
int plot_of(double low, double high, double land_m, int count) {
  const int k = static_cast<int>(std::floor(0.5 * (low + high) / land_m * count));
  return k < 0 ? 0 : k >= count ? count - 1 : k;
}

/// Plots by the rounded quotient of land and wished edge; houses that stand at the border of the land set back as their
/// zone says, those between plots no nearer than the least gap to where the border may be, an eighth of a plot moved.
StressFigure plots_of(const ZoneOfHouses& z) {
  Looks looks;
  const double wished = z.zone == Zone::kTall ? 38.0 : z.zone == Zone::kMiddle ? 33.0 : 30.0;
  const int nx = static_cast<int>(std::round(kLandX_m / wished)), ny = static_cast<int>(std::round(kLandY_m / wished));
  const auto houses = city::planned_buildings(level_ground(), blocks_of(z.zone));
  // Houses of a block come plot by plot from the south-west: the next block begins where the plot goes back.
  UniformLaw setback(z.setback_low, z.setback_high, 1e-9);
  std::vector<int> on_plot(static_cast<std::size_t>(nx * ny), 0);
  int l_shapes = 0, wide_enough = 0;
  UniformLaw cut(0.35, 0.6, 1e-9);
  const double move_x = 0.12 * kLandX_m / nx, move_y = 0.12 * kLandY_m / ny;
  for (std::size_t n = 0; n < houses.size(); ++n) {
    const Building& b = houses[n];
    looks.right(b.name == "building " + std::to_string(n + 1) && b.base_m == 0.0 && b.height_m == 0.0);
    const Vector2d south_west(kWestOfLand_m, kSouthOfLand_m);
    Outline o = outline_of(b);
    o.low -= south_west, o.high -= south_west;
    const int i = plot_of(o.low.x(), o.high.x(), kLandX_m, nx), j = plot_of(o.low.y(), o.high.y(), kLandY_m, ny);
    ++on_plot[static_cast<std::size_t>(j * nx + i)];
    const Vector2d size = o.high - o.low;
    looks.right(size.x() > 6.0 - 1e-9 && size.y() > 6.0 - 1e-9);
    for (int axis = 0; axis < 2; ++axis) {
      const int k = axis == 0 ? i : j, count = axis == 0 ? nx : ny;
      const double land = axis == 0 ? kLandX_m : kLandY_m, move = axis == 0 ? move_x : move_y;
      const double before = o.low[axis], after = land - o.high[axis];
      const bool low = z.zone == Zone::kLow;
      if (k == 0) {
        setback.take(before);
      } else {
        looks.right(before > land * k / count - move + z.gap_low - 1e-9);
        if (!low) looks.right(before < land * k / count + move + z.gap_high + 1e-9);
      }
      if (k == count - 1) {
        if (!low || k > 0) setback.take(after);
      } else {
        looks.right(after > land * (count - 1 - k) / count - move + z.gap_low - 1e-9);
        if (!low || k > 0) looks.right(after < land * (count - 1 - k) / count + move + z.gap_high + 1e-9);
      }
      if (low) looks.right(size[axis] < (axis == 0 ? 17.0 : 13.0) + 1e-9);
    }
    if (!(size.x() > 9.0 && size.y() > 9.0)) {
      looks.right(b.footprint_W.size() == 4);
      continue;
    }
    ++wide_enough;
    double area = 0.0;
    for (std::size_t k = 0; k < b.footprint_W.size(); ++k) {
      const Vector2d &p = b.footprint_W[k], &q = b.footprint_W[(k + 1) % b.footprint_W.size()];
      area += 0.5 * (p.x() * q.y() - p.y() * q.x());
    }
    if (b.footprint_W.size() == 4) {
      looks.near(area, size.x() * size.y(), 1e-9);
      continue;
    }
    ++l_shapes;
    looks.right(b.footprint_W.size() == 6);
    // Corner 0 is the inner one; what is cut out lies towards the middle of the block, a share of each side.
    const Vector2d inner = b.footprint_W[0] - south_west, middle = 0.5 * (o.low + o.high),
                   towards(0.5 * kLandX_m, 0.5 * kLandY_m);
    double out = 1.0;
    for (int axis = 0; axis < 2; ++axis) {
      const double share =
          (towards[axis] > middle[axis] ? o.high[axis] - inner[axis] : inner[axis] - o.low[axis]) / size[axis];
      cut.take(share), out *= share;
    }
    looks.near(area, size.x() * size.y() * (1.0 - out), 1e-9);
    for (const Vector2d& p : b.footprint_W)  // none stands in the corner that is cut out
      looks.right(!((p - south_west - inner).dot(Vector2d(towards.x() > middle.x() ? 1 : -1, 0)) > 1e-9 &&
                    (p - south_west - inner).dot(Vector2d(0, towards.y() > middle.y() ? 1 : -1)) > 1e-9));
  }
  for (const int n : on_plot) look_at_share(looks, n, kHouseBlocks, z.built_share);
  look_at_share(looks, l_shapes, wide_enough, z.l_share);
  setback.look_at(looks), cut.look_at(looks);
  looks.right(city::planned_buildings(level_ground(), blocks_of(Zone::kOpen)).empty());
  return looks.figure();
}

/// On level ground: heights by their law, walls and roofs of as many of each material as is said; flat roofs, gables
/// of low houses that are no L, rooms on high roofs that are none; bottoms half a metre in the ground. What is planned
/// before there is ground is what is built.
StressFigure houses_as_built(const ZoneOfHouses& z) {
  Looks looks;
  const city::Plan plan = blocks_of(z.zone);
  SceneParts parts = made::nothing();
  city::add_buildings(level_ground(), plan, city::Terrain(level_ground()), parts);
  const auto planned = city::planned_buildings(level_ground(), plan);
  looks.right(planned.size() == parts.buildings.size() && parts.objects.size() == planned.size());
  struct Seen {
    std::string wall, roof;
    double top = -kInfinity, bottom = kInfinity, roof_low = kInfinity, roof_high = -kInfinity;
    double lies = 0.0;
  };
  std::vector<Seen> seen(parts.objects.size());
  for (std::uint32_t k = 0; k < parts.mesh.triangles.size(); ++k) {
    const Triangle t = Triangle::of(parts.mesh, k);
    const Vector3d n = 0.5 * (t.b - t.a).cross(t.c - t.a);
    Seen& s = seen[parts.mesh.object[k]];
    const std::string& name = parts.materials[parts.mesh.material[k]].name;
    const bool upright = std::abs(n.z()) < 1e-4 * n.norm();
    if (s.wall.empty()) s.wall = name;  // walls come first
    if (!upright && s.roof.empty()) s.roof = name;
    for (const Vector3d& p : {t.a, t.b, t.c}) {
      s.top = p.z() > s.top ? p.z() : s.top, s.bottom = p.z() < s.bottom ? p.z() : s.bottom;
      if (!upright && name == s.roof) {
        s.roof_low = p.z() < s.roof_low ? p.z() : s.roof_low;
        s.roof_high = p.z() > s.roof_high ? p.z() : s.roof_high;
      }
    }
    looks.right(upright || n.z() > 0.0);
    if (!upright && name == s.roof) s.lies += n.z();
  }
  std::map<std::string, double> walls;
  double law_low = z.zone == Zone::kTall     ? 25.0
                   : z.zone == Zone::kMiddle ? 10.0
                                             : 4.0,
         law_high = z.zone == Zone::kTall     ? 80.0
                    : z.zone == Zone::kMiddle ? 22.0
                                              : 9.0;
  // Of tall ones the root of the height over 25 m is uniform.
  UniformLaw heights(z.zone == Zone::kTall ? 0.0 : law_low, z.zone == Zone::kTall ? 1.0 : law_high, 1e-9);
  const double grain = 4.0 * kHalfUlp * 100.0;
  for (std::size_t n = 0; n < planned.size() && n < parts.buildings.size(); ++n) {
    const Building& b = parts.buildings[n];
    looks.right(b.name == planned[n].name && b.footprint_W == planned[n].footprint_W && b.base_m == 0.0);
    looks.right(parts.objects[b.object].name == b.name && parts.objects[b.object].kind == ObjectKind::kBuilding);
    heights.take(z.zone == Zone::kTall ? std::sqrt((b.height_m - 25.0) / 55.0) : b.height_m);
    const Seen& s = seen[b.object];
    ++walls[s.wall];
    looks.right(s.roof == z.roof);
    looks.near(s.bottom, -0.5, grain);
    const bool l = b.footprint_W.size() == 6;
    const Outline o = outline_of(b);
    const Vector2d size = o.high - o.low;
    double area = 0.0;
    for (std::size_t k = 0; k < b.footprint_W.size(); ++k) {
      const Vector2d &p = b.footprint_W[k], &q = b.footprint_W[(k + 1) % b.footprint_W.size()];
      area += 0.5 * (p.x() * q.y() - p.y() * q.x());
    }
    looks.near(s.roof_high, b.height_m, grain);
    const double short_m = size.x() < size.y() ? size.x() : size.y();
    // A gable rises by 0.35 of half the shorter side, and 0.3 m; its two slopes cover the house.
    looks.near(s.roof_low, b.height_m - (z.zone == Zone::kLow && !l ? 0.175 * short_m + 0.3 : 0.0), grain);
    looks.near(s.top, b.height_m + (z.zone == Zone::kTall && !l ? 3.0 : 0.0), grain);
    // Roofs of metal-walled tall houses are of concrete as well; rooms on roofs have their own.
    looks.near(s.lies, area, 1e-4 * area);
  }
  const double count = static_cast<double>(planned.size());
  double named = 0.0;
  for (const auto& [name, share] : z.walls) look_at_share(looks, walls[name], count, share), named += walls[name];
  looks.near(named, count, 0.5);
  heights.look_at(looks);
  return looks.figure();
}

/// The ridge runs along the longer side: of a gabled house the two corners of the ridge lie in the middles of its
/// shorter sides, and its gables are of its walls. On a slope the height holds on the uphill side, bottoms below the
/// downhill one: the span of the ground under the house.
StressFigure houses_on_a_slope() {
  Looks looks;
  CityConfig config = level_ground();
  config.slope_percent = 8.0;
  const city::Plan plan = blocks_of(Zone::kLow);
  const city::Terrain terrain(config);
  SceneParts parts = made::nothing(), level = made::nothing();
  city::add_buildings(config, plan, terrain, parts);
  city::add_buildings(level_ground(), plan, city::Terrain(level_ground()), level);
  const double rise = 0.08 / std::sqrt(2.0), grain = 8.0 * kHalfUlp * 100.0;
  std::vector<std::vector<Vector3d>> ridges(parts.objects.size());
  std::vector<double> high(parts.objects.size(), -kInfinity);
  for (const int pass : {0, 1})
    for (std::uint32_t k = 0; k < parts.mesh.triangles.size(); ++k) {
      const Triangle t = Triangle::of(parts.mesh, k);
      for (const Vector3d& p : {t.a, t.b, t.c}) {
        double& top = high[parts.mesh.object[k]];
        if (pass == 0) top = p.z() > top ? p.z() : top;
        if (pass == 1 && p.z() > top - grain) ridges[parts.mesh.object[k]].push_back(p);
      }
    }
  int gabled = 0;
  looks.right(parts.buildings.size() == level.buildings.size());
  for (std::size_t n = 0; n < parts.buildings.size() && n < level.buildings.size(); ++n) {
    const Building& b = parts.buildings[n];
    const Outline o = outline_of(b);
    const Vector2d size = o.high - o.low, middle = 0.5 * (o.low + o.high);
    looks.near(b.base_m, rise * o.low.sum(), grain);
    looks.near(b.height_m, level.buildings[n].height_m + rise * size.sum(), 2.0 * grain);
    looks.near(high[b.object], b.base_m + b.height_m, grain);
    if (b.footprint_W.size() != 4) continue;
    ++gabled;
    const bool along_x = size.x() >= size.y();
    for (const Vector3d& p : ridges[b.object]) {
      const Vector2d off = p.head<2>() - middle;
      looks.near(along_x ? off.y() : off.x(), 0.0, grain);
      looks.near(std::abs(along_x ? off.x() : off.y()), 0.5 * (along_x ? size.x() : size.y()), grain);
    }
    // Each end is in a gable, twice in one slope and once in the other, or the other way round.
    looks.right(ridges[b.object].size() == 8);
  }
  looks.right(gabled > 500);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> house_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "houses of blocks of each kind",
           .why = "a setback taken for a gap, a corner cut out at the street, a share or material of another zone",
           .expected = "shapes exactly, shares and drawn numbers by their laws: 5 sigma, ends to 16 mean distances",
           .unit = "of the bound",
           .loose = "some bounds are those of laws, others of roundings"});
  for (const ZoneOfHouses& z : kHouseZones)
    rows.add(std::string("houses/plots_of_a_zone_") + z.name, [&z] { return plots_of(z); })
        .add(std::string("houses/as_built_in_a_zone_") + z.name, [&z] { return houses_as_built(z); });
  rows.add("houses/on_a_slope", houses_on_a_slope);
  return rows.take();
}

}  // namespace canyon::scene
