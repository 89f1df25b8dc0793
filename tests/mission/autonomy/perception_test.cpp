#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/mission/autonomy/perception/lane_reference.h"
#include "canyon/mission/autonomy/perception/odometry_frame.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/tests/mission/autonomy/box_scan.h"

namespace canyon::mission {
namespace {

const GpsTime kSeenFrom = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
using testing::Box;
using testing::kMast_m;

/// A parked car of the built-in city, headed along x, by the middle of its ground: hull and cabin.
std::vector<Box> car_at(double x, double y) {
  return {{{x - 2.25, y - 0.9, 0.2}, {x + 2.25, y + 0.9, 0.9}}, {{x - 1.4, y - 0.78, 0.9}, {x + 1.0, y + 0.78, 1.5}}};
}

/// A ground_grid, shown scans from places.
class Eyes {
 public:
  Eyes() : perception_(model_row(perceptions(), "ground_grid").make(ReferenceParameters{}.perception.model.own, {})) {}
  /// `height_m` is where the estimate has the vehicle.
  void see(const Eigen::Vector2d& p, const std::vector<Box>& boxes, double slope = 0.0, double height_m = 0.0) {
    t_s_ += 0.1;
    const Eigen::Quaterniond R(Eigen::AngleAxisd(-std::atan(slope), Eigen::Vector3d::UnitY()));
    const Pose X_OB{R, {p.x(), p.y(), height_m}};
    const Pose X_OL{Eigen::Quaterniond::Identity(), {p.x(), p.y(), height_m + kMast_m}};
    EXPECT_TRUE(perception_->see(testing::box_scan(p, boxes, kSeenFrom + t_s_, slope), X_OL, X_OB, t_s_));
  }
  void wait(double s) { t_s_ += s; }
  const BlockedCells& blocked() const { return perception_->blocked(); }
  /// How far the vehicle may go straight ahead from p.
  double free_m(const Eigen::Vector2d& p) const {
    return free_along({p, 0.0}, 0.0, 25.0, {}, perception_->blocked(), {});
  }
  const Perception& perception() const { return *perception_; }

