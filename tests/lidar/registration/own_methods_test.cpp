// The own methods: one engine, no PCL.
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "canyon/core/files/files.h"
#include "canyon/core/math/chi_square.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/lidar/files/clouds/read_cloud.h"
#include "canyon/lidar/registration/cloud_pair.h"
#include "canyon/lidar/registration/engine/engine_registration.h"
#include "canyon/lidar/registration/engine/match_sums.h"
#include "canyon/lidar/registration/engine/prior_law.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/tests/lidar/registration/made_clouds.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::lidar {
namespace {

using Points = std::vector<Eigen::Vector3f>;
using testing::closed_room;
using testing::expect_promise;
using testing::kOwnMethods;
using testing::law;
using testing::level_ground;
using testing::long_corridor;
using testing::offset;
using testing::own_method;
using testing::place;
using testing::Walls;

struct RealPair {
  CloudPlaces source, target;
  Pose reference;
};
RealPair real_pair(const std::string& source, const std::string& target, const std::string& reference) {
  RealPair out{*read_cloud(source), *read_cloud(target), {}};
  Eigen::Matrix4d T;
  std::ifstream file(reference);
  for (int i = 0; i < 16; ++i) file >> T(i / 4, i % 4);
  out.reference = Pose::from_matrix(T);
  return out;
}
#define CANYON_REAL_PAIR(pair)                                        \
  CANYON_REAL_DATA(source_path, "lidar/pair/source.ply");             \
  CANYON_REAL_DATA(target_path, "lidar/pair/target.ply");             \
  CANYON_REAL_DATA(reference_path, "lidar/pair/T_target_source.txt"); \
  const RealPair pair = real_pair(source_path, target_path, reference_path)

Points floats(const CloudPlaces& cloud) {
  Points out;
  for (const Eigen::Vector3d& p : cloud.points) out.push_back(p.cast<float>());
  return out;
}

TEST(OwnMethods, RealScansAgreeWithTheirReference) {
  CANYON_REAL_PAIR(pair);
  for (const char* name : kOwnMethods) {
    const CloudPair found = register_pair(*own_method(name, 0.25), pair.source, pair.target, {});
    EXPECT_EQ(found.result.status, RegistrationStatus::kConverged) << name;
    const Vector6d error = (pair.reference.inverse() * found.result.X_TS).log();
    // The reference itself is good to about 1 cm, its roll to about 0.7 deg (the data's MANIFEST).
    EXPECT_LT(error.tail<3>().norm(), 0.02) << name;
    EXPECT_LT(std::abs(error[0]), 0.7 * kDegree) << name;
    EXPECT_LT(error.segment<2>(1).norm(), 0.25 * kDegree) << name;
  }
}

/// 200 starts off by so much each: right to 0.1 m and 1 degree are as many as are asked for.
void expect_right_from_rings_on_the_pair(const RealPair& pair, const std::string& name) {
  const auto method = own_method(name, 0.25);
  const auto source = method->prepare(floats(pair.source));
  const Registration::Placed placed{method->prepare(floats(pair.target)), Pose{}};
  struct Ring {
    double m, deg;
    int wanted;  // of 200, as required
  };
  const RandomStream random(3, "test.rings");
  for (const Ring& ring : {Ring{0.5, 2, 198}, Ring{1, 5, 198}, Ring{2, 10, 160}}) {
    int right = 0;
    for (std::uint64_t k = 0; k < 200; ++k) {
      Vector6d off;
      off << ring.deg * kDegree * random.direction(0, k), ring.m * random.direction(1, k);
      const auto result = method->align(*source, {&placed, 1}, pair.reference * Pose::exp(off));
      const Vector6d error = (pair.reference.inverse() * result.X_TS).log();
      right += error.tail<3>().norm() < 0.1 && error.head<3>().norm() < kDegree ? 1 : 0;
    }
    std::printf("%s from %.1f m, %.0f deg: %d of 200 right\n", name.c_str(), ring.m, ring.deg, right);
    EXPECT_GE(right, ring.wanted) << name << ' ' << ring.m;
  }
}

TEST(OwnMethods, RealScansFromRingsOfGuesses) {
  CANYON_REAL_PAIR(pair);
  expect_right_from_rings_on_the_pair(pair, "gicp");
}

TEST(OwnMethodsNightly, RealScansFromRingsOfGuessesByTheOthers) {
  CANYON_REAL_PAIR(pair);
  for (const char* name : {"point_to_plane", "vgicp"}) expect_right_from_rings_on_the_pair(pair, name);
}

TEST(OwnMethods, SameBitsForAnyNumberOfThreads) {
  const Points source = closed_room(1), target = closed_room(2);
  for (const char* name : kOwnMethods) {
    RegistrationResult first;
    for (const int n : {1, 2, 8, 1}) {
      set_threads(n);
      const auto result = place(*own_method(name, 0.2), source, target, {offset(0.2, -0.1, 0.05, 2), law(0.3, 3)});
      if (first.iterations == 0) first = result;
      EXPECT_EQ(result.X_TS.p, first.X_TS.p) << name;
      EXPECT_EQ(result.X_TS.R.coeffs(), first.X_TS.R.coeffs()) << name;
      EXPECT_EQ(result.covariance, first.covariance) << name;
      EXPECT_EQ(result.status, first.status) << name;
    }
  }
  set_threads(0);
}

TEST(OwnMethods, CloudsMovedToTheRadiusOfTheEarth) {
  const Points source = closed_room(1), target = closed_room(2);
  const Eigen::Vector3d far(6378e3, 0, 0);
  CloudPlaces s, t, s_far, t_far;
  for (const auto& p : source) s.points.push_back(p.cast<double>()), s_far.points.push_back(p.cast<double>() + far);
  for (const auto& p : target) t.points.push_back(p.cast<double>()), t_far.points.push_back(p.cast<double>() + far);
  const auto gicp = own_method("gicp");
  const Pose guess = offset(0.1, 0.05, 0, 1);
  const Pose shift{Eigen::Quaterniond::Identity(), far};
  const auto here = register_pair(*gicp, s, t, {guess}),
             there = register_pair(*gicp, s_far, t_far, {shift * guess * shift.inverse()});
  ASSERT_EQ(there.result.status, RegistrationStatus::kConverged);
  const Eigen::Vector3d middle_here = here.result.X_TS * Eigen::Vector3d(Eigen::Vector3d::Zero());
  const Eigen::Vector3d middle_there = there.result.X_TS * far - far;
  EXPECT_LT((middle_here - middle_there).norm(), 1e-6);  // the requirement
  EXPECT_LT(so3_log(here.result.X_TS.R.conjugate() * there.result.X_TS.R).norm(), 1e-7);
}

// Sigma of a turn is about the source's middle. 2026-11-30: it was about the origin, so that 5 degrees were a shift of
// 556 km there, and a search as far as that found nothing to be matched to.
TEST(OwnMethods, APriorOfCloudsAtTheRadiusOfTheEarthIsAboutTheirMiddle) {
  const Points source = closed_room(1), target = closed_room(2);
  const Eigen::Vector3d far(6378e3, -4e5, 100);
  const Pose shift{Eigen::Quaterniond::Identity(), far};
  CloudPlaces s, t, s_far, t_far;
  for (const auto& p : source) s.points.push_back(p.cast<double>()), s_far.points.push_back(p.cast<double>() + far);
  for (const auto& p : target) t.points.push_back(p.cast<double>()), t_far.points.push_back(p.cast<double>() + far);
  Matrix6d to_room = Matrix6d::Identity();  // xi at the room's origin, of xi at the Earth's
  to_room.bottomLeftCorner<3, 3>() = -skew(far);
  for (const char* name : kOwnMethods) {
    const auto method = own_method(name);
    for (const Matrix6d& P : {law(0.3, 1), law(1, 5)}) {
      const Pose guess = offset(0.2, -0.1, 0.02, 1);
      const auto here = register_pair(*method, s, t, {guess, P}).result,
                 there = register_pair(*method, s_far, t_far, {shift * guess * shift.inverse(), P}).result;
      ASSERT_EQ(here.status, RegistrationStatus::kConverged) << name;
      ASSERT_EQ(there.status, RegistrationStatus::kConverged) << name;
      // Thinned by voxels that lie otherwise: two draws of the same error, 99.9 % of both together.
      const Vector6d xi = (here.X_TS.inverse() * (shift.inverse() * there.X_TS * shift)).log();
      const Matrix6d both = here.covariance + to_room * there.covariance * to_room.transpose();
      EXPECT_LT(xi.dot(both.ldlt().solve(xi)), chi_square_threshold(1e-3, 6.0)) << name;
      EXPECT_LT(xi.tail<3>().norm(), 0.02) << name;  // twice the noise of a point
    }
  }
}

TEST(OwnMethods, FloatsBeyond10KmAreDoubted) {
  CloudPlaces cloud{{{20e3, 0, 0}}, true};
  EXPECT_EQ(cloud_doubt("a.bin", cloud), "a.bin: coordinates in single precision beyond 10 km are no finer than 1 mm");
  cloud.single_precision = false;
  EXPECT_EQ(cloud_doubt("a.las", cloud), "");
}

// 2026-11-30: nobody said how much of a cloud was left out.
TEST(OwnMethods, PointsThatAreNotFiniteAreTold) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  CloudPlaces cloud{{{1, 2, 3}, {nan, 2, 3}, {1, 2, -infinite}, {4, 5, 6}}, true};
  EXPECT_EQ(cloud_doubt("a.pcd", cloud), "a.pcd: 2 of 4 points are not finite and left out");
  cloud.points.emplace_back(20e3, 0, 0);
  EXPECT_EQ(
      cloud_doubt("a.pcd", cloud),
      "a.pcd: 2 of 5 points are not finite and left out; coordinates in single precision beyond 10 km are no finer "
      "than 1 mm");
}

