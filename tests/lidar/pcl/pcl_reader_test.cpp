#include <cstring>

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include "canyon/core/files/files.h"
#include "canyon/core/files/pcd.h"
#include "canyon/core/random/random.h"
#include "canyon/lidar/files/cloud_files.h"
#include "canyon/lidar/files/clouds/read_cloud.h"
#include "canyon/lidar/files/scan_files.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::lidar {
namespace {

class PclReader : public ::testing::Test {
 protected:
  std::string path_ = canyon::testing::temporary_file("test.pcd");
};

TEST_F(PclReader, ReadsOurCloudToTheBit) {
  const RandomStream random(1, "test.cloud");
  std::vector<MapPoint> points(3000);
  std::vector<float> errors(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    points[i] = {.p_W = Eigen::Vector3d(random.normal3(i) * 300.0).cast<float>(),
                 .intensity = static_cast<float>(random.uniform(5, i))};
    errors[i] = static_cast<float>(random.uniform(6, i));
  }
  ASSERT_TRUE(write_pcd(path_, MapCloud(points), errors).ok());
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
    ASSERT_EQ(error_m, errors[i]);
  }
}

TEST_F(PclReader, WritesCompressedCloudsThatWeRead) {
  const RandomStream random(2, "test.cloud");
  pcl::PointCloud<pcl::PointXYZI> cloud;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    pcl::PointXYZI p;
    p.getVector3fMap() = (random.normal3(i) * 30.0).cast<float>();
    p.intensity = static_cast<float>(i % 7);
    cloud.push_back(p);
  }
  ASSERT_EQ(pcl::io::savePCDFileBinaryCompressed(path_, cloud), 0);
  const auto read = read_cloud(path_);
  ASSERT_TRUE(read.ok()) << read.error().str();
  ASSERT_EQ(read->points.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    ASSERT_EQ(read->points[i], Eigen::Vector3f(cloud[i].getVector3fMap()).cast<double>()) << i;
}

TEST_F(PclReader, WritesWhatWeRead) {
  pcl::PointCloud<pcl::PointXYZI> cloud;
  for (int i = 0; i < 100; ++i) {
    pcl::PointXYZI p;
    p.x = 0.1f * static_cast<float>(i), p.y = -p.x, p.z = 3.0f, p.intensity = 0.01f * static_cast<float>(i);
    cloud.push_back(p);
  }
  ASSERT_EQ(pcl::io::savePCDFileBinary(path_, cloud), 0);
  auto reader = PcdReader::open(path_);
  ASSERT_TRUE(reader.ok()) << reader.error().str();
  ASSERT_EQ(reader->points(), cloud.size());
  const auto bytes = reader->next();
  ASSERT_TRUE(bytes.ok());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto value = [&](const char* name) {
      float out = 0;
      std::memcpy(&out, bytes->data() + i * reader->point_bytes() + *reader->float_at(name), sizeof out);
      return out;
    };
    ASSERT_EQ(Eigen::Vector3f(value("x"), value("y"), value("z")), Eigen::Vector3f(cloud[i].getVector3fMap()));
    ASSERT_EQ(value("intensity"), cloud[i].intensity);
  }
}

/// A structured scan as PCD and as PLY, every field by name.
TEST_F(PclReader, ReadsOurScans) {
  std::vector<LidarPoint> points;
  const RandomStream random(2, "test.scan");
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Eigen::Vector3f p = Eigen::Vector3d(random.normal3(i) * 30.0).cast<float>();
    points.push_back({.x = p.x(),
                      .y = p.y(),
                      .z = p.z(),
                      .intensity = static_cast<float>(random.uniform(5, i)),
                      .time_s = -1e-4f * static_cast<float>(i),
                      .ring = static_cast<std::uint16_t>(i % 700),
                      .return_index = static_cast<std::uint8_t>(i % 3)});
  }
  for (const std::string format : {"pcd", "ply"}) {
    ASSERT_TRUE(write_text_file(path_, (*cloud_format(format, ""))->text(GpsTime{}, points)).ok());
    pcl::PCLPointCloud2 raw;
    ASSERT_EQ(format == "pcd" ? pcl::io::loadPCDFile(path_, raw) : pcl::io::loadPLYFile(path_, raw), 0);
    ASSERT_EQ(raw.width * raw.height, points.size());
    const auto bytes_of = [&](const std::string& name, std::size_t i) {
      for (const auto& field : raw.fields)
        if (field.name == name) return raw.data.data() + i * raw.point_step + field.offset;
      ADD_FAILURE() << "no field " << name;
      return raw.data.data();
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      const LidarPoint& p = points[i];
      const auto expect_float = [&](const char* name, float expected) {
        float value;
        std::memcpy(&value, bytes_of(name, i), 4);
        ASSERT_EQ(value, expected) << format << ' ' << name;
      };
      expect_float("x", p.x);
      expect_float("y", p.y);
      expect_float("z", p.z);
      expect_float("intensity", p.intensity);
      expect_float("time", p.time_s);
      std::uint16_t ring;
      std::memcpy(&ring, bytes_of("ring", i), 2);
      ASSERT_EQ(ring, p.ring) << format;
      ASSERT_EQ(*bytes_of("return", i), p.return_index) << format;
    }
  }
}

}  // namespace
}  // namespace canyon::lidar
