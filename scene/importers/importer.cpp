#include "canyon/scene/importers/importer.h"
#include "canyon/scene/importers/assimp_part.h"

#include <cctype>
#include <filesystem>
#include <system_error>

#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/core/lower_case.h"

namespace canyon::scene {
namespace {

bool holds(std::string_view text, const char* word) {
  return text.find(word) != std::string_view::npos;
}

bool is_cityjson(std::string_view text) {
  return holds(text, "\"CityObjects\"") || holds(text, "\"CityJSON\"");
}
bool is_geojson(std::string_view text) {
  return holds(text, "FeatureCollection") || (holds(text, "\"Feature\"") && !is_cityjson(text));
}
bool is_citygml(std::string_view text) {
  return holds(text, "CityModel");
}
bool is_osm(std::string_view text) {
  return holds(text, "<osm");
}
bool is_mitsuba(std::string_view text) {
  return holds(text, "<scene");
}

#ifdef CANYON_WITH_ASSIMP
Result<RawScene> read_with_assimp(const std::string& path, const ReadOptions&) {
  return library_part("assimp", &canyon_assimp_part).read(path);
}
#endif

}  // namespace

ModelTable<SceneReader> scene_formats() {
  static const std::vector<SceneFormat> formats = {
      {"OBJ", {{".obj"}, read_obj}, "Wavefront OBJ; groups and objects become objects, usemtl names materials"},
      {"PLY", {{".ply"}, read_ply}, "Stanford PLY, ascii and both binary forms"},
      {"CityJSON",
       {{".city.json", ".city.jsonl", ".jsonl", ".json"}, read_cityjson, is_cityjson},
       "CityJSON 1.0, 1.1 and 2.0, and CityJSONSeq"},
      {"GeoJSON",
       {{".geojson", ".json"}, read_geojson, is_geojson},
       "footprints with heights, surfaces with heights of their own, streets as lines"},
      {"CityGML",
       {{".gml", ".citygml", ".xml"}, read_citygml, is_citygml},
       "CityGML 1.0 and 2.0, PLATEAU's i-UR included"},
      {"OSM", {{".osm", ".xml"}, read_osm, is_osm}, "OpenStreetMap XML: buildings and streets"},
      {"Mitsuba",
       {{".xml"}, read_mitsuba, is_mitsuba},
       "Mitsuba and Sionna scenes of PLY and OBJ meshes with ITU materials"},
#ifdef CANYON_WITH_ASSIMP
      {"glTF", {{".gltf", ".glb"}, read_with_assimp}, "glTF 2.0, y up (assimp)"},
      {"assimp", {{".dae", ".fbx", ".stl", ".3ds"}, read_with_assimp}, "what else assimp reads"},
#endif
  };
  return formats;
}

Result<RawScene> read_scene_file(const std::string& path, const ReadOptions& options) {
  std::string name = lower_case(path);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  std::vector<const SceneFormat*> candidates;
  std::string endings;
  for (const SceneFormat& format : scene_formats()) {
    bool fits = false;
    for (const char* ending : format.make.endings) {
      fits = fits || name.ends_with(ending);
      if ((" " + endings).find(" " + std::string(ending) + " ") == std::string::npos)
        endings += std::string(ending) + " ";
    }
    if (fits) candidates.push_back(&format);
  }
  endings.pop_back();
  if (candidates.empty()) {
#ifndef CANYON_WITH_ASSIMP
    if (name.ends_with(".gltf") || name.ends_with(".glb"))
      return Error{path, 0, "", "this canyon was built without glTF", "a build with CANYON_WITH_ASSIMP=ON"};
#endif
    return Error{path, 0, "", "a scene format that is not known", "a file that ends with " + endings};
  }
  const auto read = [&](const SceneFormat& format) -> Result<RawScene> {
    CANYON_TRY(RawScene scene, format.make.read(path, options));
    scene.files[0] = path;
    if (options.up_axis != UpAxis::kAuto) scene.y_up = options.up_axis == UpAxis::kY;
    return scene;
  };
  const Error empty{path, 0, "", "is empty", "a scene"};
  std::error_code unknown_size;
  if (std::filesystem::file_size(path, unknown_size) == 0 && !unknown_size) return empty;
  if (candidates.size() == 1 && candidates[0]->make.looks_like == nullptr) return read(*candidates[0]);

  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) return empty;
  std::string expected;
  for (const SceneFormat* format : candidates) {
    if (format->make.looks_like == nullptr || format->make.looks_like(text)) return read(*format);
    expected += (expected.empty() ? "" : " or ") + std::string(format->name);
  }
  return Error{path, 0, "", "does not look like a scene", expected};
}