/// Along what the surfaces leave open the result is the most probable one by the prior, given all others: its slope is
/// nothing there, to 1e-3 of a sigma.
void expect_prior_along(const char* name, const Points& source, const Points& target, const PosePrior& prior,
                        const std::vector<int>& open) {
  const auto result = place(*own_method(name), source, target, prior);
  EXPECT_EQ(result.status, RegistrationStatus::kConverged) << name;
  ASSERT_EQ(result.open.size(), open.size()) << name;
  const Vector6d moved = (prior.X_TS.inverse() * result.X_TS).log();
  for (const int k : open) {
    const double sigma = std::sqrt(prior.covariance(k, k));
    EXPECT_LT(std::abs(moved[k]), 0.05 * sigma) << name << " axis " << k;
    EXPECT_GT(result.covariance(k, k), 0.5 * sigma * sigma) << name << " axis " << k;
  }
  const Matrix6d weight = PriorLaw::of(prior)->covariance_at(result.X_TS).inverse();
  for (const Vector6d& v : result.open)
    EXPECT_LT(std::abs(v.dot(weight * moved)) / std::sqrt(v.dot(weight * v)), 1e-3) << name << ' ' << v.transpose();
}

TEST(OwnMethods, OpenDirectionsAreThePriors) {
  for (const char* name : kOwnMethods) {
    expect_prior_along(name, long_corridor(1), long_corridor(2), {offset(0.3, 0.1, 0.02, 0.5), law(0.3, 1)}, {3});
    expect_prior_along(name, level_ground(1), level_ground(2), {offset(0.2, -0.3, 0.05, 1), law(0.3, 1)}, {2, 3, 4});
  }
}

