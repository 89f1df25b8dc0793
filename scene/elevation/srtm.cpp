#include <cctype>
#include <cmath>
#include <filesystem>

#include "canyon/core/files/files.h"
#include "canyon/core/files/zip_file.h"
#include "canyon/scene/elevation/elevation.h"

namespace canyon::scene {

/// SRTM tiles of one degree: 1201 or 3601 samples a side, 16 bits, big-endian, rows from the north; the name tells the
/// south-west corner. Heights are above the geoid (EGM96); -32768 is unknown.
Result<Elevation> read_srtm(const std::string& path) {
  const bool zip = path.size() > 4 && (path.ends_with(".zip") || path.ends_with(".ZIP"));
  CANYON_TRY(const std::string bytes, zip ? read_zip_member(path, ".hgt") : read_text_or_gzip_file(path));
  const std::string name = std::filesystem::path(path).filename().string();
  const auto digits = [&](std::size_t from, std::size_t count) {
    int value = 0;
    for (std::size_t k = from; k < from + count; ++k)
      value =
          k < name.size() && std::isdigit(static_cast<unsigned char>(name[k])) ? 10 * value + (name[k] - '0') : 1000000;
    return value;
  };
  const char ns = name.empty() ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  const char ew = name.size() < 4 ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(name[3])));
  const int lat = digits(1, 2), lon = digits(4, 3);
  if ((ns != 'N' && ns != 'S') || (ew != 'E' && ew != 'W') || lat > 90 || lon > 180)
    return Error{path, 0, "", "the name does not tell the place", "a name like N43E007.hgt"};
  const int side = bytes.size() == 2u * 1201u * 1201u ? 1201 : bytes.size() == 2u * 3601u * 3601u ? 3601 : 0;
  if (side == 0)
    return Error{path, 0, "", std::to_string(bytes.size()) + " bytes",
                 "1201 x 1201 or 3601 x 3601 samples of two bytes"};
  Elevation out;
  out.frame = {"OGC:CRS84", false};
  out.columns = out.rows = side;
  out.step_x = out.step_y = 1.0 / (side - 1);
  out.west = ew == 'E' ? lon : -lon;
  out.north = (ns == 'N' ? lat : -lat) + 1.0;
  out.height_m.resize(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (std::size_t i = 0; i < out.height_m.size(); ++i) {
    const auto value = static_cast<std::int16_t>(static_cast<unsigned char>(bytes[2 * i]) << 8 |
                                                 static_cast<unsigned char>(bytes[2 * i + 1]));
    out.height_m[i] = value == -32768 ? std::nanf("") : static_cast<float>(value);
  }
  return out;
}

}  // namespace canyon::scene
