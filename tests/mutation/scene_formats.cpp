#include <algorithm>
#include <array>
#include <bit>

#ifdef CANYON_WITH_ASSIMP
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <assimp/Exporter.hpp>
#endif

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/scene/import.h"
#include "canyon/scene/written_scene.h"
#include "canyon/tests/mutation/format.h"
#include "canyon/tests/report/synthetic_results.h"
#include "canyon/tests/report/temporary_directory.h"
#include "canyon/tests/scene/importers/citygml_text.h"

namespace canyon::testing {
namespace {

constexpr const char* kObj =
    "# comment\nmtllib room.mtl\nv 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2\no ground\nusemtl grass\n"
    "f 1/1/1 2/2/2 3/3/3 4/4/4\ng wall 1\nusemtl itu_glass\nf -5 -4 \\\n-1\nvt 0 0\nvn 0 0 1\n";
constexpr const char* kPlyText =
    "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 1\n2 0 1\n2 2 1\n0 2 1\n4 0 1 2 3\n";

template <class T>
std::string bytes_of(T value, bool big_endian) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return {bytes.begin(), bytes.end()};
}

/// A square in binary, with a property that nobody asked for.
std::string ply_bytes(bool big_endian) {
  std::string out = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                    "_endian 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nproperty "
                    "uchar red\nelement face 2\nproperty list uchar uint vertex_index\nend_header\n";
  const double xy[4][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  for (const auto& p : xy) {
    for (const double v : {p[0], p[1], 1.0}) out += bytes_of(v, big_endian);
    out += '\x7f';
  }
  for (const std::array<std::uint32_t, 3>& f : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}}) {
    out += '\x03';
    for (const std::uint32_t v : f) out += bytes_of(v, big_endian);
  }
  return out;
}

constexpr const char* kCityJson =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],"translate":[85000,447000,0]},
"metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/7415"},
"CityObjects":{"house":{"type":"Building","attributes":{"name":"town hall","measuredHeight":6.0},"children":["part"]},
"part":{"type":"BuildingPart","parents":["house"],
"geometry":[{"type":"Solid","lod":"2.2","boundaries":[[[[3,2,1,0]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]],
"semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},{"type":"WallSurface"},{"type":"Window"}],
"values":[[0,1,2,2,2,3]]}}]}},
"vertices":[[0,0,1000],[10000,0,1000],[10000,8000,1000],[0,8000,1000],[0,0,7000],[10000,0,7000],[10000,8000,7000],[0,8000,7000]]})";
constexpr const char* kCityJsonSequence =
    R"({"type":"CityJSON","version":"2.0","CityObjects":{},"vertices":[],"transform":{"scale":[1,1,1],"translate":[85000,447000,0]},"metadata":{"referenceSystem":"urn:ogc:def:crs:EPSG::7415"}}
{"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":1,"boundaries":[[[0,1,2,3]]]}]}},"vertices":[[0,0,5],[10,0,5],[10,8,5],[0,8,5]]}
{"type":"CityJSONFeature","id":"b","CityObjects":{"b":{"type":"Building","geometry":[{"type":"MultiSurface","lod":1,"boundaries":[[[0,1,2,3]]]}]}},"vertices":[[50,0,5],[60,0,5],[60,8,5],[50,8,5]]}
)";

constexpr const char* kGeoJson =
    R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}},
"features":[{"type":"Feature","properties":{"id":"town hall","height":12.0,"ground_height":200.0},
"geometry":{"type":"Polygon","coordinates":[
[[5.0,45.0],[5.0003,45.0],[5.0003,45.0002],[5.0,45.0002],[5.0,45.0]],
[[5.0001,45.00005],[5.0002,45.00005],[5.0002,45.00015],[5.0001,45.00015],[5.0001,45.00005]]]}},
{"type":"Feature","properties":{"id":7,"levels":2,"ground_height":200},"geometry":{"type":"MultiPolygon","coordinates":[
[[[5.0005,45.0],[5.0006,45.0],[5.0006,45.0001],[5.0005,45.0]]]]}},
{"type":"Feature","properties":{"highway":"residential"},"geometry":{"type":"LineString","coordinates":[[4.9999,44.9999],[5.0007,44.9999]]}}]})";