// 2026-11-24: it did not come up; the search never left the prior.
TEST(OwnMethodsNightly, APriorThatTheCloudsContradictIsSaidToBe) {
  const Points source = closed_room(1), target = closed_room(2);
  for (const char* name : kOwnMethods) {
    const auto method = own_method(name);
    for (const double off_m : {0.3, 0.5, 1.0}) {
      const auto result = place(*method, source, target, {offset(off_m, 0, 0, 0), law(0.02, 0.2)});
      EXPECT_EQ(result.status, RegistrationStatus::kBeyondPrior) << name << ' ' << off_m;
      ASSERT_TRUE(result.surfaces) << name;
      EXPECT_LT(result.surfaces->X_TS.p.norm(), 0.1) << name;  // the room's own place, to the width of its noise
    }
    const auto agreed = place(*method, source, target, {offset(0.02, 0.01, 0, 0.1), law(0.02, 0.2)});
    EXPECT_EQ(agreed.status, RegistrationStatus::kConverged) << name;
  }
}

/// The pair from guesses that are 0.5 m and 0.8 degrees off either way, for a prior that is sure of them to so much.
void expect_contradiction(const RealPair& pair, const char* name, double leaf_m, double sigma_m, double sigma_deg) {
  const std::string what = std::string(name) + ", leaf " + std::to_string(leaf_m) + ", sigma " +
                           std::to_string(sigma_m) + " m, " + std::to_string(sigma_deg) + " deg";
  for (const double side : {1.0, -1.0}) {
    Vector6d off;
    off << 0.0, 0.0, 0.8 * kDegree, 0.4, -0.3, 0.0;
    const PosePrior prior{pair.reference * Pose::exp(side * off), law(sigma_m, sigma_deg)};
    const RegistrationResult r = register_pair(*own_method(name, leaf_m), pair.source, pair.target, prior).result;
    EXPECT_EQ(r.status, RegistrationStatus::kBeyondPrior) << what << ", side " << side;
    ASSERT_TRUE(r.surfaces) << what;
    // The reference itself is good to about 1 cm, its roll to about 0.7 deg.
    const Vector6d error = (pair.reference.inverse() * r.surfaces->X_TS).log();
    EXPECT_LT(error.tail<3>().norm(), 0.05) << what;
    EXPECT_LT(error.head<3>().norm(), 0.8 * kDegree) << what;
  }
}

