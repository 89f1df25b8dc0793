#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <unordered_map>

#include "canyon/core/process/progress.h"
#include "canyon/scene/importers/importer.h"
#include "canyon/scene/importers/parsing/xml_file.h"
#include "canyon/scene/surfaces/triangulate.h"

namespace canyon::scene {
namespace {

using Tags = std::map<std::string, std::string>;

/// Streets that a car may drive, and how wide they usually are, kerb to kerb.
struct Highway {
  const char* value;
  double width_m;
};
constexpr Highway kHighways[] = {{"motorway", 11.0},    {"trunk", 9.0},          {"primary", 9.0},
                                 {"secondary", 8.0},    {"tertiary", 7.0},       {"unclassified", 6.0},
                                 {"residential", 6.0},  {"living_street", 5.0},  {"service", 4.0},
                                 {"road", 6.0},         {"motorway_link", 5.0},  {"trunk_link", 5.0},
                                 {"primary_link", 5.0}, {"secondary_link", 5.0}, {"tertiary_link", 5.0}};

struct MaterialName {
  const char* osm;
  const char* ours;
};
constexpr MaterialName kMaterials[] = {
    {"roof_tiles", "brick"},     {"stone", "marble"},          {"sandstone", "marble"},
    {"plaster", "plasterboard"}, {"cement_block", "concrete"}, {"tar_paper", "roofing"},
    {"slate", "concrete"},       {"copper", "metal"},          {"zinc", "metal"},
    {"steel", "metal"}};

std::string material_of(const Tags& tags, const char* key) {
  const auto tag = tags.find(key);
  if (tag == tags.end()) return "";
  for (const MaterialName& m : kMaterials)
    if (tag->second == m.osm) return m.ours;
  return tag->second;
}

/// Metres of "12", "12.5 m", "40'" or "40 ft"; NaN otherwise.
double metres(const Tags& tags, const char* key) {
  const auto tag = tags.find(key);
  if (tag == tags.end()) return std::numeric_limits<double>::quiet_NaN();
  char* end = nullptr;
  const double value = std::strtod(tag->second.c_str(), &end);
  if (end == tag->second.c_str()) return std::numeric_limits<double>::quiet_NaN();
  const std::string unit = end;
  return unit.find('\'') != std::string::npos || unit.find("ft") != std::string::npos ? 0.3048 * value : value;
}

double or_zero(double value) {
  return std::isfinite(value) ? value : 0.0;
}

bool is(const Tags& tags, const char* key) {
  const auto tag = tags.find(key);
  return tag != tags.end() && tag->second != "no";
}

using Ring = std::vector<Eigen::Vector2d>;

/// A building, or a part of one, as the file has it.
struct Shape {
  std::string name;  ///< "way 12"
  Tags tags;
  std::vector<std::vector<Ring>> outlines;  ///< each with its holes
  std::uint32_t line = 0;                   ///< of the file

  bool contains(const Eigen::Vector2d& p) const {
    return std::any_of(outlines.begin(), outlines.end(),
                       [&](const auto& rings) { return polygon_contains(rings[0], p); });
  }
  /// A point that lies inside, away from the border.
  Eigen::Vector2d inner_point() const {
    const std::vector<Ring>& rings = outlines[0];
    Ring points;
    for (const Ring& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
    Eigen::Vector2d best = points[0];
    double largest = 0.0;
    for (const auto& t : triangulate(rings)) {
      const Eigen::Vector2d &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
      const double area = twice_area({a, b, c});
      if (area > largest) largest = area, best = (a + b + c) / 3.0;
    }
    return best;
  }
};

class OsmReader {
 public:
  OsmReader(const std::string& path, const ReadOptions& options) : path_(path), options_(options) {}

  Result<RawScene> read() {
    CANYON_TRY(const XmlFile file, XmlFile::load(path_));
    if (file.root().name() != "osm")
      return Error{path_, file.root().line(), "", "<" + std::string(file.root().name()) + ">", "an <osm> file"};
    scene_.frame = {"OGC:CRS84", false};
    for (XmlElement e = file.root().first_child(); e; e = e.next()) {
      throw_if_cancelled();
      if (e.name() == "node") CANYON_TRY_STATUS(node(e));
      if (e.name() == "way") CANYON_TRY_STATUS(way(e));
    }
    for (XmlElement e = file.root().first_child(); e; e = e.next())
      if (e.name() == "relation") relation(e);
    set_up();
    missing_.tell(scene_, options_);
    if (open_ > 0)
      scene_.warnings.push_back(std::to_string(open_) +
                                " buildings whose outline is cut off or not closed are left out");
    if (scene_.footprints.empty() && scene_.streets.empty())
      return Error{path_, 0, "", "holds no building and no street", "ways with building=* or highway=*"};
    return std::move(scene_);
  }

