// Heights of the ground from files of every format, each sample and what lies between.
#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/scene/elevation/elevation.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using stress::kEpsilon;
using stress::Looks;

/// A file of that name in a folder that is gone again with it.
class FileForNow {
 public:
  explicit FileForNow(const std::string& name) {
    const auto base = std::filesystem::temp_directory_path();
    for (int k = 0; folder_.empty(); ++k) {
      const auto candidate = base / ("canyon-heights-" + std::to_string(::getpid()) + "-" + std::to_string(k));
      if (std::filesystem::create_directory(candidate)) folder_ = candidate;
    }
    path = (folder_ / name).string();
  }
  ~FileForNow() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  FileForNow(const FileForNow&) = delete;
  FileForNow& operator=(const FileForNow&) = delete;
  void write(const std::string& bytes) const { std::ofstream(path, std::ios::binary) << bytes; }

  std::string path;

 private:
  std::filesystem::path folder_;
};

/// Heights in whole metres that no shift, turn or mirror leaves as they are; -32768 in a few places: not known.
int height_of(int column, int row) {
  if ((column * 7 + row * 3) % 997 == 11) return -32768;
  return (column * 31 + row * 17 + (column * row) % 29) % 4001 - 300;
}

/// Every sample where it stands by its name's corner: a tile spans one degree, first row in the north. Both sizes, all
/// four quarters of the Earth, and names that are none.
StressFigure srtm(int side, const char* name, double west, double south) {
  Looks looks;
  std::string bytes(std::size_t{2} * static_cast<std::size_t>(side) * static_cast<std::size_t>(side), '\0');
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const auto value = static_cast<std::uint16_t>(height_of(column, row));
      const std::size_t at =
          2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(side) + static_cast<std::size_t>(column));
      bytes[at] = static_cast<char>(value >> 8), bytes[at + 1] = static_cast<char>(value & 255);
    }
  const FileForNow file(name);
  file.write(bytes);
  const auto read = read_elevation(file.path);
  looks.right(read.ok());
  if (!read) return looks.figure();
  looks.right(read->columns == side && read->rows == side);
  const double step = 1.0 / (side - 1);
  looks.near(read->west, west, kEpsilon), looks.near(read->north, south + 1.0, kEpsilon);
  looks.near(read->step_x, step, kEpsilon), looks.near(read->step_y, step, kEpsilon);
  int wrong = 0;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const float found = read->at(column, row);
      const int height = height_of(column, row);
      wrong += (height == -32768 ? std::isnan(found) : found == static_cast<float>(height)) ? 0 : 1;
    }
  looks.right(wrong == 0);
  const FileForNow short_file(name), other("heights.hgt");
  short_file.write(bytes.substr(2));
  other.write(bytes);
  looks.right(!read_elevation(short_file.path) && !read_elevation(other.path));
  return looks.figure();
}

/// A field that is what files are made of: bytes in the order of this machine or the other.
class Bytes {
 public:
  explicit Bytes(bool little) : little_(little) {}
  template <class T>
  void put(T value) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof value);
    const bool turn = little_ != (std::endian::native == std::endian::little);
    for (std::size_t i = 0; i < raw.size(); ++i) text += raw[turn ? raw.size() - 1 - i : i];
  }
  std::string text;

 private:
  bool little_;
};

/// As TIFF 6.0 and GeoTIFF 1.1 have it: one image, its pixels in one strip or in tiles of 16, and where it stands.
struct Tiff {
  int columns = 37, rows = 21;
  bool little = true, tiled = false, point = false, by_matrix = false;
  std::uint16_t bits = 32, format = 3;  // 1 unsigned, 2 signed, 3 floating point

  double height(int column, int row) const {
    const int h = height_of(column, row);
    if (h == -32768) return format == 1 ? 255.0 : -99.0;  // no data
    return format == 1 ? (h + 300) % 251 : bits == 8 ? h % 120 : format == 3 ? h + 0.25 : h;
  }

