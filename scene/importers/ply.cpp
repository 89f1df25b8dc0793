#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstring>
#include <filesystem>

#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/importers/importer.h"

namespace canyon::scene {
namespace {

enum class Format { kAscii, kLittleEndian, kBigEndian };

struct Type {
  const char* names[2];
  std::size_t bytes;
  char kind;  ///< i, u or f
};
constexpr Type kTypes[] = {{{"char", "int8"}, 1, 'i'},     {{"uchar", "uint8"}, 1, 'u'},   {{"short", "int16"}, 2, 'i'},
                           {{"ushort", "uint16"}, 2, 'u'}, {{"int", "int32"}, 4, 'i'},     {{"uint", "uint32"}, 4, 'u'},
                           {{"float", "float32"}, 4, 'f'}, {{"double", "float64"}, 8, 'f'}};

const Type* type_of(std::string_view name) {
  for (const Type& type : kTypes)
    if (name == type.names[0] || name == type.names[1]) return &type;
  return nullptr;
}

struct Property {
  std::string name;
  const Type* type = nullptr;
  const Type* count = nullptr;  ///< of lists
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

/// One PLY file being read: the header tells what follows, as text or as bytes of either order.
/// assimp reads PLY too, but in single precision (half a metre on a national grid), with mistakes told without file and
/// line, in a process of its own; and builds without it read the meshes of Mitsuba and Sionna.
class PlyReader {
 public:
  PlyReader(const std::string& path, std::string text) : path_(path), text_(std::move(text)) {}

  Result<RawScene> read() {
    CANYON_TRY_STATUS(header());
    RawScene scene;
    const std::string name = std::filesystem::path(path_).stem().string();
    object_ = scene.add_object(name, kind_by_name(name, ObjectKind::kOther));
    scene.meshes.emplace_back();
    for (const Element& element : elements_)
      if (element.count > 0 && (element.properties.empty() || element.count > text_.size()))
        return mistake(std::to_string(element.count) + " of element \"" + element.name + "\"",
                       "properties, and no more than the file holds");
    if (format_ == Format::kAscii) ++line_;  // the first line after the header
    for (const Element& element : elements_) {
      for (std::size_t i = 0; i < element.count; ++i) {
        throw_if_cancelled();
        if (element.name == "vertex") {
          CANYON_TRY_STATUS(vertex(element, scene.meshes[0]));
        } else if (element.name == "face") {
          CANYON_TRY_STATUS(face(element, scene));
        } else {
          for (const Property& property : element.properties) CANYON_TRY_STATUS(values(property));
        }
      }
    }
    if (scene.meshes[0].vertices.empty()) return Error{path_, 0, "", "holds no vertex", "a PLY mesh"};
    if (scene.meshes[0].triangles.empty() && scene.polygons.empty())
      return Error{path_, 0, "", "holds no face: a cloud of points", "a PLY mesh"};
    return scene;
  }

 private:
  Error mistake(std::string what, std::string expected) const {
    return {path_, line_, "", std::move(what), std::move(expected)};
  }

  bool next_line(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line = trimmed(std::string_view(text_).substr(at_, end - at_));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    at_ = end + 1;
    ++line_;
    return true;
  }

  Status header() {
    std::string_view line;
    if (!next_line(line) || line != "ply") return mistake("does not begin with \"ply\"", "a PLY file");
    bool format_known = false;
    while (next_line(line)) {
      const auto words = split(line, " \t", true);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") {
        if (!format_known) return mistake("no format line", "format ascii, binary_little_endian or binary_big_endian");
        line_ = format_ == Format::kAscii ? line_ : 0;
        return Ok{};
      }
      if (words[0] == "format" && words.size() >= 2) {
        format_known = words[1] == "ascii" || words[1] == "binary_little_endian" || words[1] == "binary_big_endian";
        format_ = words[1] == "ascii"                  ? Format::kAscii
                  : words[1] == "binary_little_endian" ? Format::kLittleEndian
                                                       : Format::kBigEndian;
        if (format_known) continue;
      } else if (words[0] == "element" && words.size() == 3) {
        Element element{std::string(words[1]), 0, {}};
        if (std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count).ec == std::errc()) {
          elements_.push_back(std::move(element));
          continue;
        }
      } else if (words[0] == "property" && !elements_.empty()) {
        const bool list = words.size() == 5 && words[1] == "list";
        if (list || words.size() == 3) {
          Property property{std::string(words.back()), type_of(words[words.size() - 2]),
                            list ? type_of(words[2]) : nullptr};
          if (property.type != nullptr && (!list || property.count != nullptr)) {
            elements_.back().properties.push_back(std::move(property));
            continue;
          }
        }
      }
      return mistake("\"" + std::string(line.substr(0, 60)) + "\" is not understood", "a PLY header");
    }
    return mistake("the header has no end", "end_header");
  }

