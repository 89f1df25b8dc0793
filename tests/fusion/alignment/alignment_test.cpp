#include "canyon/fusion/alignment/alignment.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/navigation_file.h"
#include "canyon/core/units.h"

namespace canyon::fusion {
namespace {

const Geodetic kPlace{45.0 * kDegree, 7.0 * kDegree, 200.0};

// A force and a heading are an attitude: that of any roll, pitch and heading comes back from what it feels.
TEST(Alignment, AnAttitudeFromForceAndHeading) {
  const Eigen::Vector3d p_E = ecef_from_geodetic(kPlace), up_force = -gravity_E(p_E);
  for (const double heading_deg : {0.0, 73.0, 180.0, 301.0})
    for (const double pitch_deg : {-30.0, 0.0, 12.0})
      for (const double roll_deg : {-40.0, 0.0, 25.0}) {
        const Eigen::Quaterniond R =
            attitude_from_ned(kPlace, roll_deg * kDegree, pitch_deg * kDegree, heading_deg * kDegree);
        const Eigen::Quaterniond found =
            attitude_from_force(p_E, R.conjugate() * up_force, up_force, heading_deg * kDegree);
        // Gravity is the ellipsoid's normal to 1e-5 rad at this height; of a steep nose the heading takes its tangent.
        EXPECT_LT(found.angularDistance(R), 2e-5) << heading_deg << " " << pitch_deg << " " << roll_deg;
      }
}

/// Fixes a second apart along a straight line north-east, 5 m/s and faster by 1 m/s^2, and what a level unit feels.
struct Straight {
  std::vector<GnssFix> fixes;
  std::vector<ImuSample> imu;
  ModelParameters own;

  explicit Straight(bool velocities) {
    const GpsTime start = GpsTime::from_week_sow(2200, 0.0);
    const Eigen::Matrix3d R = rotation_E_from_enu(kPlace);
    const Eigen::Vector3d course = Eigen::Vector3d(1.0, 1.0, 0.0).normalized();
    const Eigen::Quaterniond level = attitude_from_ned(kPlace, 0.0, 0.0, 45.0 * kDegree);
    const Eigen::Vector3d origin = ecef_from_geodetic(kPlace);
    for (int k = 0; k <= 10; ++k) {
      GnssFix fix;
      fix.t = start + k;
      fix.status = FixStatus::kSingle;
      fix.p_A_E = origin + R * course * (5.0 * k + 0.5 * k * k) + level * Eigen::Vector3d(0.0, 0.0, 1.0);
      fix.covariance_E = 1e-4 * Eigen::Matrix3d::Identity();
      if (velocities) {
        fix.v_A_E = R * course * (5.0 + k);
        fix.velocity_covariance_E = 1e-4 * Eigen::Matrix3d::Identity();
      }
      fixes.push_back(fix);
    }
    const Eigen::Vector3d force = level.conjugate() * (R * course - gravity_E(origin));
    for (int k = 1; k <= 1000; ++k)
      imu.push_back({.t = start + 0.01 * k, .dt_s = 0.01, .dtheta_U = Eigen::Vector3d::Zero(), .dv_U = 0.01 * force});
    in_motion_parameters(own);
  }
  Result<Aligned> align() const {
    return align_in_motion(own, {.imu = imu, .fixes = fixes, .noise = {}, .lever_A_B = {0.0, 0.0, 1.0}});
  }
};

TEST(Alignment, InMotionOnAStraight) {
  for (const bool velocities : {true, false}) {
    const Straight drive(velocities);
    const auto aligned = drive.align();
    ASSERT_TRUE(aligned.ok()) << aligned.error().str();
    const NedAttitude a = ned_attitude(geodetic_from_ecef(aligned->nav.p_EU_E), aligned->nav.R_EU);
    // Level, but for what 50 m of the Earth's curvature are (1e-5 rad), and along the course.
    EXPECT_NEAR(a.roll_rad, 0.0, 2e-5);
    EXPECT_NEAR(a.pitch_rad, 0.0, 2e-5);
    EXPECT_NEAR(a.heading_rad, 45.0 * kDegree, 2e-5);
    const double t_s = aligned->nav.t - drive.fixes.front().t;
    EXPECT_NEAR(aligned->nav.v_EU_E.norm(), 5.0 + t_s, 1e-3);
    const Eigen::Vector3d at = drive.fixes[static_cast<std::size_t>(t_s)].p_A_E;
    EXPECT_NEAR((aligned->nav.p_EU_E - at).norm(), 1.0, 1e-6);  // the antenna's lever
    EXPECT_GT(aligned->heading_rad, 1.9 * kDegree);
    EXPECT_LT(aligned->heading_rad, 2.2 * kDegree);
  }
}

TEST(Alignment, InMotionNeedsSpeedAndSamples) {
  Straight slow(true);
  for (GnssFix& fix : slow.fixes) fix.v_A_E *= 0.1;
  EXPECT_EQ(
      slow.align().error().str(),
      "start.in_motion_speed_m_s: the fixes within the log never move faster than 1.50 m/s, expected a lower limit, or "
      "another row of start.from");
  Straight empty(true);
  empty.imu.resize(1);
  EXPECT_FALSE(empty.align().ok());
}

}  // namespace
}  // namespace canyon::fusion
