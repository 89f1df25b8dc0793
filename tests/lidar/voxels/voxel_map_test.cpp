#include "canyon/lidar/voxels/voxel_map.h"

#include <cmath>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::lidar {
namespace {

std::vector<Eigen::Vector3f> scattered(std::uint32_t n, double half_m) {
  const RandomStream random(5, "test.voxels");
  std::vector<Eigen::Vector3f> points(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t a = 0; a < 3; ++a) points[i][a] = static_cast<float>(random.uniform(-half_m, half_m, a, i));
  }
  return points;
}

using Key = std::tuple<double, double, double>;
Key key(const Eigen::Vector3f& p, double leaf_m) {
  return {std::floor(p.x() / leaf_m), std::floor(p.y() / leaf_m), std::floor(p.z() / leaf_m)};
}

TEST(VoxelMap, KeepsTheFirstPointOfEachVoxel) {
  const auto points = scattered(20000, 3.0);
  VoxelMap map(0.3);
  std::map<Key, Eigen::Vector3f> first;
  for (const auto& p : points) {
    const bool is_first = first.emplace(key(p, 0.3), p).second;
    EXPECT_EQ(map.insert({.p_W = p, .intensity = 0.5f}), is_first);
  }
  ASSERT_EQ(map.size(), first.size());
  ASSERT_LT(first.size(), points.size() / 2);
  const MapCloud taken = std::move(map).take();
  ASSERT_EQ(taken.size(), first.size());
  for (const MapPoint& kept : taken.block(0)) EXPECT_EQ(kept.p_W, first.at(key(kept.p_W, 0.3)));
}

// More than a block, so that the order goes on from one to the next.
TEST(VoxelMap, TakesThemInTheOrderOfFirstSight) {
  const auto points = scattered(400000, 40.0);
  VoxelMap map(0.3);
  std::vector<MapPoint> expected;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const MapPoint point{.p_W = points[i], .intensity = static_cast<float>(i)};
    if (map.insert(point)) expected.push_back(point);
  }
  ASSERT_GT(expected.size(), MapCloud::kBlock);
  const MapCloud taken = std::move(map).take();
  ASSERT_EQ(taken.size(), expected.size());
  for (std::size_t i = 0; i < taken.size(); ++i) {
    ASSERT_EQ(taken[i].p_W, expected[i].p_W) << i;
    ASSERT_EQ(taken[i].intensity, expected[i].intensity) << i;
  }
}

TEST(VoxelMap, CentroidsInTheOrderOfFirstSight) {
  const auto points = scattered(20000, 3.0);
  const auto centroids = voxel_centroids(points, 0.5);
  std::map<Key, std::pair<Eigen::Vector3d, int>> sums;
  std::vector<Key> order;
  for (const auto& p : points) {
    auto& [sum, count] = sums.try_emplace(key(p, 0.5), Eigen::Vector3d::Zero(), 0).first->second;
    if (count == 0) order.push_back(key(p, 0.5));
    sum += p.cast<double>();
    ++count;
  }
  ASSERT_EQ(centroids.size(), order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto& [sum, count] = sums.at(order[i]);
    EXPECT_EQ(centroids[i], (sum / count).cast<float>());
  }
}

TEST(VoxelMap, NegativeCoordinatesAndFarPoints) {
  VoxelMap map(1.0);
  EXPECT_TRUE(map.insert({.p_W = {-0.1f, 0, 0}}));
  EXPECT_TRUE(map.insert({.p_W = {0.1f, 0, 0}})) << "-0.1 and 0.1 are in different voxels";
  EXPECT_TRUE(map.insert({.p_W = {1e6f, -1e6f, 0}}));
  // 2026-11-22: a point beyond the grid ended the program.
  EXPECT_FALSE(map.insert({.p_W = {2e6f, 0, 0}}));
  EXPECT_FALSE(map.insert({.p_W = {NAN, 0, 0}}));
  EXPECT_FALSE(map.insert({.p_W = {0, 0, -INFINITY}}));
  EXPECT_EQ(map.out_of_reach(), 3);
  EXPECT_EQ(map.size(), 3U);
  EXPECT_TRUE(voxel_centroids(std::vector<Eigen::Vector3f>{{NAN, 0, 0}, {0, 1e9f, 0}}, 1.0).empty());
}

}  // namespace
}  // namespace canyon::lidar
