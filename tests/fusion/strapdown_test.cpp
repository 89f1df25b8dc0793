#include "canyon/fusion/strapdown.h"

#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"

namespace canyon::fusion {
namespace {

Eigen::Quaterniond earth_turn(double t_s) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(Wgs84::rate_rad_s * t_s, Eigen::Vector3d::UnitZ()));
}

/// Free fall: with only the centrifugal term as "gravity", inertial space is empty and E is merely a turning frame.
Eigen::Vector3d only_centrifugal_E(const Eigen::Vector3d& p_E) {
  return -earth_rate_E().cross(earth_rate_E().cross(p_E));
}

TEST(Strapdown, AtRestStaysAtRest) {
  // One hour at 100 Hz of exact increments: force up, Earth rate. Attitude tilted, so that no axis is special.
  const LocalFrame frame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
  NavState state;
  state.p_EU_E = frame.origin_E();
  state.R_EU = (Eigen::Quaterniond(frame.R_EW()) * rotation_from({.yaw_rad = 1.0, .pitch_rad = 0.2, .roll_rad = -0.4}))
                   .normalized();
  const NavState start = state;
  const Increments rest{.dt_s = 0.01,
                        .dtheta_U = 0.01 * (state.R_EU.conjugate() * earth_rate_E()),
                        .dv_U = -0.01 * (state.R_EU.conjugate() * gravity_E(state.p_EU_E))};
  auto strapdown = make_strapdown("two_sample");
  for (int k = 0; k < 360000; ++k) strapdown->advance(state, rest);
  const Eigen::Vector3d drift_W = frame.R_EW().transpose() * (state.p_EU_E - start.p_EU_E);
  std::printf("at rest, 1 h: %.1e m horizontal, %.1e m vertical, %.1e deg\n", drift_W.head<2>().norm(), drift_W.z(),
              state.R_EU.angularDistance(start.R_EU) / kDegree);
  EXPECT_LT(drift_W.head<2>().norm(), 1e-3);
  EXPECT_LT(std::abs(drift_W.z()), 1e-2);  // the vertical channel grows as exp(t / 570 s)
  EXPECT_LT(state.R_EU.angularDistance(start.R_EU), 1e-8 * kDegree);
}

/// Classical coning, q = [cos a/2, sin a/2 cos Wt, sin a/2 sin Wt, 0]. Increments are exact integrals of its rate. What
/// an algorithm leaves is a rotation about z, in closed form with x = W h:
///   none:        (W - sin(x) / h) sin^2(a) / 2
///   two-sample:  that minus (4 sin^2(a) sin^2(x/2)) sin(x) / (12 h), which to leading order is W sin^2(a) x^4 / 60.
TEST(Strapdown, ConingLeavesWhatTheClosedFormsSay) {
  const double a = 0.01, rate = 2.0 * kPi * 10.0, h = 0.005, x = rate * h;
  const double s2 = std::sin(a) * std::sin(a);
  const double none = 0.5 * s2 * (rate - std::sin(x) / h);
  const double two = none - 4.0 * s2 * std::pow(std::sin(0.5 * x), 2) * std::sin(x) / (12.0 * h);
  EXPECT_NEAR(two / (rate * s2 * std::pow(x, 4) / 60.0), 1.0, x * x);
  const double first_step = (none - two) * h;  // has no predecessor and goes uncorrected
  const struct {
    const char* name;
    double drift_rad_s, extra_rad;
  } rows[] = {
      {"euler", none, 0.0}, {"trapezoid", none, 0.0}, {"constant_rate", none, 0.0}, {"two_sample", two, first_step}};
  for (const auto& row : rows) {
    auto strapdown = make_strapdown(row.name, only_centrifugal_E);
    const auto attitude = [&](double t) {
      return Eigen::Quaterniond(std::cos(a / 2), std::sin(a / 2) * std::cos(rate * t),
                                std::sin(a / 2) * std::sin(rate * t), 0.0);
    };
    NavState state;
    state.R_EU = attitude(0.0);
    const int n = 4000;  // 20 s, 200 periods
    for (int k = 0; k < n; ++k) {
      const double t0 = k * h, t1 = t0 + h;
      Increments in;
      in.dt_s = h;
      in.dtheta_U = {std::sin(a) * (std::cos(rate * t1) - std::cos(rate * t0)),
                     std::sin(a) * (std::sin(rate * t1) - std::sin(rate * t0)),
                     -2.0 * rate * std::pow(std::sin(a / 2), 2) * h};
      strapdown->advance(state, in);
    }
    const Eigen::Quaterniond R_IU = earth_turn(n * h) * state.R_EU;
    const Eigen::Vector3d error = so3_log(R_IU * attitude(n * h).conjugate());
    const double expected = row.drift_rad_s * n * h + row.extra_rad;
    EXPECT_NEAR(std::abs(error.z()) / expected, 1.0, 10.0 * a * a) << row.name;  // leading terms in a
    EXPECT_LT(error.head<2>().norm(), 0.02 * std::abs(error.z()) + 1e-9) << row.name;
  }
}

