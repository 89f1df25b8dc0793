#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>

#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

using testing::pose_at;

pcl::PointCloud<pcl::PointXYZ>::Ptr pcl_cloud(const std::vector<Eigen::Vector3f>& points) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const Eigen::Vector3f& p : points) cloud->push_back(pcl::PointXYZ(p.x(), p.y(), p.z()));
  return cloud;
}

/// Ours changes PCL's solver, search and normals; on a well-constrained scene it must still find what PCL finds.
TEST(PclGicp, UnchangedPclFindsTheSamePose) {
  const scene::Scene scene(testing::street_crossing());
  LidarConfig lidar;
  lidar.mount_m.setZero();
  const auto scanner = *make_scanner(lidar, 3);
  const auto view = [&](const Pose& X_WL, std::int64_t index) {
    return testing::positions(
        scanner->scan(index, testing::kStart, testing::standing(X_WL), scene::SceneAt(scene)).scan);
  };
  const Pose X_WT = pose_at(-1, 0.5, 1.8, 3), X_WS = pose_at(0.5, -0.2, 1.8, 6);
  RegistrationConfig config;
  const auto registration = *make_registration(config);
  const auto target = registration->prepare(view(X_WT, 0));
  const auto source = registration->prepare(view(X_WS, 1));
  const Pose truth = X_WT.inverse() * X_WS;
  Vector6d off;
  off << 0.005, -0.005, 0.02, 0.2, -0.2, 0.1;
  const Pose guess = truth * Pose::exp(off);
  const Registration::Placed placed{target, Pose{}};
  const RegistrationResult ours = registration->align(*source, std::span(&placed, 1), guess);
  ASSERT_EQ(ours.status, RegistrationStatus::kConverged);

  pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ, double> gicp;
  gicp.setInputSource(pcl_cloud(source->points));
  gicp.setInputTarget(pcl_cloud(target->points));
  gicp.setMaxCorrespondenceDistance(config.method.own.get<MatchingParameters>().max_correspondence_m);
  gicp.setMaximumIterations(50);
  gicp.setTransformationEpsilon(1e-5);
  gicp.setRotationEpsilon(1e-6);
  gicp.setTranslationGradientTolerance(1e-4);
  gicp.setRotationGradientTolerance(1e-4);
  pcl::PointCloud<pcl::PointXYZ> aligned;
  gicp.align(aligned, guess.matrix());
  const Pose theirs = Pose::from_matrix(gicp.getFinalTransformation());

  const Vector6d between = (ours.X_TS.inverse() * theirs).log();
  const Vector6d their_error = (truth.inverse() * theirs).log();
  const Vector6d our_error = (truth.inverse() * ours.X_TS).log();
  RecordProperty("their_error_mm", std::to_string(their_error.tail<3>().norm() * 1e3));
  RecordProperty("our_error_mm", std::to_string(our_error.tail<3>().norm() * 1e3));
  // Both within the accuracy asked of a registration: a centimetre and a tenth of a degree.
  EXPECT_LT(between.tail<3>().norm(), 0.01)
      << "theirs " << their_error.transpose() << ", ours " << our_error.transpose();
  EXPECT_LT(between.head<3>().norm(), 0.1 * kDegree)
      << "theirs " << their_error.transpose() << ", ours " << our_error.transpose();
}

}  // namespace
}  // namespace canyon::lidar
