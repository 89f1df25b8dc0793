#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/tracing/tiled_tracer.h"
#include "canyon/tests/scene/importers/import_fixture.h"
#include "canyon/tests/scene/small_scenes.h"
#include "canyon/tests/support/process_cpu.h"
#include "canyon/tests/support/test_data.h"

/// Files that were made to hurt, or that somebody damaged: an error in one line, or a scene whose cost follows what is
/// in it.
namespace canyon::scene::testing {

/// What took minutes before is done in milliseconds; a slow machine is not to be taken for it.
constexpr double kRunaway_s = 30.0;
namespace {

using canyon::testing::process_cpu_s;
using ::testing::HasSubstr;

// 2026-11-22: XML_PARSE_HUGE took away libxml2's own limits: 1.5 kB of entities that hold one another took 2 GB.
TEST_F(Import, XmlThatDeclaresEntitiesIsRefused) {
  std::string bomb =
      "<?xml version=\"1.0\"?>\n<!DOCTYPE x [\n<!ENTITY e0 \"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\">\n";
  for (int i = 1; i < 20; ++i) {
    bomb += "<!ENTITY e" + std::to_string(i) + " \"";
    for (int k = 0; k < 8; ++k) bomb += "&e" + std::to_string(i - 1) + ";";
    bomb += "\">\n";
  }
  bomb += "]>\n";
  const double before_s = process_cpu_s();
  const std::string told = ":3: DOCTYPE: declares entities or attributes, expected XML without declarations of its own";
  EXPECT_EQ(message("a.osm", bomb + "<osm><way id=\"1\"><tag k=\"building\" v=\"&e19;\"/></way></osm>"),
            "a.osm" + told);
  EXPECT_EQ(message("a.gml", bomb + "<CityModel><cityObjectMember>&e19;</cityObjectMember></CityModel>"),
            "a.gml" + told);
  EXPECT_EQ(message("a.xml", bomb + "<scene><shape type=\"&e19;\"/></scene>"), "a.xml" + told);
  // Default attributes grow a file just so.
  EXPECT_EQ(message("b.osm", "<!DOCTYPE osm [\n<!ATTLIST node v CDATA \"" + std::string(100000, 'a') +
                                 "\">\n]>\n<osm><node id=\"1\" lat=\"1\" lon=\"1\"/></osm>"),
            "b.osm:2: DOCTYPE: declares entities or attributes, expected XML without declarations of its own");
  EXPECT_LT(process_cpu_s() - before_s, kRunaway_s);
}

// 2026-11-22: elements nested without bounds ended our own recursion with a segmentation fault.
TEST_F(Import, XmlThatNestsWithoutEndIsRefused) {
  std::string deep = "<CityModel>";
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  EXPECT_EQ(message("a.gml", deep), "a.gml:1: elements more than 256 deep, expected a scene");
}

TEST_F(Import, HonestXmlMayBeLarge) {
  std::string text = "<?xml version='1.0' encoding='UTF-8'?>\n<osm version=\"0.6\">\n";
  for (int i = 0; text.size() < 12'000'000; ++i)  // libxml2's limits are of 10 MB
    text += "<node id=\"" + std::to_string(100 + i) + "\" lat=\"45.1\" lon=\"5.1\"><tag k=\"note\" v=\"" +
            std::string(60, 'n') + "\"/></node>\n";
  text +=
      "<node id=\"1\" lat=\"45\" lon=\"5\"/><node id=\"2\" lat=\"45\" lon=\"5.0002\"/><node id=\"3\" lat=\"45.0002\" "
      "lon=\"5.0002\"/><way id=\"7\"><nd ref=\"1\"/><nd ref=\"2\"/><nd ref=\"3\"/><nd ref=\"1\"/>"
      "<tag k=\"building\" v=\"yes\"/></way></osm>";
  EXPECT_EQ(parts("large.osm", text).buildings.size(), 1u);
}

// 2026-11-22: tiles were counted in int, and one far vertex made a rectangle of ground as wide.
TEST_F(Import, AFarCornerIsNamedWithFileAndLine) {
  const double before_s = process_cpu_s();
  const std::string rest =
      " km from the middle of the scene, expected coordinates within 100 km of it, or scene.center_deg and "
      "scene.radius_m to leave out what is farther";
  const auto obj = [](const std::string& vertex) {
    return "v 0 0 0\nv 20 0 0\nv 20 0 9\n" + vertex + "\no wall\nf 1 2 3\nf 1 2 4\n";
  };
  EXPECT_EQ(message("a.obj", obj("v 99999999999999999999 30 0")), "a.obj:4: vertex 4: lies 1e+17" + rest);
  EXPECT_EQ(message("a.obj", obj("v 1e6 30 0")), "a.obj:4: vertex 4: lies 1000" + rest);
  EXPECT_THAT(message("a.obj", obj("v 0 -1e38 0")), ::testing::StartsWith("a.obj:4: vertex 4: lies "));
  EXPECT_EQ(message("a.ply",
                    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
                    "z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n20 0 0\n20 0 9\n0 "
                    "1e6 0\n3 0 1 2\n3 0 1 3\n"),
            "a.ply:13: vertex 4: lies 1000" + rest);
  std::string town = "{\"type\":\"FeatureCollection\",\"features\":[\n";
  for (int i = 0; i < 3; ++i)
    town +=
        "{\"type\":\"Feature\",\"properties\":{\"height\":9},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[["
        "[5.0,45.0],[5.0002,45.0],[5.0002,45.0002],[" +
        std::string(i == 2 ? "2147483648" : "5.0") + ",45.0002],[5.0,45.0]]]}}" + (i == 2 ? "\n" : ",\n");
  EXPECT_THAT(message("a.geojson", town + "]}"), ::testing::StartsWith("a.geojson:4: building 3: lies "));
  EXPECT_LT(process_cpu_s() - before_s, kRunaway_s);
  // A vertex that no face uses is nowhere.
  EXPECT_EQ(parts("b.obj", "v 0 0 0\nv 20 0 0\nv 20 0 9\nv 1e30 0 0\no wall\nf 1 2 3\n").mesh.triangles.size() % 2, 1u);
}

// 2026-11-22: what no importer has looked at must not break the tracer either.
TEST(TiledTracer, ATriangleWithoutEndCostsNoMoreThanAnother) {
  SceneParts parts = empty_parts();
  add_plane(parts, 50.0, 0.0);
  add_building(parts, rectangle(10, -5, 20, 5), 0.0, 12.0);
  MeshBuilder mesh(parts);
  mesh.begin_object("sail", ObjectKind::kOther);
  mesh.triangle({0, 0, 40}, {1e20, 30, 40}, {0, 1, 40}, 0);
  for (int i = 0; i < 3000; ++i)
    mesh.triangle({-99e3, -99e3, 50.0 + i}, {99e3, 99e3, 50.0 + i}, {-99e3, 99e3, 51.0 + i}, 0);
  const double before_s = process_cpu_s();
  const Scene scene(parts);
  const SceneAt at(scene);
  EXPECT_NEAR(at.trace({{0, 0, 5}, {1, 0, 0}}).range_m, 10.0, 1e-5);
  EXPECT_TRUE(at.blocked({0, 0.2, 5}, {0, 0.2, 300}));
  EXPECT_FALSE(at.trace({{5e9, -8e9, 5}, {0, -1, 0}}).hit());
  EXPECT_LE(static_cast<double>(TiledTracer(scene.parts(), scene.extent()).tiles()), TiledTracer::kMostTiles);
  EXPECT_LT(process_cpu_s() - before_s, kRunaway_s);
}

/// Fifty houses of 18 x 12 m on rolling ground, somewhere in a square.
std::string fifty_houses(double width_deg) {
  std::string out = "{\"type\":\"FeatureCollection\",\"features\":[\n";
  const RandomStream stream(9, "test.houses");
  for (std::uint64_t i = 0; i < 50; ++i) {
    const double lon = 5.0 + width_deg * (stream.uniform(0, i) - 0.5),
                 lat = 45.0 + width_deg * (stream.uniform(1, i) - 0.5);
    char text[512];
    std::snprintf(text, sizeof text,
                  "{\"type\":\"Feature\",\"properties\":{\"height\":9,\"ground_height\":%.1f},\"geometry\":{\"type\":"
                  "\"Polygon\",\"coordinates\":[[[%.7f,%.7f],[%.7f,%.7f],[%.7f,%.7f],[%.7f,%.7f],[%.7f,%.7f]]]}}%s\n",
                  300.0 + 40.0 * std::sin(30.0 * lon), lon, lat, lon + 2e-4, lat, lon + 2e-4, lat + 1e-4, lon,
                  lat + 1e-4, lon, lat, i < 49 ? "," : "");
    out += text;
  }
  return out + "]}";
}

// 2026-11-22: 49 buildings over 9 x 10 km made 7.4 million triangles of ground, and took 35 s.
TEST_F(Import, FiftyBuildingsCostTheSameWhateverTheirExtent) {
  for (const double width_deg : {0.01, 0.1, 1.0}) {  // 1, 11 and 111 km
    const double before_s = process_cpu_s();
    const Scene scene(parts("houses.geojson", fifty_houses(width_deg)));
    const double took_s = process_cpu_s() - before_s;
    std::printf("  %.0f km: %zu triangles, %.2f s of CPU\n", 111.0 * width_deg, scene.mesh().triangles.size(), took_s);
    EXPECT_EQ(scene.buildings().size(), 50u);
    EXPECT_LT(scene.mesh().triangles.size(), 300000u);
    for (const Building& b : scene.buildings()) {
      const Eigen::Vector2d p = b.footprint_W[0];
      const auto here = scene.ground(p.x(), p.y());
      ASSERT_TRUE(here.has_value());
      EXPECT_LE(b.base_m - 60.0, here->height_m);
    }
    // Ground everywhere between them.
    for (const Building& b : scene.buildings()) {
      const Eigen::Vector2d p = 0.5 * (b.footprint_W[0] + scene.buildings()[0].footprint_W[0]);
      EXPECT_TRUE(scene.ground(p.x(), p.y()).has_value());
    }
  }
}

TEST_F(Import, ZurichNeedsNoMoreGroundThanItsBuildings) {
  CANYON_REAL_DATA(path, "scenes/zurich/zurich_subset_lod2.city.json.gz");
  const double before_s = process_cpu_s();
  const auto made = import(path);
  ASSERT_TRUE(made.ok());
  const Scene scene(made->parts);
  std::printf("  %zu triangles, %.2f s of CPU\n", scene.mesh().triangles.size(), process_cpu_s() - before_s);
  EXPECT_EQ(scene.buildings().size(), 49u);
  EXPECT_LT(scene.mesh().triangles.size(), 300000u);
}

// 2026-11-22: map coordinates without their system stayed as they are, where single precision steps by 3 cm.
TEST_F(Import, LocalMetresFarFromTheirOriginAreSetAboutTheirMiddle) {
  const std::string cube = "o building 1\nf 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";
  const auto vertices = [](double x, double y, double z) {
    std::string out;
    for (const double up : {0.0, 6.0})
      for (const auto& c : {Eigen::Vector2d(0, 0), Eigen::Vector2d(10.013, 0), Eigen::Vector2d(10.013, 8.007),
                            Eigen::Vector2d(0, 8.007)}) {
        char line[120];
        std::snprintf(line, sizeof line, "v %.4f %.4f %.4f\n", x + c.x(), y + c.y(), z + up);
        out += line;
      }
    return out;
  };
  const SceneParts far = parts("map.obj", vertices(683000.25, 248000.75, 431.0) + cube);
  ASSERT_EQ(far.buildings.size(), 1u);
  const auto& outline = far.buildings[0].footprint_W;
  // Kept to a step of single precision at 10 m, 5e-7 m, where they were 0.03 m before.
  EXPECT_NEAR(std::abs(outline[2].x() - outline[0].x()), 10.013, 2e-6);
  EXPECT_NEAR(std::abs(outline[2].y() - outline[0].y()), 8.007, 2e-6);
  EXPECT_NEAR(far.buildings[0].base_m, 0.0, 1e-9);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_EQ(warnings_[0],
            "no coordinate system is said (scene.crs) and none is local: (683005, 248005, 431) of the file is set down "
            "at 45.000000, 5.000000 deg, 100.0 m (scene.lat_deg, scene.lon_deg, scene.base_height_m)");
  // Metres about an origin of the file's own stay where they are.
  const SceneParts near = parts("near.obj", vertices(300.0, -200.0, 4.0) + cube);
  EXPECT_TRUE(warnings_.empty());
  EXPECT_NEAR(near.buildings[0].footprint_W[0].x(), 305.0, 6.0);
  EXPECT_NEAR(near.buildings[0].base_m, 4.0, 1e-6);
}

TEST_F(Import, ZurichWithoutItsCoordinateSystemLosesNoMoreTriangles) {
  CANYON_REAL_DATA(path, "scenes/zurich/zurich_subset_lod2.city.json.gz");
  const std::string bare = scratch_.file("bare.city.json");
  ASSERT_EQ(std::system(("gzip -dc '" + path + "' | sed 's/\"referenceSystem\"/\"was\"/' > '" + bare + "'").c_str()),
            0);
  const auto said = import(path);
  ASSERT_TRUE(said.ok());
  const std::size_t dropped = Scene(said->parts).dropped_triangles();
  const auto unsaid = import(bare);
  ASSERT_TRUE(unsaid.ok()) << unsaid.error().str();
  EXPECT_TRUE(unsaid->report.crs.empty());
  EXPECT_GT(unsaid->report.file_origin_m.head<2>().norm(), 1e5);
  const std::size_t dropped_bare = Scene(unsaid->parts).dropped_triangles();
  std::printf("  triangles that no ray meets: %zu with the system, %zu without\n", dropped, dropped_bare);
  // Corners within 5.5 km of W's origin either way: the same slivers, but for those at the limit.
  EXPECT_LE(dropped_bare, dropped + 5);
}

// 2026-11-22: a far corner of a courtyard was not looked at, and the building reached around the Earth.
TEST_F(Import, AFarCornerOfACourtyardIsNamed) {
  EXPECT_THAT(
      message("a.geojson",
              "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":{\"id\":\"hall\","
              "\"height\":9},\n\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[5,45],[5.001,45],[5.001,45.001],"
              "[5,45]],[[21,45.0002],[5.0005,45.0002],[5.0005,45.0004],[21,45.0002]]]}}]}"),
      ::testing::HasSubstr("hall: lies "));
}

// 2026-11-22: an empty file "does not look like a scene".
TEST_F(Import, AnEmptyFileIsToldToBeEmpty) {
  for (const char* name : {"a.obj", "a.ply", "a.json", "a.geojson", "a.city.json", "a.gml", "a.osm", "a.xml"})
    EXPECT_EQ(message(name, ""), std::string(name) + ": is empty, expected a scene");
  EXPECT_EQ(message("a.json", " \n\t\n"), "a.json: is empty, expected a scene");
}

TEST_F(Import, ASceneThatIsTooLargeIsRefusedBeforeItIsMade) {
  config_.file = write("houses.geojson", fifty_houses(0.02));
  config_.undulation_m = 40.0;
  config_.ground_cell_m = 0.5;
  config_.margin_m = 1000.0;
  const double before_s = process_cpu_s();
  const auto made = import_scene(config_, {}, 1'000'000);
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().str(), HasSubstr("houses.geojson: a scene of about "));
  EXPECT_THAT(made.error().str(), HasSubstr("million triangles, "));
  EXPECT_THAT(made.error().str(),
              HasSubstr("expected larger cells (scene.ground_cell_m), less around it (scene.margin_m), "
                        "a part of it (scene.radius_m), or scene.max_triangles above 1000000"));
  EXPECT_LT(process_cpu_s() - before_s, kRunaway_s);
  // What is said before is what comes out, to a fifth.
  config_.ground_cell_m = 5.0, config_.margin_m = 60.0;
  const auto small = import_scene(config_, {});
  ASSERT_TRUE(small.ok());
  const auto triangles = static_cast<double>(small->parts.mesh.triangles.size());
  EXPECT_NEAR(small->report.predicted.triangles, triangles, 0.2 * triangles);
}

// 2026-11-22: nothing in scene/ looked whether the user had asked to stop.
TEST_F(Import, EveryPhaseStopsWhenAsked) {
  config_.file = write("houses.geojson", fifty_houses(0.02));
  const auto whole = parts("houses.geojson", fifty_houses(0.02));
  struct Asked {
    Asked() { set_cancel_requested(true); }
    ~Asked() { set_cancel_requested(false); }
  };
  const Scene scene(whole);
  {
    const Asked asked;
    EXPECT_THROW((void)import_scene(config_, {}), Cancelled);
    EXPECT_THROW(Scene{whole}, Cancelled);
    EXPECT_THROW((void)scene.facets(), Cancelled);
    EXPECT_THROW((void)scene.edges(), Cancelled);
    EXPECT_THROW((void)make_city({}), Cancelled);
  }
  EXPECT_FALSE(scene.facets().facets().empty());  // and can be asked again
}

}  // namespace
}  // namespace canyon::scene::testing