 private:
  static Tags tags_of(const XmlElement& e) {
    Tags tags;
    for (XmlElement tag = e.first_child(); tag; tag = tag.next())
      if (tag.name() == "tag") tags[tag.attribute("k").value_or("")] = tag.attribute("v").value_or("");
    return tags;
  }

  Result<long long> id_of(const XmlElement& e, const char* attribute) const {
    const std::string text = e.attribute(attribute).value_or("");
    long long id = 0;
    if (std::from_chars(text.data(), text.data() + text.size(), id).ec != std::errc())
      return Error{path_, e.line(), attribute, "\"" + text + "\" is not a number", "an id"};
    return id;
  }

  Status node(const XmlElement& e) {
    CANYON_TRY(const long long id, id_of(e, "id"));
    const std::string lat = e.attribute("lat").value_or(""), lon = e.attribute("lon").value_or("");
    Eigen::Vector2d p;
    const auto read = [](const std::string& text, double& value) {
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      return error == std::errc() && end == text.data() + text.size();
    };
    if (!read(lon, p.x()) || !read(lat, p.y()) || std::abs(p.y()) > 90.0 || std::abs(p.x()) > 180.0)
      return Error{path_, e.line(), "node", "lat=\"" + lat + "\" lon=\"" + lon + "\"", "degrees"};
    nodes_[id] = p;
    if (!e.first_child()) return Ok{};
    const Tags tags = tags_of(e);
    if (const auto kind = tags.find("natural"); kind != tags.end() && kind->second == "tree")
      tree(id, p, tags, e.line());
    return Ok{};
  }

  Status way(const XmlElement& e) {
    CANYON_TRY(const long long id, id_of(e, "id"));
    std::vector<long long> refs;
    for (XmlElement nd = e.first_child(); nd; nd = nd.next()) {
      if (nd.name() != "nd") continue;
      CANYON_TRY(const long long ref, id_of(nd, "ref"));
      refs.push_back(ref);
    }
    const Tags tags = tags_of(e);
    if (is(tags, "building") || is(tags, "building:part"))
      note("way " + std::to_string(id), e.line(), tags, {refs}, {});
    if (tags.contains("highway")) street(tags, refs, e.line());
    ways_[id] = std::move(refs);
    return Ok{};
  }

  void relation(const XmlElement& e) {
    const Tags tags = tags_of(e);
    const auto type = tags.find("type");
    if (type == tags.end()) return;
    if (type->second == "building") return group(e);
    if (type->second != "multipolygon" || !(is(tags, "building") || is(tags, "building:part"))) return;
    std::vector<std::vector<long long>> outer, inner;
    for (XmlElement member = e.first_child(); member; member = member.next()) {
      if (member.name() != "member" || member.attribute("type") != "way") continue;
      const auto found = ways_.find(std::atoll(member.attribute("ref").value_or("0").c_str()));
      if (found == ways_.end()) continue;
      (member.attribute("role") == "inner" ? inner : outer).push_back(found->second);
    }
    note("relation " + e.attribute("id").value_or("?"), e.line(), tags, joined(std::move(outer)),
         joined(std::move(inner)));
  }

  /// A relation of type building says which parts belong to which outline.
  void group(const XmlElement& e) {
    std::string outline;
    std::vector<std::string> parts;
    for (XmlElement member = e.first_child(); member; member = member.next()) {
      if (member.name() != "member") continue;
      const std::string name = member.attribute("type").value_or("") + " " + member.attribute("ref").value_or("");
      if (member.attribute("role") == "outline") outline = name;
      if (member.attribute("role") == "part") parts.push_back(name);
    }
    for (const std::string& part : parts) outline_of_[part] = outline;
  }

