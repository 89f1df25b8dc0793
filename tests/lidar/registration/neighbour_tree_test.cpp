#include "canyon/lidar/registration/neighbour_tree.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/random/random.h"

namespace canyon::lidar {
namespace {

/// Every point, the slow way.
std::vector<NeighbourTree::Neighbour> all_near(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& query,
                                               float radius_m, std::size_t k) {
  std::vector<NeighbourTree::Neighbour> out;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const float dx = points[i].x() - query.x(), dy = points[i].y() - query.y(), dz = points[i].z() - query.z();
    const float squared_m = dx * dx + dy * dy + dz * dz;
    if (squared_m < radius_m * radius_m) out.push_back({squared_m, i});
  }
  std::sort(out.begin(), out.end());
  if (out.size() > k) out.resize(k);
  return out;
}

void expect_same(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& query, float radius_m,
                 std::size_t k) {
  const NeighbourTree tree(points);
  std::vector<NeighbourTree::Neighbour> found(k);
  found.resize(tree.nearest(query, radius_m, found));
  const auto expected = all_near(points, query, radius_m, k);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].index, expected[i].index);
    EXPECT_EQ(found[i].squared_m, expected[i].squared_m);
  }
}

TEST(NeighbourTree, EqualsExhaustiveSearch) {
  const RandomStream random(3, "test.points");
  for (std::uint32_t set = 0; set < 40; ++set) {
    std::vector<Eigen::Vector3f> points(1 + set * 13);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      // A flat sheet, as clouds of streets are; every fourth set on a lattice, full of equal distances.
      Eigen::Vector3d p(random.uniform(-5, 5, 3 * set, i), random.uniform(-5, 5, 3 * set + 1, i),
                        random.uniform(0, 1, 3 * set + 2, i));
      if (set % 4 == 0) p = p.array().round();
      points[i] = p.cast<float>();
    }
    for (std::uint32_t q = 0; q < 25; ++q) {
      Eigen::Vector3d query(random.uniform(-7, 7, 900, q), random.uniform(-7, 7, 901, q),
                            random.uniform(-2, 2, 902, q));
      if (set % 4 == 0) query = query.array().round();
      for (const float radius_m : {0.5f, 2.0f, 50.0f}) {
        for (const std::size_t k : {1u, 5u, 20u}) expect_same(points, query.cast<float>(), radius_m, k);
      }
    }
  }
}

TEST(NeighbourTree, NothingAndTwins) {
  std::vector<NeighbourTree::Neighbour> found(3);
  EXPECT_EQ(NeighbourTree(std::span<const Eigen::Vector3f>()).nearest({0, 0, 0}, 10, found), 0u);
  const std::vector<Eigen::Vector3f> twins(100, Eigen::Vector3f(1, 2, 3));
  expect_same(twins, {1, 2, 3}, 1.0f, 7);
  // A point exactly at the radius is not closer.
  const std::vector<Eigen::Vector3f> one{{1, 0, 0}};
  EXPECT_EQ(NeighbourTree(one).nearest({0, 0, 0}, 1.0f, found), 0u);
  EXPECT_THROW(NeighbourTree(std::vector<Eigen::Vector3f>{{NAN, 0, 0}}), ProgramError);
}

}  // namespace
}  // namespace canyon::lidar
