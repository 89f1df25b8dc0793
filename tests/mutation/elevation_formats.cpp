#include <numeric>

#include <tiffio.h>
#include <zlib.h>

#include "canyon/core/check.h"
#include "canyon/tests/mutation/deflated.h"
#include "canyon/tests/mutation/format.h"
#include "canyon/tests/report/synthetic_results.h"
#include "canyon/tests/report/temporary_directory.h"
#include "canyon/tests/scene/importers/tiff_text.h"

namespace canyon::testing {
namespace {

/// Buildings at 45 N, 5 E.
constexpr const char* kHillTown = R"({"type":"FeatureCollection","features":[{"type":"Feature",
"properties":{"id":"town hall","height":12.0},"geometry":{"type":"Polygon","coordinates":[
[[5.0,45.0],[5.0003,45.0],[5.0003,45.0002],[5.0,45.0002],[5.0,45.0]]]}}]})";
constexpr const char* kWgs84 =
    "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
    "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]";

std::vector<Companion> hill_town() {
  return {{"town.geojson", kHillTown}};
}

constexpr int kSide = 40;

std::string whole_geotiff() {
  std::vector<float> heights(kSide * kSide);
  for (int k = 0; k < kSide * kSide; ++k) heights[static_cast<std::size_t>(k)] = 200.0f + 0.1f * static_cast<float>(k);
  scene::testing::TiffText tiff(kSide, kSide, heights);
  tiff.place(4.999, 45.002, 1e-4, 4326);
  return tiff.text();
}

/// What geographic information systems write: packed, tiled, of whole numbers, in the other byte order.
std::string packed_geotiff(int compression, bool tiled, bool big_endian) {
  constexpr std::uint32_t kScale = 33550, kTiePoint = 33922, kKeys = 34735;
  static const TIFFFieldInfo kGeoTags[] = {
      {kScale, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("GeoPixelScale")},
      {kTiePoint, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("GeoTiePoints")},
      {kKeys, -1, -1, TIFF_SHORT, FIELD_CUSTOM, 1, 1, const_cast<char*>("GeoKeyDirectory")}};
  const TemporaryDirectory scratch;
  const std::string path = scratch.file("t.tif");
  TIFF* tiff = TIFFOpen(path.c_str(), big_endian ? "wb" : "wl");
  CANYON_CHECK(tiff != nullptr, "path = ", path);
  TIFFMergeFieldInfo(tiff, kGeoTags, 3);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kSide);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kSide);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_INT);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
  if (compression != COMPRESSION_PACKBITS) TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  const double scale[] = {1e-4, 1e-4, 0.0}, tie[] = {0, 0, 0, 4.999, 45.002, 0};
  const std::uint16_t keys[] = {1, 1, 0, 2, 1024, 0, 1, 2, 2048, 0, 1, 4326};
  TIFFSetField(tiff, kScale, 3, scale);
  TIFFSetField(tiff, kTiePoint, 6, tie);
  TIFFSetField(tiff, kKeys, 12, keys);
  if (tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
    std::vector<std::int16_t> tile(256);
    std::iota(tile.begin(), tile.end(), std::int16_t{200});
    for (std::uint32_t y = 0; y < kSide; y += 16)
      for (std::uint32_t x = 0; x < kSide; x += 16) TIFFWriteTile(tiff, tile.data(), x, y, 0, 0);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 8);
    std::vector<std::int16_t> row(kSide);
    for (std::uint32_t y = 0; y < kSide; ++y) {
      std::iota(row.begin(), row.end(), static_cast<std::int16_t>(200 + y));
      TIFFWriteScanline(tiff, row.data(), y, 0);
    }
  }
  TIFFClose(tiff);
  return load(path);
}

/// A tile of three arc-seconds, 45 to 46 N, 5 to 6 E.
std::string srtm_tile() {
  std::string out;
  out.reserve(2 * 1201 * 1201);
  for (int row = 0; row < 1201; ++row)
    for (int column = 0; column < 1201; ++column) {
      const int height = column == 7 && row == 7 ? -32768 : 200 + (row + column) % 50;
      out += static_cast<char>(height >> 8);
      out += static_cast<char>(height);
    }
  return out;
}

