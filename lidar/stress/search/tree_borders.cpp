// Trees of points on a lattice: distances are whole numbers, so that borders, limits and ties come out to the bit.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "canyon/core/stress/looks.h"
#include "canyon/lidar/registration/engine/leaf_tree.h"
#include "canyon/lidar/stress/search/subjects.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector3f;

/// `nx` by `ny` by `nz` points, one apart, each as often as is said; shuffled by a step that has no factor in common.
std::vector<Vector3f> lattice(int nx, int ny, int nz, int times) {
  std::vector<Vector3f> in_order, out;
  for (int t = 0; t < times; ++t)
    for (int x = 0; x < nx; ++x)
      for (int y = 0; y < ny; ++y)
        for (int z = 0; z < nz; ++z)
          in_order.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  for (std::size_t k = 0, at = 0; k < in_order.size(); ++k, at = (at + 10007) % in_order.size())
    out.push_back(in_order[at]);
  return out;
}

/// Every question of a tree, at lattice points, between them, where its cells meet and beside all, with limits that
/// just reach the next layer and just do not: what comes out is what trying all gives, to the bit. Neighbours come
/// nearest first, the lower place first among equals; how far the others are at least is never more than it is. A
/// figure counts.
StressFigure lattice_questions(int nx, int ny, int nz, int times) {
  const auto points = lattice(nx, ny, nz, times);
  const LeafTree tree(points);
  int wrong = 0;
  const auto is = [&wrong](bool right) { wrong += right ? 0 : 1; };
  is(tree.size() == points.size() && tree.order().size() == points.size());
  std::vector<bool> seen(points.size(), false);
  for (std::size_t k = 0; k < tree.size(); ++k) {
    is(tree.point(k) == points[tree.order()[k]]);
    seen[tree.order()[k]] = true;
  }
  is(std::find(seen.begin(), seen.end(), false) == seen.end());
  std::vector<Vector3f> queries = {{-2, 0, 1}, {0, 0, 0}, {-1, -1, -1}};
  for (int k = 0; k < 40; ++k)
    queries.emplace_back(0.5f * static_cast<float>((7 * k) % (2 * nx + 3)) - 0.5f,
                         0.5f * static_cast<float>((5 * k) % (2 * ny + 3)) - 0.5f,
                         0.5f * static_cast<float>((3 * k) % (2 * nz + 3)) - 0.5f);
  for (const Vector3f& q : queries) {
    std::vector<float> all;
    for (std::size_t k = 0; k < tree.size(); ++k) all.push_back((tree.point(k) - q).squaredNorm());
    std::vector<float> sorted = all;
    std::sort(sorted.begin(), sorted.end());
    for (const float limit : {0.0f, 0.25f, 1.0f, std::nextafter(1.0f, 2.0f), 2.75f, 9.0f, 1e6f}) {
      const auto within =
          static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), limit) - sorted.begin());
      const auto one = tree.nearest(q, limit);
      is((one.at == LeafTree::kNone) == (within == 0));
      is(one.squared_m == (within == 0 ? limit : sorted[0]));
      if (one.at != LeafTree::kNone) is(all[one.at] == sorted[0]);
      for (const std::size_t most : {1U, 5U, 32U}) {
        std::array<LeafTree::Nearest, 32> near;
        const std::size_t found = tree.nearest(q, limit, {near.data(), most});
        is(found == (within < most ? within : most));
        for (std::size_t k = 0; k < found; ++k) {
          is(near[k].squared_m == sorted[k] && all[near[k].at] == sorted[k]);
          if (k > 0)
            is(near[k - 1].squared_m < near[k].squared_m ||
               (near[k - 1].squared_m == near[k].squared_m && near[k - 1].at < near[k].at));
        }
      }
      const auto last = static_cast<std::uint32_t>(tree.size() - 1);
      for (const std::uint32_t first : {LeafTree::kNone, 0U, last / 2, last}) {
        const auto two = tree.nearest_from(q, limit, first);
        is((two.at == LeafTree::kNone) == (within == 0));
        is(two.squared_m == (within == 0 ? limit : sorted[0]));
        if (two.at == LeafTree::kNone) {
          // All others are as far as the nearest at least, and as what was asked for.
          is(two.others_squared_m <= sorted[0] && two.others_squared_m >= limit);
          continue;
        }
        is(all[two.at] == sorted[0]);
        is(two.others_squared_m >= sorted[0]);
        if (sorted.size() > 1) is(two.others_squared_m <= sorted[1]);
      }
    }
  }
  std::size_t told = 0;
  for (std::uint32_t leaf = 0; leaf < tree.leaves(); ++leaf)
    for (const float limit : {1.0f, 2.5f, 1e6f}) {
      LeafTree::OfLeaf<7> of;
      tree.nearest_of_leaf(leaf, limit, of);
      is(of.end - of.begin <= LeafTree::kBucket);
      for (std::uint32_t i = of.begin; i < of.end; ++i, ++told) {
        std::vector<float> sorted;
        for (std::size_t k = 0; k < tree.size(); ++k) sorted.push_back((tree.point(k) - tree.point(i)).squaredNorm());
        std::sort(sorted.begin(), sorted.end());
        const auto within =
            static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), limit) - sorted.begin());
        const std::size_t found = of.count[i - of.begin];
        is(found == (within < 7 ? within : 7));
        for (std::size_t k = 0; k < found; ++k) {
          const auto& n = of.nearest[i - of.begin][k];
          is(n.squared_m == sorted[k] && (tree.point(n.at) - tree.point(i)).squaredNorm() == sorted[k]);
        }
      }
    }
  is(told == 3 * tree.size());
  return {1.0 * wrong, 0.0};
}