constexpr const char* kOsm = R"(<?xml version="1.0"?>
<osm version="0.6">
<node id="1" lat="45.0" lon="5.0"/><node id="2" lat="45.0" lon="5.0002"/>
<node id="3" lat="45.0002" lon="5.0002"/><node id="4" lat="45.0002" lon="5.0"/>
<node id="11" lat="45.0" lon="5.0005"/><node id="12" lat="45.0" lon="5.0007"/>
<node id="13" lat="45.0002" lon="5.0007"/><node id="14" lat="45.0002" lon="5.0005"/>
<node id="31" lat="44.9999" lon="4.9999"/><node id="32" lat="44.9999" lon="5.0003"/><node id="33" lat="45.0004" lon="5.0003"/>
<node id="41" lat="45.0001" lon="5.0004"><tag k="natural" v="tree"/><tag k="height" v="8"/></node>
<way id="1"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/><tag k="building" v="yes"/><tag k="height" v="10 m"/>
<tag k="roof:shape" v="gabled"/><tag k="roof:height" v="4"/><tag k="building:material" v="brick"/></way>
<way id="2"><nd ref="11"/><nd ref="12"/><nd ref="13"/><nd ref="14"/><nd ref="11"/><tag k="building:levels" v="2"/></way>
<way id="3"><nd ref="31"/><nd ref="32"/><nd ref="33"/><tag k="highway" v="residential"/></way>
<relation id="7"><member type="way" ref="2" role="outer"/><tag k="type" v="multipolygon"/><tag k="building" v="yes"/></relation>
</osm>
)";

constexpr const char* kMitsuba = R"(<scene version="2.1.0">
<bsdf type="twosided" id="mat-itu_concrete"><bsdf type="diffuse"><rgb value="0.5 0.5 0.5" name="reflectance"/></bsdf></bsdf>
<bsdf type="diffuse" id="mat-itu_metal"/>
<shape type="ply" id="elm__1"><string name="filename" value="tile.ply"/><ref id="mat-itu_concrete" name="bsdf"/></shape>
<shape type="obj" id="elm__2"><string name="filename" value="room.obj"/><ref id="mat-itu_metal" name="bsdf"/></shape>
<shape type="sphere"/>
</scene>
)";

constexpr const char* kMaterials =
    "[[material]]\nname = \"straw\"\nitu = [1.5, 0.0, 0.002, 1.2]\nthickness_m = 0.2\nroughness_m = 0.01\n"
    "lidar_reflectance = 0.6\nlidar_specular = 0.1\nsource = \"made up\"\n[[material]]\nname = \"mirror\"\n"
    "lidar_reflectance = 0.05\n";

std::vector<Companion> meshes() {
  return {{"tile.ply", kPlyText}, {"room.obj", kObj}};
}

#ifdef CANYON_WITH_ASSIMP
/// What stands between `key` and the next of `ends` becomes `value`, everywhere: no date of today in a seed.
std::string with_fixed(std::string text, const std::string& key, const char* ends, const std::string& value) {
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + key.size())) {
    const std::size_t begin = at + key.size();
    text.replace(begin, text.find_first_of(ends, begin) - begin, value);
  }
  return text;
}

