#include "lidar/cloud_files.h"

#include <gtest/gtest.h>

#include "core/files.h"
#include "core/random.h"
#include "tests/support/temporary_folder.h"

namespace canyon::lidar {
namespace {

class CloudFiles : public ::testing::Test {
 protected:
  std::string path_ = canyon::testing::temporary_file("test.pcd");
  std::string error_of(const std::string& content) {
    EXPECT_TRUE(write_text_file(path_, content).ok());
    const auto cloud = read_pcd(path_);
    if (cloud.ok()) return "no error";
    const std::string text = cloud.error().str();
    return text.starts_with(path_) ? text.substr(path_.size()) : text;
  }
};

TEST_F(CloudFiles, WhatIsWrittenIsReadBackToTheBit) {
  const RandomStream random(1, "test.cloud");
  std::vector<MapPoint> points(1234);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    points[i] = {.p_W = Eigen::Vector3d(random.normal3(i) * 500.0).cast<float>(),
                 .intensity = static_cast<float>(random.uniform(7, i)),
                 .error_m = static_cast<float>(random.uniform(8, i))};
  }
  ASSERT_TRUE(write_pcd(path_, points).ok());
  const auto back = read_pcd(path_);
  ASSERT_TRUE(back.ok()) << back.error().str();
  ASSERT_EQ(back->size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ((*back)[i].p_W, points[i].p_W);
    EXPECT_EQ((*back)[i].intensity, points[i].intensity);
    EXPECT_EQ((*back)[i].error_m, points[i].error_m);
  }
}

TEST_F(CloudFiles, EmptyCloud) {
  ASSERT_TRUE(write_pcd(path_, {}).ok());
  const auto back = read_pcd(path_);
  ASSERT_TRUE(back.ok()) << back.error().str();
  EXPECT_TRUE(back->empty());
}

TEST_F(CloudFiles, OtherFieldsAndOrdersAreRead) {
  const float values[2][6] = {{9, 3, 1, 2, 0.5f, 7}, {9, 6, 4, 5, 0.25f, 7}};
  const std::string head =
      "VERSION 0.7\nFIELDS rgb z x y intensity normal\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\nWIDTH "
      "2\nHEIGHT 1\n"
      "POINTS 2\nDATA binary\n";
  ASSERT_TRUE(write_text_file(path_, head + std::string(reinterpret_cast<const char*>(values), sizeof values)).ok());
  const auto cloud = read_pcd(path_);
  ASSERT_TRUE(cloud.ok()) << cloud.error().str();
  EXPECT_EQ((*cloud)[1].p_W, Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ((*cloud)[0].intensity, 0.5f);
  EXPECT_EQ((*cloud)[0].error_m, 0.0f) << "absent fields are 0";
}

TEST_F(CloudFiles, MistakesAreNamed) {
  const std::string head = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  EXPECT_EQ(error_of(""), ":1: the header ends early, expected DATA binary");
  EXPECT_EQ(error_of(head), ":6: the header ends early, expected DATA binary");
  EXPECT_EQ(error_of(head + "DATA binary\n"), ":6: DATA: \"DATA binary\", expected POINTS N before it");
  EXPECT_EQ(error_of(head + "POINTS two\n"), ":6: POINTS: \"POINTS two\", expected POINTS N");
  EXPECT_EQ(error_of(head + "POINTS 2\nDATA ascii\n"), ":7: DATA: \"DATA ascii\", expected DATA binary");
  EXPECT_EQ(error_of(head + "POINTS 2\nDATA binary\n0123456789ab"), ": POINTS: data for 1 points only, expected 2");
  EXPECT_EQ(error_of(head + "POINTS 99999999999999999\nDATA binary\n"),
            ": POINTS: data for 0 points only, expected 99999999999999999");
  EXPECT_EQ(error_of("FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nPOINTS 0\nDATA binary\n"),
            ": z: no such field, expected x, y, z of type F and size 4");
  EXPECT_EQ(error_of("FIELDS x y z\nSIZE 4 -4 4\n"), ":2: SIZE: \"SIZE 4 -4 4\", expected positive whole numbers");
  EXPECT_EQ(error_of("FIELDS x y z\nSIZE 4 4\n"), ":2: SIZE: \"SIZE 4 4\", expected one value per field");
  EXPECT_FALSE(read_pcd("no_such_file.pcd").ok());
  EXPECT_FALSE(write_pcd("no_such_folder/cloud.pcd", {}).ok());
}

}  // namespace
}  // namespace canyon::lidar
