#include <algorithm>
#include <charconv>

#include "canyon/core/files/line_reader.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/importers/importer.h"
#include "canyon/scene/importers/parsing/xml_file.h"

namespace canyon::scene {
namespace {

struct TypeRow {
  const char* element;
  ObjectKind kind;
  const char* material;
};
constexpr TypeRow kMembers[] = {{"Building", ObjectKind::kBuilding, ""},
                                {"Bridge", ObjectKind::kOther, "concrete"},
                                {"Road", ObjectKind::kTerrain, "asphalt"},
                                {"Railway", ObjectKind::kTerrain, "ground"},
                                {"ReliefFeature", ObjectKind::kTerrain, "ground"},
                                {"LandUse", ObjectKind::kTerrain, "ground"},
                                {"PlantCover", ObjectKind::kTerrain, "grass"},
                                {"WaterBody", ObjectKind::kTerrain, "water"},
                                {"SolitaryVegetationObject", ObjectKind::kTree, "foliage"},
                                {"CityFurniture", ObjectKind::kOther, ""}};

/// "lod2MultiSurface" is of level 2; -1 for other elements.
int level_of_detail(std::string_view name) {
  return name.size() > 4 && name.starts_with("lod") && name[3] >= '0' && name[3] <= '4' ? name[3] - '0' : -1;
}

class CityGmlReader {
 public:
  explicit CityGmlReader(const std::string& path) : path_(path) {}

  Result<RawScene> read() {
    CANYON_TRY(const XmlFile file, XmlFile::load(path_));
    if (file.root().name() != "CityModel")
      return Error{path_, file.root().line(), "", "<" + std::string(file.root().name()) + ">", "a <CityModel>"};
    for (XmlElement member = file.root().first_child(); member; member = member.next()) {
      if (member.name() == "boundedBy") note_frame(member);
      if (member.name() != "cityObjectMember") continue;
      for (XmlElement object = member.first_child(); object; object = object.next()) CANYON_TRY_STATUS(add(object));
    }
    if (scene_.polygons.empty())
      return Error{path_, 0, "", "holds no surface", "city objects of level of detail 1 or more"};
    if (templates_ > 0) scene_.warnings.push_back(std::to_string(templates_) + " geometry templates are left out");
    if (flat_ > 0) scene_.warnings.push_back(std::to_string(flat_) + " buildings of level of detail 0 are left out");
    return std::move(scene_);
  }

 private:
  struct Found {
    int level;
    RawPolygon polygon;
  };

  void note_frame(const XmlElement& e) {
    if (!scene_.frame.crs.empty()) return;
    e.walk([&](const XmlElement& inner) {
      if (const auto name = inner.attribute("srsName"); name && scene_.frame.crs.empty())
        scene_.frame = frame_by_name(*name);
      return true;
    });
  }

  Status add(const XmlElement& element) {
    throw_if_cancelled();
    const TypeRow* row = nullptr;
    for (const TypeRow& known : kMembers)
      if (element.name() == known.element) row = &known;
    if (row == nullptr) return Ok{};
    note_frame(element);
    found_.clear();
    CANYON_TRY_STATUS(collect(element, -1, row->material, false));
    int best = -1;
    for (const Found& f : found_) best = std::max(best, f.level);
    if (best < 1 && row->kind == ObjectKind::kBuilding) {  // level 0 is an outline
      ++flat_;
      return Ok{};
    }
    if (found_.empty()) return Ok{};
    const std::string id =
        element.attribute("id").value_or(std::string(element.name()) + " " + std::to_string(scene_.objects.size() + 1));
    const std::uint32_t object = scene_.add_object(id, row->kind);
    for (Found& f : found_) {
      if (f.level != best) continue;
      f.polygon.object = object;
      scene_.polygons.push_back(std::move(f.polygon));
    }
    return Ok{};
  }

  /// All polygons and triangles below an element with their level of detail. Surfaces that are referred to
  /// (xlink:href) stand somewhere of their own and are met there.
  Status collect(const XmlElement& parent, int level, const std::string& material, bool ground) {
    for (XmlElement e = parent.first_child(); e; e = e.next()) {
      const std::string_view name = e.name();
      if (name == "Polygon" || name == "Triangle") {
        CANYON_TRY_STATUS(polygon(e, level, material, ground));
        continue;
      }
      if (name == "ImplicitGeometry") {  // a prototype in coordinates of its own, to be set in many places
        ++templates_;
        continue;
      }
      const int own = level_of_detail(name);
      const std::string inner = name == "Window" ? "glass" : name == "Door" ? "wood" : material;
      CANYON_TRY_STATUS(collect(e, own >= 0 ? own : level, inner, ground || name == "GroundSurface"));
    }
    return Ok{};
  }

  Status polygon(const XmlElement& e, int level, const std::string& material, bool ground) {
    Found found{level, {.material = scene_.material(material), .ground_surface = ground}};
    for (XmlElement side = e.first_child(); side; side = side.next()) {
      if (side.name() != "exterior" && side.name() != "interior") continue;
      const XmlElement ring = side.child("LinearRing");
      if (!ring) return Error{path_, side.line(), "Polygon", "no LinearRing", "a LinearRing"};
      CANYON_TRY(auto points, ring_points(ring));
      if (points.size() > 1 && points.front() == points.back()) points.pop_back();
      if (points.size() < 3) {
        if (found.polygon.rings.empty()) return Ok{};
        continue;
      }
      found.polygon.rings.push_back(std::move(points));
    }
    found.polygon.from.line = static_cast<std::uint32_t>(std::max(e.line(), 0));
    if (!found.polygon.rings.empty()) found_.push_back(std::move(found));
    return Ok{};
  }

  Result<std::vector<Eigen::Vector3d>> ring_points(const XmlElement& ring) const {
    std::vector<double> numbers;
    for (XmlElement e = ring.first_child(); e; e = e.next()) {
      if (e.name() != "posList" && e.name() != "pos") continue;
      if (const auto dimension = e.attribute("srsDimension"); dimension && *dimension != "3")
        return Error{path_, e.line(), "srsDimension", "\"" + *dimension + "\"", "3: points with a height"};
      const std::string text = e.text();
      for (const std::string_view word : split(text, " \t\r\n", true)) {
        double value = 0.0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size())
          return Error{path_, e.line(), "posList", "\"" + std::string(word) + "\" is not a number", "numbers"};
        numbers.push_back(value);
      }
    }
    if (numbers.size() % 3 != 0)
      return Error{path_, ring.line(), "posList", std::to_string(numbers.size()) + " numbers", "three for each point"};
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < numbers.size(); i += 3) points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return points;
  }

  std::string path_;
  RawScene scene_;
  std::vector<Found> found_;
  int flat_ = 0, templates_ = 0;
};

}  // namespace

Result<RawScene> read_citygml(const std::string& path, const ReadOptions&) {
  return CityGmlReader(path).read();
}

}  // namespace canyon::scene
