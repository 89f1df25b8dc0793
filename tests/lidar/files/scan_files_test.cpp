#include "canyon/lidar/files/scan_files.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "canyon/lidar/scanner.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

/// Little-endian numbers of a text, by a reader that knows nothing of the writer.
template <class T>
T number(const std::string& bytes, std::size_t at) {
  EXPECT_LE(at + sizeof(T), bytes.size());
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

std::vector<LidarPoint> points() {
  return {{.x = 1.5f, .y = -2.25f, .z = 0.125f, .intensity = 0.5f, .time_s = -0.05f, .ring = 3, .return_index = 0},
          {.x = 3.0f, .y = -4.5f, .z = 0.25f, .intensity = 1.0f, .time_s = -0.05f, .ring = 3, .return_index = 1},
          {.x = -100.0f, .y = 20.0f, .z = 7.0f, .intensity = 0.0f, .time_s = -0.04f, .ring = 300, .return_index = 0}};
}

std::string text_of(const std::string& name, const std::vector<LidarPoint>& p) {
  return (*cloud_format(name, "--format"))->text(GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.25), p);
}

/// Every field against the LAS specification 1.2 (ASPRS 2008), tables 1 and 5.
TEST(ScanFiles, LasAsItsSpecificationSays) {
  const auto cloud = points();
  const std::string b = text_of("las", cloud);
  ASSERT_EQ(b.size(), 227u + 3 * 28);
  EXPECT_EQ(b.substr(0, 4), "LASF");
  EXPECT_EQ(number<std::uint16_t>(b, 4), 0) << "file source";
  EXPECT_EQ(number<std::uint16_t>(b, 6), 1) << "adjusted standard GPS time";
  EXPECT_EQ(b.substr(8, 16), std::string(16, '\0')) << "project";
  EXPECT_EQ(b[24], 1);
  EXPECT_EQ(b[25], 2);
  EXPECT_EQ(std::string(b.c_str() + 26), "SIMULATION");
  EXPECT_EQ(std::string(b.c_str() + 58), "canyon");
  EXPECT_EQ(number<std::uint16_t>(b, 90), 182) << "day of the year";
  EXPECT_EQ(number<std::uint16_t>(b, 92), 2010);
  EXPECT_EQ(number<std::uint16_t>(b, 94), 227) << "header size";
  EXPECT_EQ(number<std::uint32_t>(b, 96), 227u) << "where the points are";
  EXPECT_EQ(number<std::uint32_t>(b, 100), 0u) << "variable records";
  EXPECT_EQ(b[104], 1) << "point format";
  EXPECT_EQ(number<std::uint16_t>(b, 105), 28);
  EXPECT_EQ(number<std::uint32_t>(b, 107), 3u);
  EXPECT_EQ(number<std::uint32_t>(b, 111), 2u) << "first returns";
  EXPECT_EQ(number<std::uint32_t>(b, 115), 1u) << "second returns";
  EXPECT_EQ(number<std::uint32_t>(b, 119), 0u);
  double scale[3], offset[3];
  for (int k = 0; k < 3; ++k) scale[k] = number<double>(b, 131 + 8 * k), offset[k] = number<double>(b, 155 + 8 * k);
  const double low[] = {-100, -4.5, 0.125}, high[] = {3, 20, 7};
  for (int k = 0; k < 3; ++k) {
    EXPECT_DOUBLE_EQ(number<double>(b, 179 + 16 * k), high[k]);
    EXPECT_DOUBLE_EQ(number<double>(b, 187 + 16 * k), low[k]);
  }
  const int numbers[] = {1, 2, 1}, counts[] = {2, 2, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t at = 227 + 28 * i;
    const float xyz[] = {cloud[i].x, cloud[i].y, cloud[i].z};
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(number<std::int32_t>(b, at + 4 * k) * scale[k] + offset[k], double{xyz[k]}, 0.5e-4 + 1e-9);
    EXPECT_NEAR(number<std::uint16_t>(b, at + 12) / 65535.0, double{cloud[i].intensity}, 0.5 / 65535);
    const auto returns = static_cast<unsigned char>(b[at + 14]);
    EXPECT_EQ(returns & 7, numbers[i]);
    EXPECT_EQ(returns >> 3 & 7, counts[i]);
    EXPECT_EQ(returns >> 6, 0);
    EXPECT_EQ(b[at + 15], 0);
    EXPECT_EQ(static_cast<unsigned char>(b[at + 17]), std::min<int>(cloud[i].ring, 255));
    const double stamp_s =
        static_cast<double>(GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.25).ns - 1'000'000'000'000'000'000) * 1e-9;
    EXPECT_NEAR(number<double>(b, at + 20), stamp_s + double{cloud[i].time_s}, 1e-7) << "of 4e8 s";
  }
}

TEST(ScanFiles, EmptyCloudsAreFilesToo) {
  const std::string las = text_of("las", {});
  ASSERT_EQ(las.size(), 227u);
  EXPECT_EQ(number<std::uint32_t>(las, 107), 0u);
  EXPECT_EQ(number<double>(las, 179), 0.0);
  EXPECT_NE(text_of("pcd", {}).find("POINTS 0\n"), std::string::npos);
  EXPECT_NE(text_of("ply", {}).find("element vertex 0\n"), std::string::npos);
}

TEST(ScanFiles, UnknownFormatsAreNamed) {
  EXPECT_EQ(cloud_format("laz", "--format").error().str(),
            "--format: unknown format \"laz\", expected one of pcd, ply, las");
}

TEST(ScanFiles, TruthGoesLineByLineWithThePoints) {
  const scene::Scene scene(testing::street_crossing());
  const scene::SceneAt at(scene);
  const std::vector<LidarPointTruth> truth{
      {.range_m = 12.34567f, .cos_incidence = 0.5f, .material = scene.mesh().material[0], .object = 0},
      {.range_m = 3.0f, .cos_incidence = 1.0f, .material = kNoMaterial, .object = kNoObject}};
  EXPECT_EQ(truth_csv(truth, at),
            "true_range_m,cos_incidence,material,object\n12.3457,0.50000,asphalt,terrain\n3.0000,1.00000,,\n");
}

}  // namespace
}  // namespace canyon::lidar