// Of up to 0.05 m and 0.5 degrees, so that the guesses are 10 sigma off and more. What the surfaces say by themselves
// is told with it. 2026-11-30: a prior of up to 0.03 m and 0.3 degrees (leaf 0.25; 0.05 and 0.5 with leaf 0.5) was
// believed. Held where it was, everything was off its surfaces, so that every direction was wide, and was opened for
// that.
TEST(OwnMethods, ASharpPriorThatTheRealPairContradictsIsNotBelieved) {
  CANYON_REAL_PAIR(pair);
  struct Sigma {
    double m, deg;
  };
  for (const Sigma& sigma : {Sigma{0, 0}, Sigma{1e-3, 0.01}, Sigma{0.01, 0.1}, Sigma{0.03, 0.3}, Sigma{0.05, 0.5}})
    for (const double leaf_m : {0.25, 0.5}) expect_contradiction(pair, "gicp", leaf_m, sigma.m, sigma.deg);
  for (const char* name : {"point_to_plane", "vgicp"}) {
    expect_contradiction(pair, name, 0.25, 0, 0);
    expect_contradiction(pair, name, 0.25, 0.03, 0.3);
  }
}

// Of the pair's own pose, by the surfaces alone, a prior may be as sure as it likes.
TEST(OwnMethods, ASharpPriorThatIsRightIsBelieved) {
  CANYON_REAL_PAIR(pair);
  for (const double leaf_m : {0.25, 0.5}) {
    const auto gicp = own_method("gicp", leaf_m);
    const RegistrationResult alone = register_pair(*gicp, pair.source, pair.target, {pair.reference}).result;
    for (const double sigma_m : {0.0, 1e-3, 0.01, 0.03, 0.1}) {
      const PosePrior prior{alone.X_TS, law(sigma_m, 10.0 * sigma_m)};
      const RegistrationResult r = register_pair(*gicp, pair.source, pair.target, prior).result;
      EXPECT_EQ(r.status, RegistrationStatus::kConverged) << leaf_m << ' ' << sigma_m;
      EXPECT_TRUE(r.open.empty()) << leaf_m << ' ' << sigma_m;
    }
  }
}

