#include "canyon/fusion/dead_reckoning.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"

namespace canyon::fusion {
namespace {

const Geodetic kReckonedPlace{45.0 * kDegree, 7.0 * kDegree, 200.0};

/// A log at rest, one sample each 10 ms.
std::vector<ImuSample> rest(const NavState& state, int samples) {
  std::vector<ImuSample> out;
  for (int k = 1; k <= samples; ++k) {
    ImuSample s;
    s.t = state.t + 0.01 * k;
    s.dt_s = 0.01;
    s.dtheta_U = 0.01 * (state.R_EU.conjugate() * earth_rate_E());
    s.dv_U = -0.01 * (state.R_EU.conjugate() * gravity_E(state.p_EU_E));
    out.push_back(s);
  }
  return out;
}

NavState start() {
  NavState state = levelled(kReckonedPlace, 30.0 * kDegree, {0.0, 0.0, 1.0});
  state.t = GpsTime::from_week_sow(1590, 1000.0);
  return state;
}

TEST(Levelled, PutsTheForceUpAndTheNoseOnItsHeading) {
  const Eigen::Vector3d force = Eigen::Vector3d(1.0, -2.0, 9.0);
  const NavState state = levelled(kReckonedPlace, 70.0 * kDegree, force);
  const Eigen::Matrix3d enu = rotation_E_from_enu(kReckonedPlace);
  const Eigen::Vector3d up = -gravity_E(state.p_EU_E).normalized();
  EXPECT_LT((state.R_EU * force.normalized() - up).norm(), 1e-15 * 10);
  EXPECT_NEAR(up.dot(enu.col(2)), 1.0, 1e-13);  // 1.6e-7 rad at 200 m, squared
  const Eigen::Vector3d nose = enu.transpose() * (state.R_EU * Eigen::Vector3d::UnitX());
  EXPECT_NEAR(std::atan2(nose.x(), nose.y()), 70.0 * kDegree, 2e-7);  // turned by that lean
}

TEST(DeadReckoning, StartsWhereItIsToldAndSkipsWhatIsBefore) {
  const NavState initial = start();
  std::vector<ImuSample> samples = rest(initial, 100);
  NavState later = initial;
  later.t = initial.t + 0.4;
  auto strapdown = make_strapdown("three_sample");
  const auto states = dead_reckon(samples, later, *strapdown);
  ASSERT_EQ(states.size(), 61u);
  EXPECT_EQ(states.front().t, later.t);
  EXPECT_EQ(states.back().t, samples.back().t);
  EXPECT_LT((states.back().p_EU_E - initial.p_EU_E).norm(), 1e-8);  // eps of 6.4e6 m
}

/// Samples that are missing: the one behind stands for the gap, so that a body at rest stays there.
TEST(DeadReckoning, BridgesAGap) {
  const NavState initial = start();
  std::vector<ImuSample> samples = rest(initial, 100);
  samples.erase(samples.begin() + 20, samples.begin() + 50);
  auto strapdown = make_strapdown("two_sample");
  const auto states = dead_reckon(samples, initial, *strapdown);
  ASSERT_EQ(states.size(), 71u);
  EXPECT_LT((states.back().p_EU_E - initial.p_EU_E).norm(), 1e-7);
  EXPECT_LT(states.back().v_EU_E.norm(), 1e-9);
}

TEST(Interpolation, IsExactOnCubicsAndAtTheEnds) {
  NavState a = start(), b = a;
  b.t = a.t + 0.1;
  // p = p0 + v t + c t^3
  const Eigen::Vector3d v(10.0, -3.0, 1.0), c(5.0, 7.0, -2.0);
  a.v_EU_E = v;
  b.p_EU_E = a.p_EU_E + 0.1 * v + 1e-3 * c;
  b.v_EU_E = v + 0.03 * c;
  const NavState middle = interpolate(a, b, a.t + 0.03);
  EXPECT_LT((middle.p_EU_E - (a.p_EU_E + 0.03 * v + 2.7e-5 * c)).norm(), 4e-9);  // a few eps of 6.4e6 m
  EXPECT_LT((interpolate(a, b, b.t).v_EU_E - b.v_EU_E).norm(), 1e-14);
}

TEST(NavigationErrors, AreEstimateMinusReference) {
  NavState truth = start(), estimate = truth;
  const Eigen::Matrix3d enu = rotation_E_from_enu(kReckonedPlace);
  estimate.p_EU_E += enu * Eigen::Vector3d(1.0, 2.0, -3.0);
  estimate.v_EU_E += enu * Eigen::Vector3d(0.1, -0.2, 0.3);
  estimate.R_EU = truth.R_EU * so3_exp({0.01, 0.02, -0.03});
  std::vector<NavState> estimates = {estimate, estimate, estimate}, truths = {truth, truth, truth};
  for (int i = 0; i < 3; ++i)
    estimates[static_cast<std::size_t>(i)].t = truths[static_cast<std::size_t>(i)].t = truth.t + 1.0 * i;
  const auto errors = navigation_errors(estimates, truths);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_LT((errors[1].position_enu_m - Eigen::Vector3d(1.0, 2.0, -3.0)).norm(), 1e-8);
  EXPECT_LT((errors[1].velocity_enu_m_s - Eigen::Vector3d(0.1, -0.2, 0.3)).norm(), 1e-14);
  EXPECT_LT((errors[1].attitude_rad - Eigen::Vector3d(0.01, 0.02, -0.03)).norm(), 1e-14);
  const NavErrorStatistics s = navigation_error_statistics(errors);
  EXPECT_NEAR(s.position_rms_m, std::sqrt(14.0), 1e-8);
  EXPECT_NEAR(s.final_horizontal_m, std::sqrt(5.0), 1e-8);
  EXPECT_TRUE(std::isnan(navigation_error_statistics(std::span(errors).first(1)).position_rms_m));
}

// 2026-11-22: of a sample whose interval held the start all was taken, also what was before it.
TEST(DeadReckoning, TakesTheShareOfASampleThatIsBehindTheStart) {
  const NavState initial = start();
  std::vector<ImuSample> samples = rest(initial, 100);
  for (ImuSample& s : samples) s.dv_U += 0.01 * (initial.R_EU.conjugate() * Eigen::Vector3d(1.0, 0.0, 0.0));  // 1 m/s^2
  NavState later = initial;
  later.t = initial.t + 0.003;  // at rest there, in the middle of the first sample
  auto strapdown = make_strapdown("two_sample");
  const auto states = dead_reckon(samples, later, *strapdown);
  ASSERT_EQ(states.size(), 101u);
  // a t^2 / 2 of 0.997 s; Coriolis and Schuler take 1e-4 of it.
  EXPECT_NEAR((states.back().p_EU_E - initial.p_EU_E).norm(), 0.5 * 0.997 * 0.997, 1e-4);
  EXPECT_NEAR(states.back().v_EU_E.norm(), 0.997, 1e-4 * 0.997);
}

}  // namespace
}  // namespace canyon::fusion