/// The same motion and three_sample, whose quadratics through D1, D2, D3 correct by (121 D2xD3 - 31 D1xD3 + D1xD2) /
/// 720; with DixDj = 4 sin^2(a) sin^2(x/2) sin((j - i) x) it leaves -19/720 W sin^2(a) x^4 to leading order: on pure
/// coning somewhat more than two_sample's 12/720, as it is made for smooth motion.
TEST(Strapdown, ConingOfThreeSamples) {
  const double a = 0.01, rate = 2.0 * kPi * 10.0, s2 = std::sin(a) * std::sin(a);
  const auto drift_rad_s = [&](double h) {
    auto strapdown = make_strapdown("three_sample", only_centrifugal_E);
    const auto attitude = [&](double t) {
      return Eigen::Quaterniond(std::cos(a / 2), std::sin(a / 2) * std::cos(rate * t),
                                std::sin(a / 2) * std::sin(rate * t), 0.0);
    };
    NavState state;
    const int n = static_cast<int>(std::lround(20.0 / h));
    for (int k = -2; k < n; ++k) {
      if (k == 0) {
        state = NavState{};
        state.R_EU = attitude(0.0);
      }
      const double t0 = k * h, t1 = t0 + h;
      Increments in;
      in.dt_s = h;
      in.dtheta_U = {std::sin(a) * (std::cos(rate * t1) - std::cos(rate * t0)),
                     std::sin(a) * (std::sin(rate * t1) - std::sin(rate * t0)),
                     -2.0 * rate * std::pow(std::sin(a / 2), 2) * h};
      strapdown->advance(state, in);
    }
    return so3_log(earth_turn(20.0) * state.R_EU * attitude(20.0).conjugate()).z() / 20.0;
  };
  for (const double h : {0.005, 0.0025}) {
    const double x = rate * h, cross = 4.0 * s2 * std::pow(std::sin(0.5 * x), 2);
    const double left =
        0.5 * s2 * (rate - std::sin(x) / h) - cross * (122.0 * std::sin(x) - 31.0 * std::sin(2.0 * x)) / (720.0 * h);
    EXPECT_NEAR(left / (-19.0 / 720.0 * rate * s2 * std::pow(x, 4)), 1.0, x * x);
    EXPECT_NEAR(std::abs(drift_rad_s(h) / left), 1.0, 10.0 * a * a) << h;  // leading terms in a
  }
}

/// Rate and force constant in U, at any angle: velocity against a fine Gauss quadrature of the turning force.
TEST(Strapdown, ConstantRateIsExact) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized(), force(3.0, 4.0, -12.0);
  for (const double angle : {0.0, 1e-7, 1e-3, 0.0999, 0.1001, 1.0, 3.0, 6.0}) {
    const double h = 0.1;
    auto strapdown = make_strapdown("constant_rate", only_centrifugal_E);
    NavState state;
    const InertialStep step = strapdown->advance(state, {.dt_s = h, .dtheta_U = angle * axis, .dv_U = h * force});
    Eigen::Vector3d dv = Eigen::Vector3d::Zero(), dp = dv;
    constexpr int kPanels = 200;
    for (int i = 0; i < kPanels; ++i) {
      for (const double node : {0.5 - std::sqrt(15.0) / 10.0, 0.5, 0.5 + std::sqrt(15.0) / 10.0}) {
        const double u = (i + node) / kPanels, weight = h / kPanels * (node == 0.5 ? 4.0 : 2.5) / 9.0;
        const Eigen::Vector3d turned = so3_exp(u * angle * axis) * force;
        dv += weight * turned;
        dp += weight * h * (1.0 - u) * turned;
      }
    }
    EXPECT_LT((step.dv_start_U - dv).norm(), 1e-14 * 13.0) << angle;
    // Position is moved in E, which turns by 7e-6 rad meanwhile.
    EXPECT_LT((state.p_EU_E - dp).norm(), 2.0 * Wgs84::rate_rad_s * h * dp.norm() + 1e-15) << angle;
  }
}