/// Of no point there is no neighbour; a point that is none, no room for an answer and more than 32 are refused. A
/// figure counts.
StressFigure no_trees() {
  int wrong = 0;
  const auto is = [&wrong](bool right) { wrong += right ? 0 : 1; };
  const LeafTree none(std::vector<Vector3f>{});
  std::array<LeafTree::Nearest, 40> room;
  is(none.size() == 0 && none.leaves() == 0 && LeafTree().leaves() == 0);
  is(none.nearest({0, 0, 0}, 9.0f).at == LeafTree::kNone && none.nearest({0, 0, 0}, 9.0f, {room.data(), 3}) == 0);
  is(none.nearest_from({0, 0, 0}, 9.0f, LeafTree::kNone).at == LeafTree::kNone);
  is(std::isinf(none.nearest_from({0, 0, 0}, 9.0f, LeafTree::kNone).others_squared_m));
  const LeafTree one(std::vector<Vector3f>{{1, 2, 3}});
  is(one.leaves() == 1 && std::isinf(one.nearest_from({1, 2, 4}, 9.0f, LeafTree::kNone).others_squared_m));
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    wrong += stress::not_refused([bad] { LeafTree(std::vector<Vector3f>{{0, 0, 0}, {0, bad, 0}}); }, "point 1");
  wrong += stress::not_refused([&] { one.nearest({0, 0, 0}, 1.0f, {room.data(), 33}); }, "33 neighbours");
  wrong += stress::not_refused([&] { one.nearest({0, 0, 0}, 1.0f, {room.data(), std::size_t{0}}); }, "0 neighbours");
  is(one.nearest({0, 0, 0}, 20.0f, {room.data(), 32}) == 1);
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> tree_border_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "points on the borders of a tree's cells",
           "a border that hides a point that lies on it, a limit that counts, a leaf's padding for a point",
           "what trying all gives, to the bit: squares of whole and half numbers", "wrong"});
  const struct {
    const char* name;
    int x, y, z, times;
  } of[] = {{"of_8", 2, 2, 2, 1},         {"of_9", 9, 1, 1, 1},         {"of_17", 1, 1, 17, 1},
            {"of_343", 7, 7, 7, 1},       {"of_a_plane", 1, 21, 13, 1}, {"of_threefold_points", 3, 5, 4, 3},
            {"of_one_place", 1, 1, 1, 30}};
  for (const auto& l : of)
    rows.add(std::string("tree_borders/") + l.name, [l] { return lattice_questions(l.x, l.y, l.z, l.times); });
  rows.add("tree_borders/of_none", no_trees);
  return rows.take();
}

}  // namespace canyon::lidar
