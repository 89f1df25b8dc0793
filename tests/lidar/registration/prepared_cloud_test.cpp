#include "canyon/lidar/registration/prepared_cloud.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/lidar/voxels/voxel_map.h"

namespace canyon::lidar {
namespace {

/// Points on the plane n . x = 3, spread over 16 m, with noise along n.
std::vector<Eigen::Vector3f> plane(const Eigen::Vector3d& normal, double sigma_m, std::uint32_t count,
                                   std::uint64_t seed = 1) {
  const RandomStream random(seed, "test.plane");
  const Eigen::Quaterniond R = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  std::vector<Eigen::Vector3f> points(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p(random.uniform(-8, 8, 0, i), random.uniform(-8, 8, 1, i),
                            3 + sigma_m * random.normal(2, i));
    points[i] = (R * p).cast<float>();
  }
  return points;
}

TEST(PreparedCloud, NormalsOfAPlaneTiltByTheStatedSigma) {
  const Eigen::Vector3d normal = Eigen::Vector3d(1, -2, 4).normalized();
  const PreparedCloud cloud = prepare_cloud(plane(normal, 0.02, 4000), 0.5);
  ASSERT_GT(cloud.points.size(), 700u);
  ASSERT_EQ(cloud.normals.size(), cloud.points.size());
  ASSERT_EQ(cloud.tilt_variance.size(), cloud.points.size());
  double tilt2 = 0, predicted2 = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    ASSERT_NEAR(cloud.normals[i].norm(), 1.0, 1e-6);
    const double cosine = std::abs(cloud.normals[i].cast<double>().dot(normal));
    tilt2 += 2 * (1 - cosine);  // over both directions of tilt
    predicted2 += cloud.tilt_variance[i];
  }
  // tilt_variance is that of the worse of two directions, so the sum over both lies between one and two times it;
  // normals of neighbouring points share most of their points, which leaves some 900 / 20 independent ones: 4.5
  // sqrt(1/45) = 0.67.
  EXPECT_GT(tilt2 / predicted2, 1.0 - 0.67);
  EXPECT_LT(tilt2 / predicted2, 2.0 + 2 * 0.67);
}

TEST(PreparedCloud, ALoneRingHasNoNormals) {
  // One laser on flat ground, 20 m around: every neighbourhood is a line.
  std::vector<Eigen::Vector3f> ring;
  for (int i = 0; i < 1800; ++i)
    ring.push_back(
        {20 * std::cos(0.0035f * static_cast<float>(i)), 20 * std::sin(0.0035f * static_cast<float>(i)), -1.8f});
  const PreparedCloud cloud = prepare_cloud(ring, 0.5);
  ASSERT_GT(cloud.points.size(), 100u);
  for (const auto& normal : cloud.normals) EXPECT_EQ(normal, Eigen::Vector3f::Zero());
}

TEST(PreparedCloud, IsolatedPointsHaveNoNormals) {
  const PreparedCloud cloud = prepare_cloud(std::vector<Eigen::Vector3f>{{1, 0, 0}, {50, 0, 0}, {0, 50, 0}}, 0.5);
  ASSERT_EQ(cloud.points.size(), 3u);
  for (const auto& normal : cloud.normals) EXPECT_EQ(normal, Eigen::Vector3f::Zero());
  EXPECT_TRUE(prepare_cloud({}, 0.5).points.empty());
}

TEST(PreparedCloud, MissingReturnsAreLeftOut) {
  auto points = plane(Eigen::Vector3d::UnitZ(), 0.02, 500);
  const PreparedCloud clean = prepare_cloud(points, 0.5);
  points.insert(points.begin() + 100, 50, Eigen::Vector3f::Zero());
  points.push_back({NAN, 0, 0});
  const PreparedCloud dirty = prepare_cloud(points, 0.5);
  ASSERT_EQ(dirty.points.size(), clean.points.size());
  for (std::size_t i = 0; i < clean.points.size(); ++i) EXPECT_EQ(dirty.points[i], clean.points[i]);
}

}  // namespace
}  // namespace canyon::lidar
