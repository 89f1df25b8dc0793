#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/importers/importer.h"

namespace canyon::scene {
namespace {

using ParsedJson = nlohmann::json;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Where publishers keep what matters. The first layout with a property that a feature has is taken.
struct Layout {
  const char* id;
  const char* height;  ///< roof above ground, m
  const char* ground;  ///< height of the ground; empty: that of the outline's own points
  const char* storeys;
  const char* walls;  ///< material codes of BD TOPO
  const char* roof;
};
constexpr Layout kLayouts[] = {
    {"ID", "HAUTEUR", "Z_MIN_SOL", "NB_ETAGES", "MAT_MURS", "MAT_TOITS"},  // IGN BD TOPO
    {"id", "measuredHeight", "", "storeysAboveGround", "", ""},            // PLATEAU, CityGML exports
    {"id", "height", "ground_height", "levels", "", ""},
    {"osm_id", "building:height", "", "building:levels", "", ""},
};

/// IGN BD TOPO 3, MAT_MURS and MAT_TOITS: the first of two digits is the main material. Stone is taken for marble, the
/// only stone of the radio table; tiles are fired clay, as bricks; slate has no row and is taken for concrete.
const char* bd_topo_wall(char code) {
  switch (code) {
    case '1':
      return "marble";
    case '2':
      return "marble";
    case '3':
      return "concrete";
    case '4':
      return "brick";
    case '5':
      return "concrete";
    case '6':
      return "wood";
    default:
      return "";
  }
}
const char* bd_topo_roof(char code) {
  switch (code) {
    case '1':
      return "brick";
    case '2':
      return "concrete";
    case '3':
      return "metal";
    case '4':
      return "concrete";
    default:
      return "";
  }
}

double number_of(const ParsedJson& properties, const std::string& key) {
  if (key.empty()) return kUnknown;
  const auto value = properties.find(key);
  if (value == properties.end()) return kUnknown;
  if (value->is_number()) return value->get<double>();
  if (!value->is_string()) return kUnknown;
  const std::string text = value->get<std::string>();
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return end != text.c_str() ? number : kUnknown;
}

/// A text or a number as text.
std::string words_of(const ParsedJson& properties, const std::string& key) {
  const auto value = key.empty() ? properties.end() : properties.find(key);
  if (value == properties.end()) return "";
  return value->is_string() ? value->get<std::string>() : value->is_number() ? value->dump() : "";
}

class GeoJsonReader {
 public:
  GeoJsonReader(const std::string& path, const ReadOptions& options) : path_(path), options_(options) {}

  Result<RawScene> read() {
    CANYON_TRY(const std::string text, read_text_or_gzip_file(path_));
    CANYON_TRY(const ParsedJson document, parse_json(text, path_, {.key = "features", .members = &members_}));
    if (!document.is_object() || json_string(document, "type") != "FeatureCollection" ||
        !document.contains("features") || !document["features"].is_array())
      return Error{path_, 0, "type", "not a collection of features", "\"type\": \"FeatureCollection\""};
    const ParsedJson::json_pointer crs("/crs/properties/name");
    scene_.frame =
        frame_by_name(document.contains(crs) && document[crs].is_string() ? document[crs].get<std::string>() : "CRS84");
    scene_.frame.authority_order = false;  // GeoJSON's order is always east, north
    for (const ParsedJson& feature : document["features"]) {
      throw_if_cancelled();
      if (!feature.is_object() || !feature.contains("geometry")) return mistake("geometry", "no geometry", "a feature");
      if (!feature["geometry"].is_null()) CANYON_TRY_STATUS(add(feature));
      ++number_;
    }
    missing_.tell(scene_, options_);
    if (other_ > 0)
      scene_.warnings.push_back(std::to_string(other_) + " features that are neither surfaces nor lines are left out");
    if (scene_.footprints.empty() && scene_.polygons.empty() && scene_.streets.empty())
      return Error{path_, 0, "features", "no footprint, surface or street", "features with polygons or lines"};
    return std::move(scene_);
  }

 private:
  Error mistake(const std::string& key, std::string what, std::string expected) const {
    return {path_, line(), "features[" + std::to_string(number_ + 1) + "]." + key, std::move(what),
            std::move(expected)};
  }

  /// Of the feature that is being read.
  int line() const { return number_ < members_.size() ? members_[number_].line : 0; }
  RawPlace from() const { return {0, static_cast<std::uint32_t>(line())}; }

  Status add(const ParsedJson& feature) {
    const ParsedJson& geometry = feature["geometry"];
    const ParsedJson none = ParsedJson::object();
    const auto found = feature.find("properties");
    const ParsedJson& properties = found != feature.end() && found->is_object() ? *found : none;
    const std::string type = json_string(geometry, "type");
    if (!geometry.is_object() || !geometry.contains("coordinates") || !geometry["coordinates"].is_array())
      return mistake("geometry", "no coordinates", "a list");
    const ParsedJson& coordinates = geometry["coordinates"];
    if (type == "LineString") return street(coordinates, properties);
    if (type == "MultiLineString") {
      for (const ParsedJson& line : coordinates) CANYON_TRY_STATUS(street(line, properties));
      return Ok{};
    }
    if (type == "Polygon") return surfaces(ParsedJson::array({coordinates}), properties);
    if (type == "MultiPolygon") return surfaces(coordinates, properties);
    ++other_;
    return Ok{};
  }

