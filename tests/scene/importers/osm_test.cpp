#include <cstdio>

#include "canyon/scene/scene_at.h"
#include "canyon/tests/scene/importers/import_fixture.h"

/// OpenStreetMap: houses, parts of buildings, courtyards, trees, streets.
namespace canyon::scene::testing {
namespace {

class Osm : public Import {
 protected:
  void node(int id, double lat, double lon, const std::string& tags = "") {
    char text[120];
    std::snprintf(text, sizeof text, "<node id=\"%d\" lat=\"%.7f\" lon=\"%.7f\">", id, lat, lon);
    osm += text + tags + "</node>";
  }
  void way(int id, std::initializer_list<int> refs, const std::string& tags) {
    osm += "<way id=\"" + std::to_string(id) + "\">";
    for (const int ref : refs) osm += "<nd ref=\"" + std::to_string(ref) + "\"/>";
    osm += tags + "</way>";
  }
  /// Nodes id + 1 to id + 4 and way `id` around them: x, y and size in units of 1e-4 degrees, 7.885 and 11.113 m at 45
  /// N.
  void block(int id, double x, double y, double width, double depth, const std::string& tags) {
    const double lat = 45.0 + 1e-4 * y, lon = 5.0 + 1e-4 * x;
    node(id + 1, lat, lon), node(id + 2, lat, lon + 1e-4 * width);
    node(id + 3, lat + 1e-4 * depth, lon + 1e-4 * width), node(id + 4, lat + 1e-4 * depth, lon);
    way(id, {id + 1, id + 2, id + 3, id + 4, id + 1}, tags);
  }
  static std::string tag(const std::string& key, const std::string& value) {
    return "<tag k=\"" + key + "\" v=\"" + value + "\"/>";
  }
  SceneParts read() { return parts("map.osm", osm + "</osm>"); }
  /// Height of what is seen from above at x, y in the units of block(), over the level ground; `about` is the middle of
  /// what was read, where W's origin lies.
  static double top_m(const Scene& scene, double x, double y, const Eigen::Vector2d& about) {
    const Eigen::Vector2d p((x - about.x()) * 7.8846, (y - about.y()) * 11.1132);
    return 100.0 - SceneAt(scene).trace({{p.x(), p.y(), 100.0}, {0, 0, -1}}).range_m;
  }

