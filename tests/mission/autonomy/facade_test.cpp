#include "canyon/mission/autonomy/facade.h"

#include <gtest/gtest.h>

#include "canyon/tests/mission/screened_house.h"

namespace canyon::mission::testing {
namespace {

TEST(Facade, IsTheWallThatFacesTheViewer) {
  scene::Building building;
  building.footprint_W = {{0, 0}, {10, 0}, {10, 20}, {0, 20}};
  building.base_m = 5;
  building.height_m = 10;
  const auto points = facade_points(building, {30, 10});
  ASSERT_EQ(points.size(), 25U);
  for (const auto& p : points) {
    EXPECT_NEAR(p.x(), 10.05, 1e-12);
    EXPECT_GT(p.y(), 0);
    EXPECT_LT(p.y(), 20);
    EXPECT_GT(p.z(), 5);
    EXPECT_LT(p.z(), 15);
  }
  EXPECT_TRUE(facade_points(building, {5, 10}).empty());  // from inside
}

double share_seen(double screen_m, const Eigen::Vector3d& camera_W) {
  const auto scene = screened_house(screen_m);
  return visible_share(scene::SceneAt(*scene), camera_W, facade_points(scene->buildings()[0], {0, 0}));
}

TEST(Facade, WhatStandsBetweenHidesItsShareOfTheGrid) {
  const Eigen::Vector3d camera(0, 0, 1.5);
  EXPECT_EQ(share_seen(0, camera), 1.0);
  EXPECT_EQ(share_seen(kHides12, camera), 13.0 / 25);
  EXPECT_EQ(share_seen(kHides13, camera), 12.0 / 25);
  // From behind the house its own walls are in the way, and nothing of it is seen where no wall faces the viewer.
  EXPECT_EQ(share_seen(0, {29, 0, 1.5}), 0.0);
  EXPECT_EQ(visible_share(scene::SceneAt(*screened_house(0)), camera, {}), 0.0);
}

}  // namespace
}  // namespace canyon::mission::testing
