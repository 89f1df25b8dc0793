#include "scene/import.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "core/units.h"
#include "scene/scene.h"
#include "scene/scene_at.h"
#include "tests/support/outside_program.h"

/// Synthetic twins of the real scenes: small files of every format, whose content is known.
namespace canyon::scene {
namespace {

class Import : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(scratch_.file(name), std::ios::binary) << text;
    return scratch_.file(name);
  }

  Result<ImportedScene> import(const std::string& path) {
    config_.file = path;
    if (config_.undulation_m == ImportConfig::kUndulationUnknown) config_.undulation_m = 40.0;
    return import_scene(config_, {45.0 * kDegree, 5.0 * kDegree, 100.0});
  }

  SceneParts parts(const std::string& name, const std::string& text) {
    auto made = import(write(name, text));
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().str());
    if (!made.ok()) return {};
    warnings_ = made->report.warnings;
    return std::move(made->parts);
  }

  /// The error's text without the folder.
  std::string message(const std::string& name, const std::string& text) {
    const auto made = import(write(name, text));
    EXPECT_FALSE(made.ok());
    if (made.ok()) return "";
    std::string out = made.error().str();
    const std::string folder = scratch_.file("");
    for (std::size_t at; (at = out.find(folder)) != std::string::npos;) out.erase(at, folder.size());
    return out;
  }

  canyon::testing::ScratchDirectory scratch_;
  ImportConfig config_;
  std::vector<std::string> warnings_;
};

double area_m2(const SceneParts& parts, const std::string& material, double up_at_least = -2.0) {
  double sum = 0.0;
  for (std::size_t i = 0; i < parts.mesh.triangles.size(); ++i) {
    const auto& t = parts.mesh.triangles[i];
    const auto at = [&](std::size_t k) { return parts.mesh.vertices[t[k]].cast<double>(); };
    const Eigen::Vector3d n = 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
    if (parts.materials[parts.mesh.material[i]].name == material && n.z() >= up_at_least * n.norm()) sum += n.norm();
  }
  return sum;
}

// A footprint of about 20 x 20 m with a yard of 10 x 10 m, 12 m high, on ground at 200 m: 1e-4 deg of latitude are 11.1
// m.
constexpr const char* kFootprint = R"({"type":"FeatureCollection","features":[{"type":"Feature",
"properties":{"id":"town hall","height":12.0,"ground_height":200.0},"geometry":{"type":"Polygon","coordinates":[
[[5.0,45.0],[5.0003,45.0],[5.0003,45.0002],[5.0,45.0002],[5.0,45.0]],
[[5.0001,45.00005],[5.0002,45.00005],[5.0002,45.00015],[5.0001,45.00015],[5.0001,45.00005]]]}}]})";

TEST_F(Import, GeoJsonFootprintWithAYard) {
  SceneParts made = parts("town.geojson", kFootprint);
  ASSERT_EQ(made.buildings.size(), 1u);
  const Building& b = made.buildings[0];
  EXPECT_EQ(b.name, "town hall");
  EXPECT_DOUBLE_EQ(b.height_m, 12.0);
  EXPECT_NEAR(b.base_m, 0.0, 1e-4);  // the origin lies on the ground
  EXPECT_NEAR(made.frame.origin().h_m, 240.0, 1e-9);
  EXPECT_EQ(made.undulation_m, 40.0);
  ASSERT_EQ(b.footprint_W.size(), 4u);
  ASSERT_EQ(b.courtyards_W.size(), 1u);
  // WGS84 at 45 degrees: 1e-4 deg are 11.1132 m of meridian (Helmert's series) and 7.8846 m of parallel.
  const double east_m = 7.8846, north_m = 11.1132;
  EXPECT_NEAR((b.footprint_W[1] - b.footprint_W[0]).norm(), 3 * east_m, 2e-3);
  EXPECT_NEAR((b.footprint_W[3] - b.footprint_W[0]).norm(), 2 * north_m, 2e-3);
  const double roof_m2 = 6 * east_m * north_m - east_m * north_m;
  EXPECT_NEAR(area_m2(made, "roofing"), roof_m2, 0.05);
  // Walls of outline and yard, half a metre below the ground.
  EXPECT_NEAR(area_m2(made, "concrete"), 12.5 * (2 * (3 * east_m + 2 * north_m) + 2 * (east_m + north_m)), 0.2);
  const Scene scene(std::move(made));
  EXPECT_EQ(scene.building_at(b.footprint_W[0] + Eigen::Vector2d(1, 1)), &scene.buildings()[0]);
  EXPECT_EQ(scene.building_at({0, 0}), nullptr);  // in the yard
  EXPECT_TRUE(scene.ground(0, 0).has_value());
  // The yard is open to the sky, the building is not.
  const SceneAt at(scene);
  EXPECT_FALSE(at.blocked_towards({0, 0, 1}, {0, 0, 1}));
  EXPECT_TRUE(at.blocked_towards({-east_m, 0, 1}, {0, 0, 1}));
}

