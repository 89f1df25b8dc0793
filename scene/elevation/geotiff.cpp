#include <tiffio.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "canyon/core/files/files.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/elevation/elevation.h"

namespace canyon::scene {
namespace {

// Tags and keys of GeoTIFF 1.1 (OGC 19-008r4) and GDAL.
constexpr ttag_t kPixelScale = 33550, kTiepoint = 33922, kTransformation = 34264, kGeoKeys = 34735, kNoData = 42113;
constexpr std::uint16_t kRasterType = 1025, kGeodeticCrs = 2048, kProjectedCrs = 3072, kVerticalCrs = 4096;
constexpr std::uint16_t kPixelIsPoint = 2, kUserDefined = 32767;

/// libtiff does not know these tags by itself.
void extend(TIFF* tiff) {
  static const TIFFFieldInfo kFields[] = {
      {kPixelScale, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("ModelPixelScale")},
      {kTiepoint, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("ModelTiepoint")},
      {kTransformation, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("ModelTransformation")},
      {kGeoKeys, -1, -1, TIFF_SHORT, FIELD_CUSTOM, 1, 1, const_cast<char*>("GeoKeyDirectory")},
      {kNoData, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDAL_NODATA")}};
  TIFFMergeFieldInfo(tiff, kFields, sizeof kFields / sizeof kFields[0]);
}

template <class T>
std::vector<T> list(TIFF* tiff, ttag_t tag) {
  std::uint16_t count = 0;
  T* values = nullptr;
  return TIFFGetField(tiff, tag, &count, &values) == 1 ? std::vector<T>(values, values + count) : std::vector<T>();
}

std::uint16_t geo_key(const std::vector<std::uint16_t>& keys, std::uint16_t key) {
  for (std::size_t i = 4; i + 3 < keys.size(); i += 4)
    if (keys[i] == key && keys[i + 1] == 0) return keys[i + 3];
  return 0;
}

/// One sample as it lies in memory.
struct SampleType {
  std::uint16_t bits = 1, format = SAMPLEFORMAT_UINT;

  float read(const std::uint8_t* at) const {
    const auto as = [at]<class T>(T value) {
      std::memcpy(&value, at, sizeof value);
      return static_cast<float>(value);
    };
    if (format == SAMPLEFORMAT_IEEEFP) return bits == 32 ? as(float{}) : as(double{});
    if (format == SAMPLEFORMAT_INT)
      return bits == 8 ? as(std::int8_t{}) : bits == 16 ? as(std::int16_t{}) : as(std::int32_t{});
    return bits == 8 ? as(std::uint8_t{}) : bits == 16 ? as(std::uint16_t{}) : as(std::uint32_t{});
  }
  bool known() const {
    return format == SAMPLEFORMAT_IEEEFP
               ? bits == 32 || bits == 64
               : (format == SAMPLEFORMAT_INT || format == SAMPLEFORMAT_UINT) && (bits == 8 || bits == 16 || bits == 32);
  }
};

bool read_pixels(TIFF* tiff, SampleType type, Elevation& out) {
  const std::size_t bytes = type.bits / 8;
  const auto store = [&](std::uint32_t column, std::uint32_t row, const std::uint8_t* at) {
    if (column < static_cast<std::uint32_t>(out.columns) && row < static_cast<std::uint32_t>(out.rows))
      out.height_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(out.columns) + column] = type.read(at);
  };
  if (TIFFIsTiled(tiff) != 0) {
    std::uint32_t width = 0, length = 0;
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &width);
    TIFFGetField(tiff, TIFFTAG_TILELENGTH, &length);
    constexpr tmsize_t kLargestTile = tmsize_t{1} << 28;
    if (TIFFTileSize(tiff) > kLargestTile) return false;
    std::vector<std::uint8_t> tile(static_cast<std::size_t>(TIFFTileSize(tiff)));
    if (width == 0 || length == 0 || tile.size() < std::size_t{width} * length * bytes) return false;
    for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(out.rows); y += length) {
      for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(out.columns); x += width) {
        throw_if_cancelled();
        if (TIFFReadTile(tiff, tile.data(), x, y, 0, 0) < 0) return false;
        for (std::uint32_t r = 0; r < length; ++r)
          for (std::uint32_t c = 0; c < width; ++c)
            store(x + c, y + r, tile.data() + (std::size_t{r} * width + c) * bytes);
      }
    }
    return true;
  }
  std::vector<std::uint8_t> line(static_cast<std::size_t>(TIFFScanlineSize(tiff)));
  if (line.size() < static_cast<std::size_t>(out.columns) * bytes) return false;
  for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(out.rows); ++y) {
    throw_if_cancelled();
    if (TIFFReadScanline(tiff, line.data(), y, 0) < 0) return false;
    for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(out.columns); ++c) store(c, y, line.data() + c * bytes);
  }
  return true;
}

}  // namespace

