#include "canyon/scene/surfaces/edge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <Eigen/Geometry>

#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::scene {
namespace {

constexpr double kBlock_m = 50.0;
constexpr double kTile_m = 2000.0;
constexpr std::size_t kEdgeRow = 8;  // edges, or blocks, that are looked at together
using Row = Eigen::Array<double, static_cast<int>(kEdgeRow), 1>;
const double kFlat = std::cos(15.0 * kDegree);

using Place = std::tuple<float, float, float>;

Place place(const Eigen::Vector3f& p) {
  return {p.x() + 0.0F, p.y() + 0.0F, p.z() + 0.0F};  // -0 becomes +0
}

/// Unit vector in the triangle's plane, across the edge, away from the third corner.
Eigen::Vector3d away(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& third) {
  const Eigen::Vector3d along = (b - a).normalized();
  const Eigen::Vector3d in = third - a;
  return (in.dot(along) * along - in).normalized();
}

/// One side of a triangle: its ends as they are passed, and the corner opposite.
struct Side {
  std::uint32_t triangle;
  Eigen::Vector3d a, b, third, normal;
};

void add_edges(const Scene& scene, const std::vector<std::uint32_t>& members, double min_length_m,
               std::vector<Edge>& out) {
  const Mesh& mesh = scene.mesh();
  std::map<std::pair<Place, Place>, std::vector<Side>> sides;  // both ends sorted: the two triangles pass them in turn
  std::vector<std::pair<Place, Place>> order;
  for (const std::uint32_t i : members) {
    throw_if_cancelled();
    const Triangle t = Triangle::of(mesh, i);
    const Eigen::Vector3d corners[3] = {t.a, t.b, t.c};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      Place from = place(mesh.vertices[mesh.triangles[i][k]]), to = place(mesh.vertices[mesh.triangles[i][l]]);
      if (to < from) std::swap(from, to);
      auto& list = sides[{from, to}];
      if (list.empty()) order.push_back({from, to});
      list.push_back({i, corners[k], corners[l], corners[m], t.area_normal().normalized()});
    }
  }
  for (const auto& key : order) {
    throw_if_cancelled();
    const std::vector<Side>& list = sides[key];
    const Side& one = list[0];
    if ((one.b - one.a).norm() < min_length_m || list.size() > 2) continue;
    if (list.size() == 1) {
      const std::uint16_t own = mesh.material[one.triangle];
      out.push_back({one.a, one.b, one.normal, -one.normal, away(one.a, one.b, one.third), own, own});
      continue;
    }
    const Side& two = list[1];
    const bool convex = one.normal.dot(two.third - one.a) < 0.0;
    if (!convex || one.normal.dot(two.normal) > kFlat) continue;
    const Eigen::Vector3d outward = one.normal + two.normal;
    out.push_back({one.a, one.b, one.normal, two.normal,
                   outward.norm() > 1e-6 ? Eigen::Vector3d(outward.normalized()) : away(one.a, one.b, one.third),
                   mesh.material[one.triangle], mesh.material[two.triangle]});
  }
}

/// How far beside a straight way of this length the end of a bent one may lie that is longer by the detour.
double bend_m(double along_m, double detour_m) {
  return std::sqrt(detour_m * (2.0 * along_m + detour_m));
}

}  // namespace

std::vector<Edge> convex_edges(const Scene& scene, double min_length_m) {
  const Mesh& mesh = scene.mesh();
  std::vector<std::vector<std::uint32_t>> by_object(scene.objects().size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const ObjectKind kind = scene.objects()[mesh.object[i]].kind;
    if (kind != ObjectKind::kTerrain && kind != ObjectKind::kTree) by_object[mesh.object[i]].push_back(i);
  }
  std::vector<Edge> edges;
  for (const auto& members : by_object) add_edges(scene, members, min_length_m, edges);
  edges.shrink_to_fit();
  return edges;
}

void EdgeIndex::Square::add(const Edge& e) {
  for (const Eigen::Vector3d& p : {e.a_W, e.b_W}) {
    reach_m = std::max(reach_m, std::hypot(p.x() - x_m, p.y() - y_m));
    top_m = std::max(top_m, p.z());
    bottom_m = std::min(bottom_m, p.z());
  }
}

