#include <gtest/gtest.h>

#include <cmath>

#include "canyon/scene/city/city.h"
#include "canyon/scene/city/plan.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/scene_source.h"

namespace canyon::scene::testing {
namespace {

CityConfig with_kerbs(double height_m) {
  CityConfig config;
  config.extent_m = 500.0;
  config.kerb_height_m = height_m;
  return config;
}

// What one sees from above, over the ground, along a line across a kerb.
TEST(Pavements, AreRaisedByTheKerbsHeight) {
  const CityConfig config = with_kerbs(0.12);
  const Scene city(make_city(config));
  const SceneAt at(city);
  int raised = 0, level = 0;
  for (const city::Block& block : city::make_plan(config).blocks) {
    const double y = block.kerb.center().y();
    for (const double inwards_m : {-0.5, 0.5}) {
      const double x = block.kerb.x0 + inwards_m, ground_m = city.ground(x, y)->height_m;
      // From under crowns and over nothing else that stands there.
      const Hit hit = at.trace(Ray{{x, y, ground_m + 0.5}, {0.0F, 0.0F, -1.0F}, 2.0F});
      ASSERT_TRUE(hit.hit());
      const double above_m = 0.5 - static_cast<double>(hit.range_m);
      if (std::abs(above_m) < 0.02) ++level;
      if (std::abs(above_m - 0.12) < 0.02) ++raised;
    }
  }
  const auto blocks = static_cast<int>(city::make_plan(config).blocks.size());
  EXPECT_GT(raised, 9 * blocks / 10);
  EXPECT_GT(level, 2 * blocks / 3) << "cars may be parked there";
  EXPECT_LT(level, blocks + 1);
}

TEST(Pavements, AreNoneUnlessAskedFor) {
  EXPECT_LT(make_city(with_kerbs(0.0)).mesh.triangles.size(), make_city(with_kerbs(0.1)).mesh.triangles.size());
  for (const SceneObject& object : make_city(with_kerbs(0.0)).objects) EXPECT_NE(object.name.rfind("pavement", 0), 0U);
}

// As a mission makes it, with its table of materials.
TEST(Pavements, AreMadeForAMission) {
  SceneConfig config;
  config.city = with_kerbs(0.12);
  const auto made = make_scene(config);
  ASSERT_TRUE(made) << made.error().str();
  const Scene city(made->parts);
  EXPECT_GT(city.objects().size(), 100U);
}

// The terminal says how large a scene is going to be; it is refused where that is too much.
TEST(Pavements, AreCountedBeforehand) {
  const double with = predicted_cost(with_kerbs(0.1)).triangles, without = predicted_cost(with_kerbs(0.0)).triangles;
  const auto made = [](double height_m) {
    return static_cast<double>(make_city(with_kerbs(height_m)).mesh.triangles.size());
  };
  EXPECT_EQ(with - without, made(0.1) - made(0.0));
}

}  // namespace
}  // namespace canyon::scene::testing
