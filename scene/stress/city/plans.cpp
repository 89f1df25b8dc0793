// Streets, blocks and zones of the built-in city, over many seeds and sizes; and what is known of its site beforehand.
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/scene/city/plan.h"
#include "canyon/scene/city/site.h"
#include "canyon/scene/stress/city/drawn_laws.h"
#include "canyon/scene/stress/city/subjects.h"
#include "canyon/scene/stress/made_scenes.h"

namespace canyon::scene {
namespace {

using city::Zone;
using Eigen::Vector2d;
using Eigen::Vector3d;
using made::look_at_share;
using stress::Looks;

CityConfig city_of(std::int64_t seed, double extent_m, double block_m, double street_m) {
  CityConfig config;
  config.seed = seed, config.extent_m = extent_m, config.block_m = block_m, config.street_width_m = street_m;
  return config;
}

/// The grid of a plan from its nodes: lines of columns and rows.
struct Grid2 {
  std::vector<double> x, y;
};
Grid2 grid_of(const city::Plan& plan) {
  std::set<double> x, y;
  for (const Vector2d& n : plan.streets.nodes_W) x.insert(n.x()), y.insert(n.y());
  return {{x.begin(), x.end()}, {y.begin(), y.end()}};
}

/// As many blocks as the wished edge fits in, rounded, between rims of 30 m; sides that are drawn from 0.8 to 1.2 of
/// one another; every block within its four lines less half a street, row by row from the south-west; nodes in the
/// same order.
StressFigure grids_of_streets() {
  Looks looks;
  double neighbours = 0.0, squares = 0.0, fourths = 0.0, least = 9.0, most = 0.0;
  const struct {
    double extent_m, block_m;
    std::size_t blocks;
  } sizes[] = {{1000.0, 90.0, 10}, {300.0, 60.0, 4}, {1500.0, 200.0, 7}, {700.0, 183.0, 3}, {310.0, 171.0, 1}};
  for (std::int64_t seed = 0; seed < 24; ++seed)
    for (const auto& s : sizes) {
      const city::Plan plan = city::make_plan(city_of(seed, s.extent_m, s.block_m, 14.0));
      const Grid2 grid = grid_of(plan);
      const std::size_t n = s.blocks;
      looks.right(grid.x.size() == n + 1 && grid.y.size() == n + 1 && plan.blocks.size() == n * n &&
                  plan.streets.nodes_W.size() == (n + 1) * (n + 1));
      if (grid.x.size() != n + 1 || grid.y.size() != n + 1 || plan.blocks.size() != n * n) continue;
      const double half_m = 0.5 * s.extent_m;
      for (const std::vector<double>& line : {grid.x, grid.y}) {
        looks.near(line.front(), 30.0 - half_m, 1e-10), looks.near(line.back(), half_m - 30.0, 1e-10);
        for (std::size_t k = 0; k + 2 < line.size(); ++k) {
          const double ratio = (line[k + 1] - line[k]) / (line[k + 2] - line[k + 1]),
                       log2 = std::pow(std::log(ratio), 2);
          least = ratio < least ? ratio : least, most = ratio > most ? ratio : most;
          neighbours += 1.0, squares += log2, fourths += log2 * log2;
        }
      }
      for (std::size_t j = 0; j <= n; ++j)
        for (std::size_t i = 0; i <= n; ++i)
          looks.near((plan.streets.nodes_W[j * (n + 1) + i] - Vector2d(grid.x[i], grid.y[j])).norm(), 0.0, 1e-12);
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i) {
          const city::Rectangle& kerb = plan.blocks[j * n + i].kerb;
          looks.near(kerb.x0, grid.x[i] + 7.0, 1e-10), looks.near(kerb.x1, grid.x[i + 1] - 7.0, 1e-10);
          looks.near(kerb.y0, grid.y[j] + 7.0, 1e-10), looks.near(kerb.y1, grid.y[j + 1] - 7.0, 1e-10);
        }
      for (const auto& e : plan.streets.edges) looks.near(e.width_m, 14.0, 1e-300);
    }
  // Of u uniform from 0.8 to 1.2: the variance of ln u from its two first moments, twice that for a quotient.
  const auto first = [](double u) { return u * std::log(u) - u; };
  const auto second = [](double u) { return u * (std::log(u) * std::log(u) - 2.0 * std::log(u) + 2.0); };
  const double mean = (first(1.2) - first(0.8)) / 0.4, square = (second(1.2) - second(0.8)) / 0.4;
  // Neighbours share a side, which makes their mean less certain, by no more than sqrt(3); 5 sigma.
  const double sigma = std::sqrt((fourths / neighbours - std::pow(squares / neighbours, 2)) / neighbours);
  looks.near(squares / neighbours, 2.0 * (square - mean * mean), 5.0 * std::sqrt(3.0) * sigma);
  looks.right(least >= 0.8 / 1.2 - 1e-12 && most <= 1.2 / 0.8 + 1e-12);
  // The ends of a quotient are rare: at a hundredth of them there are some 2 e-4 of all.
  looks.right(least < 0.75 && most > 1.34);
  return looks.figure();
}

/// Which streets are left out: 8 of 100 of those that are not at the rim, nor within 60 m of the tall quarter; none
/// that leaves a dead end, and nothing that leaves an island. What remains is in its order.
StressFigure streets_left_out() {
  Looks looks;
  double may = 0.0, dropped = 0.0, spared = 0.0;
  for (std::int64_t seed = 100; seed < 130; ++seed) {
    const city::Plan plan = city::make_plan(city_of(seed, 1000.0, 70.0, 12.0));
    const Grid2 grid = grid_of(plan);
    const auto n = static_cast<std::uint32_t>(grid.x.size());
    std::set<std::pair<std::uint32_t, std::uint32_t>> there;
    std::vector<int> degree(plan.streets.nodes_W.size(), 0);
    for (const auto& e : plan.streets.edges) {
      there.insert({e.a, e.b}), ++degree[e.a], ++degree[e.b];
      looks.right(e.b == e.a + 1 || e.b == e.a + n);
    }
    for (const int d : degree) looks.right(d >= 2);
    // A wave from the first node reaches all.
    std::vector<std::uint32_t> wave = {0};
    std::set<std::uint32_t> reached = {0};
    while (!wave.empty()) {
      const std::uint32_t at = wave.back();
      wave.pop_back();
      for (const auto& [a, b] : there)
        if ((a == at && reached.insert(b).second) || (b == at && reached.insert(a).second))
          wave.push_back(a == at ? b : a);
    }
    looks.right(reached.size() == degree.size());
    const auto decide = [&](std::uint32_t a, std::uint32_t b) {
      const Vector2d m = 0.5 * (plan.streets.nodes_W[a] + plan.streets.nodes_W[b]);
      const bool at_rim = std::abs(m.x()) > 469.0 || std::abs(m.y()) > 469.0;
      const Vector2d off = (m - plan.quarter.center()).cwiseAbs();
      const bool near_quarter = off.x() < 150.0 + 60.0 && off.y() < 150.0 + 60.0;
      const bool is_there = there.count({a, b}) == 1;
      if (at_rim || near_quarter) {
        looks.right(is_there);
        spared += 1.0;
      } else {
        may += 1.0, dropped += is_there ? 0.0 : 1.0;
      }
    };
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        if (i > 0) decide(j * n + i - 1, j * n + i);
        if (j > 0) decide((j - 1) * n + i, j * n + i);
      }
  }
  // A street stays where another three of the seven at an end went before it, or one of three at the rim: of 100 that
  // should go no more than 8 do not.
  const double sigma = std::sqrt(may * 0.08 * 0.92);
  looks.right(dropped < 0.08 * may + 5.0 * sigma && dropped > 0.92 * 0.08 * may - 5.0 * sigma);
  looks.right(may > 4000.0 && spared > 2000.0);
  return looks.figure();
}

