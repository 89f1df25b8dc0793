#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/autonomy/self_check/planar_match.h"

namespace canyon::mission {
namespace {

/// A street of 12 m between walls with a pillar every 6 m, as points seen from a pose, within 28 m.
PlanarPoints street_from(const PlanPose& at, bool pillars) {
  PlanarPoints points;
  const auto add = [&](double x, double y) {
    const Eigen::Vector2d p = Eigen::Rotation2Dd(-at.yaw_rad) * (Eigen::Vector2d(x, y) - at.p_m);
    if (p.norm() < 28.0) points.push_back(p);
  };
  for (double x = -60.0; x < 320.0; x += 0.2) {
    add(x, 6.0);
    add(x, -6.0);
  }
  for (double x = -60.0; pillars && x < 320.0; x += 6.0) {
    for (double y = 0.0; y < 1.6; y += 0.2) {
      add(x, 6.0 - y);
      add(x + 2.0, -6.0 + y);
    }
  }
  return points;
}

PlanarMotion guess(const PlanPose& pose, double sigma_m) {
  PlanarMotion motion{pose, Eigen::Matrix3d::Zero()};
  motion.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, std::pow(1.0 * kDegree, 2);
  return motion;
}

TEST(WallPieces, FindTheMotionBetweenTwoScans) {
  const PlanPose then{{3.0, 0.4}, 0.05}, moved{{1.4, 0.1}, 0.02};
  const WallPieces walls(street_from(then, true));
  const Eigen::Rotation2Dd R(then.yaw_rad);
  const PlanPose now{then.p_m + R * moved.p_m, then.yaw_rad + moved.yaw_rad};
  const PlanarMotion found = walls.match(street_from(now, true), guess({{1.2, 0.0}, 0.0}, 0.5));
  EXPECT_NEAR((found.pose.p_m - moved.p_m).norm(), 0.0, 0.05) << "a quarter of the points' spacing";
  EXPECT_NEAR(found.pose.yaw_rad, moved.yaw_rad, 0.05 / 15.0);
  EXPECT_LT(std::sqrt(found.covariance(0, 0)), 0.1);
}

TEST(WallPieces, AlongBareWallsKeepToWhatWasKnown) {
  const PlanPose then{{3.0, 0.4}, 0.0}, now{{4.4, 0.6}, 0.0};
  const WallPieces walls(street_from(then, false));
  const PlanarMotion found = walls.match(street_from(now, false), guess({{1.1, 0.0}, 0.0}, 0.5));
  EXPECT_NEAR(found.pose.p_m.y(), 0.2, 0.03);
  EXPECT_NEAR(found.pose.p_m.x(), 1.1, 0.02);
  EXPECT_NEAR(std::sqrt(found.covariance(0, 0)), 0.5, 0.02);
}

const GpsTime kCheckStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

/// A drive up that street at 4 m/s as an own-motion check lives it; `off` says how far the estimate is off at a time.
class CheckedDrive {
 public:
  explicit CheckedDrive(bool wheel) : wheel_(wheel) {
    const ReferenceParameters defaults;
    check_ = model_row(self_checks(), "own_motion").make.make(defaults.self_check.model.own);
  }

