// State blocks by their parameters, and what a state holds as a whole.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/error_state.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/states/receiver_clock.h"
#include "canyon/fusion/states/state_block.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/block_rows.h"
#include "canyon/fusion/stress/parts/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using stress::kInfinity;
using stress::Looks;

ImuNoise block_noise() {
  ImuNoise n;
  n.gyro = {.white_per_sqrt_hz = 1e-4,
            .turn_on_bias_sigma = 3e-3,
            .in_run_bias_sigma = 4e-4,
            .in_run_bias_tau_s = 250.0,
            .scale_sigma = 2e-3,
            .misalignment_sigma_rad = 5e-3};
  n.accel = {.white_per_sqrt_hz = 2e-3,
             .turn_on_bias_sigma = 0.05,
             .in_run_bias_sigma = 0.02,
             .in_run_bias_tau_s = 90.0,
             .scale_sigma = 7e-4,
             .misalignment_sigma_rad = 1e-3};
  return n;
}

/// What one state of a block should be.
struct Expected {
  double sigma, tau_s, density;
};
Expected constant(double sigma) {
  return {sigma, kInfinity, 0.0};
}
Expected markov(double sigma, double tau_s) {
  return {sigma, tau_s, 2.0 * sigma * sigma / tau_s};
}
Expected walk(double sigma, double per_root_s) {
  return {sigma, kInfinity, per_root_s * per_root_s};
}

struct BlockRow {
  const char* block;
  const char* keys;
  std::vector<Expected> states;
};

