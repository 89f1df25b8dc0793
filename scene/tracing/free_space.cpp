#include "canyon/scene/tracing/free_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "canyon/core/process/progress.h"
#include "canyon/scene/ground/ground_detail.h"
#include "canyon/scene/surfaces/triangulate.h"

namespace canyon::scene {
namespace {

constexpr double kClearance_m = 2.5, kHeadroom_m = 2.5, kKerb_m = 0.3;
constexpr double kStraight_m = 1.5, kDeadEnd_m = 25.0;

/// A grid over the terrain, seen from above.
struct Raster {
  double west_m = 0.0, south_m = 0.0, cell_m = 2.0;
  int columns = 0, rows = 0;

  std::size_t index(int c, int r) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c);
  }
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  Eigen::Vector2d center(int c, int r) const { return {west_m + (c + 0.5) * cell_m, south_m + (r + 0.5) * cell_m}; }
  int column(double x) const { return static_cast<int>(std::floor((x - west_m) / cell_m)); }
  int row(double y) const { return static_cast<int>(std::floor((y - south_m) / cell_m)); }
  bool inside(int c, int r) const { return c >= 0 && r >= 0 && c < columns && r < rows; }

  /// Cells whose centers a triangle covers from above, with its height there.
  template <class Body>
  void cover(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Body& body) const {
    const double det = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (std::abs(det) < 1e-9) return;
    const auto [x0, x1] = std::minmax({a.x(), b.x(), c.x()});
    const auto [y0, y1] = std::minmax({a.y(), b.y(), c.y()});
    for (int r = std::max(row(y0), 0); r <= std::min(row(y1), rows - 1); ++r) {
      for (int k = std::max(column(x0), 0); k <= std::min(column(x1), columns - 1); ++k) {
        const Eigen::Vector2d p = center(k, r);
        const double v = ((p.x() - a.x()) * (c.y() - a.y()) - (p.y() - a.y()) * (c.x() - a.x())) / det;
        const double w = ((b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x())) / det;
        if (v >= -1e-9 && w >= -1e-9 && v + w <= 1.0 + 1e-9)
          body(k, r, a.z() + v * (b.z() - a.z()) + w * (c.z() - a.z()));
      }
    }
  }
};

/// Wider scenes are looked at only near what stands: ground without anything has no middle lines, and what is asked of
/// it costs as much as the rest.
constexpr double kWide_m = 4000.0, kNear_m = 150.0;

std::array<Eigen::Vector3d, 3> corners(const Mesh& mesh, std::size_t i) {
  const auto& t = mesh.triangles[i];
  return {mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(), mesh.vertices[t[2]].cast<double>()};
}

Raster raster_of(const SceneParts& parts) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
  for (std::size_t i = 0; i < parts.mesh.triangles.size(); ++i) {
    if (parts.objects[parts.mesh.object[i]].kind != ObjectKind::kTerrain) continue;
    for (const Eigen::Vector3d& p : corners(parts.mesh, i)) {
      if (!p.allFinite()) continue;
      low = low.cwiseMin(p.head<2>());
      high = high.cwiseMax(p.head<2>());
    }
  }
  Raster raster;
  if (low.x() > high.x()) return raster;
  raster.cell_m = std::max(2.0, (high - low).maxCoeff() / 2000.0);
  raster.west_m = low.x(), raster.south_m = low.y();
  raster.columns = static_cast<int>((high.x() - low.x()) / raster.cell_m) + 1;
  raster.rows = static_cast<int>((high.y() - low.y()) / raster.cell_m) + 1;
  return raster;
}

