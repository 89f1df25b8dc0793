#include "canyon/fusion/states/state_block.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/fusion/error_state.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/propagation/error_propagation.h"
#include "canyon/fusion/stress/at_rest.h"

namespace canyon::fusion {
namespace {

const FilterConfig kDefaults;

TEST(StateBlocks, BiasesCarryTurnOnAndInRunInOneState) {
  TriadNoise n;
  n.turn_on_bias_sigma = 3.0;
  n.in_run_bias_sigma = 0.1;
  n.in_run_bias_tau_s = 100.0;
  const auto both = make_biases({.noise = {.gyro = n, .accel = {}}});
  EXPECT_NEAR(both->variance(0), 9.01, 1e-14);
  // Driven at the in-run rate: variance 2 * 0.01 / 100 per second; but it outlives the in-run correlation time.
  EXPECT_NEAR(both->process(0).density, 2e-4, 1e-18);
  EXPECT_NEAR(both->process(0).tau_s, 90100.0, 1e-9);
  EXPECT_EQ(both->variance(3), 0.0);

  n.turn_on_bias_sigma = 0.0;
  const auto wandering = make_biases({.noise = {.gyro = {}, .accel = n}});
  EXPECT_EQ(wandering->process(5).tau_s, 100.0);  // then it is the Gauss-Markov process itself
  n = {};
  n.turn_on_bias_sigma = 2.0;
  const auto constant = make_biases({.noise = {.gyro = n, .accel = n}});
  EXPECT_EQ(constant->process(0).density, 0.0);  // and a random constant
  EXPECT_EQ(constant->variance(0), 4.0);
}

TEST(StateBlocks, BiasesMayBeSplit) {
  TriadNoise n;
  n.turn_on_bias_sigma = 3.0;
  n.in_run_bias_sigma = 0.1;
  n.in_run_bias_tau_s = 100.0;
  ErrorState state({"turn_on_biases", "in_run_biases"}, kDefaults.own, {.noise = {.gyro = n, .accel = n}});
  EXPECT_EQ(state.size(), 21);
  EXPECT_EQ(state.padded_size(), 24);
  EXPECT_EQ(state.offset("turn_on_biases"), 9);
  EXPECT_EQ(state.offset("in_run_biases"), 15);
  EXPECT_EQ(state.offset("gains"), -1);
  state.start({});
  Eigen::VectorXd error = Eigen::VectorXd::Zero(24);
  error[9] = 1.0;
  error[15] = 0.25;
  error[20] = -2.0;
  state.inject(error);
  EXPECT_EQ(state.calibration().gyro_bias, Eigen::Vector3d(1.25, 0, 0));
  EXPECT_EQ(state.calibration().accel_bias, Eigen::Vector3d(0, 0, -2.0));
}

TEST(StateBlocks, WhatTheImuDoesNotHaveIsNotCarried) {
  ImuNoise noise;
  EXPECT_EQ(ErrorState({"biases", "gains"}, kDefaults.own, {.noise = noise}).size(), 15);
  noise.accel.scale_sigma = 1e-4;
  EXPECT_EQ(ErrorState({"biases", "gains"}, kDefaults.own, {.noise = noise}).size(), 33);
  EXPECT_EQ(ErrorState({"biases"}, kDefaults.own, {.noise = noise}).size(), 15);
  EXPECT_EQ(ErrorState({}, kDefaults.own, {.noise = noise}).size(), 9);
}

// The clock is the integral of its rate: after T, of the two random walks, q1 T + q2 T^3 / 3 and q2 T^2 / 2.
TEST(StateBlocks, TheClockIsTheIntegralOfItsRate) {
  const FilterConfig c = configured(
      "clock_sigma_m = 3\nclock_rate_sigma_m_s = 2\nclock_walk_m_per_sqrt_s = 0.5\n"
      "clock_rate_walk_m_s_per_sqrt_s = 0.2");
  ErrorState state({"receiver_clock"}, c.own, {});
  ErrorPropagation propagation(state, {});
  NavState at;
  at.p_EU_E = {6378137.0, 0.0, 0.0};
  state.start(at);
  const int n = state.padded_size(), clock = state.offset("receiver_clock");
  ErrorMatrix P = ErrorMatrix::Zero(n, n);
  P(clock, clock) = 9.0;
  P(clock + 1, clock + 1) = 4.0;
  ErrorMatrix moved = ErrorMatrix::Identity(n, n);
  propagation.set_interval(0.01);
  for (int k = 0; k < 500; ++k) {
    propagation.set_step(state, {.dt_s = 0.01}, {}, Eigen::Matrix3d::Zero());
    propagation.propagate(P);
    propagation.move(moved);
  }
  constexpr double T = 5.0, q1 = 0.25, q2 = 0.04;
  // Sums of 500 terms.
  EXPECT_NEAR(P(clock, clock), 9.0 + 4.0 * T * T + q1 * T + q2 * T * T * T / 3.0, 1e-11);
  EXPECT_NEAR(P(clock, clock + 1), 4.0 * T + q2 * T * T / 2.0, 1e-11);
  EXPECT_NEAR(P(clock + 1, clock + 1), 4.0 + q2 * T, 1e-12);
  EXPECT_NEAR(moved(clock, clock + 1), T, 1e-12);
  EXPECT_EQ(P, P.transpose().eval());
  // And so are the values.
  Eigen::VectorXd error = Eigen::VectorXd::Zero(n);
  error[clock + 1] = 2.0;
  state.inject(error);
  state.fade(propagation.decay(), 0.5);
  EXPECT_EQ(state.values(clock, 2), Eigen::Vector2d(1.0, 2.0));
}

TEST(StateBlocks, RowsThatNeedOneAnotherAreTold) {
  const auto told = [](const std::string& keys) {
    const Status status = check_parts(filter_parts(configured(keys)));
    return status.ok() ? std::string() : status.error().str();
  };
  EXPECT_EQ(told(""), "");
  EXPECT_EQ(told("filter = \"vehicle\""), "");
  EXPECT_EQ(
      told("measurements = [\"ranges\"]"),
      "fusion.measurements: \"ranges\" without state \"receiver_clock\", expected \"receiver_clock\" in fusion.states");
  EXPECT_EQ(told("measurements = [\"relative_pose\"]"),
            "fusion.measurements: \"relative_pose\" without state \"clone\", expected \"clone\" in fusion.states");
}

}  // namespace
}  // namespace canyon::fusion