/// Classical sculling: angle a sin(Wt) about x, force c sin(Wt) along y of the turning frame; the mean acceleration
/// along the inertial z is c J1(a), exactly.
TEST(Strapdown, ScullingGivesTheBesselAcceleration) {
  const double a = 0.02, c = 5.0, rate = 2.0 * kPi * 10.0;
  const auto relative_error = [&](const char* name, double h) {
    auto strapdown = make_strapdown(name, only_centrifugal_E);
    NavState state;
    const int n = static_cast<int>(std::lround(10.0 / h));
    for (int k = 0; k < n; ++k) {
      const double t0 = k * h, t1 = t0 + h;
      Increments in;
      in.dt_s = h;
      in.dtheta_U = {a * (std::sin(rate * t1) - std::sin(rate * t0)), 0.0, 0.0};
      in.dv_U = {0.0, c / rate * (std::cos(rate * t0) - std::cos(rate * t1)), 0.0};
      strapdown->advance(state, in);
    }
    const Eigen::Vector3d v_I = earth_turn(10.0) * (state.v_EU_E + earth_rate_E().cross(state.p_EU_E));
    const double expected = c * std::cyl_bessel_j(1.0, a) * 10.0;
    return v_I.z() / expected - 1.0;
  };
  const double coarse = relative_error("two_sample", 0.005), fine = relative_error("two_sample", 0.0025);
  std::printf("sculling: relative error %.1e at 200 Hz, %.1e at 400 Hz; euler %.1e\n", coarse, fine,
              relative_error("euler", 0.005));
  EXPECT_LT(std::abs(coarse), std::pow(rate * 0.005, 4));
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.3);
  for (const double h : {0.005, 0.0025}) {
    const double x = rate * h, three = relative_error("three_sample", h);
    std::printf("sculling with three_sample: relative error %.1e at %.0f Hz\n", three, 1.0 / h);
    EXPECT_NEAR(three / (19.0 / 360.0 * std::pow(x, 4)), 1.0, 2.0 * x * x) << h;  // as for coning, to leading order
  }
  const double x2 = std::pow(rate * 0.005, 2);  // without any correction: x^2 / 6 to leading order
  EXPECT_NEAR(std::abs(relative_error("euler", 0.005)) / (x2 / 6.0), 1.0, x2);
}

TEST(Strapdown, TableAndNames) {
  EXPECT_THAT(strapdown_names(),
              ::testing::ElementsAre("euler", "trapezoid", "constant_rate", "two_sample", "three_sample"));
  EXPECT_THROW((void)make_strapdown("eulr"), ProgramError);
}

TEST(Strapdown, ResetForgetsThePast) {
  NavState a, b;
  a.p_EU_E = b.p_EU_E = {6378137.0, 0.0, 0.0};
  const Increments first{.dt_s = 0.01, .dtheta_U = {0.01, 0.0, 0.0}, .dv_U = {0.1, 0.0, 0.0}};
  const Increments second{.dt_s = 0.01, .dtheta_U = {0.0, 0.01, 0.0}, .dv_U = {0.0, 0.1, 0.0}};
  auto with_past = make_strapdown("two_sample"), without = make_strapdown("two_sample");
  NavState scratch = a;
  with_past->advance(scratch, first);
  const InertialStep coned = with_past->advance(a, second);
  EXPECT_EQ(coned.rotation_U, Eigen::Vector3d(0.0, 0.01, 1e-4 / 12.0));
  with_past->reset();
  scratch = a;
  const InertialStep x = with_past->advance(scratch, second);
  const InertialStep y = without->advance(b, second);
  EXPECT_EQ(x.rotation_U, y.rotation_U);
  EXPECT_EQ(x.dv_start_U, y.dv_start_U);
}

}  // namespace
}  // namespace canyon::fusion