// What the corridor's walls contradict is found out though its length is open, and the length alone contradicts
// nothing.
TEST(OwnMethods, AnOpenDirectionContradictsNoPrior) {
  const Points source = long_corridor(1), target = long_corridor(2);
  for (const char* name : kOwnMethods) {
    const auto method = own_method(name);
    for (const double sigma_m : {0.0, 0.01, 0.05}) {
      EXPECT_EQ(place(*method, source, target, {offset(3, 0, 0, 0), law(sigma_m, 10 * sigma_m)}).status,
                RegistrationStatus::kConverged)
          << name << ' ' << sigma_m;
      EXPECT_EQ(place(*method, source, target, {offset(3, 0.5, 0, 0.8), law(sigma_m, 10 * sigma_m)}).status,
                RegistrationStatus::kBeyondPrior)
          << name << ' ' << sigma_m;
    }
  }
}

/// Two clouds of a shaft of 16 m, or higher: four walls and no floor, so that nothing tells of the height but their
/// ends. What stands above the target's is pulled down to its edge by those points alone that are within 2 m of it,
/// while all others have a neighbour level with them.
RegistrationResult down_a_shaft(std::int64_t max_iterations, const PosePrior& prior, int times = 1) {
  const auto shaft = [times](std::uint64_t number) {
    const double half_m = 8.0 * times;
    return Walls(number)
        .add({-8, -6, -half_m}, {16, 0, 0}, {0, 0, 2 * half_m}, 768 * times)
        .add({-8, 6, -half_m}, {16, 0, 0}, {0, 0, 2 * half_m}, 768 * times)
        .add({-8, -6, -half_m}, {0, 12, 0}, {0, 0, 2 * half_m}, 576 * times)
        .add({8, -6, -half_m}, {0, 12, 0}, {0, 0, 2 * half_m}, 576 * times)
        .take();
  };
  RegistrationConfig config;
  auto& matching = config.method.own.get<MatchingParameters>();
  matching.leaf_m = 0.4;
  matching.max_correspondence_m = 2.0;
  matching.max_iterations = max_iterations;
  return place(**make_registration(config), shaft(51), shaft(52), prior);
}

// 12 m too high. Of each metre of edge 2 m of wall above it pull, by 1 m in the mean, and what overlaps, 5 to 12 m of
// it, pulls by nothing: 2 / (5 + 2) to 2 / (12 + 2) m a round, 0.29 to 0.14 m. So the 30 rounds on a part of the points
// leave metres, and the one after them a step of decimetres, where up to 3 cm would count as settled. From 0.3 m the
// steps are 0.3^2 / 2 / 16 m at most, and one round is enough.
TEST(OwnMethods, WhatIsOnItsWayWhenTheRoundsAreUsedUpHasNotConverged) {
  const RegistrationResult far = down_a_shaft(1, {offset(0, 0, 12, 0)});
  EXPECT_EQ(far.status, RegistrationStatus::kNotConverged);
  EXPECT_TRUE(far.X_TS.matrix().allFinite());
  EXPECT_TRUE(far.covariance.allFinite());
  EXPECT_GT(far.X_TS.p.z(), 2.0);
  EXPECT_LT(far.X_TS.p.z(), 12.0);
  EXPECT_EQ(down_a_shaft(1, {offset(0, 0, 0.3, 0)}).status, RegistrationStatus::kConverged);
}