/// True where nothing stands on the terrain.
std::vector<std::uint8_t> open_ground(const SceneParts& parts, const Raster& raster) {
  std::vector<double> ground_m(raster.size(), -std::numeric_limits<double>::infinity());
  const Mesh& mesh = parts.mesh;
  const auto kind = [&](std::size_t i) { return parts.objects[mesh.object[i]].kind; };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (kind(i) != ObjectKind::kTerrain) continue;
    throw_if_cancelled();
    const auto t = corners(mesh, i);
    raster.cover(t[0], t[1], t[2], [&](int c, int r, double z) {
      double& g = ground_m[raster.index(c, r)];
      g = std::max(g, z);
    });
  }
  std::vector<std::uint8_t> open(raster.size());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = std::isfinite(ground_m[i]) ? 1 : 0;
  const auto stand = [&](int c, int r, double z) {
    if (!raster.inside(c, r)) return;
    const std::size_t i = raster.index(c, r);
    if (z > ground_m[i] + kKerb_m && z < ground_m[i] + kHeadroom_m) open[i] = 0;
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (kind(i) == ObjectKind::kTerrain || kind(i) == ObjectKind::kTree) continue;
    throw_if_cancelled();
    const auto t = corners(mesh, i);
    if (!t[0].allFinite() || !t[1].allFinite() || !t[2].allFinite()) continue;
    raster.cover(t[0], t[1], t[2], stand);
    // Walls have no area from above: along their lower edges, at the height where a car would meet them.
    const double low_m = std::min({t[0].z(), t[1].z(), t[2].z()}), high_m = std::max({t[0].z(), t[1].z(), t[2].z()});
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d &a = t[k], &b = t[(k + 1) % 3];
      const int steps = std::clamp(static_cast<int>((b - a).head<2>().norm() / (0.5 * raster.cell_m)), 1, 4000);
      for (int s = 0; s <= steps; ++s) {
        const Eigen::Vector2d p = a.head<2>() + (b - a).head<2>() * s / steps;
        const int c = raster.column(p.x()), r = raster.row(p.y());
        if (!raster.inside(c, r)) continue;
        const double g = ground_m[raster.index(c, r)];
        if (low_m < g + kHeadroom_m && high_m > g + kKerb_m) open[raster.index(c, r)] = 0;
      }
    }
  }
  for (const Building& building : parts.buildings) {
    std::vector<std::vector<Eigen::Vector2d>> rings{building.footprint_W};
    rings.insert(rings.end(), building.courtyards_W.begin(), building.courtyards_W.end());
    std::vector<Eigen::Vector2d> points;
    for (const auto& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
    for (const auto& t : triangulate(rings)) {
      const auto at = [&](std::uint32_t v) { return Eigen::Vector3d(points[v].x(), points[v].y(), 0.0); };
      raster.cover(at(t[0]), at(t[1]), at(t[2]), [&](int c, int r, double) { open[raster.index(c, r)] = 0; });
    }
  }
  return open;
}

/// Closes what lies farther than kNear_m from all that stands, in squares; nothing if nothing stands.
void close_far_ground(const SceneParts& parts, const Raster& raster, std::vector<std::uint8_t>& open) {
  std::vector<std::uint8_t> near(raster.size(), 0);
  const auto mark = [&](const Eigen::Vector2d& p) {
    const int c0 = std::max(raster.column(p.x() - kNear_m), 0),
              c1 = std::min(raster.column(p.x() + kNear_m), raster.columns - 1);
    const int r0 = std::max(raster.row(p.y() - kNear_m), 0),
              r1 = std::min(raster.row(p.y() + kNear_m), raster.rows - 1);
    for (int r = r0; r <= r1; ++r)
      for (int c = c0; c <= c1; ++c) near[raster.index(c, r)] = 1;
  };
  GroundDetail standing;
  for (std::size_t i = 0; i < parts.mesh.triangles.size(); ++i) {
    const ObjectKind kind = parts.objects[parts.mesh.object[i]].kind;
    if (kind == ObjectKind::kTerrain || kind == ObjectKind::kTree) continue;
    const auto t = corners(parts.mesh, i);
    for (std::size_t k = 0; k < 3; ++k) standing.add(t[k].head<2>(), t[(k + 1) % 3].head<2>());
  }
  const std::vector<GroundDetail::Square> squares = standing.squares();
  for (const GroundDetail::Square& square : squares) {
    throw_if_cancelled();
    mark(GroundDetail::kSquare_m * Eigen::Vector2d(square.x + 0.5, square.y + 0.5));
  }
  for (std::size_t i = 0; !squares.empty() && i < open.size(); ++i) open[i] = open[i] && near[i] ? 1 : 0;
}

/// Distance to the nearest closed cell or the border, in metres, to some 4 % (chamfer 3-4, Borgefors 1986).
std::vector<float> clearance(const Raster& raster, const std::vector<std::uint8_t>& open) {
  std::vector<float> d(raster.size(), 0.0f);
  const auto at = [&](int c, int r) { return raster.inside(c, r) ? d[raster.index(c, r)] : 0.0f; };
  const float step = static_cast<float>(raster.cell_m) / 3.0f;
  for (int r = 0; r < raster.rows; ++r)
    for (int c = 0; c < raster.columns; ++c)
      if (open[raster.index(c, r)])
        d[raster.index(c, r)] = std::min({at(c - 1, r) + 3 * step, at(c, r - 1) + 3 * step, at(c - 1, r - 1) + 4 * step,
                                          at(c + 1, r - 1) + 4 * step});
  for (int r = raster.rows - 1; r >= 0; --r)
    for (int c = raster.columns - 1; c >= 0; --c)
      if (open[raster.index(c, r)]) {
        float& here = d[raster.index(c, r)];
        here = std::min({here, at(c + 1, r) + 3 * step, at(c, r + 1) + 3 * step, at(c + 1, r + 1) + 4 * step,
                         at(c - 1, r + 1) + 4 * step});
      }
  return d;
}