/// Each block with what it is when nobody says otherwise, and as its keys say: sizes, sigmas, times and densities.
StressFigure blocks() {
  Looks looks;
  const ImuNoise n = block_noise();
  const auto both = [](const Expected& gyro, const Expected& accel) {
    return std::vector<Expected>{gyro, gyro, gyro, accel, accel, accel};
  };
  // A constant and a process in one: the density of the process, the variance of both.
  const auto merged = [](const TriadNoise& t) {
    const double variance = t.turn_on_bias_sigma * t.turn_on_bias_sigma + t.in_run_bias_sigma * t.in_run_bias_sigma,
                 density = 2.0 * t.in_run_bias_sigma * t.in_run_bias_sigma / t.in_run_bias_tau_s;
    return Expected{std::sqrt(variance), 2.0 * variance / density, density};
  };
  const auto gains = [&](double tau_s) {
    std::vector<Expected> out;
    for (const TriadNoise* t : {&n.gyro, &n.accel})
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
          const double sigma = row == column ? t->scale_sigma : t->misalignment_sigma_rad;
          out.push_back(tau_s > 0.0 ? markov(sigma, tau_s) : constant(sigma));
        }
    return out;
  };
  const auto times = [](std::size_t count, const Expected& e) { return std::vector<Expected>(count, e); };
  const auto clock = [](double m, double m_s, double walk_m, double walk_m_s, double system_m) {
    return std::vector<Expected>{walk(m, walk_m), walk(m_s, walk_m_s), constant(system_m), constant(system_m),
                                 constant(system_m)};
  };
  const double degree = kPi / 180.0;
  const std::vector<BlockRow> rows = {
      {"biases", "", both(merged(n.gyro), merged(n.accel))},
      {"turn_on_biases", "", both(constant(3e-3), constant(0.05))},
      {"in_run_biases", "", both(markov(4e-4, 250.0), markov(0.02, 90.0))},
      {"gains", "", gains(0.0)},
      {"gains", "imu_gain_tau_s = 60", gains(60.0)},
      {"mounting", "", times(3, walk(degree, 0.1 * degree / 60.0))},
      {"mounting", "mounting_sigma_deg = 3\nmounting_walk_deg_per_sqrt_hr = 2",
       times(3, walk(3.0 * degree, 2.0 * degree / 60.0))},
      {"antenna_lever", "", times(3, constant(0.1))},
      {"antenna_lever", "antenna_lever_sigma_m = 0.4", times(3, constant(0.4))},
      {"time_offset", "", times(1, constant(0.05))},
      {"time_offset", "time_offset_sigma_s = 0.2", times(1, constant(0.2))},
      {"receiver_clock", "", clock(100.0, 300.0, 0.1, 0.1, 100.0)},
      {"receiver_clock",
       "clock_sigma_m = 7\nclock_rate_sigma_m_s = 5\nclock_walk_m_per_sqrt_s = 0.3\nclock_rate_walk_m_s_per_sqrt_s = "
       "0.2\nsystem_time_sigma_m = 11",
       clock(7.0, 5.0, 0.3, 0.2, 11.0)},
      {"range_errors", "", times(24, markov(1.0, 60.0))},
      {"range_errors", "range_error_slots = 7\nrange_error_tau_s = 15", times(7, markov(1.0, 15.0))},
      {"barometer_bias", "", times(1, markov(50.0, 7200.0))},
      {"barometer_bias", "barometer_bias_sigma_m = 9\nbarometer_bias_tau_s = 400", times(1, markov(9.0, 400.0))},
      {"hard_iron", "", times(3, constant(5.0))},
      {"hard_iron", "hard_iron_sigma_ut = 2", times(3, constant(2.0))},
      {"clone", "", times(6, constant(0.0))},
      {"wheel_scale", "", times(1, constant(0.01))},
      {"wheel_scale", "wheel_scale_sigma_percent = 4", times(1, constant(0.04))},
      {"fix_error", "fix_error_sigma_m = 0.7\nfix_error_tau_s = 12", times(3, markov(0.7, 12.0))},
      {"velocity_error", "velocity_error_tau_s = 4", times(3, markov(1.0, 4.0))}};
  std::vector<std::string> seen;
  for (const BlockRow& row : rows) {
    const auto block = model_row(state_blocks(), row.block).make(configured(row.keys).own, {.noise = n});
    if (!block || block->size() != static_cast<int>(row.states.size())) return {kInfinity, 1.0};
    seen.emplace_back(row.block);
    for (int i = 0; i < block->size(); ++i) {
      const Expected& e = row.states[static_cast<std::size_t>(i)];
      looks.close(block->variance(i), e.sigma * e.sigma, 16.0);
      looks.close(block->process(i).density, e.density, 32.0);
      looks.right(std::isinf(e.tau_s) ? std::isinf(block->process(i).tau_s)
                                      : std::abs(block->process(i).tau_s / e.tau_s - 1.0) < 1e-14);
      const bool clock_itself = std::string(row.block) == "receiver_clock" && i == 0;
      looks.right(block->integral_of(i) == (clock_itself ? 1 : -1));
    }
  }
  for (const auto& row : state_blocks()) looks.right(std::find(seen.begin(), seen.end(), row.name) != seen.end());
  // Without any such error there is nothing to estimate; with one kind of one triad there is.
  ImuNoise bare;
  looks.right(model_row(state_blocks(), "gains").make(FilterConfig().own, {.noise = bare}) == nullptr);
  for (double TriadNoise::*sigma : {&TriadNoise::scale_sigma, &TriadNoise::misalignment_sigma_rad})
    for (const bool gyro : {true, false}) {
      ImuNoise one;
      TriadNoise& triad = gyro ? one.gyro : one.accel;
      triad.*sigma = 1e-3;
      looks.right(model_row(state_blocks(), "gains").make(FilterConfig().own, {.noise = one}) != nullptr);
    }
  ImuNoise still;
  still.gyro.turn_on_bias_sigma = 0.2;
  const auto held = model_row(state_blocks(), "biases").make(FilterConfig().own, {.noise = still});
  looks.right(std::isinf(held->process(0).tau_s) && held->process(0).density == 0.0);
  looks.close(held->variance(1), 0.04, 4.0), looks.right(held->variance(4) == 0.0);
  looks.right(ClockIndex::of(GnssSystem::kGps) == -1 && ClockIndex::of(GnssSystem::kGlonass) == 2 &&
              ClockIndex::of(GnssSystem::kGalileo) == 3 && ClockIndex::of(GnssSystem::kBeidou) == 4 &&
              ClockIndex::of(GnssSystem::kQzss) == -1);
  return looks.figure();
}

