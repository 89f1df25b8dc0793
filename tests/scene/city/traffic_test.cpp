#include "canyon/scene/city/traffic.h"

#include <gtest/gtest.h>

#include "canyon/scene/city/site.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/scene/small_scenes.h"

namespace canyon::scene::testing {
namespace {

TEST(Traffic, GoesAlongItsWayOnTheGround) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 3.0, 0.1);  // rises 10 % to the east
  const Scene scene(std::move(parts));
  const auto traffic =
      Traffic::make({{"", "car", {-20, 0, 20, 0, 20, 30}, 5.0, 2.0}, {"walker", "person", {0, 10}, 1.0, 0.0}}, scene);
  ASSERT_TRUE(traffic.ok()) << traffic.error().str();
  const auto place = [&](double t_s) { return traffic->at(t_s)[0].X_WS.p; };
  EXPECT_LT((place(0.0) - Eigen::Vector3d(-20, 0, 1)).norm(), 1e-5);
  EXPECT_LT((place(2.0) - Eigen::Vector3d(-20, 0, 1)).norm(), 1e-5);
  EXPECT_LT((place(6.0) - Eigen::Vector3d(0, 0, 3)).norm(), 1e-5);
  EXPECT_LT((place(14.0) - Eigen::Vector3d(20, 20, 5)).norm(), 1e-5);
  EXPECT_LT((place(100.0) - Eigen::Vector3d(20, 30, 5)).norm(), 1e-5);  // stands at the end
  const Pose up_hill = traffic->at(6.0)[0].X_WS;
  EXPECT_LT((up_hill.R * Eigen::Vector3d::UnitX() - Eigen::Vector3d(1, 0, 0.1).normalized()).norm(), 1e-6);
  EXPECT_EQ(traffic->at(0.0)[0].name, "car 1");
  EXPECT_EQ(traffic->at(0.0)[1].name, "walker");

  SceneAt at(scene);
  at.set_instances(traffic->at(6.0));
  const Hit hit = at.trace({{0, 10, 30}, {0, 0, -1}});
  EXPECT_EQ(at.object(at.surface(hit.triangle).object).kind, ObjectKind::kPerson);
  EXPECT_NEAR(30.0 - hit.range_m, 3.0 + 1.75, 1e-5);  // people stand upright on slopes
}

// Its way of 70 m takes 14 s from 2 s on.
TEST(Traffic, StandsBeforeItsWayAndAfterIt) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 0.0);
  const Scene scene(std::move(parts));
  const auto traffic = Traffic::make({{"goes", "car", {-20, 0, 20, 0, 20, 30}, 5.0, 2.0},
                                      {"there and back", "car", {0, 20, 10, 20, 0, 20}, 5.0, 2.0},
                                      {"has no way", "car", {0, 10}, 5.0, 2.0},
                                      {"has no speed", "person", {0, 40, 10, 40}, 0.0, 2.0}},
                                     scene);
  ASSERT_TRUE(traffic.ok()) << traffic.error().str();
  using Places = std::vector<std::size_t>;
  EXPECT_EQ(traffic->standing(0.0, 2.0), (Places{0, 1, 2, 3})) << "none has started";
  EXPECT_EQ(traffic->standing(0.0, 3.0), (Places{2, 3}));
  EXPECT_EQ(traffic->standing(0.0, 100.0), (Places{2, 3})) << "one is at the same place both times";
  EXPECT_EQ(traffic->standing(6.0, 100.0), (Places{1, 2, 3}));
  EXPECT_EQ(traffic->standing(16.0, 100.0), (Places{0, 1, 2, 3})) << "all have come to their ends";
  EXPECT_EQ(traffic->standing(15.9, 100.0), (Places{1, 2, 3}));
}

TEST(Traffic, MistakesAreTold) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 0.0);
  const Scene scene(std::move(parts));
  EXPECT_EQ(Traffic::make({{"", "car", {1.0}, 5.0, 0.0}}, scene).error().str(),
            "scene.moving[1].path_m: 1 numbers, expected x, y of at least one point");
  EXPECT_EQ(Traffic::make({{"", "car", {500, 0}, 5.0, 0.0}}, scene).error().str(),
            "scene.moving[1].path_m: (500, 0) lies outside the scene, expected a point on the terrain");
  EXPECT_TRUE(Traffic::make({}, scene)->empty());
  SceneConfig city;
  EXPECT_EQ(
      check_ways({{"", "car", {501, 0}, 5.0, 0.0}}, *planned_site(city)).error().str(),
      "scene.moving[1].path_m: (501, 0) lies outside the scene, expected a point on the terrain (scene.extent_m)");
}

// 2026-11-30: two buses of one name were told apart by nobody: "hit other vehicle bus".
TEST(Traffic, NamesAreThoseOfNothingElse) {
  SceneParts parts = empty_parts();
  add_plane(parts, 100.0, 0.0);
  const std::string ground = parts.objects.front().name;
  const Scene scene(std::move(parts));
  const auto thing = [](const std::string& name, const std::string& shape = "car") {
    return MovingConfig{.name = name, .shape = shape, .path_m = {1.0, 2.0}, .speed_m_s = 5.0, .start_s = 0.0};
  };
  const auto told = [&](const std::vector<MovingConfig>& things) {
    const auto traffic = Traffic::make(things, scene);
    return traffic.ok() ? "no mistake" : traffic.error().str();
  };
  const SceneConfig city;
  const auto told_beforehand = [&](const std::vector<MovingConfig>& things) {
    const Status checked = check_ways(things, *planned_site(city));
    return checked.ok() ? "no mistake" : checked.error().str();
  };
  const std::string twice =
      "scene.moving[3].name: \"line 9\" is the name of scene.moving[1] too, expected a name of its own";
  EXPECT_EQ(told({thing("line 9", "bus"), thing(""), thing("line 9", "bus")}), twice);
  EXPECT_EQ(told_beforehand({thing("line 9", "bus"), thing(""), thing("line 9", "bus")}), twice);
  // Those without a name are named by their shape and number.
  EXPECT_EQ(told({thing("car 2"), thing("")}),
            "scene.moving[2].name: \"car 2\" is the name of scene.moving[1] too, expected a name of its own");
  EXPECT_EQ(told({thing("car 2"), thing("", "bus"), thing("")}), "no mistake");
  EXPECT_EQ(told({thing(""), thing(ground)}),
            "scene.moving[2].name: \"" + ground +
                "\" is the name of something that stands in the scene too, expected a name of its own");
  EXPECT_EQ(told_beforehand({thing("building 1")}),
            "scene.moving[1].name: \"building 1\" is the name of something that stands in the scene too, expected a "
            "name of its own");
}

}  // namespace
}  // namespace canyon::scene::testing
