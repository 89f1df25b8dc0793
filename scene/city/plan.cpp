#include "canyon/scene/city/plan.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/scene/city/draws.h"

namespace canyon::scene::city {
namespace {

constexpr double kRim_m = 30.0;  // from the outermost street's centre line to the edge of the square

/// Positions of parallel streets: `count` blocks of varied size between the rims.
std::vector<double> street_lines(const CityConfig& config, const RandomStream& stream, std::uint32_t direction) {
  const double length_m = config.extent_m - 2.0 * kRim_m;
  const int count = std::max(1, static_cast<int>(std::lround(length_m / config.block_m)));
  std::vector<double> at{0.0};
  for (int i = 0; i < count; ++i)
    at.push_back(at.back() + stream.uniform(0.8, 1.2, direction, static_cast<std::uint64_t>(i)));
  const double total = at.back();
  for (double& x : at) x = -0.5 * length_m + length_m * x / total;
  return at;
}

Zone zone_of(const Block& block, int ring, const Rectangle& quarter, Draws draws) {
  const Eigen::Vector2d offset = (block.kerb.center() - quarter.center()).cwiseAbs();
  const double from_center = std::max(offset.x(), offset.y()) / (0.5 * quarter.width());  // 1 at the quarter's border
  const double open_share = ring == 0 ? 0.7 : ring == 1 ? 0.15 : 0.05;
  const bool open = draws.chance(open_share);
  if (from_center < 1.0) return Zone::kTall;
  if (open) return Zone::kOpen;
  return from_center + draws.between(-0.3, 0.3) < 2.1 ? Zone::kMiddle : Zone::kLow;
}

/// All nodes still reachable from the first?
bool connected(const StreetGraph& streets) {
  std::vector<std::vector<std::uint32_t>> next(streets.nodes_W.size());
  for (const auto& e : streets.edges) {
    next[e.a].push_back(e.b);
    next[e.b].push_back(e.a);
  }
  std::vector<bool> seen(next.size(), false);
  std::vector<std::uint32_t> open{0};
  seen[0] = true;
  std::size_t count = 0;
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    ++count;
    for (const std::uint32_t n : next[node]) {
      if (!seen[n]) {
        seen[n] = true;
        open.push_back(n);
      }
    }
  }
  return count == next.size();
}

/// Leaves out some streets away from the rim and the tall quarter, as long as no dead end and no island appears.
void drop_streets(StreetGraph& streets, const Rectangle& quarter, double rim, const RandomStream& stream) {
  constexpr double kShare = 0.08;
  const std::vector<StreetGraph::Edge> all = streets.edges;
  for (std::size_t i = 0; i < all.size(); ++i) {
    throw_if_cancelled();
    const auto is_this = [&](const StreetGraph::Edge& e) { return e.a == all[i].a && e.b == all[i].b; };
    const Eigen::Vector2d &a = streets.nodes_W[all[i].a], &b = streets.nodes_W[all[i].b];
    const Eigen::Vector2d middle = 0.5 * (a + b);
    const bool at_rim = middle.cwiseAbs().maxCoeff() > rim - 1.0;
    const Rectangle keep = quarter.inset(-60.0);
    const bool in_quarter =
        middle.x() > keep.x0 && middle.x() < keep.x1 && middle.y() > keep.y0 && middle.y() < keep.y1;
    if (stream.uniform(0, i) >= kShare || at_rim || in_quarter) continue;
    const auto degree = [&](std::uint32_t node) {
      return std::count_if(streets.edges.begin(), streets.edges.end(),
                           [&](const auto& e) { return e.a == node || e.b == node; });
    };
    if (degree(all[i].a) < 3 || degree(all[i].b) < 3) continue;
    StreetGraph fewer = streets;
    fewer.edges.erase(std::find_if(fewer.edges.begin(), fewer.edges.end(), is_this));
    if (connected(fewer)) streets = std::move(fewer);
  }
}

}  // namespace

Zone Plan::zone_near(const Eigen::Vector2d& p) const {
  double best = 1e300;
  Zone zone = Zone::kOpen;
  for (const Block& b : blocks) {
    const double dx = std::max({b.kerb.x0 - p.x(), 0.0, p.x() - b.kerb.x1});
    const double dy = std::max({b.kerb.y0 - p.y(), 0.0, p.y() - b.kerb.y1});
    if (dx * dx + dy * dy < best) {
      best = dx * dx + dy * dy;
      zone = b.zone;
    }
  }
  return zone;
}

Plan make_plan(const CityConfig& config) {
  const auto seed = static_cast<std::uint64_t>(config.seed);
  const RandomStream line_stream(seed, "scene.city.streets"), zone_stream(seed, "scene.city.zones"),
      drop_stream(seed, "scene.city.dropped");
  const std::vector<double> xs = street_lines(config, line_stream, 0), ys = street_lines(config, line_stream, 1);
  const auto columns = static_cast<std::uint32_t>(xs.size()), rows = static_cast<std::uint32_t>(ys.size());

  Plan plan;
  const double half_quarter_m = 0.15 * config.extent_m, quarter_at_m = 0.17 * config.extent_m;
  const double qx = zone_stream.uniform(0, 1u << 20) < 0.5 ? -quarter_at_m : quarter_at_m;
  const double qy = zone_stream.uniform(1, 1u << 20) < 0.5 ? -quarter_at_m : quarter_at_m;
  plan.quarter = {qx - half_quarter_m, qy - half_quarter_m, qx + half_quarter_m, qy + half_quarter_m};

  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t node = j * columns + i;
      plan.streets.nodes_W.emplace_back(xs[i], ys[j]);
      if (i > 0) plan.streets.edges.push_back({node - 1, node, config.street_width_m});
      if (j > 0) plan.streets.edges.push_back({node - columns, node, config.street_width_m});
    }
  }
  const double half_street_m = 0.5 * config.street_width_m;
  for (std::uint32_t j = 0; j + 1 < rows; ++j) {
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const int ring = static_cast<int>(std::min({i, j, columns - 2 - i, rows - 2 - j}));
      Block block{Rectangle{xs[i], ys[j], xs[i + 1], ys[j + 1]}.inset(half_street_m), Zone::kOpen};
      block.zone = zone_of(block, ring, plan.quarter, Draws(zone_stream, i, j));
      plan.blocks.push_back(block);
    }
  }
  drop_streets(plan.streets, plan.quarter, xs.back(), drop_stream);
  return plan;
}

}  // namespace canyon::scene::city