/// A tetrahedron of one material under two nodes, as assimp itself writes it.
std::vector<Seed> exported(const char* format, const std::string& name) {
  aiScene scene;
  scene.mFlags = 0;
  scene.mNumMaterials = 1;
  scene.mMaterials = new aiMaterial* [1] { new aiMaterial() };
  const aiString material("itu_brick");
  scene.mMaterials[0]->AddProperty(&material, AI_MATKEY_NAME);
  auto* mesh = new aiMesh();
  mesh->mName = "wall 1";
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mNumVertices = 4;
  mesh->mVertices = new aiVector3D[4]{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
  mesh->mNormals = new aiVector3D[4]{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh->mNumFaces = 4;
  mesh->mFaces = new aiFace[4];
  const unsigned faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (int i = 0; i < 4; ++i) {
    mesh->mFaces[i].mNumIndices = 3;
    mesh->mFaces[i].mIndices = new unsigned[3]{faces[i][0], faces[i][1], faces[i][2]};
  }
  scene.mNumMeshes = 1;
  scene.mMeshes = new aiMesh* [1] { mesh };
  scene.mRootNode = new aiNode("root");
  auto* child = new aiNode("wall 1");
  child->mNumMeshes = 1;
  child->mMeshes = new unsigned[1]{0};
  scene.mRootNode->addChildren(1, &child);
  const TemporaryDirectory scratch;
  Assimp::Exporter exporter;
  CANYON_CHECK(exporter.Export(&scene, format, scratch.file(name)) == aiReturn_SUCCESS, "format = ", format, ": ",
               exporter.GetErrorString());
  std::string text = load(scratch.file(name));
  for (const char* key : {"<created>", "<modified>"}) text = with_fixed(text, key, "<", "2026-11-22T08:00:00");
  for (const char* key :
       {"\tYear: ", "\tMonth: ", "\tDay: ", "\tHour: ", "\tMinute: ", "\tSecond: ", "\tMillisecond: "})
    text = with_fixed(text, key, "\n", "7");
  for (const char* key : {"CreationTime: \"", "DateTime_GMT\", \"DateTime\", \"\", \"\", \""})
    text = with_fixed(text, key, "\"", "2026-11-22 08:00:00:000");
  return {{name, text}};
}

std::vector<Format> assimp_formats() {
  struct Row {
    const char *name, *file;
    std::vector<const char*> exporters;
  };
  const std::vector<Row> rows{{"Glb", "t.glb", {"glb2"}},
                              {"Collada", "t.dae", {"collada"}},
                              {"Fbx", "t.fbx", {"fbxa"}},
                              {"Stl", "t.stl", {"stl", "stlb"}},
                              {"ThreeDs", "t.3ds", {"3ds"}}};
  std::vector<Format> out;
  for (const Row& row : rows)
    out.push_back(
        {.name = row.name, .command = {"scene", "info", "@", "--undulation", "40"}, .read = {}, .seeds = [row] {
           std::vector<Seed> seeds;
           for (const char* exporter : row.exporters) seeds.push_back(exported(exporter, row.file).front());
           return seeds;
         }});
  // One triangle, its numbers within the file.
  out.push_back({.name = "Gltf", .command = {"scene", "info", "@", "--undulation", "40"}, .read = {}, .seeds = [] {
                   return std::vector<Seed>{{"t.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1],"translation":[10,20,30]},{"mesh":0,"name":"wall 1","scale":[2,2,2]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0,"material":0}]}],"materials":[{"name":"brick"}],
"buffers":[{"uri":"data:application/octet-stream;base64,AAABAAIAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA=","byteLength":44}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":6,"target":34963},{"buffer":0,"byteOffset":8,"byteLength":36,"target":34962}],
"accessors":[{"bufferView":0,"byteOffset":0,"componentType":5123,"count":3,"type":"SCALAR","max":[2],"min":[0]},
{"bufferView":1,"byteOffset":0,"componentType":5126,"count":3,"type":"VEC3","max":[1.0,1.0,0.0],"min":[0.0,0.0,0.0]}]})"}};
                 }});
  return out;
}
#else
std::vector<Format> assimp_formats() {
  return {};
}
#endif

/// A small scene in canyon's own files.
const std::vector<Seed>& written() {
  static const std::vector<Seed> files = written_by(
      [] {
        scene::ImportConfig config;
        config.file = "town.geojson";
        config.undulation_m = 40.0;
        const auto made = scene::import_scene(config, {45.0 * kDegree, 5.0 * kDegree, 100.0});
        return made.ok() && scene::write_scene(made->parts, ".").ok() ? 0 : 2;
      },
      {"scene.json", "scene.obj", "materials.toml"}, {{"town.geojson", kGeoJson}});
  return files;
}

Format written_part(const std::string& name, std::size_t which) {
  return {.name = name,
          .command = {"scene", "info", "scene.json"},
          .read = {},
          .seeds = [which] { return std::vector<Seed>{written()[which]}; },
          .beside = [] { return written(); }};
}

Format of_one_file(const std::string& name, const std::function<std::vector<Seed>()>& seeds) {
  return {.name = name, .command = {"scene", "info", "@", "--undulation", "40"}, .read = {}, .seeds = seeds};
}

}  // namespace

std::vector<Format> scene_formats() {
  std::vector<Format> out{
      of_one_file("Obj",
                  [] {
                    return std::vector<Seed>{{"room.obj", kObj}};
                  }),
      of_one_file(
          "Ply",
          [] {
            return std::vector<Seed>{{"a.ply", kPlyText}, {"b.ply", ply_bytes(false)}, {"c.ply", ply_bytes(true)}};
          }),
      of_one_file("CityJson",
                  [] {
                    return std::vector<Seed>{{"cube.city.json", kCityJson}, {"two.city.jsonl", kCityJsonSequence}};
                  }),
      of_one_file("GeoJson",
                  [] {
                    return std::vector<Seed>{{"town.geojson", kGeoJson}};
                  }),
      of_one_file("CityGml",
                  [] {
                    return std::vector<Seed>{{"one.gml", kOneBuildingCityGml}};
                  }),
      of_one_file("Osm",
                  [] {
                    return std::vector<Seed>{{"map.osm", kOsm}};
                  }),
      {.name = "Mitsuba",
       .command = {"scene", "info", "@"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{{"scene.xml", kMitsuba}};
           },
       .beside = meshes},
      {.name = "Materials",
       .command = {"scene", "info", "room.obj", "--materials", "@"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{{"mine.toml", kMaterials}};
           },
       .beside = meshes},
      written_part("WrittenSceneJson", 0),
      written_part("WrittenSceneObj", 1),
      written_part("WrittenSceneMaterials", 2)};
  for (Format& format : assimp_formats()) out.push_back(std::move(format));
  return out;
}

}  // namespace canyon::testing