  std::string file() const {
    Bytes pixels(little);
    const auto put = [&](int column, int row) {
      const double h = column < columns && row < rows ? height(column, row) : 0.0;
      if (format == 3) bits == 32 ? pixels.put(static_cast<float>(h)) : pixels.put(h);
      if (format != 3 && bits == 8) pixels.put(static_cast<std::int8_t>(static_cast<int>(h)));
      if (format != 3 && bits == 16) pixels.put(static_cast<std::int16_t>(h));
      if (format != 3 && bits == 32) pixels.put(static_cast<std::int32_t>(h));
    };
    std::vector<std::uint32_t> starts, counts;
    constexpr int kTile = 16;
    if (tiled) {
      for (int y = 0; y < rows; y += kTile)
        for (int x = 0; x < columns; x += kTile) {
          starts.push_back(static_cast<std::uint32_t>(8 + pixels.text.size()));
          for (int r = 0; r < kTile; ++r)
            for (int c = 0; c < kTile; ++c) put(x + c, y + r);
          counts.push_back(static_cast<std::uint32_t>(8 + pixels.text.size()) - starts.back());
        }
    } else {
      starts.push_back(8);
      for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) put(c, r);
      counts.push_back(static_cast<std::uint32_t>(pixels.text.size()));
    }
    if (pixels.text.size() % 2 != 0) pixels.text += '\0';
    struct Entry {
      std::uint16_t tag, type;  // 2 text, 3 of two bytes, 4 of four, 12 doubles
      std::uint32_t count;
      std::string values;
    };
    std::vector<Entry> entries;
    const auto add = [&]<class T>(std::uint16_t tag, std::uint16_t type, const std::vector<T>& values) {
      Bytes raw(little);
      for (const T value : values) raw.put(value);
      entries.push_back({tag, type, static_cast<std::uint32_t>(values.size()), raw.text});
    };
    using Short = std::uint16_t;
    const auto side = [](int n) { return std::vector<std::uint32_t>{static_cast<std::uint32_t>(n)}; };
    add(256, 4, side(columns)), add(257, 4, side(rows));
    add(258, 3, std::vector<Short>{bits}), add(259, 3, std::vector<Short>{1}), add(262, 3, std::vector<Short>{1});
    if (!tiled) add(273, 4, starts);
    add(277, 3, std::vector<Short>{1});
    if (!tiled) add(278, 4, side(rows)), add(279, 4, counts);
    if (tiled) add(322, 4, side(kTile)), add(323, 4, side(kTile)), add(324, 4, starts), add(325, 4, counts);
    add(339, 3, std::vector<Short>{format});
    if (!by_matrix) {
      add(33550, 12, std::vector<double>{0.5, 0.25, 0.0});
      add(33922, 12, std::vector<double>{2.0, 3.0, 0.0, 4000.5, 7000.25, 0.0});
    } else {
      // The same place: what the tie point says of the first pixel's corner.
      add(34264, 12, std::vector<double>{0.5, 0, 0, 3999.5, 0, -0.25, 0, 7001.0, 0, 0, 0, 0, 0, 0, 0, 1});
    }
    add(34735, 3, std::vector<Short>{1, 1, 0, 2, 1025, 0, 1, static_cast<Short>(point ? 2 : 1), 3072, 0, 1, 32632});
    const std::string none = format == 1 ? "255" : "-99";
    entries.push_back({42113, 2, static_cast<std::uint32_t>(none.size() + 1), none + '\0'});
    Bytes out(little);
    out.text = little ? "II" : "MM";
    out.put(std::uint16_t{42});
    out.put(static_cast<std::uint32_t>(8 + pixels.text.size()));
    out.text += pixels.text;
    const std::size_t after = out.text.size() + 2 + 12 * entries.size() + 4;
    std::string longer;
    out.put(static_cast<std::uint16_t>(entries.size()));
    for (Entry& entry : entries) {
      out.put(entry.tag), out.put(entry.type), out.put(entry.count);
      if (entry.values.size() <= 4) {
        entry.values.resize(4, '\0');
        out.text += entry.values;
      } else {
        out.put(static_cast<std::uint32_t>(after + longer.size()));
        longer += entry.values;
        if (longer.size() % 2 != 0) longer += '\0';
      }
    }
    out.put(std::uint32_t{0});
    return out.text + longer;
  }
};

/// Every pixel where its tie point or its matrix says, its middle or its corner; what is said to be none is none.
StressFigure geotiff(const Tiff& made) {
  Looks looks;
  const FileForNow file("heights.tif");
  const std::string bytes = made.file();
  file.write(bytes);
  const auto read = read_elevation(file.path);
  looks.right(read.ok());
  if (!read) return looks.figure();
  looks.right(read->columns == made.columns && read->rows == made.rows && read->frame.crs == "EPSG:32632");
  const double half = made.point ? 0.0 : 0.5;
  // Of the tie point pixel (2, 3) stands at (4000.5, 7000.25).
  looks.near(read->west, 4000.5 - (2.0 - half) * 0.5, 1e-300),
      looks.near(read->north, 7000.25 + (3.0 - half) * 0.25, 1e-300);
  looks.near(read->step_x, 0.5, 1e-300), looks.near(read->step_y, 0.25, 1e-300);
  int wrong = 0;
  for (int row = 0; row < made.rows; ++row)
    for (int column = 0; column < made.columns; ++column) {
      const bool none = height_of(column, row) == -32768;
      const float found = read->at(column, row), expected = static_cast<float>(made.height(column, row));
      wrong +=
          (none || expected == (made.format == 1 ? 255.0F : -99.0F) ? std::isnan(found) : found == expected) ? 0 : 1;
    }
  looks.right(wrong == 0);
  file.write(bytes.substr(0, bytes.size() / 3));
  looks.right(!read_elevation(file.path));
  return looks.figure();
}