/// The blocks that the way comes near to; what it is over is its shadow on the ground, as far as it is low enough.
template <class Take>
void EdgeIndex::Tile::blocks_along(const Way& way, double detour_m, const Take& take) const {
  const Eigen::Vector2d to_center = Eigen::Vector2d(x_m, y_m) - way.from_W.head<2>();
  const double up_m = std::max(std::abs(top_m - way.from_W.z()), std::abs(bottom_m - way.from_W.z()));
  const double farthest_m = std::sqrt(std::pow(to_center.norm() + reach_m, 2) + up_m * up_m);
  const double rise = way.towards_W.z();
  double first_m = 0.0, last_m = std::min(way.length_m, farthest_m), beside_m = 0.0;
  for (int k = 0; k < 2; ++k) {  // no farther than it is low enough, no wider than it is so far
    beside_m = bend_m(way.behind_m + last_m, detour_m);
    const double over_m = top_m + beside_m - way.from_W.z(), under_m = bottom_m - beside_m - way.from_W.z();
    if (std::abs(rise) < 1e-9) {
      const double rounding_m = 1e-9 * last_m;
      if (over_m < -rounding_m || under_m > rounding_m) return;
      continue;
    }
    first_m = std::max(first_m, (rise > 0.0 ? under_m : over_m) / rise);
    last_m = std::min(last_m, (rise > 0.0 ? over_m : under_m) / rise);
    if (first_m > last_m) return;
  }
  const Eigen::Vector2d from = way.from_W.head<2>() + first_m * way.towards_W.head<2>();
  const Eigen::Vector2d over = (last_m - first_m) * way.towards_W.head<2>();
  const double per_m2 = 1.0 / std::max(over.squaredNorm(), 1e-12);
  // The way's height over the ground's point that is nearest to a block changes by this much per metre across it.
  const double first_z_m = way.from_W.z() + first_m * rise, over_z_m = (last_m - first_m) * rise;
  const double level_m = over.norm(), slope = level_m > 1e-6 ? std::abs(over_z_m) / level_m : 1e300;
  for (std::size_t begin = 0; begin < blocks.size(); begin += kEdgeRow) {
    const auto row = [begin](const std::vector<double>& column) {
      return Eigen::Map<const Row>(column.data() + begin);
    };
    const Row dx_m = row(block_x_m) - from.x(), dy_m = row(block_y_m) - from.y();
    const Row share = (per_m2 * (over.x() * dx_m + over.y() * dy_m)).max(0.0).min(1.0);
    const Row off2_m2 = (dx_m - share * over.x()).square() + (dy_m - share * over.y()).square();
    const Row wide_m = row(block_reach_m) + beside_m;
    const Row z_m = first_z_m + share * over_z_m, apart_m = wide_m * slope + beside_m;
    const Row room_m = apart_m + (row(block_top_m) - z_m).min(z_m - row(block_bottom_m));
    const std::size_t count = std::min(kEdgeRow, blocks.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      if (off2_m2[at] <= wide_m[at] * wide_m[at] && room_m[at] >= 0.0) take(blocks[begin + k]);
    }
  }
}

void EdgeIndex::along(const Way& way, double detour_m, std::vector<std::uint32_t>& out) const {
  out.clear();
  const auto look = [&](const Block& block) {
    for (std::size_t begin = 0; begin < block.edges.size(); begin += kEdgeRow) {
      const auto row = [begin](const std::vector<double>& column) {
        return Eigen::Map<const Row>(column.data() + begin);
      };
      const Row x_m = row(block.middle_x_m) - way.from_W.x(), y_m = row(block.middle_y_m) - way.from_W.y(),
                z_m = row(block.middle_z_m) - way.from_W.z(), half_m = row(block.half_m);
      const Row along_m =
          (x_m * way.towards_W.x() + y_m * way.towards_W.y() + z_m * way.towards_W.z()).max(0.0).min(way.length_m);
      const Row off2_m2 = (x_m - along_m * way.towards_W.x()).square() + (y_m - along_m * way.towards_W.y()).square() +
                          (z_m - along_m * way.towards_W.z()).square();
      const Row bent_m = (detour_m * (2.0 * (way.behind_m + along_m + half_m) + detour_m)).sqrt();
      const Row wide_m = half_m + bent_m;
      const std::size_t count = std::min(kEdgeRow, block.edges.size() - begin);
      for (std::size_t k = 0; k < count; ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        if (off2_m2[at] <= wide_m[at] * wide_m[at]) out.push_back(block.edges[begin + k]);
      }
    }
  };
  for (const Tile& tile : tiles_) tile.blocks_along(way, detour_m, look);
}

void EdgeIndex::Block::take(const Edge& e, std::uint32_t index) {
  add(e);
  const Eigen::Vector3d middle_W = 0.5 * (e.a_W + e.b_W), along_W = e.b_W - e.a_W;
  edges.push_back(index);
  middle_x_m.push_back(middle_W.x());
  middle_y_m.push_back(middle_W.y());
  middle_z_m.push_back(middle_W.z());
  half_m.push_back(0.5 * along_W.norm());
  level_half_m.push_back(0.5 * along_W.head<2>().norm());
  edge_top_m.push_back(std::max(e.a_W.z(), e.b_W.z()));
}

void EdgeIndex::Block::fill_up() {
  const std::size_t rows = (edges.size() + kEdgeRow - 1) / kEdgeRow;
  for (auto* column : {&middle_x_m, &middle_y_m, &middle_z_m, &half_m, &level_half_m, &edge_top_m}) {
    column->resize(rows * kEdgeRow, 0.0);
    column->shrink_to_fit();
  }
}

void EdgeIndex::Tile::fill_up() {
  for (Block& block : blocks) {
    block.fill_up();
    block_x_m.push_back(block.x_m);
    block_y_m.push_back(block.y_m);
    block_reach_m.push_back(block.reach_m);
    block_top_m.push_back(block.top_m);
    block_bottom_m.push_back(block.bottom_m);
  }
  const std::size_t rows = (blocks.size() + kEdgeRow - 1) / kEdgeRow;
  for (auto* column : {&block_x_m, &block_y_m, &block_reach_m, &block_top_m, &block_bottom_m}) {
    column->resize(rows * kEdgeRow, 0.0);
    column->shrink_to_fit();
  }
}