constexpr int kAround[8][2] = {{0, 1}, {1, 1}, {1, 0}, {1, -1}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}};

/// Zhang & Suen's thinning: lines one cell wide with the same connections.
void thin(const Raster& raster, std::vector<std::uint8_t>& mask) {
  const auto on = [&](int c, int r) { return raster.inside(c, r) && mask[raster.index(c, r)] != 0; };
  std::vector<std::size_t> active, gone;
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) active.push_back(i);
  for (bool changed = true; changed;) {
    throw_if_cancelled();
    changed = false;
    for (int pass = 0; pass < 2; ++pass) {
      gone.clear();
      for (const std::size_t i : active) {
        const int c = static_cast<int>(i % static_cast<std::size_t>(raster.columns)),
                  r = static_cast<int>(i / static_cast<std::size_t>(raster.columns));
        std::array<bool, 8> p;
        int count = 0, rises = 0;
        for (std::size_t k = 0; k < 8; ++k) count += (p[k] = on(c + kAround[k][0], r + kAround[k][1]));
        if (count < 2 || count > 6) continue;
        for (std::size_t k = 0; k < 8; ++k) rises += !p[k] && p[(k + 1) % 8];
        if (rises != 1) continue;
        // North, east, south, west are p[0], p[2], p[4], p[6].
        const bool keep = pass == 0 ? (p[0] && p[2] && p[4]) || (p[2] && p[4] && p[6])
                                    : (p[0] && p[2] && p[6]) || (p[0] && p[4] && p[6]);
        if (!keep) gone.push_back(i);
      }
      for (const std::size_t i : gone) mask[i] = 0;
      changed = changed || !gone.empty();
      std::erase_if(active, [&](std::size_t i) { return mask[i] == 0; });
    }
  }
}

/// A line of cells between two ends.
using Chain = std::vector<std::uint32_t>;

/// The thinned lines as a graph of cells.
class Lines {
 public:
  Lines(const Raster& raster, const std::vector<std::uint8_t>& mask) : raster_(raster) {
    std::vector<std::uint32_t> id(mask.size(), 0xffffffffu);
    for (int r = 0; r < raster.rows; ++r)
      for (int c = 0; c < raster.columns; ++c)
        if (mask[raster.index(c, r)]) {
          id[raster.index(c, r)] = static_cast<std::uint32_t>(cells_.size());
          cells_.push_back({c, r});
        }
    next_.resize(cells_.size());
    const auto on = [&](int c, int r) { return raster.inside(c, r) && mask[raster.index(c, r)] != 0; };
    for (std::uint32_t i = 0; i < cells_.size(); ++i) {
      const auto [c, r] = cells_[i];
      for (const auto& step : kAround) {
        if (!on(c + step[0], r + step[1])) continue;
        // A diagonal beside a corner would make small triangles.
        if (step[0] != 0 && step[1] != 0 && (on(c + step[0], r) || on(c, r + step[1]))) continue;
        next_[i].push_back(id[raster.index(c + step[0], r + step[1])]);
      }
    }
    keep_largest();
  }

  Eigen::Vector2d at(std::uint32_t i) const { return raster_.center(cells_[i][0], cells_[i][1]); }
  std::size_t cell(std::uint32_t i) const { return raster_.index(cells_[i][0], cells_[i][1]); }

  /// Removes dead ends shorter than the limit; true if there were any.
  bool prune(double limit_m) {
    bool any = false;
    for (const Chain& chain : chains()) {
      const bool dead = next_[chain.front()].size() == 1 || next_[chain.back()].size() == 1;
      if (!dead || length_m(chain) >= limit_m) continue;
      for (std::size_t k = 0; k + 1 < chain.size(); ++k) cut(chain[k], chain[k + 1]);
      any = true;
    }
    return any;
  }

