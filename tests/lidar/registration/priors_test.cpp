// What is known before an alignment: believed where it is right, and where nothing else tells.
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/cloud_pair.h"
#include "canyon/lidar/registration/engine/prior_law.h"
#include "canyon/tests/lidar/registration/made_clouds.h"
#include "canyon/tests/lidar/registration/real_pair.h"

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
using testing::RealPair;
using testing::Walls;

// Sigma of a turn is about the source's middle. 2026-11-30: it was about the origin, so that 5 degrees were a shift of
// 556 km there, and a search as far as that found nothing to be matched to.
TEST(Priors, APriorOfCloudsAtTheRadiusOfTheEarthIsAboutTheirMiddle) {
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

TEST(Priors, OpenDirectionsAreThePriors) {
  for (const char* name : kOwnMethods) {
    expect_prior_along(name, long_corridor(1), long_corridor(2), {offset(0.3, 0.1, 0.02, 0.5), law(0.3, 1)}, {3});
    expect_prior_along(name, level_ground(1), level_ground(2), {offset(0.2, -0.3, 0.05, 1), law(0.3, 1)}, {2, 3, 4});
  }
}

// 2026-11-24: it did not come up; the search never left the prior.
TEST(PriorsNightly, APriorThatTheCloudsContradictIsSaidToBe) {
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
TEST(Priors, ASharpPriorThatTheRealPairContradictsIsNotBelieved) {
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
TEST(Priors, ASharpPriorThatIsRightIsBelieved) {
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
TEST(Priors, AnOpenDirectionContradictsNoPrior) {
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
TEST(Priors, RingsOnLevelGroundLeaveItOpen) {
  const PosePrior prior{offset(1.2, -0.9, 0.05, 3), law(1, 3)};
  for (const char* name : {"point_to_plane", "gicp"})
    expect_prior_along(name, rings_on_level_ground(1), rings_on_level_ground(2), prior, {2, 3, 4});
}

// The means of its voxels of 1 m follow the rings. A status, or converged with the prior's own doubt along what the
// ground leaves open; which of the two is not asked, as nothing is known of how far such means lead.
TEST(PriorsNightly, RingsOnLevelGroundMakeVoxelsSureOfNothing) {
  const PosePrior prior{offset(1.2, -0.9, 0.05, 3), law(1, 3)};
  const auto r = place(*own_method("vgicp"), rings_on_level_ground(1), rings_on_level_ground(2), prior);
  expect_promise(r, prior.X_TS, "vgicp");
  for (const int k : {2, 3, 4})
    EXPECT_TRUE(r.status != RegistrationStatus::kConverged || r.covariance(k, k) > 0.5 * prior.covariance(k, k)) << k;
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
TEST(Priors, AHalfTurnedGuessIsNoSilentSuccess) {
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