// The height is open. Of 64 m, 28 m higher, where the prior has it, (64 - 28 + 2) / 64 of the points are matched, but
// walls may go on where nothing was seen.
TEST(OwnMethods, WhereWallsMayGoOnAnOpenDirectionIsThePriors) {
  Matrix6d P = law(0.3, 1);
  P(5, 5) = 30.0 * 30.0;
  const RegistrationResult r = down_a_shaft(200, {offset(0, 0, 28, 0), P}, 4);
  EXPECT_EQ(r.status, RegistrationStatus::kConverged);
  ASSERT_EQ(r.open.size(), 1u);
  EXPECT_NEAR(r.X_TS.p.z(), 28.0, 1e-3 * 30.0);
  EXPECT_GT(std::sqrt(r.covariance(5, 5)), 0.9 * kUnconstrainedSigma_m);
  EXPECT_LT(r.overlap, 0.7);
}

/// Every point's match, if the source is where X_TS has it.
std::vector<LastMatch> matches_at(const Matching& matching, const Pose& X_TS) {
  std::vector<LastMatch> found(matching.source->points.size());
  const auto squared_m = static_cast<float>(matching.reach_m * matching.reach_m);
  for (std::size_t i = 0; i < found.size(); ++i)
    matching.target->find((X_TS * matching.source->points[i].cast<double>()).cast<float>(), squared_m, found[i]);
  return found;
}

double share_on_surfaces_moved(const Points& source, const Points& target, const Pose& moved_by) {
  const auto method = own_method("gicp");
  const auto s = method->prepare(source), t = method->prepare(target);
  const auto surfaces = point_target(t);
  const Matching matching{.source = s.get(), .target = surfaces.get(), .form = nullptr, .kernel = nullptr};
  return share_still_on_surfaces(matching, moved_by, matches_at(matching, moved_by), matches_at(matching, Pose{}));
}

// 4 m along the room its floor and side walls are on their planes still, and the walls at its ends, 16 m apart, on
// none: 192 + 128 of 416 m^2, the post left out, as thinned points are spread by area. Of ground of 40 m a quarter has
// a match 30 m on, and all of it its plane.
TEST(OwnMethods, WhatIsStillOnASurfaceIsSeenByItsPlane) {
  EXPECT_DOUBLE_EQ(share_on_surfaces_moved(closed_room(1), closed_room(2), Pose{}), 1.0);
  EXPECT_NEAR(share_on_surfaces_moved(closed_room(1), closed_room(2), offset(4, 0, 0, 0)), 320.0 / 416.0, 0.05);
  EXPECT_GT(share_on_surfaces_moved(level_ground(1), level_ground(2), offset(30, 0, 0, 0)), 0.99);
  EXPECT_LT(share_on_surfaces_moved(long_corridor(1), long_corridor(2), offset(0, 3, 0, 0)), 0.7);
}

/// Level ground 2 m below as 16 beams from -1 to -31 degrees see it: rings metres apart, but for the nearest.
Points rings_on_level_ground(std::uint64_t number) {
  const RandomStream draws(number, "test.rings");
  Points points;
  std::uint64_t k = 0;
  for (int beam = 0; beam < 16; ++beam) {
    const double radius_m = 2.0 / std::tan((1.0 + 2.0 * beam) * kDegree);
    for (int azimuth = 0; azimuth < 720; ++azimuth, ++k) {
      const double a = azimuth * 0.5 * kDegree;
      points.emplace_back(
          Eigen::Vector3d(radius_m * std::cos(a), radius_m * std::sin(a), -2.0 + 0.01 * draws.normal(0, k))
              .cast<float>());
    }
  }
  return points;
}

