#include "canyon/lidar/files/cloud_files.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <iterator>
#include <set>
#include <sstream>

#include "canyon/core/files/files.h"

namespace canyon::lidar {
namespace {

static_assert(sizeof(float) == 4);

struct Field {
  std::string name;
  std::size_t offset = 0;
  std::size_t size = 0;
  std::size_t count = 1;
  char type = 0;
};

std::vector<std::string> words(std::string_view line) {
  std::istringstream in{std::string(line)};
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

bool to_number(const std::string& word, std::size_t& value) {
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  return code == std::errc() && end == word.data() + word.size();
}

/// The text part of a PCD file, entry by entry: each at most once, FIELDS before what goes by field.
class Header {
 public:
  static constexpr const char* kEntries[] = {"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                             "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};

  std::vector<Field> fields;
  std::size_t stride = 0;
  std::size_t points = 0;

  /// One line of the header, split at blanks. Error: only what was expected is filled in.
  Status read(const std::vector<std::string>& parts) {
    const std::string& entry = parts[0];
    if (std::find(std::begin(kEntries), std::end(kEntries), entry) == std::end(kEntries))
      return expected("one of VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS, DATA");
    if (!seen_.insert(entry).second) return expected("each entry once");
    if (entry == "FIELDS") return read_names(parts);
    if (entry == "SIZE" || entry == "TYPE" || entry == "COUNT") return read_by_field(parts);
    if (entry == "WIDTH") return read_number(parts, width_);
    if (entry == "HEIGHT") return read_number(parts, height_);
    if (entry == "POINTS") return read_number(parts, points);
    return entry == "DATA" ? close(parts) : Status(Ok{});
  }

 private:
  static Error expected(std::string what) { return Error{.expected = std::move(what)}; }

  static Status read_number(const std::vector<std::string>& parts, std::size_t& value) {
    if (parts.size() != 2 || !to_number(parts[1], value)) return expected(parts[0] + " N");
    return Ok{};
  }

  Status read_names(const std::vector<std::string>& parts) {
    if (parts.size() < 2) return expected("names of fields");
    for (std::size_t i = 1; i < parts.size(); ++i) {
      fields.emplace_back();
      fields.back().name = parts[i];
    }
    return Ok{};
  }

  Status read_by_field(const std::vector<std::string>& parts) {
    constexpr std::size_t kMostValues = 65536;  // of one field
    if (parts.size() != fields.size() + 1) return expected("one value per field");
    for (std::size_t i = 1; i < parts.size(); ++i) {
      Field& field = fields[i - 1];
      const std::string& word = parts[i];
      if (parts[0] == "TYPE") {
        if (word != "F" && word != "I" && word != "U") return expected("F, I or U for each field");
        field.type = word[0];
      } else if (parts[0] == "SIZE") {
        if (!to_number(word, field.size) || (field.size != 1 && field.size != 2 && field.size != 4 && field.size != 8))
          return expected("1, 2, 4 or 8 bytes for each field");
      } else if (!to_number(word, field.count) || field.count == 0 || field.count > kMostValues) {
        return expected("whole numbers from 1 to 65536");
      }
    }
    return Ok{};
  }

  /// DATA ends the header: is all there, and does it agree?
  Status close(const std::vector<std::string>& parts) {
    if (parts.size() != 2 || parts[1] != "binary") return expected("DATA binary");
    for (const char* needed : {"FIELDS", "SIZE", "TYPE", "POINTS"})
      if (seen_.count(needed) == 0)
        return expected(std::string(needed) + (std::string_view(needed) == "POINTS" ? " N" : "") + " before it");
    const bool shaped = seen_.count("WIDTH") != 0 && seen_.count("HEIGHT") != 0;
    if (shaped && (height_ == 0 ? points != 0 : points / height_ != width_ || points % height_ != 0))
      return expected("WIDTH times HEIGHT to be POINTS");
    for (Field& field : fields) {
      field.offset = stride;
      stride += field.size * field.count;
    }
    return Ok{};
  }

  std::set<std::string> seen_;
  std::size_t width_ = 0, height_ = 0;
};

/// The beginning of a line as it may be shown: a damaged file has anything in it.
std::string shown(const std::vector<std::string>& parts) {
  std::string line;
  for (const std::string& part : parts) line += (line.empty() ? "" : " ") + part;
  line.resize(std::min<std::size_t>(line.size(), 80));
  for (char& c : line)
    if (c < ' ' || c > '~') c = '?';
  return line;
}

/// Reads the header of a file's `text`; `at` is where its data begin.
Result<Header> read_header(std::string_view text, const std::string& path, std::size_t& at) {
  Header header;
  at = 0;
  for (int line_number = 1;; ++line_number) {
    const auto end = text.find('\n', at);
    if (end == std::string_view::npos) return Error{path, line_number, "", "the header ends early", "DATA binary"};
    const auto parts = words(text.substr(at, end - at));
    at = end + 1;
    if (parts.empty() || parts[0].front() == '#') continue;
    if (const Status read = header.read(parts); !read) {
      const std::string line = shown(parts);
      return Error{path, line_number, line.substr(0, line.find(' ')), '"' + line + '"', read.error().expected};
    }
    if (parts[0] == "DATA") return header;
  }
}

}  // namespace

Status write_pcd(const std::string& path, std::span<const MapPoint> points) {
  const std::string n = std::to_string(points.size());
  std::string bytes =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity error\nSIZE 4 4 4 4 4\n"
      "TYPE F F F F F\nCOUNT 1 1 1 1 1\nWIDTH " +
      n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA binary\n";
  bytes.reserve(bytes.size() + points.size() * 20);
  for (const MapPoint& point : points) {
    const std::array<float, 5> values{point.p_W.x(), point.p_W.y(), point.p_W.z(), point.intensity, point.error_m};
    std::array<char, sizeof(values)> raw;
    std::memcpy(raw.data(), values.data(), sizeof(values));
    bytes.append(raw.data(), raw.size());
  }
  return write_text_file(path, bytes);
}

Result<std::vector<MapPoint>> read_pcd(const std::string& path) {
  CANYON_TRY(const std::string bytes, read_text_file(path));
  std::size_t data_at = 0;
  CANYON_TRY(const Header header, read_header(bytes, path, data_at));
  // x, y, z are needed; intensity and error are 0 where the file has none.
  constexpr std::array<const char*, 5> kNames{"x", "y", "z", "intensity", "error"};
  std::array<const Field*, 5> source{};
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    for (const Field& field : header.fields) {
      if (field.name != kNames[k] || field.type != 'F' || field.size != 4 || field.count != 1) continue;
      if (source[k]) return Error{path, 0, kNames[k], "there are two such fields", "one"};
      source[k] = &field;
    }
    if (k < 3 && !source[k]) return Error{path, 0, kNames[k], "no such field", "x, y, z of type F, size 4 and count 1"};
  }
  const std::size_t available = (bytes.size() - data_at) / header.stride;
  if (available < header.points)
    return Error{path, 0, "POINTS", join_values("data for ", available, " points only"), join_values(header.points)};
  std::vector<MapPoint> points(header.points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<float, 5> values{};
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (source[k]) std::memcpy(&values[k], bytes.data() + data_at + i * header.stride + source[k]->offset, 4);
    }
    points[i] = {.p_W = {values[0], values[1], values[2]}, .intensity = values[3], .error_m = values[4]};
  }
  return points;
}

}  // namespace canyon::lidar