  /// The number, or the list, that comes next, in values_.
  Status values(const Property& property) {
    double count = 1.0;
    if (property.count != nullptr) {
      CANYON_TRY(count, number(*property.count));
    }
    if (!(count >= 0.0 && count <= 1e6)) return mistake("a list of " + std::to_string(count) + " values", "a PLY mesh");
    values_.clear();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      CANYON_TRY(const double value, number(*property.type));
      values_.push_back(value);
    }
    return Ok{};
  }

  Result<double> number(const Type& type) {
    if (format_ == Format::kAscii) return word();
    if (at_ + type.bytes > text_.size()) return mistake("ends in the middle", "as many elements as the header says");
    unsigned char bytes[8];
    std::memcpy(bytes, text_.data() + at_, type.bytes);
    at_ += type.bytes;
    if ((format_ == Format::kBigEndian) != (std::endian::native == std::endian::big))
      std::reverse(bytes, bytes + type.bytes);
    const auto as = [&]<class T>(T value) {
      std::memcpy(&value, bytes, sizeof value);
      return static_cast<double>(value);
    };
    if (type.kind == 'f') return type.bytes == 4 ? as(float{}) : as(double{});
    if (type.kind == 'i')
      return type.bytes == 1 ? as(std::int8_t{}) : type.bytes == 2 ? as(std::int16_t{}) : as(std::int32_t{});
    return type.bytes == 1 ? as(std::uint8_t{}) : type.bytes == 2 ? as(std::uint16_t{}) : as(std::uint32_t{});
  }

  Result<double> word() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    double value = 0.0;
    const auto [end, error] = std::from_chars(text_.data() + begin, text_.data() + at_, value);
    if (begin == at_) return mistake("ends in the middle", "as many elements as the header says");
    if (error != std::errc() || end != text_.data() + at_)
      return mistake("\"" + text_.substr(begin, std::min<std::size_t>(at_ - begin, 40)) + "\" is not a number",
                     "a number");
    return value;
  }

  Status vertex(const Element& element, RawMesh& mesh) {
    Eigen::Vector3d p = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    for (const Property& property : element.properties) {
      CANYON_TRY_STATUS(values(property));
      if (property.name == "x" || property.name == "y" || property.name == "z")
        p[property.name[0] - 'x'] = values_.empty() ? p.x() : values_[0];
    }
    mesh.vertices.push_back(p);
    mesh.line.push_back(static_cast<std::uint32_t>(line_));
    return Ok{};
  }

  Status face(const Element& element, RawScene& scene) {
    RawMesh& mesh = scene.meshes[0];
    for (const Property& property : element.properties) {
      CANYON_TRY_STATUS(values(property));
      if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
      std::vector<std::uint32_t> corners;
      for (const double value : values_) {
        if (!(value >= 0.0 && value < static_cast<double>(mesh.vertices.size())))
          return mistake("a face with vertex " + std::to_string(static_cast<long long>(value)) + " of " +
                             std::to_string(mesh.vertices.size()),
                         "vertices that exist, counted from 0");
        corners.push_back(static_cast<std::uint32_t>(value));
      }
      if (corners.size() < 3) continue;
      if (corners.size() == 3) {
        mesh.triangles.push_back({corners[0], corners[1], corners[2]});
        mesh.object.push_back(object_);
        mesh.material.push_back(0);
        continue;
      }
      RawPolygon polygon{.object = object_, .rings = {{}}};
      polygon.from.line = static_cast<std::uint32_t>(line_);
      for (const std::uint32_t corner : corners) polygon.rings[0].push_back(mesh.vertices[corner]);
      scene.polygons.push_back(std::move(polygon));
    }
    return Ok{};
  }

  std::string path_, text_;
  std::size_t at_ = 0;
  int line_ = 0;
  Format format_ = Format::kAscii;
  std::vector<Element> elements_;
  std::uint32_t object_ = 0;
  std::vector<double> values_;
};

}  // namespace

Result<RawScene> read_ply(const std::string& path, const ReadOptions&) {
  CANYON_TRY(std::string text, read_text_or_gzip_file(path));
  return PlyReader(path, std::move(text)).read();
}

}  // namespace canyon::scene
