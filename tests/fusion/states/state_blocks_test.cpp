#include "canyon/fusion/states/state_block.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/fusion/error_state.h"
#include "canyon/fusion/filter_config.h"

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

}  // namespace
}  // namespace canyon::fusion
