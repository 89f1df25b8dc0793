#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/scene/surfaces/edge.h"

namespace canyon::scene {
namespace {

/// Edges of all directions over 600 m; some of them long.
std::vector<Edge> random_edges() {
  const RandomStream stream(5, "test.edges_along");
  std::vector<Edge> edges;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    Edge e;
    e.a_W = {stream.uniform(-300, 300, 0, i), stream.uniform(-300, 300, 1, i), stream.uniform(0, 40, 2, i)};
    e.b_W = e.a_W + (i % 50 == 0 ? 150.0 : 8.0) * stream.direction(3, i);
    edges.push_back(e);
  }
  return edges;
}

/// Does a point of the edge lie so near to the way? By many points of it.
bool lies_near(const Edge& e, const EdgeIndex::Way& way, double detour_m) {
  for (int k = 0; k <= 200; ++k) {
    const Eigen::Vector3d p_W = e.a_W + k / 200.0 * (e.b_W - e.a_W) - way.from_W;
    const double along_m = std::clamp(p_W.dot(way.towards_W), 0.0, way.length_m);
    if ((p_W - along_m * way.towards_W).squaredNorm() <= detour_m * (2.0 * (way.behind_m + along_m) + detour_m))
      return true;
  }
  return false;
}

TEST(EdgesAlong, NoneIsMissedAndFewAreTooMany) {
  const EdgeIndex index(random_edges());
  const RandomStream stream(6, "test.ways_along");
  std::size_t found = 0, near = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    EdgeIndex::Way way;
    way.from_W = {stream.uniform(-250, 250, 0, i), stream.uniform(-250, 250, 1, i), stream.uniform(0, 60, 2, i)};
    way.towards_W = i == 0 ? Eigen::Vector3d::UnitZ() : i == 1 ? Eigen::Vector3d::UnitX() : stream.direction(3, i);
    way.length_m = i % 3 == 0 ? std::numeric_limits<double>::infinity() : stream.uniform(1, 80, 4, i);
    way.behind_m = i % 2 == 0 ? 0.0 : 40.0;
    const double detour_m = i % 5 == 0 ? 0.01 : 0.25;
    std::vector<std::uint32_t> out;
    index.along(way, detour_m, out);
    std::vector<std::uint32_t> unique = out;
    std::sort(unique.begin(), unique.end());
    EXPECT_EQ(std::adjacent_find(unique.begin(), unique.end()), unique.end());
    for (std::uint32_t e = 0; e < index.edges().size(); ++e) {
      if (!lies_near(index.edges()[e], way, detour_m)) continue;
      ++near;
      EXPECT_TRUE(std::binary_search(unique.begin(), unique.end(), e)) << "way " << i << ", edge " << e;
    }
    found += out.size();
  }
  EXPECT_GT(near, 100U);
  EXPECT_LT(found, 6 * near) << "of " << 100 * index.edges().size();
}

TEST(EdgesAlong, OfNoEdgesThereAreNone) {
  std::vector<std::uint32_t> out{7};
  EdgeIndex().along({.from_W = {0, 0, 0}, .towards_W = {1, 0, 0}, .length_m = 10.0}, 1.0, out);
  EXPECT_TRUE(out.empty());
}

}  // namespace
}  // namespace canyon::scene