 private:
  std::unique_ptr<Perception> perception_;
  double t_s_ = 0.0;
};

TEST(GroundGrid, LevelAndSlopingStreetsAreFree) {
  for (const double slope : {0.0, 0.08, -0.08}) {
    Eyes eyes;
    for (int k = 0; k < 30; ++k) eyes.see({0.5 * k, 0.0}, {}, slope);
    EXPECT_TRUE(eyes.blocked().all().empty()) << slope;
    EXPECT_GT(eyes.perception().seen_m({1.0, 0.0}), 20.0) << slope;
  }
}

// A car ahead, wherever it stands within sight: its back is 2.25 m before its middle. Cells are of 0.2 m, steps of
// 0.25 m; what it keeps clear is the bumper at 2.2 m, and 0.3 m more. Nearer than 6.7 m the lowest beam passes over
// what may stand before it, 1 m at most; from 12 m on the hull may lie between two rings, and its cabin, 0.85 m on, is
// what is seen.
TEST(GroundGrid, ACarAheadBlocksAtEveryDistance) {
  for (double gap_m = 0.6; gap_m < 18.0; gap_m += 0.43) {
    Eyes eyes;
    const double back_m = 2.2 + gap_m;
    for (int k = 0; k < 3; ++k) eyes.see({0.0, 0.0}, car_at(back_m + 2.25, 0.1));
    EXPECT_LE(eyes.free_m({0.0, 0.0}), gap_m + (gap_m > 12.0 ? 0.85 : 0.0)) << gap_m;
    EXPECT_GE(eyes.free_m({0.0, 0.0}), gap_m - 0.3 - 0.2 - 0.25 - (back_m < 6.7 ? 1.0 : 0.0)) << gap_m;
  }
}

TEST(GroundGrid, OneScanAloneBlocksNothing) {
  Eyes eyes;
  eyes.see({0.0, 0.0}, car_at(12.0, 0.0));
  EXPECT_TRUE(eyes.blocked().all().empty());
  eyes.see({0.0, 0.0}, car_at(12.0, 0.0));
  EXPECT_FALSE(eyes.blocked().all().empty());
}

// Cells have numbers of 32 bits.
TEST(GroundGrid, AnEstimateBeyondAllCellsShowsNothing) {
  const auto grid = model_row(perceptions(), "ground_grid").make(ReferenceParameters{}.perception.model.own, {});
  const LidarScan scan = testing::box_scan({0.0, 0.0}, car_at(12.0, 0.0), kSeenFrom);
  const auto sees_at = [&](double x_m) {
    const Pose X_OB{Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}};
    return grid->see(scan, {X_OB.R, X_OB.p + kMast_m * Eigen::Vector3d::UnitZ()}, X_OB, 0.1);
  };
  for (const double x_m : {0.0, 9.9e6, -9.9e6}) EXPECT_TRUE(sees_at(x_m)) << x_m;
  for (const double x_m : {1e7, -1e7, 4.3e8, 1e12, 1e300, std::nan("")}) EXPECT_FALSE(sees_at(x_m)) << x_m;
}

TEST(GroundGrid, WhatDrivesAwayIsForgotten) {
  Eyes eyes;
  for (int k = 0; k < 10; ++k) eyes.see({0.0, 0.0}, car_at(12.0, 0.0));
  for (int k = 0; k < 25; ++k) eyes.see({0.0, 0.0}, {});
  EXPECT_TRUE(eyes.blocked().all().empty());
}

// Beside the vehicle the lowest beam passes over a hull: it stands there all the same.
TEST(GroundGrid, WhatItsBeamsPassOverStays) {
  Eyes eyes;
  const std::vector<Box> kerbstones{{{9.0, 1.5, 0.0}, {12.0, 2.0, 0.6}}};
  for (int k = 0; k <= 20; ++k) eyes.see({0.5 * k, 0.0}, kerbstones);
  for (int k = 0; k < 60; ++k) eyes.see({10.0, 0.0}, kerbstones);
  const double clearance = eyes.blocked().clearance_m({{10.0, 0.0}, 0.0}, {}, 2.0);
  EXPECT_LE(clearance, 0.75 + 0.1 + 0.05);  // half a cell, and LIDAR steps of 0.4 degrees
  EXPECT_GE(clearance, 0.75 - 0.1);
}

// 2026-11-27: a bonnet whose top was 3 cm above where the lowest beam passes, by the vehicle's own plane, was
// forgotten, and the vehicle drove into it. At 3.7 m that beam passes at 0.81 m; of what is 0.4 m high it sees none of
// the near end.
TEST(GroundGrid, WhatTheLowestBeamMayMissStays) {
  const auto kept = [](double seen_to_m, double then_to_m) {
    Eyes eyes;
    for (int k = 0; k < 20; ++k) eyes.see({0.0, 0.0}, {{{3.65, -0.5, 0.0}, {5.0, 0.5, seen_to_m}}});
    for (int k = 0; k < 40; ++k) eyes.see({0.0, 0.0}, {{{3.65, -0.5, 0.0}, {5.0, 0.5, then_to_m}}});
    return eyes.free_m({0.0, 0.0}) < 1.5;
  };
  EXPECT_TRUE(kept(0.9, 0.4));
  EXPECT_FALSE(kept(1.2, 0.0)) << "it has gone";
}

// The fault that sent the one of 2012 beside the street: heights of the estimate that drift, or jump, change nothing.
TEST(GroundGrid, ErrorsOfTheEstimatesHeightNeverMatter) {
  Eyes steady, drifting;
  for (int k = 0; k < 30; ++k) {
    const Eigen::Vector2d p(0.4 * k, 0.0);
    steady.see(p, car_at(25.0, 2.0), 0.03);
    drifting.see(p, car_at(25.0, 2.0), 0.03, -7.0 + 0.1 * k + (k > 15 ? 3.0 : 0.0));
  }
  ASSERT_EQ(drifting.blocked().all().size(), steady.blocked().all().size());
  for (std::size_t i = 0; i < steady.blocked().all().size(); ++i)
    EXPECT_EQ(drifting.blocked().all()[i], steady.blocked().all()[i]);
}

// 2026-11-27: a filter had a standing vehicle drive at 0.7 m/s, and what its LIDAR could not see any more moved on.
TEST(OdometryFrame, AWheelKeepsItWhereItIs) {
  OdometryFrame frame;
  NavEstimate estimate;
  estimate.X_WB.R = rotation_from({0.5 * kPi, 0.0, 0.0});
  for (int k = 0; k <= 100; ++k) {
    estimate.t = GpsTime{} + 0.1 * k;
    estimate.v_WB_W = {0.3, 0.7, 0.0};
    // It stands for five seconds, and then goes back by 0.02 m each time.
    frame.follow(estimate, false, OdometryFrame::Counted{k > 50 ? -0.02 : 0.0, k > 50 ? -0.2 : 0.0});
    if (k == 50) {
      EXPECT_EQ(frame.body().p_m, Eigen::Vector2d(0.0, 0.0));
    }
  }
  EXPECT_LT((frame.body().p_m - Eigen::Vector2d(0.0, -1.0)).norm(), 1e-12);
  EXPECT_EQ(frame.speed_m_s(), -0.2);
  EXPECT_NEAR(frame.driven_m(), 1.0, 1e-12);
}

// A quarter turn to the left about a point 5 m off: a wheel 0.8 m to the left goes 4.2 / 5 of B's way.
TEST(OdometryFrame, AWheelBesideTheAxisGoesAnotherWay) {
  OdometryFrame frame;
  NavEstimate estimate;
  constexpr int kSteps = 900;
  const double step_rad = 0.5 * kPi / kSteps;
  for (int k = 0; k <= kSteps; ++k) {
    estimate.t = GpsTime{} + 0.01 * k;
    estimate.X_WB.R = rotation_from({step_rad * k, 0.0, 0.0});
    frame.follow(estimate, false, OdometryFrame::Counted{k > 0 ? 4.2 * step_rad : 0.0, 420.0 * step_rad, 0.8});
  }
  // To the left end of each step's chord: first order of its angle.
  EXPECT_LT((frame.body().p_m - Eigen::Vector2d(5.0, 5.0)).norm(), 5.0 * step_rad);
  EXPECT_NEAR(frame.driven_m(), 2.5 * kPi, 1e-9);
  EXPECT_NEAR(frame.speed_m_s(), 500.0 * step_rad, 1e-9);
}

// A fix moves the estimate by 2 m: what was seen stays where it stands, and the route moves.
TEST(OdometryFrame, AJumpOfTheEstimateDoesNotMoveIt) {
  OdometryFrame frame;
  NavEstimate estimate;
  estimate.v_WB_W = {3.0, 0.0, 0.0};
  for (int k = 0; k <= 100; ++k) {
    estimate.t = kSeenFrom + 0.01 * k;
    estimate.X_WB.p = {0.03 * k, k < 50 ? 0.0 : 2.0, 5.0};
    frame.follow(estimate, false);
  }
  EXPECT_NEAR(frame.body().p_m.x(), 3.0, 1e-12);
  EXPECT_NEAR(frame.body().p_m.y(), 0.0, 1e-12);
  EXPECT_NEAR(frame.from_O_to_W().y(), 2.0, 1e-12);
  EXPECT_NEAR(frame.driven_m(), 3.0, 1e-12);
  frame.follow(estimate, true);
  EXPECT_NEAR(frame.driven_m(), 3.0, 1e-12) << "it is known to stand";
}

double middle_after(double seconds, double sigma_m, double wrong_by_m, double right_wall_m = -9.0,
                    const char* model = "seen_street") {
  const auto lane = model_row(lane_references(), model).make(ReferenceParameters{}.lane.model.own);
  const Path route({{0.0, 0.0}, {100.0, 0.0}}, 6.5);
  std::vector<Eigen::Vector2d> walls;
  for (double x = 0.0; x < 60.0; x += 0.2) {
    walls.emplace_back(x, 9.0);
    walls.emplace_back(x, right_wall_m);
  }
  const BlockedCells blocked({20.0, 0.0}, walls);
  double middle = 0.0;
  // In O the street lies about y = 0; the estimate has the vehicle `wrong_by_m` too far left.
  for (double t = 0.0; t < seconds; t += 0.1)
    middle = lane->middle_m({route, 20.0, {0.0, wrong_by_m}, {{20.0, 0.0}, 0.0}, sigma_m, 0.1, blocked});
  return middle;
}

// Between two middles of the street, each with its variance, the lane is where the weighted mean has it.
TEST(SeenStreet, WeighsTheStreetAgainstTheEstimate) {
  EXPECT_NEAR(middle_after(20.0, 0.5, 2.0), 2.0 * 0.25 / (0.25 + 1.0), 1e-12);
  EXPECT_NEAR(middle_after(20.0, 3.0, 2.0), 2.0 * 9.0 / (9.0 + 1.0), 1e-12);
  // It goes there at half a metre a second.
  EXPECT_NEAR(middle_after(1.0, 3.0, 2.0), 0.5, 0.05 + 1e-12);
  // Farther off than three sigma for longer than three seconds: the filter is surer than right.
  EXPECT_LT(middle_after(2.5, 0.3, 6.0), 0.6);
  EXPECT_GT(middle_after(30.0, 0.3, 6.0), 5.5);
  // Too wide for a street.
  EXPECT_EQ(middle_after(20.0, 3.0, 2.0, -20.0), 0.0);
}

// The same street, seen to be up to 6 m beside the route: with a sigma of 3 m nine tenths of that are the estimate's.
TEST(RouteAsLane, StaysWhereTheSeenStreetMoves) {
  for (const double wrong_by_m : {-6.0, -2.0, 2.0, 6.0}) {
    EXPECT_NEAR(middle_after(20.0, 3.0, wrong_by_m), 0.9 * wrong_by_m, 1e-12);
    for (const double seconds : {0.1, 2.0, 20.0})
      for (const double sigma_m : {0.3, 3.0, 30.0})
        EXPECT_EQ(middle_after(seconds, sigma_m, wrong_by_m, -9.0, "route"), 0.0)
            << seconds << " " << sigma_m << " " << wrong_by_m;
  }
}

}  // namespace
}  // namespace canyon::mission