  /// A ring or line; z is NaN where the file has none.
  Result<std::vector<Eigen::Vector3d>> points(const ParsedJson& list) const {
    std::vector<Eigen::Vector3d> out;
    if (!list.is_array())
      return mistake("geometry.coordinates", "not a list of points", "lists of two or three numbers");
    for (const ParsedJson& p : list) {
      if (!p.is_array() || p.size() < 2 || !p[0].is_number() || !p[1].is_number())
        return mistake("geometry.coordinates", "a point that is not understood", "two or three numbers");
      out.emplace_back(p[0].get<double>(), p[1].get<double>(),
                       p.size() > 2 && p[2].is_number() ? p[2].get<double>() : kUnknown);
    }
    return out;
  }

  Status street(const ParsedJson& line, const ParsedJson& properties) {
    CANYON_TRY(const auto way, points(line));
    RawStreet street;
    street.from = from();
    for (const Eigen::Vector3d& p : way) street.points.push_back(p.head<2>());
    if (const double width_m = number_of(properties, "width_m"); width_m > 0.0) street.width_m = width_m;
    if (street.points.size() >= 2) scene_.streets.push_back(std::move(street));
    return Ok{};
  }

  Layout layout_of(const ParsedJson& properties) const {
    for (const Layout& layout : kLayouts)
      if (properties.contains(layout.height)) return layout;
    return {"id", "", "", "", "", ""};
  }

  Status surfaces(const ParsedJson& polygons, const ParsedJson& properties) {
    const Layout layout = layout_of(properties);
    const std::string height_key = options_.height_property.empty() ? layout.height : options_.height_property;
    std::string name = words_of(properties, layout.id);
    std::vector<std::vector<std::vector<Eigen::Vector3d>>> rings;
    double low_m = 1e300, high_m = -1e300;
    for (const ParsedJson& polygon : polygons) {
      if (!polygon.is_array()) return mistake("geometry.coordinates", "not a list of rings", "a polygon");
      rings.emplace_back();
      for (const ParsedJson& ring : polygon) {
        CANYON_TRY(auto corner, points(ring));
        if (corner.size() > 1 && corner.front().head<2>() == corner.back().head<2>()) corner.pop_back();
        for (const Eigen::Vector3d& p : corner) low_m = std::min(low_m, p.z()), high_m = std::max(high_m, p.z());
        rings.back().push_back(std::move(corner));
      }
    }
    // Surfaces in space have no height property and points of different heights.
    if (!properties.contains(height_key) && high_m > low_m + 1e-6) {
      const std::uint32_t object =
          scene_.add_object(unique(name.empty() ? "structure" : name), kind_by_name(name, ObjectKind::kOther));
      for (auto& polygon : rings)
        scene_.polygons.push_back({.object = object, .rings = std::move(polygon), .from = from()});
      return Ok{};
    }
    const std::string ground_key = options_.ground_property.empty() ? layout.ground : options_.ground_property;
    const std::string storeys_key = options_.storeys_property.empty() ? layout.storeys : options_.storeys_property;
    const double height_m =
        missing_.resolve(number_of(properties, height_key), number_of(properties, storeys_key), options_);
    if (!std::isfinite(height_m)) return Ok{};
    const std::string walls = words_of(properties, layout.walls), roof = words_of(properties, layout.roof);
    const std::uint32_t object = scene_.add_object(unique(name.empty() ? "building" : name), ObjectKind::kBuilding);
    for (const auto& polygon : rings) {
      RawFootprint footprint{.object = object, .height_m = height_m};
      footprint.from = from();
      footprint.ground_m = ground_key.empty() ? (std::isfinite(low_m) && low_m < 1e300 ? low_m : kUnknown)
                                              : number_of(properties, ground_key);
      if (!walls.empty()) footprint.wall_material = bd_topo_wall(walls[0]);
      if (!roof.empty()) footprint.roof_material = bd_topo_roof(roof[0]);
      for (const auto& ring : polygon) {
        footprint.rings.emplace_back();
        for (const Eigen::Vector3d& p : ring) footprint.rings.back().push_back(p.head<2>());
      }
      if (!footprint.rings.empty() && footprint.rings[0].size() >= 3) scene_.footprints.push_back(std::move(footprint));
    }
    return Ok{};
  }

  /// "building" becomes "building 17" with the feature's number; names of the file stay.
  std::string unique(const std::string& name) const {
    return name == "building" || name == "structure" ? name + " " + std::to_string(number_ + 1) : name;
  }

  std::string path_;
  ReadOptions options_;
  RawScene scene_;
  std::size_t number_ = 0;
  std::vector<JsonMember> members_;
  MissingHeights missing_;
  int other_ = 0;
};

}  // namespace

Result<RawScene> read_geojson(const std::string& path, const ReadOptions& options) {
  return GeoJsonReader(path, options).read();
}

}  // namespace canyon::scene