/// Zones by where a block lies: tall within the quarter, which is 0.3 of the city wide and lies 0.17 of it off the
/// middle, in any of four directions; outside 70, 15 and 5 of 100 open, from the rim inwards; of the others the
/// middling end about 2.1 half quarters from its middle, drawn from 1.8 to 2.4.
StressFigure zones_of_blocks() {
  Looks looks;
  double open[3] = {0, 0, 0}, of[3] = {0, 0, 0}, expected = 0.0, variance = 0.0, middling = 0.0, east = 0.0,
         north = 0.0;
  constexpr int kSeeds = 60;
  for (std::int64_t seed = 0; seed < kSeeds; ++seed) {
    const city::Plan plan = city::make_plan(city_of(seed, 1000.0, 80.0, 12.0));
    const Vector2d middle = plan.quarter.center();
    looks.near(std::abs(middle.x()), 170.0, 1e-10), looks.near(std::abs(middle.y()), 170.0, 1e-10);
    looks.near(plan.quarter.width(), 300.0, 1e-10), looks.near(plan.quarter.depth(), 300.0, 1e-10);
    east += middle.x() > 0.0 ? 1.0 : 0.0, north += middle.y() > 0.0 ? 1.0 : 0.0;
    const int n = static_cast<int>(std::sqrt(static_cast<double>(plan.blocks.size())) + 0.5);
    for (int k = 0; k < n * n; ++k) {
      const city::Block& block = plan.blocks[static_cast<std::size_t>(k)];
      const Vector2d off = (block.kerb.center() - middle).cwiseAbs() / 150.0;
      const double far = worse(off.x(), off.y());
      looks.right((block.zone == Zone::kTall) == (far < 1.0));
      if (far < 1.0) continue;
      const int i = k % n, j = k / n;
      int ring = i < j ? i : j;
      ring = n - 1 - i < ring ? n - 1 - i : ring;
      ring = n - 1 - j < ring ? n - 1 - j : ring;
      ring = ring > 2 ? 2 : ring;
      of[ring] += 1.0, open[ring] += block.zone == Zone::kOpen ? 1.0 : 0.0;
      if (block.zone == Zone::kOpen) continue;
      const double chance = far < 1.8 ? 1.0 : far > 2.4 ? 0.0 : (2.4 - far) / 0.6;
      if (chance == 0.0 || chance == 1.0) {
        looks.right((block.zone == Zone::kMiddle) == (chance == 1.0));
        continue;
      }
      expected += chance, variance += chance * (1.0 - chance), middling += block.zone == Zone::kMiddle ? 1.0 : 0.0;
    }
  }
  look_at_share(looks, open[0], of[0], 0.7);
  look_at_share(looks, open[1], of[1], 0.15);
  look_at_share(looks, open[2], of[2], 0.05);
  looks.near(middling, expected, 5.0 * std::sqrt(variance) + 1.0);
  look_at_share(looks, east, kSeeds, 0.5), look_at_share(looks, north, kSeeds, 0.5);
  // The zone of a point is that of the block it lies in or is nearest to, whatever the side.
  city::Plan two;
  two.blocks = {{{0, 0, 10, 10}, Zone::kTall}, {{20, 0, 30, 10}, Zone::kMiddle}, {{0, 30, 10, 40}, Zone::kLow}};
  const struct {
    Vector2d at;
    Zone zone;
  } places[] = {{{5, 5}, Zone::kTall},      {{14.9, 5}, Zone::kTall}, {{15.1, 5}, Zone::kMiddle},
                {{-9, -9}, Zone::kTall},    {{14, 18}, Zone::kTall},  {{16, 18}, Zone::kMiddle},
                {{5, 20.1}, Zone::kLow},    {{5, 19.9}, Zone::kTall}, {{12, 33}, Zone::kLow},
                {{40, -7}, Zone::kMiddle},  {{-3, 50}, Zone::kLow},   {{25, 60}, Zone::kLow},
                {{27, 26.0}, Zone::kMiddle}};
  for (const auto& p : places) looks.right(two.zone_near(p.at) == p.zone);
  looks.right(city::Plan().zone_near({0, 0}) == Zone::kOpen);
  const city::Rectangle r{1, 2, 5, 10};
  looks.right(r.width() == 4 && r.depth() == 8 && r.center() == Vector2d(3, 6) && r.inset(0.5).x0 == 1.5 &&
              r.inset(0.5).y0 == 2.5 && r.inset(0.5).x1 == 4.5 && r.inset(0.5).y1 == 9.5);
  for (const auto& [zone, number] : {std::pair(Zone::kTall, 1.0), std::pair(Zone::kMiddle, 2.0),
                                     std::pair(Zone::kLow, 3.0), std::pair(Zone::kOpen, 4.0)})
    looks.right(city::by_zone(zone, 1.0, 2.0, 3.0, 4.0) == number);
  return looks.figure();
}

