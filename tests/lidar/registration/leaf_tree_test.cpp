#include "canyon/lidar/registration/engine/leaf_tree.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/lidar/registration/engine/surface_target.h"

namespace canyon::lidar {
namespace {

std::vector<Eigen::Vector3f> scattered(std::uint32_t count, std::uint64_t number) {
  const RandomStream draws(number, "test.leaf_tree");
  std::vector<Eigen::Vector3f> out;
  for (std::uint32_t i = 0; i < count; ++i)
    out.emplace_back(draws.uniform(-10, 10, 0, i), draws.uniform(-10, 10, 1, i), draws.uniform(-0.5, 0.5, 2, i));
  return out;
}

std::shared_ptr<PreparedCloud> cloud_of(const std::vector<Eigen::Vector3f>& points) {
  auto cloud = std::make_shared<PreparedCloud>();
  const auto tree = std::make_shared<LeafTree>(points);
  for (const std::uint32_t i : tree->order()) cloud->points.push_back(points[i]);
  cloud->normals.assign(points.size(), Eigen::Vector3f::UnitZ());
  cloud->tilt_variance.assign(points.size(), 0.0F);
  cloud->tree = tree;
  return cloud;
}

TEST(LeafTree, NeighboursOfALeafAreThoseOfItsPoints) {
  for (const std::uint32_t count : {1U, 7U, 9U, 500U, 3000U}) {
    const auto points = scattered(count, count);
    const LeafTree tree(points);
    constexpr float kReach2 = 1.5F * 1.5F;
    std::size_t seen = 0;
    LeafTree::OfLeaf<12> of;
    for (std::uint32_t leaf = 0; leaf < tree.leaves(); ++leaf) {
      tree.nearest_of_leaf(leaf, kReach2, of);
      for (std::uint32_t i = of.begin; i < of.end; ++i, ++seen) {
        std::array<LeafTree::Nearest, 12> alone;
        const std::size_t found = tree.nearest(tree.point(i), kReach2, alone);
        ASSERT_EQ(of.count[i - of.begin], found);
        for (std::size_t k = 0; k < found; ++k)
          ASSERT_EQ(of.nearest[i - of.begin][k].squared_m, alone[k].squared_m) << count << ' ' << i << ' ' << k;
      }
    }
    EXPECT_EQ(seen, count);
  }
}

TEST(LeafTree, OthersAreNoCloserThanSaid) {
  const auto points = scattered(2000, 3);
  const LeafTree tree(points);
  for (std::uint32_t q = 0; q < 300; ++q) {
    const Eigen::Vector3f query = scattered(300, 4)[q];
    const auto plain = tree.nearest(query, 4.0F);
    for (const std::uint32_t first : {LeafTree::kNone, q, plain.at}) {
      const auto found = tree.nearest_from(query, 4.0F, first);
      EXPECT_EQ(found.at, plain.at);
      EXPECT_EQ(found.squared_m, plain.squared_m);
      float second = std::numeric_limits<float>::infinity();
      for (std::uint32_t k = 0; k < tree.size(); ++k)
        if (k != found.at) second = std::min(second, (tree.point(k) - query).squaredNorm());
      EXPECT_LE(found.others_squared_m, second * 1.000001F);  // sums of squares are rounded, as kBorder has it
      EXPECT_GE(found.others_squared_m, found.squared_m * 0.999999F);
    }
  }
}

/// What is remembered of a place nearby must not change what is found, wherever the point goes and however far is
/// looked.
TEST(SurfaceTarget, WhatIsRememberedChangesNothing) {
  const auto target = point_target(cloud_of(scattered(3000, 5)));
  const RandomStream draws(6, "test.leaf_tree.walk");
  int same = 0;
  for (std::uint32_t w = 0; w < 40; ++w) {
    Eigen::Vector3f place = scattered(40, 7)[w];
    LastMatch last;
    for (std::uint32_t step = 0; step < 60; ++step) {
      const double size = std::pow(10.0, draws.uniform(-5, 0, 0, 1000 * w + step));
      place += (size * draws.direction(1, 1000 * w + step)).cast<float>();
      const auto reach2 = static_cast<float>(std::pow(draws.uniform(0.05, 2.0, 4, 1000 * w + step), 2));
      target->find(place, reach2, last);
      LastMatch fresh;
      target->find(place, reach2, fresh);
      ASSERT_EQ(last.matched, fresh.matched) << w << ' ' << step;
      same += last.place != place ? 1 : 0;
    }
  }
  EXPECT_GT(same, 500) << "searches that were left out";
}

}  // namespace
}  // namespace canyon::lidar
