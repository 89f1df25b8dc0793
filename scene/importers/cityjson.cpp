#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/importers/importer.h"

namespace canyon::scene {
namespace {

using ParsedJson = nlohmann::json;

struct Row {
  const char* type;
  ObjectKind kind;
  const char* material;
};
/// City objects and what they are to a vehicle; a type that is not here is kOther.
constexpr Row kObjectTypes[] = {{"Building", ObjectKind::kBuilding, ""},
                                {"BuildingPart", ObjectKind::kBuilding, ""},
                                {"BuildingInstallation", ObjectKind::kBuilding, ""},
                                {"Road", ObjectKind::kTerrain, "asphalt"},
                                {"Railway", ObjectKind::kTerrain, "ground"},
                                {"TransportSquare", ObjectKind::kTerrain, "asphalt"},
                                {"LandUse", ObjectKind::kTerrain, "ground"},
                                {"PlantCover", ObjectKind::kTerrain, "grass"},
                                {"WaterBody", ObjectKind::kTerrain, "water"},
                                {"TINRelief", ObjectKind::kTerrain, "ground"},
                                {"SolitaryVegetationObject", ObjectKind::kTree, "foliage"},
                                {"Bridge", ObjectKind::kOther, "concrete"}};

Row row_of(const std::string& type) {
  for (const Row& row : kObjectTypes)
    if (type == row.type) return row;
  return {"", ObjectKind::kOther, ""};
}

struct Surface {
  const char* type;
  const char* material;
};
constexpr Surface kSurfaces[] = {{"Window", "glass"}, {"Door", "wood"}, {"WaterSurface", "water"}};

class CityJsonReader {
 public:
  explicit CityJsonReader(const std::string& path) : path_(path) {}

  Result<RawScene> read() {
    CANYON_TRY(const std::string text, read_text_or_gzip_file(path_));
    // A CityJSONSeq has one object per line: first the header, then features with vertices of their own.
    std::size_t begin = 0;
    int line = 1;
    const std::size_t first_end = text.find('\n');
    const std::string_view first = std::string_view(text).substr(0, first_end);
    const bool sequence = first_end != std::string::npos && ParsedJson::accept(first) &&
                          text.find("\"CityJSONFeature\"") != std::string::npos;
    if (!sequence) {
      std::vector<JsonMember> members;
      CANYON_TRY(const ParsedJson document, parse_json(text, path_, {.key = "CityObjects", .members = &members}));
      CANYON_TRY_STATUS(header(document));
      for (const JsonMember& member : members) line_of_[member.name] = member.line;
      CANYON_TRY_STATUS(city_objects(document, 0));
    }
    while (sequence && begin < text.size()) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::string_view record = std::string_view(text).substr(begin, end - begin);
      if (record.find_first_not_of(" \t\r") != std::string_view::npos) {
        CANYON_TRY(const ParsedJson document, parse_json(record, path_, {.first_line = line}));
        if (line == 1) CANYON_TRY_STATUS(header(document));
        CANYON_TRY_STATUS(city_objects(document, line));
      }
      begin = end + 1;
      ++line;
    }
    if (scene_.polygons.empty()) return Error{path_, 0, "CityObjects", "no surface", "city objects with geometry"};
    if (flat_ > 0) scene_.warnings.push_back(std::to_string(flat_) + " buildings of level of detail 0 are left out");
    if (templates_ > 0) scene_.warnings.push_back(std::to_string(templates_) + " geometry templates are left out");
    if (dangling_ > 0)
      scene_.warnings.push_back(std::to_string(dangling_) + " rings with vertices that do not exist are left out");
    return std::move(scene_);
  }