// Rings fit one another best where the sensor stood; a metre beside, where the prior has it, many points are farther
// from any ring than matches reach. That they lie on the same ground all the same is seen by its planes; by the number
// of matches alone, as until 2026-11-29, this is not_converged.
TEST(OwnMethods, RingsOnLevelGroundLeaveItOpen) {
  const PosePrior prior{offset(1.2, -0.9, 0.05, 3), law(1, 3)};
  for (const char* name : {"point_to_plane", "gicp"})
    expect_prior_along(name, rings_on_level_ground(1), rings_on_level_ground(2), prior, {2, 3, 4});
}

// The means of its voxels of 1 m follow the rings. A status, or converged with the prior's own doubt along what the
// ground leaves open; which of the two is not asked, as nothing is known of how far such means lead.
TEST(OwnMethodsNightly, RingsOnLevelGroundMakeVoxelsSureOfNothing) {
  const PosePrior prior{offset(1.2, -0.9, 0.05, 3), law(1, 3)};
  const auto r = place(*own_method("vgicp"), rings_on_level_ground(1), rings_on_level_ground(2), prior);
  expect_promise(r, prior.X_TS, "vgicp");
  for (const int k : {2, 3, 4})
    EXPECT_TRUE(r.status != RegistrationStatus::kConverged || r.covariance(k, k) > 0.5 * prior.covariance(k, k)) << k;
}

TEST(OwnMethods, SwappedCloudsAgree) {
  int within = 0;
  const auto gicp = own_method("gicp");
  const RandomStream random(5, "test.swap");
  for (std::uint64_t k = 0; k < 100; ++k) {
    const auto a = gicp->prepare(closed_room(2 * k + 10)), b = gicp->prepare(closed_room(2 * k + 11));
    const Registration::Placed onto_b{b, Pose{}}, onto_a{a, Pose{}};
    Vector6d off;
    off << kDegree * random.direction(0, k), 0.2 * random.direction(1, k);
    const auto there = gicp->align(*a, {&onto_b, 1}, Pose::exp(off)), back = gicp->align(*b, {&onto_a, 1}, Pose{});
    const Vector6d round = (back.X_TS * there.X_TS).log();
    within +=
        round.dot((there.covariance + back.covariance).ldlt().solve(round)) < chi_square_threshold(0.01, 6) ? 1 : 0;
  }
  EXPECT_GE(within, 97);  // the requirement
}

TEST(OwnMethods, OddCloudsAndPriorsAreStatuses) {
  constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
  const Points room = closed_room(1), ground = level_ground(1);
  Points far = room, at_1e9 = room, line, half_nan = room;
  for (auto& p : far) p.x() += 500.0f;
  for (auto& p : at_1e9) p.x() += 1e9f;
  for (int k = 0; k < 5000; ++k) line.emplace_back(0.02f * static_cast<float>(k), 1.0f, 0.5f);
  for (std::size_t k = 0; k < half_nan.size(); k += 2) half_nan[k].setConstant(kNanF);
  const std::vector<std::pair<std::string, Points>> clouds{
      {"none", {}},    {"one", {{1, 2, 3}}}, {"equal", Points(5000, Eigen::Vector3f(1, 2, 3))},
      {"line", line},  {"ground", ground},   {"far", far},
      {"1e9", at_1e9}, {"room", room},       {"half NaN", half_nan}};
  Pose nan_rotation, nan_place = offset(NAN, 0, 0, 0);
  nan_rotation.R.coeffs().setConstant(NAN);
  Matrix6d line_of_sigma = Matrix6d::Zero(), negative = -law(0.1, 1);
  line_of_sigma(3, 3) = 1.0;
  const std::vector<PosePrior> priors{{Pose{}},
                                      {nan_place},
                                      {nan_rotation},
                                      {offset(0, 0, 0, 180)},
                                      {{so3_exp({kPi, 0, 0}), {0, 0, 0}}},
                                      {offset(1e7, 0, 0, 0)},
                                      {offset(1e300, 0, 0, 0)},
                                      {Pose{}, Matrix6d::Zero()},
                                      {Pose{}, line_of_sigma},
                                      {Pose{}, negative},
                                      {Pose{}, law(1e-9, 1e-9)}};
  for (const char* name : kOwnMethods) {
    const auto method = own_method(name);
    for (const auto& [s_name, s] : clouds) {
      for (const auto& [t_name, t] : clouds) {
        const auto source = method->prepare(s);
        const Registration::Placed placed{method->prepare(t), Pose{}};
        const bool small = s.size() < 2 || s_name == "equal" || t.size() < 2 || t_name == "equal" || s_name == "1e9" ||
                           t_name == "1e9";
        for (std::size_t k = 0; k < priors.size(); ++k) {
          const std::string what =
              std::string(name) + ": " + s_name + " onto " + t_name + ", prior " + std::to_string(k);
          const auto r = method->align_with_prior(*source, {&placed, 1}, priors[k]);
          expect_promise(r, priors[k].X_TS, what);
          const bool nowhere = !priors[k].X_TS.matrix().allFinite() || k == 5 || k == 6;
          EXPECT_FALSE((small || nowhere) && r.status == RegistrationStatus::kConverged) << what;
        }
      }
    }
    EXPECT_EQ(place(*method, room, far, {}).status, RegistrationStatus::kTooLittleOverlap) << name;
    EXPECT_EQ(place(*method, line, line, {}).status, RegistrationStatus::kDegenerate) << name;
    EXPECT_EQ(place(*method, room, room, {nan_place}).status, RegistrationStatus::kDiverged) << name;
  }
}