TEST_F(Import, NoGapBetweenBuildingsAndSlopingTerrain) {
  // Terrain falls 1 m over 8.5 m to the east; the building's own ground is the height at its western end.
  std::string grid = "ncols 40\nnrows 40\nxllcorner 4.999\nyllcorner 44.999\ncellsize 0.0001\nNODATA_value -9999\n";
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 40; ++column) grid += std::to_string(205.0 - 0.9 * column) + " ";
    grid += "\n";
  }
  config_.terrain = write("slope.asc", grid);
  write("slope.prj",
        "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
        "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]");
  config_.ground_cell_m = 2.0;
  const Scene scene(parts("town.geojson", kFootprint));
  const Building& b = scene.buildings()[0];
  const SceneAt at(scene);
  // All around, a ray from outside towards a wall just above the ground meets the wall.
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d a = b.footprint_W[i], c = b.footprint_W[(i + 1) % 4], way = c - a;
    const Eigen::Vector2d out(way.y() / way.norm(), -way.x() / way.norm());
    for (double s = 0.01; s < 1.0; s += 0.01) {
      const Eigen::Vector2d p = a + s * way + 0.3 * out;
      const double z = scene.ground(p.x(), p.y())->height_m + 0.15;
      EXPECT_TRUE(at.blocked({p.x(), p.y(), z}, {p.x() - 0.6 * out.x(), p.y() - 0.6 * out.y(), z})) << i << " " << s;
    }
  }
}

TEST_F(Import, CityJsonWithSemantics) {
  const std::string cube =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],"translate":[85000,447000,0]},
"metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/7415"},
"CityObjects":{"house":{"type":"Building","children":["part"]},"part":{"type":"BuildingPart","parents":["house"],
"geometry":[{"type":"Solid","lod":"2.2","boundaries":[[[[3,2,1,0]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]],
"semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},{"type":"WallSurface"},{"type":"Window"}],
"values":[[0,1,2,2,2,3]]}}]}},
"vertices":[[0,0,1000],[10000,0,1000],[10000,8000,1000],[0,8000,1000],[0,0,7000],[10000,0,7000],[10000,8000,7000],[0,8000,7000]]})";
  const SceneParts made = parts("cube.city.json", cube);
  ASSERT_EQ(made.buildings.size(), 1u);
  EXPECT_EQ(made.buildings[0].name, "house");
  EXPECT_NEAR(made.buildings[0].height_m, 6.0, 1e-6);
  ASSERT_EQ(made.buildings[0].footprint_W.size(), 4u);
  // The grid of the Dutch system is 1.0000 of true length here to 1e-4.
  EXPECT_NEAR(area_m2(made, "roofing"), 80.0, 0.02);
  EXPECT_NEAR(area_m2(made, "glass"), 48.0, 0.02);
  // As a sequence, line by line, the same.
  const std::string sequence =
      "{\"type\":\"CityJSON\",\"version\":\"2.0\",\"CityObjects\":{},\"vertices\":[],\"transform\":{\"scale\":[1,1,1],"
      "\"translate\":[85000,447000,0]},\"metadata\":{\"referenceSystem\":\"urn:ogc:def:crs:EPSG::7415\"}}\n"
      "{\"type\":\"CityJSONFeature\",\"id\":\"a\",\"CityObjects\":{\"a\":{\"type\":\"Building\",\"geometry\":[{"
      "\"type\":"
      "\"MultiSurface\",\"lod\":1,\"boundaries\":[[[0,1,2,3]]]}]}},\"vertices\":[[0,0,5],[10,0,5],[10,8,5],[0,8,5]]}\n"
      "{\"type\":\"CityJSONFeature\",\"id\":\"b\",\"CityObjects\":{\"b\":{\"type\":\"Building\",\"geometry\":[{"
      "\"type\":"
      "\"MultiSurface\",\"lod\":1,\"boundaries\":[[[0,1,2,3]]]}]}},\"vertices\":[[50,0,5],[60,0,5],[60,8,5],[50,8,5]]}"
      "\n";
  EXPECT_EQ(parts("two.city.jsonl", sequence).buildings.size(), 2u);
}

