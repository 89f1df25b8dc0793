// Kerbs as the reference autonomy sees them, and the lane between them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/perception/kerb_rises.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/tests/mission/autonomy/box_scan.h"

namespace canyon::mission {
namespace {

using testing::Box;

constexpr double kHalfStreet_m = 6.0;

/// Pavements to both sides of a street along x.
std::vector<Box> pavements(double height_m, double half_street_m = kHalfStreet_m) {
  return {{{-100.0, half_street_m, -1.0}, {200.0, 30.0, height_m}},
          {{-100.0, -30.0, -1.0}, {200.0, -half_street_m, height_m}}};
}

std::vector<Eigen::Vector2d> rises(const std::vector<Box>& boxes, const Eigen::Vector2d& p, double slope = 0.0,
                                   double noise_m = 0.0) {
  LidarScan scan = testing::box_scan(p, boxes, {}, slope, noise_m);
  // From another azimuth on: rings may come in any order.
  std::rotate(scan.points.begin(), scan.points.begin() + static_cast<std::ptrdiff_t>(scan.points.size() / 3),
              scan.points.end());
  const Pose X_OL{Eigen::Quaterniond::Identity(), {p.x(), p.y(), testing::kMast_m + slope * p.x()}};
  return kerb_rises({.scan = scan,
                     .X_OL = X_OL,
                     .origin = p,
                     .along = {1.0, 0.0},
                     .ground_m = slope * p.x(),
                     .up = Eigen::Vector3d(-slope, 0.0, 1.0).normalized()});
}

TEST(KerbRises, LieWhereTheKerbsAre) {
  for (const double height_m : {0.08, 0.12, 0.15})
    for (const double slope : {0.0, 0.08, 0.12, -0.06})
      for (const double noise_m : {0.0, 0.03}) {
        int left = 0, right = 0;
        for (const Eigen::Vector2d& p : rises(pavements(height_m), {0.0, -1.5}, slope, noise_m)) {
          EXPECT_NEAR(std::abs(p.y()), kHalfStreet_m, 0.1) << height_m << ' ' << slope << ' ' << noise_m;
          ++(p.y() > 0.0 ? left : right);
        }
        const int fewest = slope < 0.0 ? 2 : 3;  // downhill, from a level sensor, fewer rings come near
        EXPECT_GE(left, fewest) << height_m << ' ' << slope << ' ' << noise_m;
        EXPECT_GE(right, fewest) << height_m << ' ' << slope << ' ' << noise_m;
      }
}

TEST(KerbRises, AreNoneOnALevelStreetOrAtThingsThatStandThere) {
  EXPECT_TRUE(rises({}, {0.0, 0.0}, 0.0, 0.03).empty());
  EXPECT_TRUE(rises({}, {0.0, 0.0}, 0.08, 0.03).empty());
  const std::vector<Box> car{{{8.0, 2.0, 0.0}, {12.5, 3.8, 1.5}}};
  EXPECT_TRUE(rises(car, {0.0, 0.0}, 0.0, 0.03).empty());
  const std::vector<Box> post{{{8.0, 2.0, 0.0}, {8.2, 2.2, 3.0}}};
  EXPECT_TRUE(rises(post, {0.0, 0.0}, 0.0, 0.03).empty());
  EXPECT_TRUE(rises(pavements(0.5), {0.0, 0.0}).empty()) << "a wall is no kerb";
}

TEST(KerbRises, OfAScanThatIsNotFiniteAreNone) {
  LidarScan scan = testing::box_scan({0.0, 0.0}, pavements(0.12), {});
  for (LidarPoint& point : scan.points) point.x = std::numeric_limits<float>::quiet_NaN();
  const Pose X_OL{Eigen::Quaterniond::Identity(), {0.0, 0.0, testing::kMast_m}};
  EXPECT_TRUE(kerb_rises({.scan = scan, .X_OL = X_OL, .origin = {0.0, 0.0}, .along = {1.0, 0.0}}).empty());
}

/// A vehicle that drives 20 m along a street, half a metre right of its middle, with an estimate `wrong_by_m` too far
/// left and a heading that is wrong: where it has the lane in the end.
double middle_beside(double wrong_by_m, const std::vector<Box>& boxes, double heading_error_rad = 0.0,
                     double true_y_m = -0.5) {
  const auto lane = model_row(lane_references(), "seen_kerbs").make(ReferenceParameters{}.lane.model.own);
  const Path route({{0.0, 0.0}, {200.0, 0.0}}, 6.5);
  const BlockedCells none;
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(heading_error_rad, Eigen::Vector3d::UnitZ()));
  double middle = 0.0;
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector2d p(20.0 + 0.1 * k, true_y_m);
    const LidarScan scan = testing::box_scan(p, boxes, {}, 0.0, 0.03, static_cast<std::uint64_t>(k));
    const Pose X_OB{turned, turned * Eigen::Vector3d(p.x(), p.y(), 0.0)};
    const Pose X_OL{turned, X_OB.p + Eigen::Vector3d(0.0, 0.0, testing::kMast_m)};
    const PlanPose body{X_OB.p.head<2>(), heading_error_rad};
    const Eigen::Vector2d estimate(p.x(), p.y() + wrong_by_m);
    middle = lane->middle_m({route, p.x(), estimate - body.p_m, body, 3.0, 0.1, none, &scan, &X_OL, &X_OB});
  }
  return middle;
}

