#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>

#include "canyon/core/units.h"
#include "canyon/scene/import.h"
#include "canyon/scene/inspect.h"
#include "canyon/scene/scene.h"
#include "canyon/tests/support/outside_program.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::scene {
namespace {

ImportedScene import(const ImportConfig& config) {
  auto made = import_scene(config, {});
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().str());
  if (!made.ok()) return {};
  for (const std::string& warning : made->report.warnings) std::printf("  %s\n", warning.c_str());
  return *std::move(made);
}

double height_sum_m(const SceneParts& parts) {
  double sum = 0.0;
  for (const Building& b : parts.buildings) sum += b.height_m;
  return sum;
}

/// Counted with a few lines of python that know nothing of Canyon (json and xml modules only): features or city
/// objects, and the sum of their heights: the height property, 3 m per storey or 9 m where it is unknown; of solids
/// highest minus lowest vertex. Heights are rounded to 1e-3 m in the files, coordinates of W in single precision to
/// 3e-5 m.
void expect_counts(const SceneParts& parts, std::size_t buildings, double sum_m) {
  EXPECT_EQ(parts.buildings.size(), buildings);
  EXPECT_NEAR(height_sum_m(parts), sum_m, 1e-3 * sum_m);
}

TEST(ImportRealScenes, Shibuya) {
  CANYON_REAL_DATA(buildings, "scenes/shibuya/shibuya_buildings_lod1_epsg6668.geojson");
  CANYON_REAL_DATA(bridges, "scenes/shibuya/shibuya_bridges_lod2_epsg6668.geojson");
  ImportConfig config;
  config.file = buildings;
  config.more_files = {bridges};
  config.undulation_m = 36.7;
  const ImportedScene made = import(config);
  expect_counts(made.parts, 802, 15707.6);
  const Scene scene(made.parts);
  const auto& origin = scene.frame().origin();
  EXPECT_NEAR(origin.lat_rad / kDegree, 35.65905, 1e-3);
  EXPECT_NEAR(origin.lon_rad / kDegree, 139.70063, 1e-3);
  EXPECT_EQ(made.report.undulation_source, "stated");
  // 28 viaducts beside the buildings and the terrain.
  EXPECT_EQ(scene.objects().size(), 1u + 802u + 28u);
  EXPECT_GT(scene.streets().edges.size(), 100u);
}

TEST(ImportRealScenes, LyonIsTheSameFromBothCoordinateSystems) {
  CANYON_REAL_DATA(wgs84, "scenes/lyon1/lyon1_buildings_wgs84.geojson");
  CANYON_REAL_DATA(cc46, "scenes/lyon1/buildings_lyon1_epsg3946.geojson.gz");
  ImportConfig config;
  config.undulation_m = 50.0;
  config.streets = StreetSource::kFile;
  config.center_deg = {45.76983, 4.82597};
  config.file = wgs84;
  const ImportedScene one = import(config);
  expect_counts(one.parts, 2576, 51764.3);
  config.file = cc46;
  const ImportedScene two = import(config);
  expect_counts(two.parts, 2576, 51764.3);
  // Corner by corner: the copy in degrees is rounded to 1e-7, 8 mm along a meridian, 11 mm in all; RGF93 is taken for
  // WGS84 by both.
  ASSERT_EQ(one.parts.buildings.size(), two.parts.buildings.size());
  std::size_t corners = 0;
  for (std::size_t i = 0; i < one.parts.buildings.size(); ++i) {
    const auto &a = one.parts.buildings[i].footprint_W, &b = two.parts.buildings[i].footprint_W;
    if (a.size() != b.size()) continue;
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_LT((a[k] - b[k]).norm(), 0.02) << i;
      ++corners;
    }
  }
  EXPECT_GT(corners, 10000u);
  // Walls and roofs by BD TOPO's codes.
  std::size_t brick = 0;
  for (const std::uint16_t m : one.parts.mesh.material) brick += one.parts.materials[m].name == "brick";
  EXPECT_GT(brick, 1000u);
}