  /// Ways put together at their ends.
  static std::vector<std::vector<long long>> joined(std::vector<std::vector<long long>> ways) {
    for (std::size_t i = 0; i < ways.size(); ++i) {
      for (std::size_t j = i + 1; j < ways.size() && !ways[i].empty() && ways[i].front() != ways[i].back();) {
        auto& other = ways[j];
        if (!other.empty() && other.back() == ways[i].back()) std::reverse(other.begin(), other.end());
        if (other.empty() || other.front() != ways[i].back()) {
          ++j;
          continue;
        }
        ways[i].insert(ways[i].end(), other.begin() + 1, other.end());
        ways.erase(ways.begin() + static_cast<std::ptrdiff_t>(j));
        j = i + 1;
      }
    }
    return ways;
  }

  /// The corners of a closed way; empty if it is open or leaves the file.
  std::vector<Eigen::Vector2d> ring(const std::vector<long long>& refs) const {
    std::vector<Eigen::Vector2d> out;
    if (refs.size() < 4 || refs.front() != refs.back()) return out;
    for (std::size_t i = 0; i + 1 < refs.size(); ++i) {
      const auto found = nodes_.find(refs[i]);
      if (found == nodes_.end()) return {};
      out.push_back(found->second);
    }
    return out;
  }

  /// Keeps a building or a part for set_up(), when all are known.
  void note(const std::string& name, int line, const Tags& tags, const std::vector<std::vector<long long>>& outer,
            const std::vector<std::vector<long long>>& inner) {
    throw_if_cancelled();
    Shape shape{name, tags, {}, static_cast<std::uint32_t>(std::max(line, 0))};
    for (const auto& refs : outer)
      if (auto points = ring(refs); !points.empty()) shape.outlines.push_back({std::move(points)});
    for (const auto& refs : inner) {
      const Ring hole = ring(refs);
      if (hole.empty()) continue;
      const Eigen::Vector2d within = Shape{"", {}, {{hole}}, 0}.inner_point();
      for (auto& rings : shape.outlines) {
        if (!polygon_contains(rings[0], within)) continue;
        rings.push_back(hole);
        break;
      }
    }
    if (shape.outlines.empty())
      ++open_;
    else
      (is(tags, "building") ? buildings_ : parts_).push_back(std::move(shape));
  }

  /// Of a building with parts only these are built, and the outline is its footprint (Simple 3D Buildings). A part of
  /// no building stands for itself.
  void set_up() {
    std::map<std::string, std::size_t> number_of;
    for (std::size_t b = 0; b < buildings_.size(); ++b) number_of[buildings_[b].name] = b;
    std::vector<std::vector<const Shape*>> parts_of(buildings_.size());
    std::vector<const Shape*> alone;
    for (const Shape& part : parts_) {
      throw_if_cancelled();
      const auto stated = outline_of_.find(part.name);
      const auto known = stated == outline_of_.end() ? number_of.end() : number_of.find(stated->second);
      std::size_t b = known == number_of.end() ? 0 : known->second;
      if (known == number_of.end()) {
        const Eigen::Vector2d within = part.inner_point();
        while (b < buildings_.size() && !buildings_[b].contains(within)) ++b;
      }
      if (b < buildings_.size())
        parts_of[b].push_back(&part);
      else
        alone.push_back(&part);
    }
    for (std::size_t b = 0; b < buildings_.size(); ++b) add_building(buildings_[b], parts_of[b]);
    for (const Shape* part : alone) add_building(*part, {});
  }

  void add_building(const Shape& outline, const std::vector<const Shape*>& parts) {
    std::vector<RawFootprint> made;
    if (parts.empty()) {
      add_footprints(outline, outline.tags, made);
    } else {
      for (const auto& rings : outline.outlines) {
        RawFootprint footprint{.rings = rings};
        footprint.only_outline = true;
        footprint.from.line = outline.line;
        made.push_back(std::move(footprint));
      }
      const std::size_t outlines = made.size();
      for (const Shape* part : parts) {
        // What a part does not say of itself, the building says.
        Tags tags = part->tags;
        const auto inherit = [&](const char* key) {
          if (const auto tag = outline.tags.find(key); tag != outline.tags.end()) tags.insert(*tag);
        };
        const bool tall = tags.contains("height") || tags.contains("building:levels");
        if (!tall) inherit("height"), inherit("building:levels");
        inherit("building:material"), inherit("roof:material");
        add_footprints(*part, tags, made);
      }
      if (made.size() == outlines) return;
    }
    if (made.empty()) return;
    const std::uint32_t object = scene_.add_object(outline.name, ObjectKind::kBuilding);
    for (RawFootprint& footprint : made) {
      footprint.object = object;
      scene_.footprints.push_back(std::move(footprint));
    }
  }

