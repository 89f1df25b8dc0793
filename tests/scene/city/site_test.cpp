#include "canyon/scene/city/site.h"

#include <gtest/gtest.h>

namespace canyon::scene {
namespace {

TEST(Site, TheKeysOfItsExtentAreThoseThatWereSet) {
  SceneConfig config;
  EXPECT_EQ(extent_keys(config), "scene.extent_m");
  config.from.file = "houses.geojson";
  EXPECT_EQ(extent_keys(config), "scene.margin_m");
  config.from.center_deg = {45.7, 4.8};
  config.from.radius_m = 100.0;
  EXPECT_EQ(extent_keys(config), "scene.margin_m, scene.center_deg, scene.radius_m");
}

TEST(Site, WhatIsPlannedIsWhatIsBuilt) {
  SceneConfig config;
  config.city.extent_m = 500.0;
  config.city.terrain_cell_m = 10.0;
  const auto planned = planned_site(config);
  ASSERT_TRUE(planned.has_value());
  const Scene scene(make_city(config.city));
  const Site made = site_of(scene, config);
  EXPECT_EQ(planned->low_W, made.low_W);
  EXPECT_EQ(planned->high_W, made.high_W);
  EXPECT_EQ(planned->frame.origin_E(), made.frame.origin_E());
  ASSERT_EQ(planned->streets.edges.size(), made.streets.edges.size());
  EXPECT_EQ(planned->streets.nodes_W, made.streets.nodes_W);
  ASSERT_FALSE(made.buildings.empty());
  ASSERT_EQ(planned->buildings.size(), made.buildings.size());
  for (std::size_t i = 0; i < made.buildings.size(); ++i) {
    EXPECT_EQ(planned->buildings[i].name, made.buildings[i].name);
    EXPECT_EQ(planned->buildings[i].footprint_W, made.buildings[i].footprint_W);
  }
}

TEST(Site, AnEmptyCityHasNoBuildings) {
  SceneConfig config;
  config.city.empty = true;
  EXPECT_TRUE(planned_site(config)->buildings.empty());
  EXPECT_FALSE(planned_site(config)->streets.edges.empty());
}

TEST(Site, ASceneFromFilesHasToBeRead) {
  SceneConfig config;
  config.from.file = "city.geojson";
  EXPECT_FALSE(planned_site(config).has_value());
}

}  // namespace
}  // namespace canyon::scene
