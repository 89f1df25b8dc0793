#include "canyon/core/files/pcd.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>

namespace canyon {
namespace {

static_assert(std::endian::native == std::endian::little && sizeof(float) == 4, "binary PCD is written as memory is");

std::vector<std::string> words(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

bool to_number(const std::string& word, std::size_t& value) {
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  return code == std::errc() && end == word.data() + word.size();
}

/// The text part of a file, entry by entry: each at most once, FIELDS before what goes by field.
class Header {
 public:
  static constexpr const char* kEntries[] = {"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                             "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};

  std::vector<PcdField> fields;
  std::size_t point_bytes = 0;
  std::size_t points = 0;
  bool any_data = false;  ///< text and compressed data are taken as well
  std::string data;       ///< "binary", ...

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
    for (std::size_t i = 1; i < parts.size(); ++i) fields.push_back({.name = parts[i], .type = 0, .size = 0});
    return Ok{};
  }

  Status read_by_field(const std::vector<std::string>& parts) {
    constexpr std::size_t kMostValues = 65536;  // of one field
    if (fields.empty()) return expected("FIELDS before it");
    if (parts.size() != fields.size() + 1) return expected("one value per field");
    for (std::size_t i = 1; i < parts.size(); ++i) {
      PcdField& field = fields[i - 1];
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
    const bool known = parts.size() == 2 &&
                       (parts[1] == "binary" || (any_data && (parts[1] == "ascii" || parts[1] == "binary_compressed")));
    if (!known) return expected(any_data ? "DATA ascii, binary or binary_compressed" : "DATA binary");
    data = parts[1];
    for (const char* needed : {"FIELDS", "SIZE", "TYPE", "POINTS"})
      if (seen_.count(needed) == 0)
        return expected(std::string(needed) + (std::string_view(needed) == "POINTS" ? " N" : "") + " before it");
    const bool shaped = seen_.count("WIDTH") != 0 && seen_.count("HEIGHT") != 0;
    if (shaped && (height_ == 0 ? points != 0 : points / height_ != width_ || points % height_ != 0))
      return expected("WIDTH times HEIGHT to be POINTS");
    for (PcdField& field : fields) {
      field.offset = point_bytes;
      point_bytes += field.size * field.count;
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

/// Leaves `in` where the points begin.
Result<Header> read_header(std::istream& in, const std::string& path, bool any_data = false) {
  Header header;
  header.any_data = any_data;
  std::string line;
  for (int line_number = 1;; ++line_number) {
    if (!std::getline(in, line) || in.eof())
      return Error{path, line_number, "", "the header ends early", "DATA binary"};
    const auto parts = words(line);
    if (parts.empty() || parts[0].front() == '#') continue;
    if (const Status read = header.read(parts); !read) {
      const std::string text = shown(parts);
      return Error{path, line_number, text.substr(0, text.find(' ')), '"' + text + '"', read.error().expected};
    }
    if (parts[0] == "DATA") return header;
  }
}

}  // namespace

std::string pcd_header(const std::vector<PcdField>& fields, std::size_t points) {
  std::string names, sizes, types, counts;
  for (const PcdField& field : fields) {
    names += " " + field.name;
    sizes += " " + std::to_string(field.size);
    types += std::string(" ") + field.type;
    counts += " " + std::to_string(field.count);
  }
  const std::string n = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS" + names + "\nSIZE" + sizes + "\nTYPE" +
         types + "\nCOUNT" + counts + "\nWIDTH " + n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n +
         "\nDATA binary\n";
}

Result<PcdReader> PcdReader::open(const std::string& path) {
  PcdReader out;
  out.path_ = path;
  out.in_.open(path, std::ios::binary);
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (!out.in_ || unknown) return Error{path, 0, {}, "cannot be read", "a PCD file"};
  CANYON_TRY(Header header, read_header(out.in_, path));
  out.fields_ = std::move(header.fields);
  out.point_bytes_ = header.point_bytes;
  out.points_ = header.points;
  const auto available = (size - static_cast<std::uintmax_t>(out.in_.tellg())) / out.point_bytes_;
  if (available < out.points_)
    return Error{path, 0, "POINTS", "the file holds " + std::to_string(available) + " points",
                 std::to_string(out.points_) + " as its header says"};
  return out;
}

Result<std::size_t> PcdReader::float_at(const std::string& name) const {
  const PcdField* found = nullptr;
  for (const PcdField& field : fields_) {
    if (field.name != name || field.type != 'F' || field.size != 4 || field.count != 1) continue;
    if (found) return Error{path_, 0, name, "there are two such fields", "one"};
    found = &field;
  }
  if (!found) return Error{path_, 0, name, "no such field", "one of type F, size 4 and count 1"};
  return found->offset;
}

Result<std::span<const char>> PcdReader::next() {
  constexpr std::size_t kPiece = 1 << 20;
  const std::size_t n = std::min(points_ - done_, std::max<std::size_t>(1, kPiece / point_bytes_));
  bytes_.resize(n * point_bytes_);
  in_.read(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
  if (static_cast<std::size_t>(in_.gcount()) != bytes_.size())
    return Error{path_, 0, "POINTS", "cannot be read to its end", std::to_string(points_) + " points"};
  done_ += n;
  return std::span<const char>(bytes_);
}

namespace {

/// Number `i` of a field in its bytes.
double value_at(const PcdField& field, const char* bytes) {
  const auto as = [bytes](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  };
  switch (field.type) {
    case 'F':
      return field.size == 4 ? as(float{}) : as(double{});
    case 'I':
      return field.size == 1   ? as(std::int8_t{})
             : field.size == 2 ? as(std::int16_t{})
             : field.size == 4 ? as(std::int32_t{})
                               : as(std::int64_t{});
    default:
      return field.size == 1   ? as(std::uint8_t{})
             : field.size == 2 ? as(std::uint16_t{})
             : field.size == 4 ? as(std::uint32_t{})
                               : as(std::uint64_t{});
  }
}

/// LZF as PCL writes it: a control byte, then a literal run or a copy of what came before. Empty: the data are damaged.
std::string unpacked_lzf(std::string_view packed, std::size_t size) {
  std::string out;
  out.reserve(size);
  std::size_t at = 0;
  while (at < packed.size()) {
    const auto control = static_cast<unsigned char>(packed[at++]);
    if (control < 32) {
      const std::size_t run = control + 1u;
      if (run > packed.size() - at || run > size - out.size()) return {};
      out.append(packed.substr(at, run));
      at += run;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) {
      if (at >= packed.size()) return {};
      length += static_cast<unsigned char>(packed[at++]);
    }
    if (at >= packed.size()) return {};
    const std::size_t back =
        (static_cast<std::size_t>(control & 0x1f) << 8) + static_cast<unsigned char>(packed[at++]) + 1;
    length += 2;
    if (back > out.size() || length > size - out.size()) return {};
    for (std::size_t k = 0; k < length; ++k) out.push_back(out[out.size() - back]);
  }
  return out.size() == size ? out : std::string();
}

using Axes = std::array<const PcdField*, 3>;

Result<Axes> axes_of(const Header& header, const std::string& path) {
  constexpr const char* kNames[] = {"x", "y", "z"};
  Axes axes{};
  for (const PcdField& field : header.fields) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (field.name != kNames[a]) continue;
      if (axes[a] != nullptr) return Error{path, 0, field.name, "there are two such fields", "one"};
      axes[a] = &field;
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    if (axes[a] == nullptr) return Error{path, 0, kNames[a], "no such field", "fields x, y and z"};
    if (axes[a]->count != 1 || (axes[a]->type == 'F' && axes[a]->size < 4))
      return Error{path, 0, kNames[a], "is no single number", "count 1, and 4 or 8 bytes of type F"};
  }
  return axes;
}

Error ends_early(const std::string& path, std::size_t held, std::size_t points) {
  return Error{path, 0, "POINTS", "the file holds " + std::to_string(held) + " points",
               std::to_string(points) + " as its header says"};
}

Status read_text_points(std::istream& in, const std::string& path, const Header& header, const Axes& axes,
                        CloudPlaces& out) {
  std::size_t columns = 0;
  std::array<std::size_t, 3> column{};
  for (const PcdField& field : header.fields) {
    for (std::size_t a = 0; a < 3; ++a)
      if (axes[a] == &field) column[a] = columns;
    columns += field.count;
  }
  std::string line;
  while (out.points.size() < header.points && std::getline(in, line)) {
    const auto parts = words(line);
    if (parts.empty()) continue;
    const Error damaged{path, 0, "point " + std::to_string(out.points.size()), '"' + shown(parts) + '"',
                        std::to_string(columns) + " numbers"};
    if (parts.size() != columns) return damaged;
    Eigen::Vector3d p;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::string& word = parts[column[a]];
      const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), p[static_cast<Eigen::Index>(a)]);
      if (code != std::errc() || end != word.data() + word.size()) return damaged;
    }
    out.points.push_back(p);
  }
  if (out.points.size() < header.points) return ends_early(path, out.points.size(), header.points);
  return Ok{};
}

}  // namespace

Result<CloudPlaces> read_pcd_places(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (!in || unknown) return Error{path, 0, {}, "cannot be read", "a PCD file"};
  CANYON_TRY(const Header header, read_header(in, path, true));
  CANYON_TRY(const Axes axes, axes_of(header, path));
  CloudPlaces out;
  out.single_precision = axes[0]->type == 'F' && axes[0]->size == 4;
  if (header.data == "ascii") {
    out.single_precision = false;
    CANYON_TRY_STATUS(read_text_points(in, path, header, axes, out));
    return out;
  }
  const std::uintmax_t behind = size - static_cast<std::uintmax_t>(in.tellg());
  if (header.data == "binary" && behind / header.point_bytes < header.points)
    return ends_early(path, behind / header.point_bytes, header.points);
  std::string bytes(behind, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::uintmax_t>(in.gcount()) != behind)
    return Error{path, 0, "", "cannot be read to its end", "points"};
  const bool packed = header.data == "binary_compressed";
  if (packed) {
    // Two lengths, then all values of the first field, of the second, ...
    std::uint32_t lengths[2] = {0, 0};
    if (bytes.size() >= sizeof lengths) std::memcpy(lengths, bytes.data(), sizeof lengths);
    const bool as_long = header.points <= lengths[1] / header.point_bytes &&  // their product may be beyond 64 bits
                         header.points * header.point_bytes == lengths[1];
    if (bytes.size() < sizeof lengths || bytes.size() - sizeof lengths < lengths[0] || !as_long)
      return Error{path, 0, "DATA", "the compressed data end early or are not as long as the header says",
                   std::to_string(header.points) + " points"};
    // Three bytes give 264 at most: a short file cannot ask for gigabytes.
    constexpr std::uint32_t kMostPerByte = 88;
    const bool possible = lengths[1] / kMostPerByte <= lengths[0];
    if (possible) bytes = unpacked_lzf(std::string_view(bytes).substr(sizeof lengths, lengths[0]), lengths[1]);
    if (!possible || bytes.size() != lengths[1])
      return Error{path, 0, "DATA", "the compressed data are damaged", "LZF as PCL writes it"};
  }
  out.points.resize(header.points);
  for (std::size_t i = 0; i < header.points; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      const PcdField& field = *axes[a];
      const std::size_t at =
          packed ? field.offset * header.points + i * field.size : i * header.point_bytes + field.offset;
      out.points[i][static_cast<Eigen::Index>(a)] = value_at(field, bytes.data() + at);
    }
  }
  return out;
}

}  // namespace canyon