std::string little(std::size_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i));
  return out;
}

/// An archive of two members: a note, stored, and the tile, deflated.
std::string zip(const std::string& tile) {
  struct Member {
    std::string name, packed;
    std::size_t size;
    int method;
  };
  const std::vector<Member> members{{"readme.txt", "heights\n", 8, 0},
                                    {"N45E005.hgt", deflated(tile, -MAX_WBITS), tile.size(), 8}};
  std::string out, directory;
  for (const Member& m : members) {
    const std::string sizes = little(m.packed.size(), 4) + little(m.size, 4) + little(m.name.size(), 2);
    const std::string common = little(20, 2) + little(0, 2) + little(static_cast<std::size_t>(m.method), 2) +
                               little(0, 4) + little(0, 4) + sizes;
    directory += "PK\x01\x02" + little(20, 2) + common + little(0, 2) + little(0, 2) + little(0, 2) + little(0, 2) +
                 little(0, 4) + little(out.size(), 4) + m.name;
    out += "PK\x03\x04" + common + little(0, 2) + m.name + m.packed;
  }
  const std::size_t begin = out.size();
  return out + directory + "PK\x05\x06" + little(0, 4) + little(2, 2) + little(2, 2) + little(directory.size(), 4) +
         little(begin, 4) + little(0, 2);
}

std::string ascii_grid(double west, double south, double cell, double height_m) {
  std::string out = "ncols 40\nnrows 40\nxllcorner " + std::to_string(west) + "\nyllcorner " + std::to_string(south) +
                    "\ncellsize " + std::to_string(cell) + "\nNODATA_value -9999\n";
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) out += std::to_string(height_m - 0.5 * column).substr(0, 6) + " ";
    out += "\n";
  }
  return out;
}

Format of_terrain(const std::string& name, const std::string& file, const std::function<std::vector<Seed>()>& seeds,
                  const std::vector<Companion>& more = {}) {
  return {.name = name,
          .command = {"scene", "info", "town.geojson", "--undulation", "40", "--terrain", file},
          .read = {},
          .seeds = seeds,
          .beside = [more] {
            std::vector<Companion> out = hill_town();
            out.insert(out.end(), more.begin(), more.end());
            return out;
          }};
}

}  // namespace

std::vector<Format> elevation_formats() {
  const std::string grid = ascii_grid(4.999, 44.999, 0.0001, 205.0);
  return {of_terrain("GeoTiff", "@",
                     [] {
                       return std::vector<Seed>{{"t.tif", whole_geotiff()},
                                                {"t.tif", packed_geotiff(COMPRESSION_ADOBE_DEFLATE, true, false)},
                                                {"t.tif", packed_geotiff(COMPRESSION_LZW, false, true)},
                                                {"t.tif", packed_geotiff(COMPRESSION_PACKBITS, false, false)}};
                     }),
          of_terrain("Srtm", "@",
                     [] {
                       return std::vector<Seed>{{"N45E005.hgt", srtm_tile()}};
                     }),
          of_terrain("SrtmZip", "@",
                     [] {
                       return std::vector<Seed>{{"N45E005.hgt.zip", zip(srtm_tile())}};
                     }),
          of_terrain("SrtmGzip", "@",
                     [] {
                       return std::vector<Seed>{{"N45E005.hgt.gz", deflated(srtm_tile(), 16 + MAX_WBITS)}};
                     }),
          of_terrain("AsciiGrid", "@",
                     [grid] {
                       return std::vector<Seed>{{"level.asc", grid}};
                     },
                     {{"level.prj", kWgs84}}),
          of_terrain("Projection", "level.asc",
                     [] {
                       return std::vector<Seed>{{"level.prj", kWgs84}};
                     },
                     {{"level.asc", grid}})};
}

}  // namespace canyon::testing