  /// Every line between two cells that are not its inside, once.
  std::vector<Chain> chains() const {
    std::vector<Chain> out;
    for (std::uint32_t i = 0; i < cells_.size(); ++i) {
      if (next_[i].size() == 2) continue;
      for (const std::uint32_t first : next_[i]) {
        Chain chain{i, first};
        while (next_[chain.back()].size() == 2) {
          const auto& ways = next_[chain.back()];
          chain.push_back(ways[0] == chain[chain.size() - 2] ? ways[1] : ways[0]);
          if (chain.back() == i) break;
        }
        if (chain.front() < chain.back() || (chain.front() == chain.back() && chain[1] <= chain[chain.size() - 2]))
          out.push_back(std::move(chain));
      }
    }
    return out;
  }

 private:
  double length_m(const Chain& chain) const {
    double sum = 0.0;
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) sum += (at(chain[k + 1]) - at(chain[k])).norm();
    return sum;
  }
  void cut(std::uint32_t a, std::uint32_t b) {
    std::erase(next_[a], b);
    std::erase(next_[b], a);
  }

  void keep_largest() {
    std::vector<std::uint32_t> part(cells_.size(), 0xffffffffu), stack;
    std::vector<std::size_t> size;
    for (std::uint32_t i = 0; i < cells_.size(); ++i) {
      if (part[i] != 0xffffffffu) continue;
      size.push_back(0);
      part[i] = static_cast<std::uint32_t>(size.size() - 1);
      for (stack = {i}; !stack.empty();) {
        const std::uint32_t at = stack.back();
        stack.pop_back();
        ++size.back();
        for (const std::uint32_t n : next_[at]) {
          if (part[n] != 0xffffffffu) continue;
          part[n] = part[i];
          stack.push_back(n);
        }
      }
    }
    if (size.empty()) return;
    const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
    for (std::uint32_t i = 0; i < cells_.size(); ++i)
      if (part[i] != largest) next_[i].clear();
  }

  Raster raster_;
  std::vector<std::array<int, 2>> cells_;
  std::vector<std::vector<std::uint32_t>> next_;
};

/// Douglas & Peucker (1973): the points of a line that must stay for it to be followed to the tolerance.
void straighten(const std::vector<Eigen::Vector2d>& line, std::size_t begin, std::size_t end,
                std::vector<std::size_t>& kept) {
  const Eigen::Vector2d way = line[end] - line[begin];
  double farthest_m = kStraight_m;
  std::size_t at = begin;
  for (std::size_t i = begin + 1; i < end; ++i) {
    const Eigen::Vector2d q = line[i] - line[begin];
    const double along = way.squaredNorm() > 0.0 ? std::clamp(q.dot(way) / way.squaredNorm(), 0.0, 1.0) : 0.0;
    const double off_m = (q - along * way).norm();
    if (off_m > farthest_m) farthest_m = off_m, at = i;
  }
  if (at == begin) return;
  straighten(line, begin, at, kept);
  kept.push_back(at);
  straighten(line, at, end, kept);
}

}  // namespace

StreetGraph free_space_streets(const SceneParts& parts) {
  const Raster raster = raster_of(parts);
  StreetGraph graph;
  if (raster.size() == 0) return graph;
  std::vector<std::uint8_t> open = open_ground(parts, raster);
  if (raster.cell_m * std::max(raster.columns, raster.rows) > kWide_m) close_far_ground(parts, raster, open);
  const std::vector<float> clear_m = clearance(raster, open);
  std::vector<std::uint8_t> mask(raster.size());
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = clear_m[i] >= static_cast<float>(kClearance_m) ? 1 : 0;
  thin(raster, mask);
  Lines lines(raster, mask);
  for (int round = 0; round < 4 && lines.prune(kDeadEnd_m); ++round) {
  }

  std::map<std::uint32_t, std::uint32_t> nodes;
  const auto node = [&](std::uint32_t cell) {
    const auto [entry, fresh] = nodes.try_emplace(cell, static_cast<std::uint32_t>(graph.nodes_W.size()));
    if (fresh) graph.nodes_W.push_back(lines.at(cell));
    return entry->second;
  };
  for (const Chain& chain : lines.chains()) {
    std::vector<Eigen::Vector2d> line;
    for (const std::uint32_t cell : chain) line.push_back(lines.at(cell));
    std::vector<std::size_t> kept{0};
    straighten(line, 0, line.size() - 1, kept);
    kept.push_back(line.size() - 1);
    for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
      float narrowest_m = std::numeric_limits<float>::infinity();
      for (std::size_t i = kept[k]; i <= kept[k + 1]; ++i)
        narrowest_m = std::min(narrowest_m, clear_m[lines.cell(chain[i])]);
      graph.edges.push_back(
          {node(chain[kept[k]]), node(chain[kept[k + 1]]), std::min(2.0 * double{narrowest_m}, 30.0)});
    }
  }
  return graph;
}

}  // namespace canyon::scene