SourceFrame frame_by_name(const std::string& name) {
  if (name.find("CRS84") != std::string::npos) return {"OGC:CRS84", true};
  if (name.find("EPSG") == std::string::npos) return {name, true};
  // The last number after each "EPSG"; a version may stand between ("EPSG/0/7415", "EPSG::6668", "EPSG:9.9:4326").
  std::string codes;
  for (std::size_t at = name.find("EPSG"); at != std::string::npos;) {
    const std::size_t next = name.find("EPSG", at + 4);
    std::string part = name.substr(at, next == std::string::npos ? next : next - at);
    while (!part.empty() && !std::isdigit(static_cast<unsigned char>(part.back()))) part.pop_back();
    std::size_t begin = part.size();
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(part[begin - 1]))) --begin;
    if (begin < part.size()) codes += (codes.empty() ? "EPSG:" : "+") + part.substr(begin);
    at = next;
  }
  // "EPSG:31467" alone is the old way of writing, and means east first.
  return {codes, name.rfind("EPSG:", 0) != 0};
}

double MissingHeights::resolve(double height_m, double storeys, const ReadOptions& options) {
  if (height_m > 0.0 && height_m < 2000.0) return height_m;
  if (storeys > 0.0 && storeys < 300.0) {
    ++from_storeys;
    return storeys * options.storey_m;
  }
  if (options.default_height_m > 0.0) {
    ++by_default;
    return options.default_height_m;
  }
  ++left_out;
  return std::numeric_limits<double>::quiet_NaN();
}

void MissingHeights::tell(RawScene& scene, const ReadOptions& options) const {
  if (from_storeys > 0)
    scene.warnings.push_back(std::to_string(from_storeys) + " buildings without a height: storeys of " +
                             number_text(options.storey_m) + " m");
  if (by_default > 0)
    scene.warnings.push_back(std::to_string(by_default) + " buildings without a height or storeys: " +
                             number_text(options.default_height_m) + " m (scene.default_height_m)");
  if (left_out > 0)
    scene.warnings.push_back(std::to_string(left_out) + " buildings without a height or storeys are left out");
}

ObjectKind kind_by_name(std::string_view name, ObjectKind otherwise) {
  struct Row {
    const char* word;
    ObjectKind kind;
  };
  static constexpr Row kRows[] = {
      {"terrain", ObjectKind::kTerrain},   {"ground", ObjectKind::kTerrain}, {"plane", ObjectKind::kTerrain},
      {"floor", ObjectKind::kTerrain},     {"street", ObjectKind::kTerrain}, {"road", ObjectKind::kTerrain},
      {"building", ObjectKind::kBuilding}, {"house", ObjectKind::kBuilding}, {"bldg", ObjectKind::kBuilding},
      {"vehicle", ObjectKind::kVehicle},   {"car", ObjectKind::kVehicle},    {"tree", ObjectKind::kTree},
      {"wall", ObjectKind::kWall},         {"pole", ObjectKind::kPole},      {"person", ObjectKind::kPerson},
  };
  const std::string text = lower_case(name);
  // Whole words only: "car_2" is a vehicle, "Oscar" is not.
  for (const Row& row : kRows) {
    const std::size_t length = std::char_traits<char>::length(row.word);
    for (std::size_t at = text.find(row.word); at != std::string::npos; at = text.find(row.word, at + 1)) {
      const auto letter = [&](std::size_t i) {
        return i < text.size() && std::isalpha(static_cast<unsigned char>(text[i]));
      };
      if ((at == 0 || !letter(at - 1)) && !letter(at + length)) return row.kind;
    }
  }
  return otherwise;
}

}  // namespace canyon::scene
