#include "canyon/scene/city/street_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace canyon::scene {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// A square of 100 m with a diagonal street and a separate street far away.
StreetGraph square() {
  StreetGraph g;
  g.nodes_W = {{0, 0}, {100, 0}, {100, 100}, {0, 100}, {500, 0}, {600, 0}};
  g.edges = {{0, 1, 12}, {1, 2, 12}, {2, 3, 12}, {3, 0, 12}, {0, 2, 12}, {4, 5, 12}};
  return g;
}

double length(const Points& points) {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

TEST(StreetGraph, RouteTakesTheDiagonal) {
  const Points way = square().route({50, -3}, {100, 80});
  EXPECT_EQ(way, (Points{{50, 0}, {100, 0}, {100, 80}})) << "130 m by the corner, 50 + 141 + 20 by the diagonal";
  const double by_diagonal = 20.0 + 100.0 * std::sqrt(2.0) + 10.0;
  EXPECT_EQ(square().route({0, 20}, {100, 90}), (Points{{0, 20}, {0, 0}, {100, 100}, {100, 90}}))
      << "20 + 141 + 10 < 20 + 100 + 90";
  EXPECT_NEAR(length(square().route({0, 20}, {100, 90})), by_diagonal, 16 * 2.3e-16 * by_diagonal);
  const Points along_it = square().route({30, 29}, {60, 62});
  ASSERT_EQ(along_it.size(), 2u);
  EXPECT_NEAR((along_it[1] - Eigen::Vector2d(61, 61)).norm(), 0.0, 16 * 2.3e-16 * 100.0);
}

TEST(StreetGraph, RouteAlongOneStreetIsStraight) {
  EXPECT_EQ(square().route({20, 5}, {70, -5}), (Points{{20, 0}, {70, 0}}));
  EXPECT_EQ(square().route({70, 0}, {20, 0}), (Points{{70, 0}, {20, 0}}));
  EXPECT_EQ(square().route({70, 0}, {70, 1}), (Points{{70, 0}}));
}

TEST(StreetGraph, RouteToACornerRepeatsNoPoint) {
  EXPECT_EQ(square().route({50, 0}, {100, 0}), (Points{{50, 0}, {100, 0}}));
  EXPECT_EQ(square().route({50, 0}, {100, 0.0004}).size(), 2u) << "waypoints are written with millimetres";
}

TEST(StreetGraph, RouteThatDoesNotExistIsEmpty) {
  EXPECT_TRUE(square().route({50, 0}, {550, 0}).empty());
  EXPECT_TRUE(StreetGraph{}.route({0, 0}, {1, 1}).empty());
  EXPECT_EQ(square().route({520, 3}, {580, 3}), (Points{{520, 0}, {580, 0}}));
}

TEST(StreetGraph, DistanceIsToTheNearestCentreLine) {
  EXPECT_EQ(square().distance_to({50, -7}), 7.0);
  EXPECT_EQ(square().distance_to({-3, -4}), 5.0) << "beyond the end of a street";
  EXPECT_NEAR(square().distance_to({60, 40}), 20.0 / std::sqrt(2.0), 8 * 2.3e-16 * 100.0);
  EXPECT_EQ(StreetGraph{}.distance_to({0, 0}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace canyon::scene