/// What is known of a city before there is ground: its frame, its square, its streets, and the outlines of its houses,
/// the same as of the city when it is made; which keys its square follows from. A figure counts.
StressFigure sites() {
  int wrong = 0;
  const auto is = [&](bool right) { wrong += right ? 0 : 1; };
  SceneConfig config;
  config.city = city_of(4, 360.0, 90.0, 12.0), config.city.terrain_cell_m = 20.0;
  config.city.lat_deg = -12.0, config.city.lon_deg = 71.0, config.city.base_height_m = 345.0;
  const auto site = planned_site(config);
  is(site.has_value());
  if (!site) return {1.0 * wrong, 0.0};
  const Scene scene(make_city(config.city));
  const Site found = site_of(scene, config);
  is(site->low_W == Vector2d(-180, -180) && site->high_W == Vector2d(180, 180) &&
     site->extent_keys == "scene.extent_m");
  is(found.extent_keys == "scene.extent_m");
  is((found.low_W - site->low_W).norm() < 1e-4 && (found.high_W - site->high_W).norm() < 1e-4);
  is(found.buildings.size() == site->buildings.size() && !site->buildings.empty());
  for (std::size_t k = 0; k < found.buildings.size() && k < site->buildings.size(); ++k)
    is(found.buildings[k].name == site->buildings[k].name &&
       found.buildings[k].footprint_W == site->buildings[k].footprint_W);
  is(found.streets.edges.size() == site->streets.edges.size() && found.streets.nodes_W == site->streets.nodes_W);
  for (const LocalFrame* frame : {&site->frame, &found.frame}) {
    const Geodetic g = frame->to_geodetic(Vector3d::Zero());
    is(std::abs(g.lat_rad / kDegree + 12.0) < 1e-11 && std::abs(g.lon_rad / kDegree - 71.0) < 1e-11);
    is(std::abs(g.h_m - 345.0) < 1e-6);
  }
  is(site->contains({180, -180}) && site->contains({-180, 180}) && !site->contains({180.1, 0}));
  is(!site->contains({-180.1, 0}) && !site->contains({0, 180.1}) && !site->contains({0, -180.1}));
  config.city.empty = true;
  is(planned_site(config)->buildings.empty() && !planned_site(config)->streets.edges.empty());
  config.from.file = "a.obj";
  is(!planned_site(config).has_value() && extent_keys(config) == "scene.margin_m");
  config.from.center_deg = {1.0, 2.0};
  is(extent_keys(config) == "scene.margin_m, scene.center_deg");
  config.from.radius_m = 5.0;
  is(extent_keys(config) == "scene.margin_m, scene.center_deg, scene.radius_m");
  config.from.center_deg.clear();
  is(extent_keys(config) == "scene.margin_m, scene.radius_m");
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> city_plan_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "streets, blocks and zones of many cities",
           .why = "a rim taken once, rows for columns, a share of another ring, a street left out at the rim",
           .expected = "grids exactly; shares and drawn numbers by their laws to 5 sigma",
           .unit = "of the bound",
           .loose = "some bounds are those of laws, others of roundings"});
  rows.add("plans_of_cities/grids", grids_of_streets)
      .add("plans_of_cities/streets_left_out", streets_left_out)
      .add("plans_of_cities/zones", zones_of_blocks);
  rows.of({.group = StressGroup::kData,
           .mechanism = "what is known of a city beforehand",
           .why = "a square of the whole edge, a house under another number, a key that is not said",
           .expected = "what the city has when it is made: exact",
           .unit = "wrong"});
  rows.add("plans_of_cities/sites", sites);
  return rows.take();
}

}  // namespace canyon::scene
