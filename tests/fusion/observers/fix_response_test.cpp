// What the filter says of its own response is what comes of it where fixes are really moved.
#include "canyon/fusion/observers/fix_response.h"

#include <gtest/gtest.h>
#include <Eigen/SVD>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion {
namespace {

constexpr int kFixCount = 20, kSamplesPerFix = 50;
const GpsTime kFixStart = GpsTime::from_week_sow(1590, 396000.0);
const LocalFrame kFixFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
const Eigen::Vector3d kFixImu(0.0, 0.0, 0.4), kFixAntenna(-0.3, 0.0, 1.2);

const Eigen::Vector3d kAcceleration_W(1.0, 2.0, 0.0);

/// A level body, axes along east, north, up, that speeds up from rest: attitude, velocity and position are coupled.
ImuSample sample(std::int64_t k) {
  ImuSample s;
  s.t = tick(kFixStart, k + 1, 100.0);
  s.dt_s = 0.01;
  const Eigen::Matrix3d R_WE = kFixFrame.R_EW().transpose();
  s.dtheta_U = s.dt_s * (R_WE * earth_rate_E());
  s.dv_U = s.dt_s * (kAcceleration_W - R_WE * gravity_E(kFixFrame.to_E(kFixImu)));
  return s;
}

/// Where B ends after all fixes, each of which is moved by `moves`; `response`, if any, is told everything.
Eigen::Vector3d place_after(const std::vector<Eigen::Vector3d>& moves, FixResponse* response,
                            const std::vector<double>& expected = {}, FixResponse::Moved* moved = nullptr,
                            const FilterConfig& config = {}) {
  ErrorStateFilter filter(config, tactical_noise(), kFixFrame, kFixImu, kFixAntenna);
  filter.initialize(kFixStart, Pose{}, Eigen::Vector3d::Zero());
  if (response != nullptr) filter.watch(response);
  std::int64_t k = 0;
  for (int fix = 0; fix < kFixCount; ++fix) {
    for (int i = 0; i < kSamplesPerFix; ++i) filter.predict(sample(k++));
    GnssFix z;
    z.t = filter.nav_state().t;
    z.status = FixStatus::kDifferential;
    const double t = z.t - kFixStart;
    z.p_A_E = kFixFrame.to_E(kFixAntenna + 0.5 * t * t * kAcceleration_W) + moves[static_cast<std::size_t>(fix)];
    z.covariance_E = 0.25 * Eigen::Matrix3d::Identity();
    if (response != nullptr) response->expect(expected[static_cast<std::size_t>(fix)]);
    filter.update(z);
  }
  for (int i = 0; i < kSamplesPerFix / 2; ++i) filter.predict(sample(k++));
  if (moved != nullptr) *moved = response->moved(filter.body_jacobian(), kFixFrame.R_EW().col(2));
  return kFixFrame.R_EW() * filter.estimate().X_WB.p;
}

const std::vector<Eigen::Vector3d> kUnmoved(kFixCount, Eigen::Vector3d::Zero());

// The derivative by one fix, found by moving it by 1 cm along each axis. What is of second order: attitudes that fixes
// correct by up to 3 mrad, about which the filter linearizes anew, below 1 %.
TEST(FixResponse, OfOneFixIsTheDerivativeOfTheEstimate) {
  constexpr double kMove_m = 0.01;
  const Eigen::Vector3d unmoved = place_after(kUnmoved, nullptr);
  for (const std::size_t fix : {0u, 7u, 19u}) {
    Eigen::Matrix3d derivative;
    for (int axis = 0; axis < 3; ++axis) {
      auto moves = kUnmoved;
      moves[fix][axis] = kMove_m;
      derivative.col(axis) = (place_after(moves, nullptr) - unmoved) / kMove_m;
    }
    std::vector<double> expected(kFixCount, 0.0);
    expected[fix] = 1.0;
    FixResponse response;
    FixResponse::Moved moved;
    place_after(kUnmoved, &response, expected, &moved);
    const double largest = Eigen::JacobiSVD<Eigen::Matrix3d>(derivative).singularValues()[0];
    EXPECT_NEAR(moved.any_m, largest, 0.01 * largest) << fix;
    const double up = (kFixFrame.R_EW().col(2).transpose() * derivative).norm();
    EXPECT_NEAR(moved.up_m, up, 0.01 * largest) << fix;
  }
}

// 2026-11-22: a filter that was lost takes its place from a fix, and the response knew nothing of that.
TEST(FixResponse, OfAFixThatALostFilterStartsAgainFrom) {
  FilterConfig lost;
  lost.initial_position_sigma_m = 2e6;
  constexpr double kMove_m = 0.01;
  const Eigen::Vector3d unmoved = place_after(kUnmoved, nullptr, {}, nullptr, lost);
  for (const std::size_t fix : {0u, 1u, 19u}) {
    Eigen::Matrix3d derivative;
    for (int axis = 0; axis < 3; ++axis) {
      auto moves = kUnmoved;
      moves[fix][axis] = kMove_m;
      derivative.col(axis) = (place_after(moves, nullptr, {}, nullptr, lost) - unmoved) / kMove_m;
    }
    std::vector<double> expected(kFixCount, 0.0);
    expected[fix] = 1.0;
    FixResponse response;
    FixResponse::Moved moved;
    place_after(kUnmoved, &response, expected, &moved, lost);
    const double largest = Eigen::JacobiSVD<Eigen::Matrix3d>(derivative).singularValues()[0];
    EXPECT_NEAR(moved.any_m, largest, 0.01 * largest) << fix;
  }
}

// Whatever the directions in which all fixes are moved, the estimate stays within the sum; a constant bias, which a
// filter lets pass whole, comes near it.
TEST(FixResponse, TheSumBoundsEveryChoiceOfDirections) {
  constexpr double kMove_m = 0.01;
  FixResponse response;
  FixResponse::Moved moved;
  const Eigen::Vector3d unmoved = place_after(kUnmoved, &response, std::vector<double>(kFixCount, kMove_m), &moved);
  const RandomStream stream(3, "test.directions");
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    auto moves = kUnmoved;
    for (std::uint32_t fix = 0; fix < kFixCount; ++fix) moves[fix] = kMove_m * stream.direction(fix, trial);
    EXPECT_LE((place_after(moves, nullptr) - unmoved).norm(), moved.any_m) << trial;
  }
  const std::vector<Eigen::Vector3d> bias(kFixCount, kMove_m * Eigen::Vector3d::UnitX());
  const double by_bias = (place_after(bias, nullptr) - unmoved).norm();
  EXPECT_LE(by_bias, moved.any_m);
  EXPECT_GT(by_bias, 0.2 * moved.any_m);
}