  template <class Off>
  void drive(double for_s, double sigma_m, const Off& off) {
    constexpr double kSpeed = 4.0;
    for (const double until = t_s_ + for_s; t_s_ < until - 1e-9;) {
      t_s_ += 0.1;
      const GpsTime t = kCheckStart + t_s_;
      const double x = kSpeed * t_s_;
      if (wheel_)
        for (int i = 0; i < 5; ++i) check_->count({t, 0.02, 0, kSpeed});
      NavEstimate estimate;
      estimate.t = t;
      estimate.X_WB.p.head<2>() = Eigen::Vector2d(x, 0.0) + off(t_s_);
      estimate.v_WB_W.x() = kSpeed;
      estimate.pose_covariance.setZero();
      estimate.pose_covariance.diagonal().tail<3>().setConstant(sigma_m * sigma_m);
      LidarScan scan;
      scan.t = t;
      for (const Eigen::Vector2d& p : street_from({{x, 0.0}, 0.0}, true))
        scan.points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0F, 0.5F, 0.0F, 0, 0});
      check_->see(scan, {estimate.X_WB.R, estimate.X_WB.p + Eigen::Vector3d(0, 0, 1.5)}, estimate);
      if (check_->trust() != Trust::kGood && !doubted_s_) doubted_s_ = t_s_;
      if (check_->trust() == Trust::kLost && !lost_s_) lost_s_ = t_s_;
    }
  }
  std::optional<double> doubted_s() const { return doubted_s_; }
  std::optional<double> lost_s() const { return lost_s_; }
  Trust trust() const { return check_->trust(); }

 private:
  bool wheel_;
  std::unique_ptr<SelfCheck> check_;
  double t_s_ = 0.0;
  std::optional<double> doubted_s_, lost_s_;
};

// Errors as large as the estimate says, independent from scan to scan: the worst case for it.
TEST(OwnMotion, BelievesAnEstimateThatErrsAsItSays) {
  for (const bool wheel : {true, false}) {
    CheckedDrive drive(wheel);
    const RandomStream noise(1, "tests.own_motion");
    std::uint64_t k = 0;
    drive.drive(120.0, 0.5, [&](double) {
      const Eigen::Vector3d n = noise.normal3(k++);
      return Eigen::Vector2d(0.5 * n.x(), 0.5 * n.y());
    });
    EXPECT_FALSE(drive.doubted_s()) << wheel;
  }
}

// 8 m: over the 32 s that a look may reach back its own way of 130 m errs by 1.3 m (course_share), which with the
// estimate's 0.3 m takes 4.3 sigma (false_alarm 1e-4, two axes) of 1.4 m, or 6 m.
TEST(OwnMotion, DoubtsAJumpAtOnceAndIsLostWhereItLasts) {
  for (const bool wheel : {true, false}) {
    CheckedDrive drive(wheel);
    drive.drive(60.0, 0.3, [](double t_s) { return Eigen::Vector2d(0.0, t_s > 40.0 ? 8.0 : 0.0); });
    ASSERT_TRUE(drive.doubted_s()) << wheel;
    EXPECT_NEAR(*drive.doubted_s(), 40.0, 1.1) << "a look is due once a second at least";
    ASSERT_TRUE(drive.lost_s()) << wheel;
    EXPECT_NEAR(*drive.lost_s() - *drive.doubted_s(), 12.0, 1.1);
  }
}

TEST(OwnMotion, GoesOnAfterAJumpThatGoesAway) {
  CheckedDrive drive(true);
  drive.drive(60.0, 0.3, [](double t_s) { return Eigen::Vector2d(0.0, t_s > 40.0 && t_s < 46.0 ? 5.0 : 0.0); });
  EXPECT_TRUE(drive.doubted_s());
  EXPECT_FALSE(drive.lost_s());
  EXPECT_EQ(drive.trust(), Trust::kGood);
}

TEST(OwnMotion, DoubtsAnEstimateThatWandersOffFasterThanItSays) {
  CheckedDrive drive(true);
  drive.drive(90.0, 0.3, [](double t_s) { return Eigen::Vector2d(0.0, 0.4 * std::max(0.0, t_s - 30.0)); });
  ASSERT_TRUE(drive.doubted_s());
  EXPECT_LT(*drive.doubted_s(), 60.0);
}

TEST(OwnMotion, DoubtsAnEstimateThatIsUnsureByItself) {
  CheckedDrive drive(true);
  drive.drive(30.0, 6.0, [](double) { return Eigen::Vector2d(0.0, 0.0); });
  EXPECT_TRUE(drive.lost_s());
}

}  // namespace
}  // namespace canyon::mission