/// A grid in text by its corner and by its first sample's middle, with holes: every value, and between four of them
/// what is bilinear there, to roundings; beside the grid and beside a hole none.
StressFigure ascii_grid(bool by_centre) {
  Looks looks;
  constexpr int kColumns = 41, kRows = 23;
  std::string text = "ncols " + std::to_string(kColumns) + "\nNROWS " + std::to_string(kRows) + "\n";
  text += by_centre ? "xllcenter 1000.25\nyllcenter -500.25\n" : "xllcorner 1000\nyllcorner -500.5\n";
  text += "cellsize 0.5\nnodata_value -32768\n";
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) text += std::to_string(height_of(column, row)) + " ";
    text += row % 2 == 0 ? "\n" : " ";
  }
  const FileForNow file("heights.asc");
  file.write(text);
  const auto read = read_elevation(file.path);
  looks.right(read.ok());
  if (!read) return looks.figure();
  looks.right(read->columns == kColumns && read->rows == kRows);
  const double west = 1000.25, north = -500.25 + 0.5 * (kRows - 1);
  const RandomStream draws(7, "stress.elevations");
  int none = 0;
  for (int k = 0; k < 3000; ++k) {
    const double u = draws.uniform(-1.0, kColumns, 0, k), v = draws.uniform(-1.0, kRows, 1, k);
    const auto found = read->height({west + 0.5 * u, north - 0.5 * v});
    const int c = static_cast<int>(std::floor(u)), r = static_cast<int>(std::floor(v));
    if (std::abs(u) < 1e-9 || std::abs(v) < 1e-9 || std::abs(u - (kColumns - 1)) < 1e-9 ||
        std::abs(v - (kRows - 1)) < 1e-9)
      continue;
    std::optional<double> expected;
    if (u > 0.0 && v > 0.0 && u < kColumns - 1 && v < kRows - 1) {
      double sum = 0.0;
      bool known = true;
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
          const int h = height_of(c + i, r + j);
          known = known && h != -32768;
          sum += (i == 0 ? c + 1 - u : u - c) * (j == 0 ? r + 1 - v : v - r) * h;
        }
      if (known) expected = sum;
    }
    none += expected ? 0 : 1;
    looks.right(found.has_value() == expected.has_value());
    // Places round by 1e-13 of a thousand metres, over half a metre, times steps of up to 4000 m.
    if (found && expected) looks.near(*found, *expected, kEpsilon * 1000.0 / 0.5 * 4000.0);
  }
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const auto found = read->height({west + 0.5 * column, north - 0.5 * row});
      if (height_of(column, row) != -32768 && found) looks.near(*found, height_of(column, row), 1e-9);
    }
  looks.right(none > 100);
  for (const char* wrong :
       {"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\n1 2 3 4\n", "ncols 2\nnrows 2\ncellsize 1\nyllcorner 0\n1 2 3 4\n",
        "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n",
        "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4 5\n",
        "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize -1\n1 2 3 4\n"}) {
    file.write(wrong);
    looks.right(!read_elevation(file.path));
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> elevation_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "heights of the ground in files",
           "a row from the south, a sample of the other end first, a corner for a middle",
           "each sample where the format says, and what is bilinear between: roundings", "of the bound"});
  rows.add("elevations/srtm_of_3_seconds", [] { return srtm(1201, "S12W077.hgt", -77.0, -12.0); });
  rows.add("elevations/srtm_of_1_second", [] { return srtm(3601, "N43E007.hgt", 7.0, 43.0); });
  const std::pair<const char*, Tiff> made[] = {
      {"float", {}},
      {"double_tiled_of_the_other_order", {.little = false, .tiled = true, .bits = 64}},
      {"16_bits_by_points", {.point = true, .bits = 16, .format = 2}},
      {"32_bits_tiled_by_matrix", {.tiled = true, .by_matrix = true, .bits = 32, .format = 2}},
      {"unsigned_bytes", {.bits = 8, .format = 1}},
      {"signed_bytes_by_matrix_and_points",
       {.little = false, .point = true, .by_matrix = true, .bits = 8, .format = 2}}};
  for (const auto& [name, tiff] : made)
    rows.add(std::string("elevations/geotiff_of_") + name, [tiff = tiff] { return geotiff(tiff); });
  rows.add("elevations/grid_by_its_corner", [] { return ascii_grid(false); });
  rows.add("elevations/grid_by_its_first_middle", [] { return ascii_grid(true); });
  return rows.take();
}

}  // namespace canyon::scene