TEST(SeenKerbs, MoveTheLaneToTheMiddleBetweenThem) {
  // Of the estimate's 3 m and the kerbs' 0.15 m the kerbs' share is 0.9975.
  EXPECT_NEAR(middle_beside(2.0, pavements(0.12)), 2.0, 0.1);
  EXPECT_NEAR(middle_beside(-2.0, pavements(0.12)), -2.0, 0.1);
  EXPECT_NEAR(middle_beside(2.0, pavements(0.12, 10.0), 0.0, -3.0), 2.0, 0.1) << "far off the middle of a wide street";
  EXPECT_EQ(middle_beside(2.0, {}), 0.0) << "no kerbs";
  const std::vector<Box> one_side{pavements(0.12)[0]};
  EXPECT_EQ(middle_beside(2.0, one_side), 0.0) << "one kerb alone";
}

// The estimate's heading may be wrong: kerbs lean then against the route, and count where the vehicle is.
TEST(SeenKerbs, LeanWithTheHeadingsError) {
  for (const double error_deg : {-3.0, 1.5, 5.0})
    EXPECT_NEAR(middle_beside(1.0, pavements(0.12), error_deg * kDegree), 1.0, 0.15) << error_deg;
}

// What was seen in one street says nothing of the next.
TEST(SeenKerbs, ForgetAStreetThatTheyTurnedOutOf) {
  const auto lane = model_row(lane_references(), "seen_kerbs").make(ReferenceParameters{}.lane.model.own);
  const BlockedCells none;
  const auto drive = [&](const Path& route, const std::vector<Box>& boxes, double yaw_rad) {
    double middle = 0.0;
    for (int k = 0; k < 60; ++k) {
      const Eigen::Vector2d ahead(std::cos(yaw_rad), std::sin(yaw_rad));
      const Eigen::Vector2d p = route.at(20.0) + 0.1 * k * ahead;
      const LidarScan scan = testing::box_scan(p, boxes, {}, 0.0, 0.03, static_cast<std::uint64_t>(k));
      const Pose X_OB{Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())), {p.x(), p.y(), 0.0}};
      const Pose X_OL{Eigen::Quaterniond::Identity(), {p.x(), p.y(), testing::kMast_m}};
      middle = lane->middle_m({route, 20.0 + 0.1 * k, {0.0, 0.0}, {p, yaw_rad}, 3.0, 1.0, none, &scan, &X_OL, &X_OB});
    }
    return middle;
  };
  const Path east({{0.0, 0.0}, {200.0, 0.0}}, 6.5), north({{26.0, -20.0}, {26.0, 200.0}}, 6.5);
  EXPECT_NEAR(drive(east, pavements(0.12), 0.0), 0.0, 0.1);
  // 1 m left of the middle of a street to the north.
  const std::vector<Box> across{{{33.0, -100.0, -1.0}, {60.0, 200.0, 0.12}},
                                {{-10.0, -100.0, -1.0}, {21.0, 200.0, 0.12}}};
  EXPECT_NEAR(drive(north, across, 0.5 * kPi), -1.0, 0.1);
}

}  // namespace
}  // namespace canyon::mission