/// What a state holds as a whole: what each block feeds and says of the IMU, renewals, fades and integrals, and the
/// corrections of what is measured.
StressFigure whole_state() {
  Looks looks;
  DrawnNumbers draw(4);
  ErrorState state({"gains", "biases", "receiver_clock", "mounting", "clone"}, FilterConfig().own,
                   {.noise = block_noise()});
  looks.right(state.size() == 9 + 18 + 6 + 5 + 3 + 6 && state.padded_size() == 48 && state.offset("gains") == 9 &&
              state.offset("biases") == 27 && state.offset("receiver_clock") == 33 && state.mounting() == 38 &&
              state.offset("fix_error") == -1);
  NavState nav;
  nav.p_EU_E = Vector3d(1.0, 2.0, 3.0), nav.v_EU_E = Vector3d(4.0, 5.0, 6.0);
  state.start(nav);
  looks.right(state.integrals().size() == 1 && state.integrals()[0].integral == 33 && state.integrals()[0].of == 34);
  VectorXd error = VectorXd::Zero(48);
  for (int i = 0; i < 47; ++i) error[i] = 0.01 * draw.next();
  state.take_clone();
  const VectorXd clone_error = error.segment(41, 6);
  state.inject(error);
  looks.near((state.nav.p_EU_E - nav.p_EU_E - error.segment<3>(3)).norm() +
                 (state.nav.v_EU_E - nav.v_EU_E - error.segment<3>(6)).norm(),
             0.0, 1e-14);
  looks.near(so3_log(state.nav.R_EU).cwiseAbs().sum(), error.head<3>().cwiseAbs().sum(), 1e-14);
  looks.near((so3_log(state.clone()->R_EU) - clone_error.head<3>()).norm() +
                 (state.clone()->p_EU_E - nav.p_EU_E - clone_error.tail<3>()).norm(),
             0.0, 1e-14);
  looks.near((state.values(9, 32) - error.segment(9, 32)).norm() + state.values(41, 6).norm(), 0.0, 1e-15);
  looks.near((state.R_UB() - so3_exp(error.segment<3>(38)).toRotationMatrix()).norm(), 0.0, 1e-15);
  looks.near((state.mounting_jacobian() - so3_right_jacobian(error.segment<3>(38))).norm(), 0.0, 1e-15);
  // Gains row by row, then biases; and the mean over a step.
  VectorXd share = VectorXd::Ones(48);
  for (int i = 9; i < 33; ++i) share[i] = 0.5 + 0.01 * i;
  const Calibration at_once = state.calibration(), over = state.step_calibration(share);
  for (const auto& [imu, by] : {std::pair(&at_once, VectorXd(VectorXd::Ones(48))), std::pair(&over, share)}) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        looks.near(imu->gyro_gain(i, j), error[9 + 3 * i + j] * by[9 + 3 * i + j], 1e-16);
        looks.near(imu->accel_gain(i, j), error[18 + 3 * i + j] * by[18 + 3 * i + j], 1e-16);
      }
    looks.near((imu->gyro_bias - error.segment<3>(27).cwiseProduct(by.segment<3>(27))).norm(), 0.0, 1e-16);
    looks.near((imu->accel_bias - error.segment<3>(30).cwiseProduct(by.segment<3>(30))).norm(), 0.0, 1e-16);
    looks.near((imu->gyro_inverse * (Matrix3d::Identity() + imu->gyro_gain) - Matrix3d::Identity()).norm(), 0.0, 1e-14);
    looks.near((imu->accel_inverse * (Matrix3d::Identity() + imu->accel_gain) - Matrix3d::Identity()).norm(), 0.0,
               1e-14);
    // A unit of these errors measures what it is given back.
    const Vector3d w = draw.three(), f = draw.three();
    const Increments back = imu->apply(0.02, 0.02 * (w + imu->gyro_gain * w + imu->gyro_bias),
                                       0.02 * (f + imu->accel_gain * f + imu->accel_bias));
    looks.near((back.dtheta_U - 0.02 * w).norm() + (back.dv_U - 0.02 * f).norm(), 0.0, 1e-15);
    looks.right(back.dt_s == 0.02);
  }
  // Feeds: by the unit's own rates and forces, each axis its row.
  const Increments in{.dt_s = 0.02, .dtheta_U = draw.three(), .dv_U = draw.three()};
  MatrixXd fed = MatrixXd::Zero(6, 48), expected = MatrixXd::Zero(6, 48);
  for (const Feed& feed : state.feeds(in)) fed(feed.axis, feed.state) += feed.rate;
  for (int axis = 0; axis < 6; ++axis) {
    for (int j = 0; j < 3; ++j) expected(axis, 9 + 3 * axis + j) = (axis < 3 ? in.dtheta_U : in.dv_U)[j] / 0.02;
    expected(axis, 27 + axis) = 1.0;
  }
  looks.near((fed - expected).norm(), 0.0, 1e-12);
  VectorXd decay = VectorXd::Ones(48);
  decay[28] = 0.25, decay[30] = 0.5;
  state.renew(29, 0.3);
  state.fade(decay, 2.0);
  looks.near(state.values(28, 1)[0], 0.25 * error[28], 1e-16),
      looks.near(state.values(30, 1)[0], 0.5 * error[30], 1e-16);
  looks.near(state.values(29, 1)[0], 0.3 * error[29], 1e-16),
      looks.near(state.values(33, 1)[0], error[33] + 2.0 * error[34], 1e-16);
  looks.close(state.first_variance(9), 4e-6, 8.0), looks.close(state.first_variance(10), 2.5e-5, 8.0),
      looks.close(state.first_variance(34), 9e4, 8.0);
  looks.right(state.first_variance(3) == 0.0 && state.first_variance(47) == 0.0);
  state.start(nav);
  looks.right(state.values(9, 32).isZero(0.0) && !state.clone() && state.R_UB() == Matrix3d::Identity());
  return looks.figure();
}

}  // namespace

std::vector<StressCase> state_block_cases() {
  StressRows rows = block_rows();
  rows.add("states/blocks", blocks).add("states/whole_state", whole_state);
  return rows.take();
}

}  // namespace canyon::fusion