  void add_footprints(const Shape& source, const Tags& tags, std::vector<RawFootprint>& out) {
    RawFootprint shape;
    const double roof_levels = or_zero(metres(tags, "roof:levels"));
    const double height = metres(tags, "height");
    shape.height_m = missing_.resolve(std::isfinite(height) ? height : metres(tags, "building:height"),
                                      metres(tags, "building:levels") + roof_levels, options_);
    if (!std::isfinite(shape.height_m)) return;
    const double lift = metres(tags, "min_height");
    shape.lift_m = std::isfinite(lift) ? lift : or_zero(metres(tags, "building:min_level")) * options_.storey_m;
    if (!(shape.lift_m >= 0.0 && shape.lift_m < shape.height_m)) shape.lift_m = 0.0;
    const auto roof = tags.find("roof:shape");
    if (roof != tags.end()) {
      shape.roof = roof->second == "gabled"      ? RoofShape::kGabled
                   : roof->second == "hipped"    ? RoofShape::kHipped
                   : roof->second == "pyramidal" ? RoofShape::kPyramidal
                                                 : RoofShape::kFlat;
    }
    const double roof_height = metres(tags, "roof:height");
    shape.roof_height_m = std::isfinite(roof_height) ? roof_height : std::max(1.0, roof_levels) * options_.storey_m;
    if (shape.roof == RoofShape::kFlat) shape.roof_height_m = 0.0;
    shape.roof_height_m = std::clamp(shape.roof_height_m, 0.0, shape.height_m - shape.lift_m);
    const auto orientation = tags.find("roof:orientation");
    shape.ridge_across = orientation != tags.end() && orientation->second == "across";
    shape.wall_material = material_of(tags, "building:material");
    shape.roof_material = material_of(tags, "roof:material");
    for (const auto& rings : source.outlines) {
      out.push_back(shape);
      out.back().rings = rings;
      out.back().from.line = source.line;
    }
  }

  /// Without figures a street tree of middle age: 10 m high, its crown half as wide.
  void tree(long long id, const Eigen::Vector2d& p, const Tags& tags, int line) {
    const double height_m = metres(tags, "height"), crown_m = metres(tags, "diameter_crown");
    RawTree tree{.object = scene_.add_object("node " + std::to_string(id), ObjectKind::kTree), .place = p};
    tree.height_m = height_m > 1.0 && height_m < 120.0 ? height_m : 10.0;
    tree.crown_m = crown_m > 0.5 && crown_m < 60.0 ? crown_m : 0.5 * tree.height_m;
    tree.from.line = static_cast<std::uint32_t>(std::max(line, 0));
    scene_.trees.push_back(tree);
  }

  void street(const Tags& tags, const std::vector<long long>& refs, int line) {
    const auto area = tags.find("area"), tunnel = tags.find("tunnel");
    if ((area != tags.end() && area->second == "yes") || (tunnel != tags.end() && tunnel->second != "no")) return;
    const auto value = tags.find("highway");
    for (const Highway& row : kHighways) {
      if (value->second != row.value) continue;
      RawStreet street;
      const double width = metres(tags, "width"), lanes = metres(tags, "lanes");
      street.width_m = width > 1.0 && width < 100.0 ? width : lanes >= 1.0 && lanes < 20.0 ? 3.25 * lanes : row.width_m;
      for (const long long ref : refs)
        if (const auto found = nodes_.find(ref); found != nodes_.end()) street.points.push_back(found->second);
      street.from.line = static_cast<std::uint32_t>(std::max(line, 0));
      if (street.points.size() >= 2) scene_.streets.push_back(std::move(street));
    }
  }

  std::string path_;
  ReadOptions options_;
  RawScene scene_;
  std::unordered_map<long long, Eigen::Vector2d> nodes_;
  std::map<long long, std::vector<long long>> ways_;
  std::vector<Shape> buildings_, parts_;
  std::map<std::string, std::string> outline_of_;  ///< of parts, where a relation says so
  MissingHeights missing_;
  int open_ = 0;
};

}  // namespace

Result<RawScene> read_osm(const std::string& path, const ReadOptions& options) {
  return OsmReader(path, options).read();
}

}  // namespace canyon::scene
