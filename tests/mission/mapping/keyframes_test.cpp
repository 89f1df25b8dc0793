#include "canyon/mission/mapping/keyframes.h"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/scanner.h"
#include "canyon/tests/mission/memory_recorder.h"
#include "canyon/tests/mission/recorder/keyframe_columns.h"

namespace canyon::mission::testing {
namespace {

const GpsTime kFirstKeyframe = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

/// Answers one after the other, as an own method does: what the surfaces alone say, and what they leave open.
class AnsweringRegistration final : public lidar::Registration {
 public:
  explicit AnsweringRegistration(std::vector<lidar::RegistrationResult> answers) : answers_(std::move(answers)) {}
  std::shared_ptr<const lidar::PreparedCloud> prepare(std::span<const Eigen::Vector3f>) const override {
    return std::make_shared<lidar::PreparedCloud>();
  }
  lidar::RegistrationResult align(const lidar::PreparedCloud&, std::span<const Placed>, const Pose&) const override {
    return answers_.at(next_++);
  }

 private:
  std::vector<lidar::RegistrationResult> answers_;
  mutable std::size_t next_ = 0;
};

/// Of [turned; moved]: some 0.06 degrees and 2 cm, all six correlated.
Matrix6d correlated() {
  Matrix6d A;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j)
      A(i, j) = (i < 3 ? 1e-3 : 0.02) * (i == j ? 1.0 : 0.3 * double((i + 2 * j) % 3 - 1));
  const Matrix6d P = A * A.transpose();
  return 0.5 * (P + P.transpose());
}

constexpr int kSteps = 400;

/// A drive whose alignments err by what they say, their floor included, while every prediction is half a metre off and
/// claims 2 cm. The sensor stands askew and away from B.
struct AlignedDrive {
  MissionConfig config;
  Matrix6d said = correlated(), whole = said;  ///< without and with the floor
  std::vector<Vector6d> open{Vector6d::Unit(5), (Vector6d() << 0.0625, 0.0, 0.0, 0.0, 0.0, 0.0).finished()};
  MemoryRecorder recorder;

  AlignedDrive() {
    config.registration.method.name = "gicp";
    config.registration.motion_floor_m_s = config.registration.motion_floor_deg_s = 0.0;
    config.lidar.mount_m = {1.5, -0.4, 1.8};
    config.lidar.mount_yaw_pitch_roll_deg = {70.0, 10.0, -5.0};
    const double floor_rad = config.registration.alignment_floor_deg * kDegree,
                 floor_m = config.registration.alignment_floor_m;
    whole.diagonal().head<3>().array() += floor_rad * floor_rad;
    whole.diagonal().tail<3>().array() += floor_m * floor_m;
    drive();
  }

  Pose X_WB_true(int k) const {
    return {rotation_from({.yaw_rad = 0.2 * k, .pitch_rad = 0.05, .roll_rad = -0.03}), {3.0 * k, 0.4 * k, 0.1 * k}};
  }

  void drive() {
    const Pose X_BL = lidar::sensor_in_body(config.lidar);
    const Matrix6d root = whole.llt().matrixL();
    const RandomStream draws(1, "keyframes_test");
    std::vector<lidar::RegistrationResult> answers;
    for (int k = 1; k <= kSteps; ++k) {
      Vector6d z;
      for (Eigen::Index i = 0; i < 6; ++i) z[i] = draws.normal(std::uint32_t(i), std::uint64_t(k));
      const Pose X_LL_true = (X_WB_true(k - 1) * X_BL).inverse() * (X_WB_true(k) * X_BL);
      lidar::RegistrationResult& answer = answers.emplace_back();
      answer.status = lidar::RegistrationStatus::kConverged;
      answer.X_TS = X_LL_true * Pose::exp(root * z).inverse();
      answer.covariance = said;
      answer.surfaces = {.X_TS = answer.X_TS, .covariance = said};
      answer.open = open;
    }
    PartClock clock;
    const Boundaries boundaries(kFirstKeyframe);
    const ScoredMaps::Wanted no_maps{.by_filter = false, .registered = false};
    Keyframes keyframes(config, std::make_unique<AnsweringRegistration>(std::move(answers)), nullptr, no_maps,
                        boundaries, clock, recorder);
    for (int k = 0; k <= kSteps; ++k) {
      const auto scan = std::make_shared<LidarScan>();
      scan->t = kFirstKeyframe + double(k);
      scan->points.push_back({1, 0, 0, 0.5f, 0, 0, 0});
      NavEstimate estimate;
      estimate.t = scan->t;
      estimate.X_WB = X_WB_true(k);
      estimate.pose_covariance = 0.01 * Matrix6d::Identity();
      const Pose moved = X_WB_true(k - 1).inverse() * X_WB_true(k);
      const RelativePose motion{
          scan->t, scan->t, {moved.R, moved.p + Eigen::Vector3d(0.5, 0.0, 0.0)}, 4e-4 * Matrix6d::Identity()};
      ASSERT_TRUE(keyframes.take({scan, estimate, motion, X_WB_true(k), 3.0 * k}).ok());
    }
    ASSERT_TRUE(keyframes.complete().ok());
    ASSERT_EQ(recorder.keyframes.size(), std::size_t{kSteps + 1});
  }
};

// The sum over all steps is chi-square with 6 degrees of freedom each; both tails together: 1e-6 of false alarms. That
// the predictions are off is in the step, whose square it makes some 430, not in the alignment.
TEST(KeyframesTest, TheSquareOfTheAlignmentAloneIsThatOfItsCovariance) {
  const AlignedDrive aligned;
  double alone = 0.0;
  for (std::size_t k = 1; k <= kSteps; ++k) {
    auto of = keyframe_columns(aligned.recorder.keyframes[k]);
    alone += std::stod(of["align_nees"]);
    EXPECT_GT(std::stod(of["step_nees"]), chi_square_threshold(1e-6, 6.0)) << k;
  }
  const double tail = chi_square_tail(alone, 6.0 * kSteps);
  EXPECT_GT(tail, 0.5e-6) << alone / kSteps << " on average";
  EXPECT_LT(tail, 1.0 - 0.5e-6) << alone / kSteps << " on average";
}

TEST(KeyframesTest, WhatTheSurfacesSayComesToTheFile) {
  const AlignedDrive aligned;
  EXPECT_EQ(keyframe_columns(aligned.recorder.keyframes[0])["align_nees"], "") << "nothing to be aligned to";
  auto of = keyframe_columns(aligned.recorder.keyframes[1]);
  EXPECT_EQ(of["open_directions"], "2");
  EXPECT_EQ(of["open_vectors"], "0 0 0 0 0 1;0.0625 0 0 0 0 0");
  const std::vector<double> covariance = numbers_in(of["align_covariance"]);
  ASSERT_EQ(covariance.size(), 21U);
  std::size_t at = 0;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = i; j < 6; ++j) EXPECT_EQ(covariance[at++], aligned.whole(i, j)) << i << ", " << j;
}

}  // namespace
}  // namespace canyon::mission::testing
