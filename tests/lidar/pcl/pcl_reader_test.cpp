#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include "core/random.h"
#include "lidar/cloud_files.h"

namespace canyon::lidar {
namespace {

class PclReader : public ::testing::Test {
 protected:
  std::string path_ = (std::filesystem::temp_directory_path() / "canyon_pcl_reader_test.pcd").string();
  void TearDown() override { std::filesystem::remove(path_); }
};

TEST_F(PclReader, ReadsOurCloudToTheBit) {
  const RandomStream random(1, "test.cloud");
  std::vector<MapPoint> points(3000);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    points[i] = {.p_W = Eigen::Vector3d(random.normal3(i) * 300.0).cast<float>(),
                 .intensity = static_cast<float>(random.uniform(5, i)),
                 .error_m = static_cast<float>(random.uniform(6, i))};
  }
  ASSERT_TRUE(write_pcd(path_, points).ok());
  pcl::PointCloud<pcl::PointXYZI> cloud;
  ASSERT_EQ(pcl::io::loadPCDFile(path_, cloud), 0);
  ASSERT_EQ(cloud.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(Eigen::Vector3f(cloud[i].getVector3fMap()), points[i].p_W);
    ASSERT_EQ(cloud[i].intensity, points[i].intensity);
  }
  // The error column is a field of ours; PCL keeps it when asked for the raw cloud.
  pcl::PCLPointCloud2 raw;
  ASSERT_EQ(pcl::io::loadPCDFile(path_, raw), 0);
  ASSERT_EQ(raw.fields.size(), 5u);
  ASSERT_EQ(raw.fields[4].name, "error");
  for (std::size_t i = 0; i < points.size(); ++i) {
    float error_m = 0;
    std::memcpy(&error_m, raw.data.data() + i * raw.point_step + raw.fields[4].offset, 4);
    ASSERT_EQ(error_m, points[i].error_m);
  }
}

TEST_F(PclReader, WritesWhatWeRead) {
  pcl::PointCloud<pcl::PointXYZI> cloud;
  for (int i = 0; i < 100; ++i) {
    pcl::PointXYZI p;
    p.x = 0.1f * static_cast<float>(i), p.y = -p.x, p.z = 3.0f, p.intensity = 0.01f * static_cast<float>(i);
    cloud.push_back(p);
  }
  ASSERT_EQ(pcl::io::savePCDFileBinary(path_, cloud), 0);
  const auto points = read_pcd(path_);
  ASSERT_TRUE(points.ok()) << points.error().str();
  ASSERT_EQ(points->size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_EQ((*points)[i].p_W, Eigen::Vector3f(cloud[i].getVector3fMap()));
    EXPECT_EQ((*points)[i].intensity, cloud[i].intensity);
  }
}

}  // namespace
}  // namespace canyon::lidar