TEST(ImportRealScenes, CityJsonDelft) {
  CANYON_REAL_DATA(path, "scenes/delft/delft.city.json");
  ImportConfig config;
  config.file = path;
  config.undulation_m = 43.5;
  const ImportedScene made = import(config);
  expect_counts(made.parts, 160, 521.07);
  EXPECT_EQ(made.report.vertical, "NAP height");
  EXPECT_EQ(made.report.ground, "surfaces of the file");
  // The file's 160 solids have no bottoms (1601 open edges, all at their lowest height); 54 objects more are sheets,
  // and 3 bridges. Walls down into the ground and floors there close every solid; 21 of the others lie in the ground.
  const Soundness sound = soundness(Scene(made.parts));
  EXPECT_EQ(sound.objects, 160u + 54u + 3u);
  // Corners of the others stand on the border of the terrain; which of them find ground there is decided by the last
  // bit of the projection, which differs between processors (181 on some, 182 on others).
  EXPECT_NEAR(static_cast<double>(sound.watertight), 160.0 + 21.0, 1.0);
  const auto& origin = made.parts.frame.origin();
  EXPECT_NEAR(origin.lat_rad / kDegree, 52.01221, 1e-3);
  EXPECT_NEAR(origin.lon_rad / kDegree, 4.36580, 1e-3);
}

TEST(ImportRealScenes, CityJsonZurich) {
  CANYON_REAL_DATA(path, "scenes/zurich/zurich_subset_lod2.city.json.gz");
  ImportConfig config;
  config.file = path;
  config.undulation_m = 47.0;
  config.streets = StreetSource::kFile;
  config.ground_cell_m = 50.0;  // 49 buildings over 9 x 11 km
  const ImportedScene made = import(config);
  expect_counts(made.parts, 49, 808.694);
}

TEST(ImportRealScenes, CityGmlOfPlateau) {
  CANYON_REAL_DATA(path, "scenes/citygml/53392642_bldg_6697_op2.gml");
  ImportConfig config;
  config.file = path;
  config.undulation_m = 36.7;
  const ImportedScene made = import(config);
  expect_counts(made.parts, 8, 53.603);
  const auto& origin = made.parts.frame.origin();
  EXPECT_NEAR(origin.lat_rad / kDegree, 35.540, 2e-3);
  EXPECT_NEAR(origin.lon_rad / kDegree, 139.777, 2e-3);
}

TEST(ImportRealScenes, EtoileFromMitsuba) {
  CANYON_REAL_DATA(archive, "scenes/etoile/etoile_sionna.tar.gz");
  const canyon::testing::ScratchDirectory scratch;
  ASSERT_EQ(std::system(("tar xzf '" + archive + "' -C '" + scratch.file("") + "'").c_str()), 0);
  ImportConfig config;
  config.file = scratch.file("etoile/etoile.xml");
  const ImportedScene made = import(config);
  expect_counts(made.parts, 280, 4896.935);
  // As in the files: the lowest parts stand on the plane, and what ends higher rests on these.
  EXPECT_EQ(made.parts.mesh.triangles.size(), 13058u);
  std::map<std::string, std::size_t> used;
  for (const std::uint16_t m : made.parts.mesh.material) ++used[made.parts.materials[m].name];
  EXPECT_EQ(used.size(), 4u);
  for (const char* name : {"marble", "metal", "wood", "concrete"}) EXPECT_GT(used[name], 0u) << name;
}

TEST(ImportRealScenes, MonacoFromOpenStreetMap) {
  CANYON_REAL_DATA(path, "scenes/monaco/monaco.osm.gz");
  CANYON_REAL_DATA(terrain, "scenes/dem/N43E007.hgt.zip");
  ImportConfig config;
  config.file = path;
  config.terrain = terrain;
  config.undulation_m = 48.0;
  const ImportedScene made = import(config);
  expect_counts(made.parts, 966, 9.0 * 966);
  EXPECT_EQ(made.parts.foliage.size(), 208u);  // nodes with natural=tree
  EXPECT_EQ(made.report.streets, "of the file");
  EXPECT_EQ(made.report.ground, "N43E007.hgt.zip");
  const Scene scene(made.parts);
  // From the sea up the slope of the Tete de Chien.
  EXPECT_GT(scene.extent().max.z() - scene.extent().min.z(), 150.0);
}

}  // namespace
}  // namespace canyon::scene