 private:
  Status header(const ParsedJson& document) {
    if (!document.is_object() || json_string(document, "type") != "CityJSON")
      return Error{path_, 0, "type", "not a CityJSON file", "\"type\": \"CityJSON\""};
    const std::string version = json_string(document, "version");
    if (version.rfind("1.", 0) != 0 && version.rfind("2.", 0) != 0)
      return Error{path_, 0, "version", "\"" + version + "\" is not known", "1.0, 1.1 or 2.0"};
    if (const auto transform = document.find("transform"); transform != document.end()) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto scale = number(*transform, "scale", k), translate = number(*transform, "translate", k);
        if (!scale || !translate)
          return Error{path_, 0, "transform", "not understood", "scale and translate of three numbers"};
        scale_[static_cast<Eigen::Index>(k)] = *scale;
        translate_[static_cast<Eigen::Index>(k)] = *translate;
      }
    }
    const ParsedJson::json_pointer crs("/metadata/referenceSystem");
    if (document.contains(crs) && document[crs].is_string())
      scene_.frame = frame_by_name(document[crs].get<std::string>());
    return Ok{};
  }

  static std::optional<double> number(const ParsedJson& object, const char* key, std::size_t k) {
    const auto list = object.find(key);
    if (list == object.end() || !list->is_array() || list->size() <= k || !(*list)[k].is_number()) return std::nullopt;
    return (*list)[k].get<double>();
  }

  Status city_objects(const ParsedJson& document, int line) {
    vertices_.clear();
    const auto vertices = document.find("vertices");
    const auto objects = document.find("CityObjects");
    if (vertices == document.end() || !vertices->is_array() || objects == document.end() || !objects->is_object())
      return Error{path_, line, "CityObjects", "no vertices or no city objects", "a CityJSON file"};
    for (const ParsedJson& v : *vertices) {
      throw_if_cancelled();
      if (!v.is_array() || v.size() != 3 || !v[0].is_number() || !v[1].is_number() || !v[2].is_number())
        return Error{path_, line, "vertices[" + std::to_string(vertices_.size()) + "]", "not understood",
                     "three numbers"};
      const Eigen::Vector3d raw(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
      vertices_.push_back(raw.cwiseProduct(scale_) + translate_);
    }
    // The finest level of detail of each object with all its parts: a building whose parts are of level 2 is not built
    // again at its own level 1.
    std::map<std::string, double> finest;
    for (const auto& [id, object] : objects->items()) {
      if (!object.is_object()) return Error{path_, line, "CityObjects." + id, "not an object", "a city object"};
      for (const ParsedJson* g : geometries_of(object)) {
        double& level = finest.try_emplace(root_of(*objects, id), -1.0).first->second;
        level = std::max(level, level_of_detail(*g));
      }
    }
    for (const auto& [id, object] : objects->items()) {
      throw_if_cancelled();
      if (const auto list = object.find("geometry"); list != object.end() && list->is_array())
        templates_ += static_cast<int>(std::count_if(list->begin(), list->end(), [](const ParsedJson& g) {
          return json_string(g, "type") == "GeometryInstance";
        }));
      const std::string root = root_of(*objects, id);
      for (const ParsedJson* g : geometries_of(object))
        if (level_of_detail(*g) == finest[root]) {
          CANYON_TRY_STATUS(add(root, id, json_string(object, "type"), *g, line));
          break;
        }
    }
    return Ok{};
  }

  /// Of what an object's geometry holds, that which has boundaries.
  static std::vector<const ParsedJson*> geometries_of(const ParsedJson& object) {
    std::vector<const ParsedJson*> out;
    const auto geometry = object.find("geometry");
    if (geometry == object.end() || !geometry->is_array()) return out;
    for (const ParsedJson& g : *geometry)
      if (g.is_object() && g.contains("boundaries") && json_string(g, "type") != "GeometryInstance") out.push_back(&g);
    return out;
  }

  /// The object that a part belongs to in the end.
  static std::string root_of(const ParsedJson& objects, std::string id) {
    for (int depth = 0; depth < 16; ++depth) {
      const auto object = objects.find(id);
      if (object == objects.end()) return id;
      const auto parents = object->find("parents");
      if (parents == object->end() || !parents->is_array() || parents->empty() || !(*parents)[0].is_string()) return id;
      id = (*parents)[0].get<std::string>();
    }
    return id;
  }

  static double level_of_detail(const ParsedJson& geometry) {
    const auto lod = geometry.find("lod");
    if (lod == geometry.end()) return 0.0;
    return lod->is_number() ? lod->get<double>() : lod->is_string() ? std::atof(lod->get<std::string>().c_str()) : 0.0;
  }

  Status add(const std::string& root, const std::string& id, const std::string& object_type, const ParsedJson& geometry,
             int line) {
    const Row row = row_of(object_type);
    if (row.kind == ObjectKind::kBuilding && level_of_detail(geometry) < 1.0 && geometry.contains("lod")) {
      ++flat_;  // an outline
      return Ok{};
    }
    const auto [entry, fresh] = by_id_.try_emplace(root, 0u);
    if (fresh) entry->second = scene_.add_object(root, row.kind);
    object_ = entry->second;
    const auto known = line_of_.find(id);
    line_ = line > 0 ? line : known != line_of_.end() ? known->second : 0;
    material_ = scene_.material(row.material);
    const ParsedJson none;
    const ParsedJson::json_pointer values("/semantics/values"), surfaces("/semantics/surfaces");
    surfaces_ = geometry.contains(surfaces) ? &geometry[surfaces] : nullptr;
    const std::string type = json_string(geometry, "type");
    const int depth = type == "Solid" ? 1 : type == "MultiSolid" || type == "CompositeSolid" ? 2 : 0;
    if (type != "Solid" && type != "MultiSolid" && type != "CompositeSolid" && type != "MultiSurface" &&
        type != "CompositeSurface")
      return Ok{};  // points and lines
    if (!faces(geometry["boundaries"], geometry.contains(values) ? geometry[values] : none, depth))
      return Error{path_, line, "CityObjects." + id + ".geometry", "boundaries are not understood", "a " + type};
    return Ok{};
  }

  /// Boundaries `depth` levels above the list of faces; semantic values run along.
  bool faces(const ParsedJson& boundaries, const ParsedJson& values, int depth) {
    if (!boundaries.is_array()) return false;
    for (std::size_t i = 0; i < boundaries.size(); ++i) {
      const ParsedJson value = values.is_array() && i < values.size() ? values[i] : ParsedJson();
      if (depth > 0) {
        if (!faces(boundaries[i], value, depth - 1)) return false;
      } else if (!face(boundaries[i], value)) {
        return false;
      }
    }
    return true;
  }

  bool face(const ParsedJson& rings, const ParsedJson& value) {
    if (!rings.is_array()) return false;
    RawPolygon polygon{.object = object_, .material = material_};
    polygon.from.line = static_cast<std::uint32_t>(line_);
    if (surfaces_ != nullptr && surfaces_->is_array() && value.is_number_unsigned() &&
        value.get<std::size_t>() < surfaces_->size()) {
      const std::string type = json_string((*surfaces_)[value.get<std::size_t>()], "type");
      polygon.ground_surface = type == "GroundSurface";
      for (const Surface& s : kSurfaces)
        if (type == s.type) polygon.material = scene_.material(s.material);
    }
    for (const ParsedJson& ring : rings) {
      if (!ring.is_array()) return false;
      std::vector<Eigen::Vector3d> points;
      bool complete = true;
      for (const ParsedJson& index : ring) {
        if (!index.is_number_unsigned()) return false;
        complete = complete && index.get<std::size_t>() < vertices_.size();
        if (complete) points.push_back(vertices_[index.get<std::size_t>()]);
      }
      if (complete && points.size() >= 3) {
        polygon.rings.push_back(std::move(points));
      } else {
        dangling_ += complete ? 0 : 1;
        if (polygon.rings.empty()) return true;  // without its outer ring there is no face
      }
    }
    if (!polygon.rings.empty()) scene_.polygons.push_back(std::move(polygon));
    return true;
  }

  std::string path_;
  RawScene scene_;
  Eigen::Vector3d scale_ = Eigen::Vector3d::Ones(), translate_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> vertices_;
  std::map<std::string, std::uint32_t> by_id_;
  std::map<std::string, int> line_of_;  ///< of city objects, where the file is one object
  int line_ = 0;
  std::uint32_t object_ = 0, material_ = 0;
  const ParsedJson* surfaces_ = nullptr;
  int templates_ = 0, dangling_ = 0, flat_ = 0;
};

}  // namespace

Result<RawScene> read_cityjson(const std::string& path, const ReadOptions&) {
  return CityJsonReader(path).read();
}

}  // namespace canyon::scene
