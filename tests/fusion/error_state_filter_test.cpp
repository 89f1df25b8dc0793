#include "canyon/fusion/error_state_filter.h"

#include <cmath>
#include <cstdio>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "canyon/core/check.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion {
namespace {

using ::testing::HasSubstr;

const GpsTime kFilterStart = GpsTime::from_week_sow(1590, 396000.0);
const LocalFrame kFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
const Eigen::Vector3d kImu(0.0, 0.0, 0.4), kAntenna(-0.3, 0.0, 1.2);

const std::vector<std::vector<std::string>> kStateChoices = {
    {"biases"}, {"biases", "gains"}, {"turn_on_biases", "in_run_biases", "gains"}};

ErrorStateFilter started(const FilterConfig& config = {}, const ImuNoise& noise = tactical_noise()) {
  ErrorStateFilter filter(config, noise, kFrame, kImu, kAntenna);
  filter.initialize(kFilterStart, Pose{}, Eigen::Vector3d::Zero());
  return filter;
}

/// Sample k at rest, level, body axes along east, north, up.
ImuSample at_rest(std::int64_t k, double rate_hz = 100.0) {
  ImuSample s;
  s.t = tick(kFilterStart, k + 1, rate_hz);
  s.dt_s = 1.0 / rate_hz;
  const Eigen::Matrix3d R_WE = kFrame.R_EW().transpose();
  s.dtheta_U = s.dt_s * (R_WE * earth_rate_E());
  s.dv_U = -s.dt_s * (R_WE * gravity_E(kFrame.to_E(kImu)));
  return s;
}

GnssFix fix_at(GpsTime t, const Eigen::Vector3d& error_W, double sigma_m) {
  GnssFix fix;
  fix.t = t;
  fix.status = FixStatus::kDifferential;
  fix.p_A_E = kFrame.to_E(kAntenna + error_W);
  fix.covariance_E = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
  return fix;
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const ProgramError& e) {
    return e.what();
  }
  return "nothing was thrown";
}