TEST_F(Import, CityGmlReadsLatitudeFirst) {
  const SceneParts made = parts(
      "one.gml",
      R"(<core:CityModel xmlns:core="c" xmlns:bldg="b" xmlns:gml="g"><gml:boundedBy><gml:Envelope srsName="http://www.opengis.net/def/crs/EPSG/0/6697"/></gml:boundedBy>
<core:cityObjectMember><bldg:Building gml:id="B1"><bldg:lod0RoofEdge><gml:Polygon><gml:exterior><gml:LinearRing>
<gml:posList>35.54 139.77 0 35.54 139.7701 0 35.5401 139.7701 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></bldg:lod0RoofEdge>
<bldg:lod1Solid><gml:Solid><gml:Polygon><gml:exterior><gml:LinearRing>
<gml:posList>35.54 139.77 3 35.5401 139.77 3 35.5401 139.7701 3 35.54 139.7701 3 35.54 139.77 3</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
<gml:Polygon><gml:exterior><gml:LinearRing>
<gml:posList>35.54 139.77 13 35.54 139.7701 13 35.5401 139.7701 13 35.5401 139.77 13 35.54 139.77 13</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:Solid></bldg:lod1Solid>
</bldg:Building></core:cityObjectMember></core:CityModel>)");
  ASSERT_EQ(made.buildings.size(), 1u);
  EXPECT_EQ(made.buildings[0].name, "B1");
  EXPECT_NEAR(made.buildings[0].height_m, 10.0, 1e-5);
  EXPECT_NEAR(made.frame.origin().lat_rad / kDegree, 35.54005, 1e-6);
  EXPECT_NEAR(made.frame.origin().lon_rad / kDegree, 139.77005, 1e-6);
  EXPECT_NEAR(area_m2(made, "roofing"), 11.095 * 9.064, 0.5);  // level 1 only: 1e-4 deg at 35.54 degrees north
}

