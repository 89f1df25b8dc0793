// Where the search along a way looks for places that may be it.
#include "canyon/lidar/registration/engine/pose_search.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/lidar/registration/engine/match_form.h"
#include "canyon/lidar/registration/engine/surface_cloud.h"
#include "canyon/lidar/registration/engine/surface_target.h"
#include "canyon/tests/lidar/registration/made_clouds.h"

namespace canyon::lidar::testing {
namespace {

/// A street along x with a facade, and piers that stand out of it every so many metres, `each_way` on either side of
/// the one at x = 0.
Points street_with_piers(std::uint64_t number, double period_m, int each_way) {
  Walls walls(number);
  walls.add({-30, -6, -2}, {60, 0, 0}, {0, 12, 0}, 6000).add({-30, 6, -2}, {60, 0, 0}, {0, 0, 4}, 3000);
  for (int k = -each_way; k <= each_way; ++k) walls.add({k * period_m, 3, -2}, {0, 3, 0}, {0, 0, 4}, 600);
  return walls.take();
}

/// How far along x places are found where the source is three piers of a street of seven, at the prior's pose.
std::vector<double> found_along_m(double period_m, double sigma_m) {
  const auto source = prepare_surfaces(street_with_piers(1, period_m, 1), 0.5);
  const auto target = point_target(prepare_surfaces(street_with_piers(2, period_m, 3), 0.5));
  const MatchingParameters matching;
  const EngineParameters engine;
  PosePrior prior;
  prior.covariance = law(0.1, 0.5);
  prior.covariance(3, 3) = sigma_m * sigma_m;
  PoseSearch search(*source, *target, plane_to_plane, matching, engine, prior);
  Vector6d way = Vector6d::Zero();
  way[3] = 1.0;
  std::vector<double> out;
  for (const FoundPose& at : search.along(prior.X_TS, way)) out.push_back(at.X.p.x());
  return out;
}

/// How many are the same place as that one. Several may come to one place; who weighs them takes one of those.
std::ptrdiff_t at_place(const std::vector<double>& found_m, double place_m) {
  return std::count_if(found_m.begin(), found_m.end(), [&](double x) {
    return !are_apart((Vector6d() << 0.0, 0.0, 0.0, x - place_m, 0.0, 0.0).finished());
  });
}

// Steps are 0.5 m, half the reach of a match, and the prior's 99.9 % ellipsoid reaches 4.74 sigma: with 0.675 m 3.2 m,
// so that 3 m is the last step either way; with 0.8 m 3.8 m, which has 3.5 m as the last, and the next pier at 4.5 m.
// 2026-11-30: the last steps were looked at but never taken.
TEST(PoseSearchAlong, AMinimumAtThePriorsLastStepIsFound) {
  const auto found_m = found_along_m(3.0, 0.675);
  EXPECT_GE(at_place(found_m, 3.0), 1);
  EXPECT_GE(at_place(found_m, -3.0), 1);
}

TEST(PoseSearchAlong, OneWithinThePriorsReachIsFoundAsEver) {
  const auto found_m = found_along_m(3.0, 0.9);
  EXPECT_GE(at_place(found_m, 3.0), 1);
  EXPECT_GE(at_place(found_m, -3.0), 1);
}

TEST(PoseSearchAlong, OneThatThePriorDoesNotReachIsNone) {
  const auto found_m = found_along_m(4.5, 0.8);
  EXPECT_EQ(at_place(found_m, 4.5), 0);
  EXPECT_EQ(at_place(found_m, -4.5), 0);
}

}  // namespace
}  // namespace canyon::lidar::testing