TEST(ErrorStateFilter, StartsWithTheConfiguredUncertainty) {
  FilterConfig c;
  c.initial_attitude_sigma_deg_roll_pitch = 0.2;
  c.initial_attitude_sigma_deg_heading = 2.0;
  c.initial_position_sigma_m = 0.7;
  c.initial_velocity_sigma_m_s = 0.3;
  ErrorStateFilter filter(c, tactical_noise(), kFrame, kImu, kAntenna);
  const Pose X{rotation_from({.yaw_rad = 0.8, .pitch_rad = 0.0, .roll_rad = 0.0}), {10.0, 20.0, 3.0}};
  filter.initialize(kFilterStart, X, {4.0, 3.0, 0.1});
  const NavEstimate e = filter.estimate();
  EXPECT_LT((e.X_WB.p - X.p).norm(), 3e-9);  // positions pass through E: eps of 6e6 m
  EXPECT_LT(e.X_WB.R.angularDistance(X.R), 1e-15);
  EXPECT_LT((e.v_WB_W - Eigen::Vector3d(4.0, 3.0, 0.1)).norm(), 1e-14);
  Matrix6d expected = Matrix6d::Zero();
  expected.diagonal() << std::pow(0.2 * kDegree, 2), std::pow(0.2 * kDegree, 2), std::pow(2.0 * kDegree, 2), 0.49, 0.49,
      0.49;
  // B's own position: the lever arm's coupling to attitude must cancel.
  EXPECT_LT((e.pose_covariance - expected).cwiseAbs().maxCoeff(), 1e-15);
  // The gyro bias enters B's velocity through the lever arm: (1.5e-5 * 0.4)^2 = 4e-11.
  EXPECT_LT((e.velocity_covariance_W - 0.09 * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(ErrorStateFilter, StaysWhereItIsAtRest) {
  ErrorStateFilter filter = started();
  for (int k = 0; k < 6000; ++k) filter.predict(at_rest(k));
  const NavEstimate e = filter.estimate();
  EXPECT_EQ(e.t, tick(kFilterStart, 6000, 100.0));
  EXPECT_LT(e.X_WB.p.norm(), 1e-6);
  EXPECT_LT(e.v_WB_W.norm(), 1e-8);
  EXPECT_GT(std::sqrt(e.pose_covariance(3, 3)), 0.5);  // and grows less sure of it
}

TEST(ErrorStateFilter, AFixThatIsNoneChangesNothing) {
  ErrorStateFilter filter = started();
  filter.predict(at_rest(0));
  const auto P = filter.covariance();
  const NavEstimate before = filter.estimate();
  GnssFix none;  // NaN throughout
  none.t = filter.nav_state().t;
  const UpdateReport report = filter.update(none);
  EXPECT_FALSE(report.accepted);
  EXPECT_EQ(report.dimension, 0);
  EXPECT_EQ(filter.covariance(), P);
  EXPECT_EQ(filter.estimate().X_WB.p, before.X_WB.p);
}

TEST(ErrorStateFilter, UpdatePullsTheAntennaTowardsTheFix) {
  FilterConfig c;
  c.initial_position_sigma_m = 3.0;
  ErrorStateFilter filter = started(c);
  const UpdateReport report = filter.update(fix_at(kFilterStart, {0.0, 0.0, 4.0}, 4.0));
  EXPECT_TRUE(report.accepted);
  EXPECT_EQ(report.dimension, 3);
  // Scalar Kalman by hand: height is not touched by attitude, so gain 9 / 25 and NIS 16 / 25.
  EXPECT_NEAR(filter.estimate().X_WB.p.z(), 4.0 * 9.0 / 25.0, 1e-6);
  EXPECT_NEAR(report.nis, 16.0 / 25.0, 1e-6);
  EXPECT_NEAR(filter.estimate().pose_covariance(5, 5), 9.0 * 16.0 / 25.0, 1e-6);
  EXPECT_NEAR(report.innovation.norm(), 4.0, 1e-8);
}

TEST(ErrorStateFilter, TheGateRefusesTheUnlikely) {
  FilterConfig c = configured("gate_sigma = 4");
  ErrorStateFilter gated = started(c), open = started();
  const auto P = gated.covariance();
  const UpdateReport refused = gated.update(fix_at(kFilterStart, {20.0, 0.0, 0.0}, 0.5));
  EXPECT_FALSE(refused.accepted);
  EXPECT_EQ(refused.dimension, 3);
  EXPECT_GT(refused.nis, 100.0);
  EXPECT_EQ(gated.covariance(), P);
  EXPECT_TRUE(open.update(fix_at(kFilterStart, {20.0, 0.0, 0.0}, 0.5)).accepted);
  EXPECT_TRUE(gated.update(fix_at(kFilterStart, {0.5, 0.0, 0.0}, 0.5)).accepted);

  // As rare as 2 sigma in one dimension is NIS 8.02 in three.
  c = configured("gate_sigma = 2");
  // Height is independent of attitude: variance 0.5^2 of the start plus 0.5^2 of the fix.
  const double limit = std::sqrt(8.0249 * 0.5);
  ErrorStateFilter below = started(c), above = started(c);
  EXPECT_TRUE(below.update(fix_at(kFilterStart, {0.0, 0.0, 0.999 * limit}, 0.5)).accepted);
  EXPECT_FALSE(above.update(fix_at(kFilterStart, {0.0, 0.0, 1.001 * limit}, 0.5)).accepted);
}

TEST(ErrorStateFilter, TheFloorMakesAFixNoBetterThanIt) {
  const FilterConfig c = configured("initial_position_sigma_m = 3\nfix_sigma_floor_m = 4");
  ErrorStateFilter filter = started(c);
  EXPECT_NEAR(filter.update(fix_at(kFilterStart, {0.0, 0.0, 4.0}, 0.01)).nis, 16.0 / 25.0, 1e-6);
}

TEST(ErrorStateFilter, StopsWhatIsNotFiniteAndNamesTheProducer) {
  ErrorStateFilter filter = started();
  ImuSample bad = at_rest(0);
  bad.dv_U.y() = std::nan("");
  EXPECT_THAT(message_of([&] { filter.predict(bad); }), HasSubstr("IMU sample at "));
  bad = at_rest(0);
  bad.dt_s = 0.0;
  EXPECT_THAT(message_of([&] { filter.predict(bad); }), HasSubstr("IMU sample at "));
  GnssFix fix = fix_at(kFilterStart, Eigen::Vector3d::Zero(), 1.0);
  fix.p_A_E.x() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message_of([&] { filter.update(fix); }), HasSubstr("GNSS fix at "));
  fix = fix_at(kFilterStart, Eigen::Vector3d::Zero(), 1.0);
  fix.covariance_E(1, 1) = -1.0;
  EXPECT_THAT(message_of([&] { filter.update(fix); }), HasSubstr("covariance of the GNSS fix at "));
  fix = fix_at(kFilterStart + 2.0, Eigen::Vector3d::Zero(), 1.0);
  EXPECT_THAT(message_of([&] { filter.update(fix); }), HasSubstr("2 s away from the last IMU sample"));
}

TEST(ErrorStateFilter, RefusesAGapBetweenSamples) {
  ErrorStateFilter filter = started();
  filter.predict(at_rest(0));
  EXPECT_THAT(message_of([&] { filter.predict(at_rest(5)); }), HasSubstr("s have passed since the last one"));
  EXPECT_THAT(message_of([&] { filter.predict(at_rest(0)); }), HasSubstr("s have passed since the last one"));
}

TEST(ErrorStateFilter, ConfigurationIsReadAndChecked) {
  FilterConfig c;
  const auto good = ConfigNode::parse("gate_sigma = 5\nintegrator = \"euler\"\nstates = [\"gains\"]\n", "m.toml");
  ASSERT_TRUE(read_config(&*good, "fusion", c).ok());
  EXPECT_FALSE(takes_all(c));
  EXPECT_EQ(c.integrator, "euler");
  EXPECT_THAT(c.states, ::testing::ElementsAre("gains"));
  const auto bad = ConfigNode::parse("integrator = \"eule\"\n", "m.toml");
  const Status status = read_config(&*bad, "fusion", c);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().str(),
              ::testing::AllOf(::testing::StartsWith("m.toml:1: fusion.integrator"), HasSubstr("euler")));
}

/// 1e5 steps with fixes of 0.1 mm and 10 km in turn, from an initial kilometre and half a radian: exactly symmetric,
/// and positive definite after scaling to unit diagonal, at every check.
TEST(ErrorStateFilter, CovarianceSurvivesExtremeNoiseRatios) {
  FilterConfig c;
  c.initial_position_sigma_m = 1000.0;
  c.initial_velocity_sigma_m_s = 100.0;
  c.initial_attitude_sigma_deg_roll_pitch = 30.0;
  c.initial_attitude_sigma_deg_heading = 180.0;
  ImuNoise noise = tactical_noise();
  noise.gyro.white_per_sqrt_hz = 1e-9;
  noise.accel.white_per_sqrt_hz = 1e-9;
  noise.accel.turn_on_bias_sigma = 10.0;
  for (const auto& states : kStateChoices) {
    c.states = states;
    ErrorStateFilter filter = started(c, noise);
    double smallest = 1.0;
    for (int k = 0; k < 100000; ++k) {
      filter.predict(at_rest(k));
      if (k % 10 != 9) continue;
      filter.update(fix_at(filter.nav_state().t, Eigen::Vector3d::Zero(), k % 20 == 9 ? 1e-4 : 1e4));
      if (k % 100 != 99) continue;
      const Eigen::MatrixXd P = filter.covariance();
      ASSERT_EQ(P, P.transpose().eval()) << k;
      const Eigen::VectorXd scale = P.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::MatrixXd unit = scale.asDiagonal() * P * scale.asDiagonal();
      const Eigen::LLT<Eigen::MatrixXd> llt(unit);
      ASSERT_EQ(llt.info(), Eigen::Success) << P.rows() << " states: not positive definite after " << k << " steps";
      smallest = std::min(smallest, Eigen::MatrixXd(llt.matrixL()).diagonal().minCoeff());
    }
    std::printf("%td states: smallest Cholesky pivot of the scaled covariance %.1e\n", filter.covariance().rows(),
                smallest);
  }
}

// 2026-11-23: where the filter knew that a fix's error lasts, it took its place from one as if it did not.
TEST(ErrorStateFilter, WhatLastsOfAFixIsInThePlaceTakenFromIt) {
  ErrorStateFilter filter = started(
      configured("states = [\"biases\", \"fix_error\"]\ninitial_position_sigma_m = 1e6\nfix_error_sigma_m = 30\n"
                 "fix_error_scale = 0"));
  for (int k = 0; k < 100; ++k) filter.predict(at_rest(k));
  const UpdateReport first = filter.update(fix_at(filter.nav_state().t, Eigen::Vector3d::Zero(), 1.0));
  EXPECT_TRUE(first.accepted);
  EXPECT_EQ(first.dimension, 0);
  const Eigen::MatrixXd P = filter.covariance();
  EXPECT_EQ(P, P.transpose().eval());
  const int lasting = filter.offset("fix_error");
  for (int i = 0; i < 3; ++i) {
    // The fix's own 1 m, what lasts, and the lever arm's few millimetres.
    EXPECT_NEAR(P(3 + i, 3 + i), 1.0 + 900.0, 0.1);
    EXPECT_NEAR(P(3 + i, lasting + i), -900.0, 0.1);
  }
}

// 2026-11-22: the vertical channel's error grows as e^(t / 570 s). After four hours without a fix the covariance of the
// innovation was no longer positive definite in double precision, and the next fix ended the program.
TEST(ErrorStateFilter, AfterHoursWithoutAFixItStartsAgainFromOne) {
  for (const auto& states : kStateChoices) {
    FilterConfig c;
    c.states = states;
    ErrorStateFilter filter = started(c);
    constexpr int kSixHours = 216'000;
    int k = 0;
    for (; k < kSixHours; ++k) filter.predict(at_rest(k, 10.0));
    ASSERT_GT(filter.estimate().pose_covariance.diagonal().tail<3>().maxCoeff(), 1e20);
    const auto update = [&] { return filter.update(fix_at(filter.nav_state().t, {0.3, -0.2, 0.5}, 1.0)); };
    const UpdateReport first = update();
    EXPECT_TRUE(first.accepted);
    EXPECT_EQ(first.dimension, 0);
    EXPECT_LT((kFrame.to_W(filter.nav_state().p_EU_E) - kImu - Eigen::Vector3d(0.3, -0.2, 0.5)).norm(), 0.5);
    for (; k < kSixHours + 600; ++k) {
      filter.predict(at_rest(k, 10.0));
      if (k % 10 == 0) {
        EXPECT_EQ(update().dimension, 3);
      }
    }
    const auto P = filter.covariance();
    EXPECT_EQ(P, P.transpose().eval());
    EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(P).info(), Eigen::Success);
    const NavEstimate e = filter.estimate();
    // What the fixes err, and no more than the filter says beside it: 5 sigma, false alarm 6e-7.
    for (int i = 0; i < 3; ++i)
      EXPECT_LT(std::abs(e.X_WB.p[i] - Eigen::Vector3d(0.3, -0.2, 0.5)[i]),
                5.0 * std::sqrt(e.pose_covariance(3 + i, 3 + i)));
    EXPECT_LT(e.v_WB_W.norm(), 1.0);
  }
}

}  // namespace
}  // namespace canyon::fusion
