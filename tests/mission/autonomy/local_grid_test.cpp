#include "canyon/mission/autonomy/local_grid.h"

#include <gtest/gtest.h>

namespace canyon::mission {
namespace {

/// A level street of 20 x 20 m around the vehicle, and a wall 1 m high at x = 5 m.
std::vector<Eigen::Vector3f> street_with_wall(bool wall) {
  std::vector<Eigen::Vector3f> points;
  for (float x = -10; x <= 10; x += 0.1F)
    for (float y = -10; y <= 10; y += 0.1F) points.emplace_back(x, y, 0.0F);
  if (wall)
    for (float y = -3; y <= 3; y += 0.1F)
      for (float z = 0; z <= 1.0F; z += 0.1F) points.emplace_back(5.0F, y, z);
  return points;
}

Pose at(double x, double y, double z) {
  return {Eigen::Quaterniond::Identity(), {x, y, z}};
}

TEST(LocalGrid, FindsAWallAndItsDistance) {
  LocalGrid grid({});
  grid.add(street_with_wall(true), at(100, 200, 30), at(100, 200, 30), 0.0);
  grid.update_distances();
  EXPECT_GT(grid.obstacles(), 0);
  // Cells of 0.25 m: a distance is good to about a cell's diagonal.
  EXPECT_NEAR(grid.distance_m({100, 200}), 5.0, 0.36);
  EXPECT_NEAR(grid.distance_m({105, 206}), 3.0, 0.36);
  EXPECT_EQ(grid.distance_m({500, 500}), LocalGrid::kFar);
}

TEST(LocalGrid, ALevelStreetIsFree) {
  LocalGrid grid({});
  grid.add(street_with_wall(false), at(0, 0, 0), at(0, 0, 0), 0.0);
  grid.update_distances();
  EXPECT_EQ(grid.obstacles(), 0);
  EXPECT_EQ(grid.distance_m({0, 0}), LocalGrid::kFar);
}

// The coupling of the paper: a jump of the estimate's height turns the street itself into obstacles, until they are
// forgotten.
TEST(LocalGrid, AJumpInHeightMakesGhostsThatFade) {
  LocalGridConfig config;
  LocalGrid grid(config);
  grid.add(street_with_wall(false), at(0, 0, 0), at(0, 0, 0), 0.0);
  grid.add(street_with_wall(false), at(0, 0, 0.8), at(0, 0, 0.8), 0.1);
  grid.update_distances();
  EXPECT_GT(grid.obstacles(), 1000);
  for (double t = 0.2; t < 2 * config.memory_s; t += 0.1)
    grid.add(street_with_wall(false), at(0, 0, 0.8), at(0, 0, 0.8), t);
  grid.update_distances();
  EXPECT_EQ(grid.obstacles(), 0);
}

TEST(LocalGrid, DrivesUnderWhatIsHigh) {
  LocalGrid grid({});
  auto points = street_with_wall(false);
  for (float y = -3; y <= 3; y += 0.1F)
    for (float z = 2.5F; z <= 4.0F; z += 0.1F) points.emplace_back(5.0F, y, z);
  grid.add(points, at(0, 0, 0), at(0, 0, 0), 0.0);
  grid.update_distances();
  EXPECT_EQ(grid.obstacles(), 0);
}

TEST(LocalGrid, MovesWithTheVehicle) {
  LocalGrid grid({});
  grid.add(street_with_wall(true), at(0, 0, 0), at(0, 0, 0), 0.0);
  // 40 m on: the wall has left the grid, and its storage is reused by other places.
  grid.add(street_with_wall(false), at(60, 0, 0), at(60, 0, 0), 0.1);
  grid.update_distances();
  EXPECT_EQ(grid.obstacles(), 0);
}

// Exact distance transform against brute force.
TEST(LocalGrid, DistancesAreEuclidean) {
  LocalGrid grid({});
  std::vector<Eigen::Vector3f> points;
  for (const auto& [x, y] : {std::pair{3.1F, 2.2F}, {-4.3F, 1.1F}, {0.6F, -6.2F}})
    for (float z = 0; z <= 1.0F; z += 0.1F) points.emplace_back(x, y, z);
  grid.add(points, at(0, 0, 0), at(0, 0, 0), 0.0);
  grid.update_distances();
  ASSERT_EQ(grid.obstacles(), 3);
  const auto cell = [](double v) { return std::floor(v / 0.25); };
  for (double x = -8; x < 8; x += 0.7) {
    for (double y = -8; y < 8; y += 0.7) {
      double expected = LocalGrid::kFar;
      for (const auto& p : points)
        expected = std::min(expected, 0.25 * std::hypot(cell(p.x()) - cell(x), cell(p.y()) - cell(y)));
      ASSERT_NEAR(grid.distance_m({x, y}), expected, 1e-5) << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace canyon::mission