TEST_F(Import, OsmHeightsRoofsAndStreets) {
  std::string osm = "<osm version=\"0.6\">";
  const auto node = [&](int id, double lat, double lon) {
    char text[120];
    std::snprintf(text, sizeof text, "<node id=\"%d\" lat=\"%.7f\" lon=\"%.7f\"/>", id, lat, lon);
    osm += text;
  };
  // Two houses of about 22 x 16 m, 40 m apart, and a street with a bend.
  for (int h = 0; h < 2; ++h) {
    const double lon = 5.0 + 0.0005 * h;
    node(10 * h + 1, 45.0, lon), node(10 * h + 2, 45.0, lon + 0.0002);
    node(10 * h + 3, 45.0002, lon + 0.0002), node(10 * h + 4, 45.0002, lon);
  }
  node(31, 44.9999, 4.9999), node(32, 44.9999, 5.0003), node(33, 45.0004, 5.0003);
  const auto way = [&](int id, std::initializer_list<int> refs, const std::string& tags) {
    osm += "<way id=\"" + std::to_string(id) + "\">";
    for (const int ref : refs) osm += "<nd ref=\"" + std::to_string(ref) + "\"/>";
    osm += tags + "</way>";
  };
  way(1, {1, 2, 3, 4, 1},
      "<tag k=\"building\" v=\"yes\"/><tag k=\"height\" v=\"10 m\"/><tag k=\"roof:shape\" v=\"gabled\"/>"
      "<tag k=\"roof:height\" v=\"4\"/><tag k=\"building:material\" v=\"brick\"/>");
  way(2, {11, 12, 13, 14, 11}, "<tag k=\"building\" v=\"house\"/><tag k=\"building:levels\" v=\"2\"/>");
  way(3, {31, 32, 33}, "<tag k=\"highway\" v=\"residential\"/>");
  way(4, {31, 33}, "<tag k=\"highway\" v=\"footway\"/>");
  way(5, {11, 12, 13}, "<tag k=\"building\" v=\"yes\"/>");  // not closed
  const SceneParts made = parts("map.osm", osm + "</osm>");
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

TEST_F(Import, ObjPlyAndGltfWithTheirMaterials) {
  const SceneParts obj = parts("room.obj",
                               "# comment\nmtllib room.mtl\nv 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2\n"
                               "o ground\nusemtl grass\nf 1/1/1 2/2/2 3/3/3 4/4/4\n"
                               "g wall 1\nusemtl itu_glass\nf -5 -4 \\\n-1\n");
  ASSERT_EQ(obj.objects.size(), 2u);
  EXPECT_EQ(obj.objects[0].kind, ObjectKind::kTerrain);
  EXPECT_EQ(obj.objects[1].kind, ObjectKind::kWall);
  EXPECT_NEAR(area_m2(obj, "grass"), 12.0, 1e-6);
  EXPECT_NEAR(area_m2(obj, "glass"), 4.0, 1e-6);
  EXPECT_EQ(obj.frame.origin().h_m, 100.0);  // local metres: where the configuration says

  const SceneParts ply =
      parts("tile.ply",
            "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
            "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 1\n2 0 1\n2 2 1\n0 2 "
            "1\n4 0 1 2 3\n");
  EXPECT_NEAR(area_m2(ply, "concrete"), 4.0, 1e-6);
#ifdef CANYON_WITH_ASSIMP
  // One triangle, y up: (0,0,0) (1,0,0) (0,1,0) stands up and faces the viewer, who is in the south.
  const SceneParts gltf =
      parts("t.gltf",
            R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"wall 1"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0,"material":0}]}],"materials":[{"name":"brick"}],
"buffers":[{"uri":"data:application/octet-stream;base64,AAABAAIAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA=","byteLength":44}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":6,"target":34963},{"buffer":0,"byteOffset":8,"byteLength":36,"target":34962}],
"accessors":[{"bufferView":0,"byteOffset":0,"componentType":5123,"count":3,"type":"SCALAR","max":[2],"min":[0]},
{"bufferView":1,"byteOffset":0,"componentType":5126,"count":3,"type":"VEC3","max":[1.0,1.0,0.0],"min":[0.0,0.0,0.0]}]})");
  ASSERT_EQ(gltf.mesh.triangles.size(), 1u);
  EXPECT_NEAR(area_m2(gltf, "brick"), 0.5, 1e-6);
  const auto& t = gltf.mesh.triangles[0];
  const auto at = [&](std::size_t k) { return gltf.mesh.vertices[t[k]]; };
  EXPECT_LT(((at(1) - at(0)).cross(at(2) - at(0)) - Eigen::Vector3f(0, -1, 0)).norm(), 1e-6f);
#endif
}

