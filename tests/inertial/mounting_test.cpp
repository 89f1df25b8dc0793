#include "canyon/inertial/mounting.h"

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/inertial/motion/rigid_motion.h"
#include "canyon/inertial/true_increments.h"
#include "canyon/tests/inertial/smooth_path.h"

namespace canyon::inertial {
namespace {

using testing::SmoothPath;

const LocalFrame kMountedFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
const GpsTime kMountedStart = GpsTime::from_week_sow(1590, 0.0);

ImuConfig askew_by(double sigma_deg) {
  ImuConfig c;
  c.sensor = "ideal";
  c.lever_arm_m = {0.3, -0.2, 0.5};
  c.mounting_error_deg = sigma_deg;
  return c;
}

TEST(ImuMounting, IsParallelUnlessItIsAskedFor) {
  EXPECT_FALSE(mounting(askew_by(0.0), 1));
  EXPECT_EQ((*make_imu(askew_by(0.0), 1, kMountedFrame))->R_BU().coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

// Each of 3000 angles by itself: mean square to four sigma, false alarm 6e-5.
TEST(ImuMounting, AnglesHaveTheirSpread) {
  double sum = 0.0;
  constexpr int kUnits = 1000;
  for (int unit = 0; unit < kUnits; ++unit) {
    const auto R_BU = mounting(askew_by(0.5), static_cast<std::uint64_t>(unit));
    sum += (so3_log(*R_BU) / (0.5 * kDegree)).squaredNorm() / (3.0 * kUnits);
  }
  EXPECT_NEAR(sum, 1.0, 4.0 * std::sqrt(2.0 / (3.0 * kUnits)));
}

// A body of its own in the place of the unit, with its axes, feels the same: the kinematics are composed by power
// series (rigid_motion.h), rate and force are then those of a body's origin. Roundings of 9.8 m/s^2 over 10 ms.
TEST(ImuMounting, FeelsWhatABodyInItsPlaceFeels) {
  const ImuConfig config = askew_by(5.0);
  const auto imu = make_imu(config, 3, kMountedFrame);
  ASSERT_TRUE(imu.ok());
  KinematicState place;
  place.X_WB = {*mounting(config, 3), config.lever_arm_m};
  EXPECT_GT(so3_log(place.X_WB.R).norm(), 1.0 * kDegree);
  const SmoothPath path(kMountedStart);
  for (std::int64_t k = 0; k < 500; k += 7) {
    const std::vector<KinematicState> nodes = path.nodes(k, 100.0, 4);
    std::vector<KinematicState> own;
    for (const KinematicState& node : nodes) own.push_back(compose(node, place));
    const ImuSample found = (*imu)->sample(k, nodes),
                    expected = true_increments(own, kMountedFrame, Eigen::Vector3d::Zero());
    EXPECT_LT((found.dtheta_U - expected.dtheta_U).norm(), 1e-15) << k;
    EXPECT_LT((found.dv_U - expected.dv_U).norm(), 1e-14) << k;
  }
}

// The same for a log on a path of its own: of the IMU's own kinematics, by Boole's rule over 64 intervals of 10 ms,
// where a circle's rate and force are constant but for Earth's.
TEST(ImuMounting, IsThatOfASimulatedLogToo) {
  MotionConfig circle;
  circle.path = "circle";
  circle.radius_m = 50.0;
  circle.speed_m_s = 10.0;
  auto placed = make_motion(circle, 1);
  ASSERT_TRUE(placed.ok());
  placed->lever_arm_m = {0.3, -0.2, 0.5};
  placed->R_BU = mounting(askew_by(5.0), 3);
  std::vector<KinematicState> own;
  for (int i = 0; i <= 64; ++i) {
    own.push_back(placed->imu_at(2.0 + 0.01 * i / 64.0));
    own.back().t = placed->start + (2.0 + 0.01 * i / 64.0);
  }
  const ImuSample found = motion_increments(*placed, 2.0, 2.01),
                  expected = true_increments(own, placed->frame, Eigen::Vector3d::Zero());
  EXPECT_LT((found.dtheta_U - expected.dtheta_U).norm(), 2e-12);  // the tolerance of the quadrature, twice
  EXPECT_LT((found.dv_U - expected.dv_U).norm(), 2e-12);
}

}  // namespace
}  // namespace canyon::inertial
