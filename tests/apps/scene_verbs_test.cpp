// canyon scene ...: as a user calls it.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Two buildings of 22 x 16 m, 10 and 20 m high, 40 m apart, on ground at 200 m.
constexpr const char* kTown = R"({"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"id":"a","height":10.0,"ground_height":200.0},"geometry":{"type":"Polygon",
"coordinates":[[[5.0,45.0],[5.0002,45.0],[5.0002,45.0002],[5.0,45.0002],[5.0,45.0]]]}},
{"type":"Feature","properties":{"id":"b","height":20.0,"ground_height":200.0},"geometry":{"type":"Polygon",
"coordinates":[[[5.0005,45.0],[5.0007,45.0],[5.0007,45.0002],[5.0005,45.0002],[5.0005,45.0]]]}}]})";

class SceneVerbsTest : public testing::CommandLineTest {
 protected:
  nlohmann::json json(const std::string& arguments) const {
    EXPECT_EQ(canyon(arguments + " --json"), 0) << read("stderr");
    return nlohmann::json::parse(read("stdout"));
  }
  void expect_error(const std::string& arguments, const std::string& line) const {
    EXPECT_EQ(canyon(arguments), 2) << arguments;
    EXPECT_EQ(read("stderr"), line + "\n");
    EXPECT_THAT(leftovers(), ::testing::IsEmpty());
  }
};

TEST_F(SceneVerbsTest, InfoSaysWhatIsThere) {
  write("given.geojson", kTown);
  const auto info = json("scene info given.geojson --undulation 50");
  EXPECT_EQ(info["name"], "given.geojson");
  EXPECT_EQ(info["buildings"], 2);
  EXPECT_EQ(info["building_height_sum_m"], 30.0);
  EXPECT_EQ(info["undulation_m"], 50.0);
  EXPECT_EQ(info["undulation_source"], "stated");
  EXPECT_EQ(info["heights_above"], "orthometric (assumed)");
  EXPECT_NEAR(info["origin"]["lat_deg"].get<double>(), 45.0001, 1e-9);
  EXPECT_NEAR(info["origin"]["lon_deg"].get<double>(), 5.00035, 1e-9);
  EXPECT_EQ(info["origin"]["h_m"], 250.0);
  // 7e-4 degrees of longitude, 2e-4 of latitude, and 60 m of terrain all around in whole cells of 5 m.
  EXPECT_NEAR(info["extent_m"][0].get<double>(), 55.2 + 120.0, 10.0);
  EXPECT_NEAR(info["extent_m"][1].get<double>(), 22.2 + 120.0, 10.0);
  EXPECT_NEAR(info["extent_m"][2].get<double>(), 20.5, 0.05);
  EXPECT_NEAR(info["area_m2"].get<double>(), info["extent_m"][0].get<double>() * info["extent_m"][1].get<double>(), 1);
  EXPECT_EQ(info["facets"], 10);  // four walls and a roof each
  EXPECT_EQ(info["watertight_objects"], 2);
  EXPECT_EQ(info["objects"], 2);
  EXPECT_EQ(info["flipped_edges"], 0);
  EXPECT_EQ(info["dropped_triangles"], 0);
  ASSERT_EQ(info["materials"].size(), 3u);
  for (const auto& m : info["materials"]) {
    const double walls_m2 = 2 * (2 * (15.77 + 22.23)) * 15.5, roofs_m2 = 2 * 15.77 * 22.23;
    if (m["name"] == "asphalt") continue;
    EXPECT_NEAR(m["area_m2"].get<double>(), m["name"] == "roofing" ? roofs_m2 : walls_m2, 0.01 * walls_m2);
  }
  EXPECT_THAT(info["gnss"].dump(), HasSubstr("needs 10 mirrors for reflections"));
  EXPECT_EQ(info["hash"].get<std::string>().size(), 64u);

  ASSERT_EQ(canyon("scene info given.geojson --undulation 50"), 0);
  EXPECT_THAT(read("stdout"), AllOf(HasSubstr("buildings         2, heights sum to 30.0 m"),
                                    HasSubstr("above orthometric (assumed), undulation 50.00 m (stated)"),
                                    HasSubstr("watertight        2 of 2 objects")));
}

TEST_F(SceneVerbsTest, PicturesAreDrawn) {
  write("given.geojson", kTown);
  ASSERT_EQ(canyon("scene info given.geojson --undulation 50 --picture town.png --cell 2"), 0) << read("stderr");
  EXPECT_EQ(read("town.png").substr(1, 3), "PNG");
  ASSERT_EQ(canyon("scene info given.geojson --undulation 50 --picture town.svg"), 0) << read("stderr");
  EXPECT_THAT(read("town.svg"), HasSubstr("height above the ground"));
  const std::string check = "/usr/bin/python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' '";
  EXPECT_EQ(std::system((check + path("town.svg") + "'").c_str()), 0);
}