/// A yard with walls on two sides, which looks another one from a half turn away.
Points yard(std::uint64_t number) {
  return Walls(number)
      .add({-8, -6, -2}, {16, 0, 0}, {0, 12, 0}, 6000)
      .add({-8, -6, -2}, {16, 0, 0}, {0, 0, 4}, 3000)
      .add({-8, -6, -2}, {0, 12, 0}, {0, 0, 4}, 3000)
      .add({2, 1, -2}, {1.5, 0, 0}, {0, 0, 3}, 600)
      .take();
}

// A guess that is half turned, about the vertical or upside down: where nothing is known of how good it is right, or
// not converged; where a prior is sure of it not converged, as what is right is then far outside of the prior.
// 2026-11-30: only where nothing was known of the guess was it asked what is explained half turned; with a prior of 1 m
// and 5 degrees the level ground alone was matched, and all that it leaves open was the prior's.
TEST(OwnMethods, AHalfTurnedGuessIsNoSilentSuccess) {
  const Points source = yard(41), target = yard(42);
  for (const char* name : kOwnMethods) {
    const auto method = own_method(name);
    for (const Pose& guess : {offset(0, 0, 0, 180), Pose{so3_exp({kPi, 0, 0}), {0, 0, 0}}}) {
      const auto r = place(*method, source, target, {guess});
      const bool right = r.X_TS.p.norm() < 0.1 && so3_log(r.X_TS.R).norm() < 1.0 * kDegree;
      EXPECT_TRUE(right || r.status != RegistrationStatus::kConverged)
          << name << ": off by " << r.X_TS.p.norm() << " m, overlap " << r.overlap;
      for (const Matrix6d& P : {law(0, 0), law(0.01, 0.1), law(0.1, 1), law(1, 5), law(1, 15)}) {
        const auto held = place(*method, source, target, {guess, P});
        expect_promise(held, guess, name);
        EXPECT_NE(held.status, RegistrationStatus::kConverged)
            << name << ", sigma " << std::sqrt(P(5, 5)) << " m: overlap " << held.overlap;
      }
    }
    EXPECT_EQ(place(*method, source, target, {}).status, RegistrationStatus::kConverged) << name;
    for (const Matrix6d& P : {law(0.1, 1), law(1, 5)})
      EXPECT_EQ(place(*method, source, target, {offset(0.1, -0.1, 0, 1), P}).status, RegistrationStatus::kConverged)
          << name;
  }
}

}  // namespace
}  // namespace canyon::lidar
