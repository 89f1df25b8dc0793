#include "lidar/cloud_files.h"

#include <array>
#include <charconv>
#include <cstring>
#include <sstream>

#include "core/files.h"

namespace canyon::lidar {
namespace {

static_assert(sizeof(float) == 4);

struct Field {
  std::string name;
  std::size_t offset = 0;
  std::size_t bytes = 4;
  char type = 'F';
};

struct Header {
  std::vector<Field> fields;
  std::size_t stride = 0;
  std::size_t points = 0;
  std::size_t data_offset = 0;
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

/// The text part of a PCD file, as far as clouds of scalar fields need it.
Result<Header> parse_header(std::string_view text, const std::string& path) {
  Header header;
  std::size_t at = 0;
  bool counted = false;
  for (int line_number = 1;; ++line_number) {
    const auto end = text.find('\n', at);
    if (end == std::string_view::npos) {
      return Error{path, line_number, "", "the header ends early", "DATA binary"};
    }
    const auto parts = words(text.substr(at, end - at));
    at = end + 1;
    const auto wrong = [&](const std::string& expected) {
      std::string line;
      for (const std::string& part : parts) line += (line.empty() ? "" : " ") + part;
      return Error{path, line_number, parts[0], '"' + line.substr(0, 80) + '"', expected};
    };
    if (parts.empty() || parts[0].front() == '#') continue;
    if (parts[0] == "FIELDS") {
      header.fields.resize(parts.size() - 1);
      for (std::size_t i = 1; i < parts.size(); ++i) header.fields[i - 1].name = parts[i];
    } else if (parts[0] == "SIZE" || parts[0] == "TYPE" || parts[0] == "COUNT") {
      if (parts.size() != header.fields.size() + 1) return wrong("one value per field");
      for (std::size_t i = 1; i < parts.size(); ++i) {
        Field& field = header.fields[i - 1];
        std::size_t value = 0;
        if (parts[0] == "TYPE") {
          field.type = parts[i][0];
        } else if (!to_number(parts[i], value) || value == 0 || value > 1024) {
          return wrong("positive whole numbers");
        } else {
          field.bytes = parts[0] == "SIZE" ? value : field.bytes * value;
        }
      }
    } else if (parts[0] == "POINTS") {
      if (parts.size() != 2 || !to_number(parts[1], header.points)) return wrong("POINTS N");
      counted = true;
    } else if (parts[0] == "DATA") {
      if (parts.size() != 2 || parts[1] != "binary") return wrong("DATA binary");
      if (!counted) return wrong("POINTS N before it");
      break;
    }
  }
  for (Field& field : header.fields) {
    field.offset = header.stride;
    header.stride += field.bytes;
  }
  header.data_offset = at;
  return header;
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
  CANYON_TRY(const Header header, parse_header(bytes, path));
  // x, y, z are needed; intensity and error are 0 where the file has none.
  constexpr std::array<const char*, 5> kNames{"x", "y", "z", "intensity", "error"};
  std::array<const Field*, 5> source{};
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    for (const Field& field : header.fields) {
      if (field.name == kNames[k] && field.type == 'F' && field.bytes == 4) source[k] = &field;
    }
    if (k < 3 && !source[k]) {
      return Error{path, 0, kNames[k], "no such field", "x, y, z of type F and size 4"};
    }
  }
  const std::size_t available = (bytes.size() - header.data_offset) / header.stride;
  if (available < header.points) {
    return Error{path, 0, "POINTS", join_values("data for ", available, " points only"), join_values(header.points)};
  }
  std::vector<MapPoint> points(header.points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<float, 5> values{};
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (source[k])
        std::memcpy(&values[k], bytes.data() + header.data_offset + i * header.stride + source[k]->offset, 4);
    }
    points[i] = {.p_W = {values[0], values[1], values[2]}, .intensity = values[3], .error_m = values[4]};
  }
  return points;
}

}  // namespace canyon::lidar
