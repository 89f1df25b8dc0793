#include "canyon/scene/elevation/elevation.h"

#include <cstdio>
#include <cstring>
#include <numeric>

#include "canyon/scene/projection.h"
#include "canyon/tests/scene/importers/import_fixture.h"
#include "canyon/tests/scene/importers/tiff_text.h"
#include "canyon/tests/support/test_data.h"

/// Elevation models: what stands in them, where, and what happens to those that are damaged.
namespace canyon::scene::testing {
namespace {

class ElevationFiles : public Import {
 protected:
  std::string told(const std::string& name, const std::string& text) {
    const auto made = read_elevation(write(name, text));
    EXPECT_FALSE(made.ok());
    return made.ok() ? "" : made.error().str().substr(scratch_.file("").size());
  }
};

TEST_F(ElevationFiles, GeoTiffOfKnownContent) {
  TiffText tiff(3, 2, {1, 2, 3, 4, 5, -9999});
  tiff.place(500000, 5000100, 50, 32632);
  const auto made = read_elevation(write("t.tif", tiff.text()));
  ASSERT_TRUE(made.ok()) << made.error().str();
  EXPECT_EQ(made->frame.crs, "EPSG:32632");
  EXPECT_EQ(made->columns, 3);
  EXPECT_EQ(made->rows, 2);
  // Samples stand in the middle of their pixels.
  EXPECT_EQ(made->height({500025, 5000075}), 1.0);
  EXPECT_EQ(made->height({500075, 5000025}), 5.0);
  EXPECT_EQ(made->height({500050, 5000050}), 3.0);
  EXPECT_EQ(made->height({500000, 5000075}), std::nullopt);
}

TEST_F(ElevationFiles, AProjectionOfTheFilesOwnMustBeStated) {
  TiffText tiff(40, 40, std::vector<float>(1600, 321.0f));
  tiff.place(4.999, 45.001, 1e-4, 32767);
  config_.terrain = write("t.tif", tiff.text());
  EXPECT_EQ(message("town.geojson", kFootprint),
            "t.tif: crs: does not say its coordinate system, expected a GeoTIFF that does, a .prj beside it, or "
            "scene.crs");
}

TEST_F(ElevationFiles, DamagedAndOtherGeoTiffsAreTold) {
  TiffText tiff(100, 100, std::vector<float>(10000, 5.0f));
  tiff.place(500000, 5000100, 50, 32632);
  const std::string whole = tiff.text();
  EXPECT_EQ(told("t.tif", ""), "t.tif: not a TIFF file, expected a GeoTIFF");
  EXPECT_EQ(told("t.tif", whole.substr(0, 20000)),
            "t.tif: not a TIFF file, expected a GeoTIFF");  // its directory is last
  TiffText colour(4, 4, std::vector<float>(48, 1.0f));
  colour.place(0, 0, 1, 4326);
  colour.add(277, 3);
  EXPECT_EQ(told("t.tif", colour.text()),
            "t.tif: 4 x 4 pixels of 3 samples, expected one band of whole or floating-point numbers");
  TiffText nowhere(4, 4, std::vector<float>(16, 1.0f));
  EXPECT_EQ(told("t.tif", nowhere.text()),
            "t.tif: no place, or a rotated one, expected a GeoTIFF with pixel scale and tie point");
  TiffText huge(100000, 100000, {1.0f});
  huge.place(0, 0, 1, 4326);
  EXPECT_EQ(told("t.tif", huge.text()), "t.tif: 100000 x 100000 pixels, expected at most 400 million");
  TiffText cut(100, 100, std::vector<float>(50, 1.0f));  // pixels of half a row
  cut.place(0, 0, 1, 4326);
  EXPECT_EQ(told("t.tif", cut.text()), "t.tif: the pixels cannot be unpacked, expected a whole GeoTIFF");
}

TEST_F(ElevationFiles, GridsWithoutAPlaceAreTold) {
  EXPECT_EQ(told("t.asc", "ncols 2\nnrows 1\ncellsize 1\nyllcorner 0\n1 2\n"),
            "t.asc:5: the header has no xllcorner, expected ncols, nrows, xllcorner, yllcorner, cellsize");
}

TEST_F(ElevationFiles, OrthometricTerrainUnderAMeshInLocalMetres) {
  std::string grid = "ncols 40\nnrows 40\nxllcorner 4.998\nyllcorner 44.998\ncellsize 0.0001\n";
  for (int k = 0; k < 1600; ++k) grid += "60 ";
  config_.terrain = write("level.asc", grid);
  config_.crs = "";
  write("level.prj",
        "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
        "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]");
  // W's origin is stated 100 m above the ellipsoid; the terrain lies at 60 + 40 m.
  const SceneParts made = parts("hut.obj", "v 0 0 0\nv 4 0 0\nv 4 3 3\no hut\nf 1 2 3\n");
  EXPECT_EQ(made.undulation_m, 40.0);
  const Scene scene(made);
  ASSERT_TRUE(scene.ground(0, 0).has_value());
  EXPECT_NEAR(scene.ground(0, 0)->height_m, 0.0, 1e-3);
}

// Read with forty lines of python that know the TIFF format but neither libtiff, PROJ nor Canyon: all 742,233 samples
// (least, greatest, mean) and single ones; their places by Krueger's series of the transverse Mercator projection.
TEST(ElevationRealFiles, HeidelbergGeoTiff) {
  CANYON_REAL_DATA(path, "scenes/dem/dem_hd.tif");
  const auto made = read_elevation(path);
  ASSERT_TRUE(made.ok()) << made.error().str();
  EXPECT_EQ(made->frame.crs, "EPSG:32632");
  EXPECT_EQ(made->columns, 1041);
  EXPECT_EQ(made->rows, 713);
  const auto [low, high] = std::minmax_element(made->height_m.begin(), made->height_m.end());
  EXPECT_EQ(*low, 34.0f);
  EXPECT_EQ(*high, 581.0f);
  const double sum = std::accumulate(made->height_m.begin(), made->height_m.end(), 0.0);
  EXPECT_NEAR(sum / static_cast<double>(made->height_m.size()), 212.72068132556032, 1e-9);
  EXPECT_NEAR(made->west, 465335.1258291361, 1e-6);
  EXPECT_NEAR(made->north, 5482787.89029574, 1e-6);

  const auto projection = Projection::make(made->frame, path, "crs");
  ASSERT_TRUE(projection.ok()) << projection.error().str();
  struct Sample {
    double lat_deg, lon_deg, height_m;
  };
  for (const Sample& s : {Sample{49.429859212066624, 8.694323826066855, 173.00001525878906},
                          Sample{49.38497081454724, 8.729048554750289, 499.0000305175781},
                          Sample{49.427619568755205, 8.697785343477717, 235.0}}) {
    const auto p = projection->from_geodetic({s.lat_deg * kDegree, s.lon_deg * kDegree, 0.0});
    ASSERT_TRUE(p.has_value());
    const auto height = made->height(*p);
    ASSERT_TRUE(height.has_value());
    EXPECT_NEAR(*height, s.height_m, 1e-3);  // slopes of up to 1 times a disagreement of the projections below 1 mm
  }
}

/// The ground of a scene on that terrain: a house on the Koenigstuhl.
TEST_F(ElevationFiles, GroundFromTheHeidelbergGeoTiff) {
  CANYON_REAL_DATA(path, "scenes/dem/dem_hd.tif");
  config_.terrain = path;
  config_.undulation_m = 48.0;
  config_.center_deg = {49.38497081454724, 8.729048554750289};
  const SceneParts made = parts(
      "house.geojson",
      R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"height":6},"geometry":{"type":"Polygon",
"coordinates":[[[8.7290,49.3849],[8.7291,49.3849],[8.7291,49.3850],[8.7290,49.3850],[8.7290,49.3849]]]}}]})");
  EXPECT_EQ(made.frame.origin().h_m, 499.0 + 48.0);
  const Scene scene(made);
  // The terrain's own grid is 5 m wide over samples 25 m apart: between its corners it may be off by an eighth of the
  // change of slope (here below 0.4) times 5 m.
  EXPECT_NEAR(scene.ground(0, 0)->height_m, 0.0, 5.0 * 0.4 / 8 + 1e-3);
}

}  // namespace
}  // namespace canyon::scene::testing