TEST_F(Import, MistakesAreTold) {
  EXPECT_EQ(message("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n"),
            "a.obj:3: vertex \"3\" of 2, expected f and at least three vertices that exist, as 1, 1/2, 1/2/3 or -1");
  EXPECT_EQ(message("a.obj", "v 0 0 zero\n"), "a.obj:1: \"zero\" is not a number, expected v x y z");
  EXPECT_EQ(message("a.obj", ""), "a.obj: holds no vertex, expected at least one line of numbers");
  EXPECT_EQ(message("a.ply", "solid\n"), "a.ply:1: does not begin with \"ply\", expected a PLY file");
  EXPECT_EQ(
      message("a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nend_header\n1234"),
      "a.ply: ends in the middle, expected as many elements as the header says");
  EXPECT_EQ(message("a.geojson", "{\"type\": \"FeatureCollection\",\n\"features\": [}"),
            "a.geojson:2: not valid JSON, expected JSON text");
  EXPECT_EQ(message("a.geojson", "{\"type\": \"FeatureCollection\", \"features\": []}"),
            "a.geojson: features: no footprint, surface or street, expected features with polygons or lines");
  EXPECT_EQ(message("a.city.json", "{\"type\":\"CityJSON\",\"version\":\"3.0\",\"CityObjects\":{},\"vertices\":[]}"),
            "a.city.json: version: \"3.0\" is not known, expected 1.0, 1.1 or 2.0");
  EXPECT_EQ(message("a.json", "{}"), "a.json: does not look like a scene, expected CityJSON or GeoJSON");
  EXPECT_EQ(message("a.gml", "<core:CityModel>\n<unclosed>\n</core:CityModel>"),
            "a.gml:3: not valid XML, expected XML text");
  EXPECT_EQ(message("a.osm", "<osm>\n<node id=\"1\" lat=\"x\" lon=\"5\"/></osm>"),
            "a.osm:2: node: lat=\"x\" lon=\"5\", expected degrees");
  EXPECT_EQ(
      message("a.xml", "<scene><shape type=\"ply\">\n<string name=\"filename\" value=\"none.ply\"/></shape></scene>")
          .substr(0, 8),
      "none.ply");
  EXPECT_EQ(message("a.dwg", "x").substr(0, 47), "a.dwg: a scene format that is not known, expect");
  config_.crs = "EPSG:999999";
  EXPECT_EQ(
      message("b.geojson", kFootprint),
      "b.geojson: crs: PROJ knows no coordinate system \"EPSG:999999\", expected an EPSG code, WKT or PROJ string");
  config_.crs = "";
  config_.terrain = write("t.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3\n");
  EXPECT_EQ(message("b.geojson", kFootprint), "t.asc:7: 3 values, expected 4 values");
  config_.terrain = write("N45E005.hgt", "too short");
  EXPECT_EQ(message("b.geojson", kFootprint),
            "N45E005.hgt: 9 bytes, expected 1201 x 1201 or 3601 x 3601 samples of two bytes");
  config_.terrain = write("t.tif", "not a tiff");
  EXPECT_EQ(message("b.geojson", kFootprint), "t.tif: not a TIFF file, expected a GeoTIFF");
}

TEST_F(Import, HeightsAboveTheGeoidWithoutAGeoidAreTold) {
  if (!std::ifstream("/usr/share/GeographicLib/geoids/egm96-5.pgm").good()) {
    config_.file = write("town.geojson", kFootprint);
    const auto made = import_scene(config_, {});
    ASSERT_TRUE(made.ok());
    EXPECT_EQ(made->report.undulation_source, "none");
    ASSERT_EQ(made->report.warnings.size(), 1u);
    EXPECT_EQ(made->report.warnings[0],
              "no geoid model is installed and none is stated (scene.undulation_m): heights above sea level are taken "
              "for ellipsoidal ones");
  }
}

TEST_F(Import, UsersMaterialsAndUnknownOnes) {
  config_.materials = {write("m.toml", "[[material]]\nname = \"straw\"\nlidar_reflectance = 0.6\n")};
  const SceneParts made =
      parts("hut.obj", "v 0 0 0\nv 4 0 0\nv 4 3 0\no hut\nusemtl straw\nf 1 2 3\nusemtl chewing_gum\nf 1 3 2\n");
  EXPECT_NEAR(area_m2(made, "straw"), 6.0, 1e-6);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_EQ(warnings_[0], "material \"chewing_gum\" is not in the table: 1 surfaces take the default");
}

}  // namespace
}  // namespace canyon::scene