EdgeIndex::EdgeIndex(std::vector<Edge> edges) : edges_(std::move(edges)) {
  if (edges_.empty()) return;
  Eigen::Vector3d low = edges_[0].a_W;
  for (const Edge& e : edges_) low = low.cwiseMin(0.5 * (e.a_W + e.b_W));
  using Cell = std::pair<int, int>;
  std::map<Cell, std::size_t> tile_of;
  std::map<std::pair<Cell, Cell>, std::size_t> block_of;  // by tile and place
  for (std::uint32_t i = 0; i < edges_.size(); ++i) {
    throw_if_cancelled();
    const Edge& e = edges_[i];
    const Eigen::Vector3d middle = 0.5 * (e.a_W + e.b_W);
    const Cell wide(static_cast<int>((middle.y() - low.y()) / kTile_m),
                    static_cast<int>((middle.x() - low.x()) / kTile_m));
    const auto [tile_at, new_tile] = tile_of.emplace(wide, tiles_.size());
    if (new_tile)
      tiles_.push_back({{.x_m = low.x() + (wide.second + 0.5) * kTile_m, .y_m = low.y() + (wide.first + 0.5) * kTile_m},
                        {},
                        {},
                        {},
                        {},
                        {},
                        {}});
    Tile& tile = tiles_[tile_at->second];
    const Cell place(static_cast<int>(std::floor(middle.y() / kBlock_m)),
                     static_cast<int>(std::floor(middle.x() / kBlock_m)));
    const auto [at, fresh] = block_of.emplace(std::pair{wide, place}, tile.blocks.size());
    if (fresh) {
      Block& block = tile.blocks.emplace_back();
      block.x_m = (place.second + 0.5) * kBlock_m, block.y_m = (place.first + 0.5) * kBlock_m;
    }
    tile.add(e);
    tile.blocks[at->second].take(e, i);
  }
  for (Tile& tile : tiles_) tile.fill_up();
}

template <class Take>
void EdgeIndex::find_shading(const Eigen::Vector3d& p_W, double elevation_rad, double detour_m,
                             const Take& take) const {
  const double rise = std::tan(std::min(elevation_rad, 0.4999 * kPi)), cosine = std::cos(elevation_rad);
  const auto within = [&](const Square& square) {
    const double distance_m = std::hypot(square.x_m - p_W.x(), square.y_m - p_W.y());
    const double top_m = square.top_m - p_W.z(), farthest_m = distance_m + square.reach_m;
    // The way there is longer than its horizontal part; the widest bend is across it.
    const double bend_m = std::sqrt(2.0 * detour_m * (farthest_m / cosine + std::abs(top_m)));
    return top_m + bend_m / cosine >= std::max(distance_m - square.reach_m, 0.0) * rise;
  };
  // The same of each edge, by rows, at its nearest.
  const auto look = [&](const Block& block) {
    for (std::size_t begin = 0; begin < block.edges.size(); begin += kEdgeRow) {
      const auto row = [begin](const std::vector<double>& column) {
        return Eigen::Map<const Row>(column.data() + begin);
      };
      const Row x_m = row(block.middle_x_m) - p_W.x(), y_m = row(block.middle_y_m) - p_W.y();
      const Row top_m = row(block.edge_top_m) - p_W.z();
      const Row distance_m = ((x_m * x_m + y_m * y_m).sqrt() - row(block.level_half_m)).max(0.0);
      const Row bend_m = (2.0 * detour_m * (distance_m / cosine + top_m.abs())).sqrt();
      const Row reached_m = top_m + bend_m / cosine, asked_m = distance_m * rise;
      const std::size_t count = std::min(kEdgeRow, block.edges.size() - begin);
      for (std::size_t k = 0; k < count; ++k)
        if (reached_m[static_cast<Eigen::Index>(k)] >= asked_m[static_cast<Eigen::Index>(k)]) take(block, begin + k);
    }
  };
  for (const Tile& tile : tiles_) {
    if (!within(tile)) continue;
    for (const Block& block : tile.blocks)
      if (within(block)) look(block);
  }
}

void EdgeIndex::shading(const Eigen::Vector3d& p_W, double elevation_rad, double detour_m,
                        std::vector<Outline>& out) const {
  out.clear();
  find_shading(p_W, elevation_rad, detour_m, [&](const Block& of, std::size_t i) {
    out.push_back({of.edges[i], {of.middle_x_m[i], of.middle_y_m[i], of.middle_z_m[i]}, of.half_m[i]});
  });
}

void EdgeIndex::shading(const Eigen::Vector3d& p_W, double elevation_rad, double detour_m,
                        std::vector<std::uint32_t>& out) const {
  out.clear();
  find_shading(p_W, elevation_rad, detour_m, [&](const Block& of, std::size_t i) { out.push_back(of.edges[i]); });
}

}  // namespace canyon::scene