  std::string osm = "<osm version=\"0.6\">";
};

TEST_F(Osm, HeightsRoofsAndStreets) {
  // Two houses of about 22 x 16 m, 40 m apart, and a street with a bend.
  for (int h = 0; h < 2; ++h) {
    const double lon = 5.0 + 0.0005 * h;
    node(10 * h + 1, 45.0, lon), node(10 * h + 2, 45.0, lon + 0.0002);
    node(10 * h + 3, 45.0002, lon + 0.0002), node(10 * h + 4, 45.0002, lon);
  }
  node(31, 44.9999, 4.9999), node(32, 44.9999, 5.0003), node(33, 45.0004, 5.0003);
  way(1, {1, 2, 3, 4, 1},
      "<tag k=\"building\" v=\"yes\"/><tag k=\"height\" v=\"10 m\"/><tag k=\"roof:shape\" v=\"gabled\"/>"
      "<tag k=\"roof:height\" v=\"4\"/><tag k=\"building:material\" v=\"brick\"/>");
  way(2, {11, 12, 13, 14, 11}, "<tag k=\"building\" v=\"house\"/><tag k=\"building:levels\" v=\"2\"/>");
  way(3, {31, 32, 33}, "<tag k=\"highway\" v=\"residential\"/>");
  way(4, {31, 33}, "<tag k=\"highway\" v=\"footway\"/>");
  way(5, {11, 12, 13}, "<tag k=\"building\" v=\"yes\"/>");  // not closed
  const SceneParts made = read();
  ASSERT_EQ(made.buildings.size(), 2u);
  EXPECT_DOUBLE_EQ(made.buildings[0].height_m, 10.0);
  EXPECT_DOUBLE_EQ(made.buildings[1].height_m, 6.0);
  EXPECT_EQ(made.streets.edges.size(), 2u);
  EXPECT_EQ(made.streets.nodes_W.size(), 3u);
  ASSERT_EQ(warnings_.size(), 2u);
  EXPECT_EQ(warnings_[0], "1 buildings without a height: storeys of 3 m");
  EXPECT_EQ(warnings_[1], "1 buildings whose outline is cut off or not closed are left out");
  const Scene scene(made);
  const SceneAt at(scene);
  // The gable: 10 m at the ridge, 6 m at the eaves, 8 m half-way. The ridge runs north, along the longer side.
  const Building& b = made.buildings[0];
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const auto& p : b.footprint_W) middle += 0.25 * p;
  const double half_m = 0.5 * (b.footprint_W[1] - b.footprint_W[0]).norm();
  for (const double s : {0.0, 0.5, 0.99}) {
    const auto hit = at.trace({{middle.x() + s * half_m, middle.y(), 50.0}, {0, 0, -1}});
    EXPECT_NEAR(50.0 - hit.range_m, b.base_m + 10.0 - 4.0 * s, 0.02) << s;
  }
  EXPECT_NEAR(area_m2(made, "brick"), 2 * (2 * half_m + 22.2264) * 6.5 + 2 * half_m * 4.0, 1.0);
}

// Simple 3D Buildings: where there are parts, they are what stands there.
TEST_F(Osm, PartsStandForTheirBuilding) {
  block(100, 0, 0, 6, 4, tag("building", "yes") + tag("height", "30") + tag("building:material", "brick"));
  block(200, 0, 0, 2, 4, tag("building:part", "yes") + tag("height", "24"));  // shares three corners with the outline
  block(300, 2, 0, 2, 4, tag("building:part", "yes") + tag("building:levels", "2") + tag("building:material", "glass"));
  block(400, 4, 0, 2, 4, tag("building:part", "yes") + tag("height", "20") + tag("min_height", "5"));
  block(500, 2, 1, 1, 1, tag("building:part", "no") + tag("height", "90"));
  const Scene scene(read());
  ASSERT_EQ(scene.buildings().size(), 1u);
  const Building& b = scene.buildings()[0];
  EXPECT_EQ(b.name, "way 100");
  EXPECT_DOUBLE_EQ(b.height_m, 24.0);  // the highest part: nothing is 30 m high
  ASSERT_EQ(b.footprint_W.size(), 4u);
  EXPECT_NEAR((b.footprint_W[1] - b.footprint_W[0]).norm(), 6 * 7.8846, 2e-3);
  const Eigen::Vector2d about(3, 2);
  EXPECT_NEAR(top_m(scene, 1, 2, about), 24.0, 1e-3);
  EXPECT_NEAR(top_m(scene, 3, 2, about), 6.0, 1e-3);
  EXPECT_NEAR(top_m(scene, 5, 2, about), 20.0, 1e-3);
  // One can look through below the lifted part.
  const SceneAt at(scene);
  EXPECT_FALSE(at.blocked({2 * 7.8846, -60, 2}, {2 * 7.8846, 60, 2}));
  EXPECT_TRUE(at.blocked({2 * 7.8846, -60, 7}, {2 * 7.8846, 60, 7}));
  EXPECT_GT(area_m2(scene.parts(), "brick"), 0.0);  // parts that say nothing of their walls take the building's
  EXPECT_NEAR(area_m2(scene.parts(), "glass"), 2 * (2 * 7.8846 + 4 * 11.1132) * 6.5, 1.0);
}

TEST_F(Osm, PartsThatARelationNamesAndPartsOfNoBuilding) {
  block(100, 0, 0, 2, 2, tag("building", "yes") + tag("height", "12"));
  block(200, 3, 0, 1, 2, tag("building:part", "yes") + tag("height", "8"));   // beside the outline
  block(300, 8, 0, 1, 2, tag("building:part", "roof") + tag("height", "5"));  // alone
  block(400, 12, 0, 1, 1, tag("building", "yes") + tag("height", "4"));
  osm +=
      "<relation id=\"9\"><member type=\"way\" ref=\"100\" role=\"outline\"/>"
      "<member type=\"way\" ref=\"200\" role=\"part\"/>" +
      tag("type", "building") + "</relation>";
  const Scene scene(read());
  ASSERT_EQ(scene.buildings().size(), 3u);
  EXPECT_EQ(scene.buildings()[0].name, "way 100");
  EXPECT_DOUBLE_EQ(scene.buildings()[0].height_m, 8.0);
  EXPECT_EQ(scene.buildings()[1].name, "way 400");
  EXPECT_EQ(scene.buildings()[2].name, "way 300");
  EXPECT_DOUBLE_EQ(scene.buildings()[2].height_m, 5.0);
  const Eigen::Vector2d about(6.5, 1);
  EXPECT_NEAR(top_m(scene, 1, 1, about), 0.0, 1e-3);
  EXPECT_NEAR(top_m(scene, 3.5, 1, about), 8.0, 1e-3);
}

TEST_F(Osm, EachCourtyardIsOfItsOwnOutline) {
  block(100, 0, 0, 3, 3, "");
  block(200, 5, 0, 3, 3, "");
  block(300, 6, 1, 1, 1, "");  // in the second
  osm +=
      "<relation id=\"9\"><member type=\"way\" ref=\"100\" role=\"outer\"/>"
      "<member type=\"way\" ref=\"200\" role=\"outer\"/><member type=\"way\" ref=\"300\" role=\"inner\"/>" +
      tag("type", "multipolygon") + tag("building", "yes") + tag("height", "10") + "</relation>";
  const Scene scene(read());
  ASSERT_EQ(scene.buildings().size(), 1u);
  const Eigen::Vector2d about(4, 1.5);
  EXPECT_NEAR(top_m(scene, 1.5, 1.4, about), 10.0, 1e-3);
  EXPECT_NEAR(top_m(scene, 5.5, 1.4, about), 10.0, 1e-3);
  EXPECT_NEAR(top_m(scene, 6.5, 1.4, about), 0.0, 1e-3);
}

TEST_F(Osm, TreesHaveCrowns) {
  block(100, 0, 0, 2, 2, tag("building", "yes") + tag("height", "12"));
  node(1, 45.0001, 5.0004, tag("natural", "tree") + tag("height", "20") + tag("diameter_crown", "8"));
  node(2, 45.0001, 5.0006, tag("natural", "tree"));
  node(3, 45.0001, 5.0008, tag("natural", "peak"));
  const SceneParts made = read();
  ASSERT_EQ(made.foliage.size(), 2u);
  EXPECT_LT((made.foliage[0].radii_m - Eigen::Vector3d(4, 4, 7)).norm(), 1e-9);
  EXPECT_NEAR(made.foliage[0].center_W.z(), 13.0, 1e-3);
  EXPECT_LT((made.foliage[1].radii_m - Eigen::Vector3d(2.5, 2.5, 3.5)).norm(), 1e-9);
  const Scene scene(made);
  const SceneAt at(scene);
  const Eigen::Vector3d below = made.foliage[0].center_W - Eigen::Vector3d(0, 0, 12);
  EXPECT_NEAR(at.foliage_m(below, {0, 0, 1}), 14.0, 1e-6);
  EXPECT_FALSE(at.blocked_towards(below + Eigen::Vector3d(2, 0, 0), {0, 0, 1}));  // trees do not block
}

}  // namespace
}  // namespace canyon::scene::testing