// 2026-11-22: the bound of the chain, halved, is broken by a choice of directions: each fix is moved towards where it
// carries the place along one direction, found by moving it alone.
TEST(FixResponse, HalfTheSumIsExceededInTheWorstDirections) {
  constexpr double kMove_m = 0.01;
  FixResponse response;
  FixResponse::Moved moved;
  const Eigen::Vector3d unmoved = place_after(kUnmoved, &response, std::vector<double>(kFixCount, kMove_m), &moved);
  double most_m = 0.0;
  for (const Eigen::Vector3d& along :
       {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d::UnitY().eval(), Eigen::Vector3d::UnitZ().eval()}) {
    auto worst = kUnmoved;
    for (std::size_t fix = 0; fix < kFixCount; ++fix) {
      Eigen::Vector3d gain;
      for (int axis = 0; axis < 3; ++axis) {
        auto moves = kUnmoved;
        moves[fix][axis] = kMove_m;
        gain[axis] = along.dot(place_after(moves, nullptr) - unmoved);
      }
      worst[fix] = kMove_m * gain.normalized();
    }
    most_m = std::max(most_m, (place_after(worst, nullptr) - unmoved).norm());
  }
  EXPECT_LE(most_m, 1.01 * moved.any_m);  // what is of second order, as above
  EXPECT_GT(most_m, 0.5 * moved.any_m);
}

}  // namespace
}  // namespace canyon::fusion