/// GeoTIFF of one band, whatever way libtiff can unpack it; placed by pixel scale and tie point or by a transformation
/// without rotation. Rotated rasters are refused.
Result<Elevation> read_geotiff(const std::string& path) {
  CANYON_TRY(const std::string bytes, read_text_file(path));  // a file that is not there is told as everywhere else
  TIFFSetErrorHandler(nullptr);
  TIFFSetWarningHandler(nullptr);
  TIFFSetTagExtender(extend);
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(path.c_str(), "r"), TIFFClose);
  if (!tiff) return Error{path, 0, "", "not a TIFF file", "a GeoTIFF"};
  std::uint32_t columns = 0, rows = 0;
  std::uint16_t samples = 1;
  SampleType type;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &columns);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &rows);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_BITSPERSAMPLE, &type.bits);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLEFORMAT, &type.format);
  if (static_cast<double>(columns) * rows > kLargestGrid)
    return Error{path, 0, "", std::to_string(columns) + " x " + std::to_string(rows) + " pixels",
                 "at most 400 million"};
  // Deflate packs a level plain into a thousandth; what claims more was damaged, and would only fill memory.
  if (static_cast<double>(columns) * rows * type.bits / 8.0 > 1e6 + 2000.0 * static_cast<double>(bytes.size()))
    return Error{path, 0, "",
                 std::to_string(columns) + " x " + std::to_string(rows) + " pixels in " + std::to_string(bytes.size()) +
                     " bytes",
                 "a whole GeoTIFF"};
  if (samples != 1 || !type.known() || columns == 0 || rows == 0)
    return Error{
        path, 0, "",
        std::to_string(columns) + " x " + std::to_string(rows) + " pixels of " + std::to_string(samples) + " samples",
        "one band of whole or floating-point numbers"};

  Elevation out;
  out.columns = static_cast<int>(columns);
  out.rows = static_cast<int>(rows);
  const auto scale = list<double>(tiff.get(), kPixelScale), tie = list<double>(tiff.get(), kTiepoint);
  const auto matrix = list<double>(tiff.get(), kTransformation);
  const auto keys = list<std::uint16_t>(tiff.get(), kGeoKeys);
  if (scale.size() >= 2 && tie.size() >= 6) {
    out.step_x = scale[0], out.step_y = scale[1];
    out.west = tie[3] - tie[0] * scale[0], out.north = tie[4] + tie[1] * scale[1];
  } else if (matrix.size() == 16 && matrix[1] == 0.0 && matrix[4] == 0.0) {
    out.step_x = matrix[0], out.step_y = -matrix[5];
    out.west = matrix[3], out.north = matrix[7];
  } else {
    return Error{path, 0, "", "no place, or a rotated one", "a GeoTIFF with pixel scale and tie point"};
  }
  if (!(out.step_x > 0.0 && out.step_y > 0.0))
    return Error{path, 0, "", "pixels of no size", "a GeoTIFF with north up"};
  if (geo_key(keys, kRasterType) != kPixelIsPoint) out.west += 0.5 * out.step_x, out.north -= 0.5 * out.step_y;
  const std::uint16_t projected = geo_key(keys, kProjectedCrs), geodetic = geo_key(keys, kGeodeticCrs),
                      vertical = geo_key(keys, kVerticalCrs);
  // A projection of the file's own making has no code: the user must state it.
  const std::uint16_t code = projected != 0 ? projected : geodetic;
  if (code != 0 && code != kUserDefined)
    out.frame.crs = "EPSG:" + std::to_string(code) +
                    (vertical != 0 && vertical != kUserDefined ? "+" + std::to_string(vertical) : "");

  out.height_m.assign(std::size_t{columns} * rows, std::nanf(""));
  if (!read_pixels(tiff.get(), type, out))
    return Error{path, 0, "", "the pixels cannot be unpacked", "a whole GeoTIFF"};
  char* no_data = nullptr;
  if (TIFFGetField(tiff.get(), kNoData, &no_data) == 1) {
    const auto hole = static_cast<float>(std::atof(no_data));
    for (float& h : out.height_m)
      if (h == hole) h = std::nanf("");
  }
  return out;
}

}  // namespace canyon::scene