TEST_F(SceneVerbsTest, MakeWritesWhatInfoReadsBack) {
  const auto made = json("scene make city --seed 7 --extent 300 --out given_city");
  EXPECT_THAT(leftovers(), ::testing::IsEmpty());
  for (const char* file : {"scene.json", "scene.obj", "scene.mtl", "materials.toml"})
    EXPECT_FALSE(read(std::string("given_city/") + file).empty()) << file;
  const auto info = json("scene info given_city/scene.json");
  EXPECT_EQ(info["buildings"], made["buildings"]);
  EXPECT_EQ(info["triangles"], made["triangles"]);
  EXPECT_GT(info["buildings"].get<int>(), 5);
  EXPECT_NE(json("scene make city --seed 8 --extent 300 --out given_other")["triangles"], made["triangles"]);

  // Once more into the same place only with --force; and the same bits.
  expect_error("scene make city --seed 7 --extent 300 --out given_city",
               "given_city: output directory exists, expected a new one or --force");
  const std::string before = read("given_city/scene.obj");
  ASSERT_EQ(canyon("scene make city --seed 7 --extent 300 --out given_city --force"), 0) << read("stderr");
  EXPECT_EQ(read("given_city/scene.obj"), before);

  // Any scene can be written, and is the same scene.
  write("given.geojson", kTown);
  ASSERT_EQ(canyon("scene make given.geojson --undulation 50 --out given_town"), 0) << read("stderr");
  const auto town = json("scene info given.geojson --undulation 50");
  EXPECT_EQ(json("scene info given_town/scene.json")["hash"], town["hash"]);
}

TEST_F(SceneVerbsTest, MistakesAreToldInOneLine) {
  const auto told = [&](const std::string& name, const std::string& text, const std::string& rest) {
    write(name, text);
    expect_error("scene info " + name, name + rest);
  };
  expect_error("scene info given_none.obj",
               "given_none.obj: cannot be read (No such file or directory), expected a readable file");
  told("given.dwg", "x",
       ": a scene format that is not known, expected a file that ends with .obj .ply .city.json .city.jsonl .jsonl "
       ".json .geojson .gml .citygml .xml .osm .gltf .glb .dae .fbx .stl .3ds");
  for (const char* name : {"given.obj", "given.ply", "given.geojson", "given.city.json", "given.gml", "given.osm"}) {
    write(name, "");
    EXPECT_EQ(canyon(std::string("scene info ") + name), 2);
    const std::string message = read("stderr");
    EXPECT_EQ(message.rfind(name, 0), 0u) << message;
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
  }
  told("given.geojson", "{\"type\": 7, \"was\": \"FeatureCollection\", \"features\": []}",
       ": type: not a collection of features, expected \"type\": \"FeatureCollection\"");
  told("given.city.json", "{\"type\": [], \"CityObjects\": {}, \"vertices\": []}",
       ": type: not a CityJSON file, expected \"type\": \"CityJSON\"");
  told("given.gml",
       "<CityModel><cityObjectMember><Building><lod1Solid><Polygon><exterior><LinearRing>"
       "<posList srsDimension=\"2\">0 0 1 0 1 1 0 0</posList></LinearRing></exterior></Polygon></lod1Solid></Building>"
       "</cityObjectMember></CityModel>",
       ":1: srsDimension: \"2\", expected 3: points with a height");
  told("given.ply", "ply\nformat ascii 1.0\nelement vertex 1000000000000000000\nend_header\n",
       ":4: 1000000000000000000 of element \"vertex\", expected properties, and no more than the file holds");
  told("given.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 "
       "3\n",
       ": holds no face: a cloud of points, expected a PLY mesh");
  write("given.geojson", kTown);
  expect_error("scene info given.geojson --terrain given.dwg",
               "given.dwg: a terrain format that is not known, expected a file that ends with .tif, .tiff, .hgt, "
               ".hgt.zip, .hgt.gz or .asc");
  expect_error("scene info given.geojson --crs EPSG:1",
               "given.geojson: crs: PROJ knows no coordinate system \"EPSG:1\", expected an EPSG code, WKT or PROJ "
               "string");
  expect_mistake("scene info given.geojson --cell 0", "--cell");
  expect_mistake("scene make city --extent 10 --out given_small", "--extent");
  expect_mistake("scene info", "scene");
}

}  // namespace
}  // namespace canyon::apps
