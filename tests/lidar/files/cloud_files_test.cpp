#include "canyon/lidar/files/cloud_files.h"

#include <cstring>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/files/pcd.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::lidar {
namespace {

TEST(CloudFiles, HoldAPointsPlaceIntensityAndError) {
  const std::string path = canyon::testing::temporary_file("test.pcd");
  const float values[2][5] = {{1, 2, 3, 0.25f, 0.01f}, {-4, 5, -6, 0.5f, 1.5f}};
  MapCloud points;
  for (const auto& v : values) points.push_back({.p_W = {v[0], v[1], v[2]}, .intensity = v[3]});
  const std::vector<float> errors{values[0][4], values[1][4]};
  ASSERT_TRUE(write_pcd(path, points, errors).ok());
  EXPECT_EQ(*read_text_file(path),
            pcd_header({{.name = "x"}, {.name = "y"}, {.name = "z"}, {.name = "intensity"}, {.name = "error"}}, 2) +
                std::string(reinterpret_cast<const char*>(values), sizeof values));
  EXPECT_FALSE(write_pcd("no_such_folder/cloud.pcd", points, errors).ok());
}

}  // namespace
}  // namespace canyon::lidar
