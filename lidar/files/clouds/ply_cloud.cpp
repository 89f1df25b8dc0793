#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>

#include "canyon/core/files/line_reader.h"
#include "canyon/lidar/files/clouds/read_cloud.h"

namespace canyon::lidar {
namespace {

struct PlyType {
  const char* names[2];
  std::size_t bytes;
  char kind;  ///< i, u or f
};
constexpr PlyType kPlyTypes[] = {{{"char", "int8"}, 1, 'i'},     {{"uchar", "uint8"}, 1, 'u'},
                                 {{"short", "int16"}, 2, 'i'},   {{"ushort", "uint16"}, 2, 'u'},
                                 {{"int", "int32"}, 4, 'i'},     {{"uint", "uint32"}, 4, 'u'},
                                 {{"float", "float32"}, 4, 'f'}, {{"double", "float64"}, 8, 'f'}};

struct PlyProperty {
  std::string name;
  const PlyType* type = nullptr;
};

/// Points of a PLY: the vertices, which must come first and have no lists. What follows them is not read.
class PlyCloud {
 public:
  PlyCloud(const std::string& path, const std::string& bytes) : path_(path), bytes_(bytes) {}

  Result<CloudPlaces> read() {
    CANYON_TRY_STATUS(header());
    std::array<std::size_t, 3> column{kNoColumn, kNoColumn, kNoColumn}, offset{};
    std::size_t record = 0;
    for (std::size_t k = 0; k < properties_.size(); ++k) {
      for (std::size_t a = 0; a < 3; ++a)
        if (properties_[k].name == std::string(1, "xyz"[a])) column[a] = k, offset[a] = record;
      record += properties_[k].type->bytes;
    }
    if (std::find(column.begin(), column.end(), kNoColumn) != column.end())
      return Error{path_, 0, "", "the vertices lack x, y or z", "property float x, y and z"};
    CloudPlaces out;
    out.single_precision = !text_ && properties_[column[0]].type->bytes == 4;
    if (text_) {
      CANYON_TRY_STATUS(text_points(column, out));
      return out;
    }
    if ((bytes_.size() - at_) / record < vertices_) return ends_early((bytes_.size() - at_) / record);
    out.points.resize(vertices_);
    for (std::size_t i = 0; i < vertices_; ++i) {
      for (std::size_t a = 0; a < 3; ++a)
        out.points[i][static_cast<Eigen::Index>(a)] =
            number(*properties_[column[a]].type, at_ + i * record + offset[a]);
    }
    return out;
  }

 private:
  static constexpr std::size_t kNoColumn = ~std::size_t{0};

  Error ends_early(std::size_t held) const {
    return Error{path_, 0, "", "the file holds " + std::to_string(held) + " points",
                 std::to_string(vertices_) + " as its header says"};
  }

  bool next_line(std::string_view& line) {
    if (at_ >= bytes_.size()) return false;
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    line = trimmed(std::string_view(bytes_).substr(at_, end - at_));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    at_ = std::min(end + 1, bytes_.size());
    ++line_;
    return true;
  }

  Status header() {
    std::string_view line;
    std::string element;
    bool format = false;
    while (next_line(line)) {
      const auto words = split(line, " \t", true);
      if (line_ == 1 || words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") {
        if (!format || first_ != "vertex")
          return Error{path_, line_, "", "the vertices do not come first, or no format is said", "element vertex N"};
        return Ok{};
      }
      if (words[0] == "format" && words.size() >= 2) {
        text_ = words[1] == "ascii";
        big_endian_ = words[1] == "binary_big_endian";
        format = text_ || big_endian_ || words[1] == "binary_little_endian";
        if (format) continue;
      } else if (words[0] == "element" && words.size() == 3) {
        element = words[1];
        if (first_.empty()) first_ = element;
        std::size_t count = 0;
        const auto [end, code] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), count);
        if (element == "vertex") vertices_ = count;
        if (code == std::errc() && end == words[2].data() + words[2].size()) continue;
      } else if (words[0] == "property" && element != "vertex" && !element.empty()) {
        continue;
      } else if (words[0] == "property" && words.size() == 3) {
        const auto* type = std::find_if(std::begin(kPlyTypes), std::end(kPlyTypes), [&](const PlyType& t) {
          return words[1] == t.names[0] || words[1] == t.names[1];
        });
        properties_.push_back({std::string(words[2]), type});
        if (type != std::end(kPlyTypes)) continue;
      }
      return Error{path_, line_, "", '"' + std::string(line.substr(0, 60)) + "\" is not understood", "a PLY header"};
    }
    return Error{path_, line_, "", "the header has no end", "end_header"};
  }

  Status text_points(const std::array<std::size_t, 3>& column, CloudPlaces& out) {
    std::string_view line;
    while (out.points.size() < vertices_ && next_line(line)) {
      const auto words = split(line, " \t", true);
      if (words.empty()) continue;
      const Error damaged{path_, line_, "", '"' + std::string(line.substr(0, 60)) + '"',
                          std::to_string(properties_.size()) + " numbers"};
      if (words.size() < properties_.size()) return damaged;
      Eigen::Vector3d p;
      for (std::size_t a = 0; a < 3; ++a) {
        const std::string_view word = words[column[a]];
        const auto [end, code] =
            std::from_chars(word.data(), word.data() + word.size(), p[static_cast<Eigen::Index>(a)]);
        if (code != std::errc() || end != word.data() + word.size()) return damaged;
      }
      out.points.push_back(p);
    }
    if (out.points.size() < vertices_) return ends_early(out.points.size());
    return Ok{};
  }

  double number(const PlyType& type, std::size_t at) const {
    char bytes[8];
    for (std::size_t k = 0; k < type.bytes; ++k) bytes[k] = bytes_[at + (big_endian_ ? type.bytes - 1 - k : k)];
    const auto as = [&bytes](auto value) {
      std::memcpy(&value, bytes, sizeof value);
      return static_cast<double>(value);
    };
    if (type.kind == 'f') return type.bytes == 4 ? as(float{}) : as(double{});
    if (type.kind == 'i')
      return type.bytes == 1 ? as(std::int8_t{}) : type.bytes == 2 ? as(std::int16_t{}) : as(std::int32_t{});
    return type.bytes == 1 ? as(std::uint8_t{}) : type.bytes == 2 ? as(std::uint16_t{}) : as(std::uint32_t{});
  }

  const std::string& path_;
  const std::string& bytes_;
  std::size_t at_ = 0, vertices_ = 0;
  int line_ = 0;
  bool text_ = false, big_endian_ = false;
  std::string first_;
  std::vector<PlyProperty> properties_;
};

}  // namespace

Result<CloudPlaces> read_ply_cloud(const std::string& path, const std::string& bytes) {
  return PlyCloud(path, bytes).read();
}

}  // namespace canyon::lidar
