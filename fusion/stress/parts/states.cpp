// State blocks by their parameters, the moments of their processes, the step that moves errors, and the loops that it
// is made of: each against its definition.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/error_state.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/measurements/satellite_slots.h"
#include "canyon/fusion/propagation/markov_moments.h"
#include "canyon/fusion/propagation/row_kernels.h"
#include "canyon/fusion/propagation/step_jacobian.h"
#include "canyon/fusion/states/fix_error.h"
#include "canyon/fusion/states/range_errors.h"
#include "canyon/fusion/states/receiver_clock.h"
#include "canyon/fusion/states/state_block.h"
#include "canyon/fusion/states/velocity_error.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/subjects.h"
#include "canyon/fusion/timeline/filter_timeline.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using stress::kEpsilon;
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

/// Sizes of what lasts of fixes, velocities and pseudoranges by their definitions: squares of shares are covariances,
/// along the axes of what is stated; growth by decades between its ends.
StressFigure lasting_errors() {
  Looks looks;
  DrawnNumbers draw(6);
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix3d stated = draw.positive(3, 0.1);
    for (const double power : {1.0, 2.0, 0.5}) {
      FixErrorParameters p;
      p.fix_error_sigma_m = 0.4, p.fix_error_scale = 1.7, p.fix_error_power = power;
      const Matrix3d C = p.covariance(stated), S = p.share(stated);
      looks.near((S * S * 0.16 - C).norm() / C.norm(), 0.0, 1e-12),
          looks.near((S - S.transpose()).norm(), 0.0, 1e-13 * S.norm());
      const Matrix3d grown = (C - 0.16 * Matrix3d::Identity()) / (1.7 * 1.7);
      // To the power one it is what is stated, to two its square; of one half its root.
      const Matrix3d expected = power == 1.0   ? stated
                                : power == 2.0 ? Matrix3d(stated * stated)
                                               : Matrix3d(grown * grown);
      looks.near(((power == 0.5 ? stated : grown) - expected).norm() / expected.norm(), 0.0, 1e-11);
      p.fix_error_scale = 0.0;
      looks.right(p.share(stated) == Matrix3d::Identity());
    }
    VelocityErrorParameters v;
    v.velocity_error_scale = 0.7, v.velocity_error_up_scale = 3.0;
    const Vector3d up = draw.three().normalized();
    const Matrix3d S = v.share(stated, up), along = up * up.transpose(), across = Matrix3d::Identity() - along;
    const Matrix3d stretched = 0.49 * (across + 3.0 * along) * stated * (across + 3.0 * along);
    looks.near((S * S - stretched).norm() / stretched.norm(), 0.0, 1e-12),
        looks.near((S - S.transpose()).norm(), 0.0, 1e-13 * S.norm());
  }
  const FixErrorParameters fix;
  const VelocityErrorParameters velocity;
  RangeErrorsParameters r;
  looks.right(fix.fix_error_sigma_m == 0.3 && fix.fix_error_scale == 1.5 && fix.fix_error_power == 1.5 &&
              fix.fix_error_tau_s == 20.0 && fix.fix_error_way_m == 1e9);
  looks.right(velocity.velocity_error_scale == 0.5 && velocity.velocity_error_up_scale == 6.0 &&
              velocity.velocity_error_tau_s == 2.0);
  looks.right(r.range_error_slots == 24 && r.range_error_sigma_m == 2.0 && r.range_error_decade_db == 14.0 &&
              r.range_error_most_m == 25.0 && r.range_error_mean == 1.0 && r.range_error_tau_s == 60.0 &&
              r.range_error_way_m == 50.0);
  for (const double cn0 : {60.0, 45.0, 38.0, 31.0, 30.0, 29.0, 10.0}) {
    const double grown = cn0 >= 45.0 ? 1.0 : std::pow(10.0, (45.0 - cn0) / 14.0), held = grown < 12.5 ? grown : 12.5;
    looks.close(r.growth(cn0), held, 16.0), looks.close(r.sigma_m(cn0), 2.0 * held, 16.0);
    looks.near(r.mean_m(cn0), 2.0 * held - 2.0, 1e-13);
  }
  r.range_error_mean = 0.4, r.range_error_most_m = 1.0;  // below the least: it stays that
  looks.close(r.growth(20.0), 1.0, 1.0), looks.near(r.mean_m(20.0), 0.0, 1e-300);
  r.range_error_most_m = 25.0;
  looks.near(r.mean_m(31.0), 0.4 * 18.0, 1e-12);
  return looks.figure();
}

/// Places of satellites: one that is seen keeps its own, a new one takes a free one, else that of the one not seen for
/// longest, and of this epoch none gives way.
StressFigure slots() {
  int wrong = 0;
  SatelliteSlots places(3);
  const auto sv = [](int prn) { return SatelliteId{GnssSystem::kGps, static_cast<std::uint8_t>(prn)}; };
  const auto epoch = [&](double t, std::initializer_list<int> prns) {
    GnssEpoch e{.t = GpsTime{} + t, .observations = {}};
    for (const int prn : prns) {
      GnssObservation o;
      o.sv = sv(prn);
      e.observations.push_back(o);
    }
    places.assign(e);
  };
  const auto stand = [&](std::vector<int> of, const std::vector<int>& begun) {
    for (int prn = 1; prn <= 9; ++prn) {
      const auto at = std::find(of.begin(), of.end(), prn);
      wrong += places.of(sv(prn)) == (at == of.end() ? -1 : static_cast<int>(at - of.begin())) ? 0 : 1;
    }
    wrong += places.begun() == begun ? 0 : 1;
  };
  wrong += places.count() == 3 && !places.taken(0) && places.of(sv(0)) == -1 ? 0 : 1;
  epoch(1.0, {5, 6}), stand({5, 6}, {0, 1});
  wrong += places.taken(1) && !places.taken(2) ? 0 : 1;
  epoch(2.0, {6, 7}), stand({5, 6, 7}, {2});
  epoch(3.0, {7, 8}), stand({8, 6, 7}, {0});              // 5 was seen first
  epoch(4.0, {9, 7}), stand({8, 9, 7}, {1});              // then 6
  epoch(5.0, {1, 2, 3, 4}), stand({1, 2, 3}, {0, 1, 2});  // 8 before 9 and 7, of which the first stands first
  epoch(6.0, {4, 3}), stand({4, 2, 3}, {0});
  places.clear();
  wrong += !places.taken(0) && places.of(sv(3)) == -1 && places.count() == 3 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Moments of a process within a step: what it carries in closed form, in 64 bits of mantissa, and what drives it by
/// Simpson's rule over 8000 parts of its response, which leaves (z / 8000)^4 of a fast one; of white noise the powers.
StressFigure moments() {
  Looks looks;
  for (const double dt : {0.01, 2.0})
    for (const double z : {1e-9, 1e-3, 0.3, 0.99, 1.01, 4.0, 30.0, 60.0}) {
      const double tau = dt / z;
      const MarkovMoments found(dt, tau);
      const auto response = [&](long double u) {
        const long double x = u / tau;
        // Integrals of e^-x: series where they cancel.
        std::array<long double, 4> out{std::exp(-x), 0.0L, 0.0L, 0.0L};
        for (int k = 1; k <= 3; ++k) {
          long double sum = 0.0L, term = 1.0L;
          for (int i = 1; i <= k; ++i) term /= i;
          if (x < 2.0L) {
            for (int i = 0; i < 40; ++i) sum += term, term *= -x / (k + 1 + i);
            out[static_cast<std::size_t>(k)] = sum * std::pow(u, static_cast<long double>(k));
          } else {
            const long double factorial = k == 3 ? 2.0L : 1.0L;
            out[static_cast<std::size_t>(k)] =
                tau * (std::pow(u, static_cast<long double>(k - 1)) / factorial - out[static_cast<std::size_t>(k - 1)]);
          }
        }
        return std::array<long double, 4>{out[1], out[2], out[3], out[0]};
      };
      const auto end = response(dt);
      looks.near(found.decay, static_cast<double>(end[3]), 16.0 * kEpsilon);
      for (std::size_t k = 0; k < 3; ++k)
        looks.near(found.carried[k] / static_cast<double>(end[k]), 1.0, 64.0 * kEpsilon);
      constexpr int kParts = 8000;
      std::array<std::array<long double, 4>, 4> sum{};
      for (int i = 0; i <= kParts; ++i) {
        const auto h = response(static_cast<long double>(dt) * i / kParts);
        const long double weight = (i == 0 || i == kParts ? 1.0L : i % 2 == 1 ? 4.0L : 2.0L) * dt / (3.0L * kParts);
        for (std::size_t a = 0; a < 4; ++a)
          for (std::size_t b = 0; b < 4; ++b) sum[a][b] += weight * h[a] * h[b];
      }
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b)
          looks.near(
              found.driven(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) / static_cast<double>(sum[a][b]),
              1.0, 1e-12 + z * std::pow(z / kParts, 4));
    }
  for (const double dt : {1e-3, 0.7, 30.0}) {
    const Matrix3d found = white_moments(dt);
    const double factorial[] = {1.0, 1.0, 2.0};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        looks.close(found(i, j), std::pow(dt, i + j + 1) / (factorial[i] * factorial[j] * (i + j + 1)), 16.0);
  }
  return looks.figure();
}

/// The loops over rows against matrices: n roundings of their terms.
StressFigure loops() {
  Looks looks;
  DrawnNumbers draw(7);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (const int width : {4, 12, 36}) {
    const int states = width;
    const Rows errors = draw.any(states, width);
    std::vector<FeedTerm> terms;
    Rows fed = Rows::Zero(6, states);
    for (int k = 0; k < 9; ++k) {
      const FeedTerm term{k == 0 ? 4 : k % 5, (7 * k) % states, draw.next()};  // none of the last axis
      terms.push_back(term);
      fed(term.axis, term.state) += term.rate;
    }
    const double carried[3] = {0.9, 0.4, 0.13}, dt = 0.8;
    Rows integrals = draw.any(kIntegralRows, width);
    const Rows before = integrals;
    add_integrals(terms.data(), static_cast<int>(terms.size()), carried, dt, errors.data(), width, integrals.data(),
                  width);
    const Rows rates = fed * errors;
    const double of_gyro[] = {carried[0], carried[1], carried[2] - 0.5 * dt * carried[1]},
                 of_accel[] = {carried[0], carried[1] - 0.5 * dt * carried[0]};
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < 3; ++k)
        looks.near((integrals.row(3 * k + axis) - before.row(3 * k + axis) - of_gyro[k] * rates.row(axis)).norm(), 0.0,
                   1e-13);
      for (int k = 0; k < 2; ++k)
        looks.near(
            (integrals.row(9 + 3 * k + axis) - before.row(9 + 3 * k + axis) - of_accel[k] * rates.row(3 + axis)).norm(),
            0.0, 1e-13);
    }
    StepCoefficients step{};
    step.dt_s = dt;
    std::array<Matrix3d, 7> m;
    double* const to[] = {step.theta_theta, step.theta_gyro, step.v_theta, step.v_p,
                          step.v_v,         step.v_accel,    step.v_gyro};
    for (std::size_t k = 0; k < 7; ++k) {
      m[k] = draw.any(3, 3);
      for (int i = 0; i < 9; ++i) to[k][i] = m[k](i / 3, i % 3);
    }
    const Rows x = draw.any(9, width);
    Rows after = Rows::Zero(9, width);
    move_rows(step, x.data(), width, integrals.data(), after.data(), width);
    const Rows theta = x.topRows(3), p = x.middleRows(3, 3), v = x.bottomRows(3), g1 = integrals.topRows(3),
               g2 = integrals.middleRows(3, 3), g3 = integrals.middleRows(6, 3), a1 = integrals.middleRows(9, 3),
               a2 = integrals.bottomRows(3);
    const Rows next = m[2] * theta + m[3] * p + m[4] * v + m[5] * a1 + m[6] * g2;
    looks.near((after.topRows(3) - m[0] * theta - m[1] * g1).norm(), 0.0, 1e-12);
    looks.near((after.bottomRows(3) - next).norm(), 0.0, 1e-12);
    looks.near((after.middleRows(3, 3) - p - 0.5 * dt * (v + next) - m[5] * a2 - m[6] * g3).norm(), 0.0, 1e-12);
    Rows target = draw.any(7, width);
    const Rows was = target, left = draw.any(7, 3), right = draw.any(3, width);
    add_products(target.data(), 7, width, left.data(), right.data());
    looks.near((target - was - left * right).norm(), 0.0, 1e-13);
    Rows square = draw.any(width, width);
    const Rows old = square;
    const VectorXd factor = draw.any(width, 1);
    scale_both(square.data(), width, width - 1, factor.data());
    for (int i = 0; i < width; ++i)
      for (int j = 0; j < width; ++j)
        looks.near(square(i, j), old(i, j) * (i < width - 1 && j < width - 1 ? factor[i] * factor[j] : 1.0),
                   1e-14 * (1.0 + std::abs(old(i, j))));
  }
  return looks.figure();
}

/// One step of errors against differences of the step itself, state by state and for each error of the unit: at rest
/// over `dt_s`, where only the Earth turns, to what the differences round and the cube of its turn, and gravity's
/// gradient to a part in 1e4; and in a bend, to the square of the turn within the step.
StressFigure linearized(double dt_s, double turn_rad) {
  Looks looks;
  DrawnNumbers draw(9);
  NavState before = resting_at(48.0, 11.0, 300.0);
  before.v_EU_E = turn_rad > 0.0 ? Vector3d(30.0, -20.0, 10.0) : Vector3d(0.0, 0.0, 0.0);
  Calibration imu;
  imu.gyro_bias = 1e-3 * draw.three(), imu.accel_bias = 1e-2 * draw.three();
  imu.set_gains(0.02 * draw.any(3, 3), 0.02 * draw.any(3, 3));
  Increments in = rest_increments(before, dt_s);
  in.dtheta_U += turn_rad * Vector3d(0.6, -0.48, 0.64);
  if (turn_rad > 0.0) in.dv_U += dt_s * Vector3d(3.0, -4.0, 1.0);
  const Vector3d raw_turn = in.dtheta_U + imu.gyro_gain * in.dtheta_U + dt_s * imu.gyro_bias,
                 raw_push = in.dv_U + imu.accel_gain * in.dv_U + dt_s * imu.accel_bias;
  using Vector9 = Eigen::Matrix<double, 9, 1>;
  const auto after = [&](const Vector9& off, const Vector3d& gyro, const Vector3d& accel) {
    NavState s = before;
    s.R_EU = s.R_EU * so3_exp(off.head<3>());
    s.p_EU_E += off.segment<3>(3), s.v_EU_E += off.tail<3>();
    Calibration with = imu;
    with.gyro_bias += gyro, with.accel_bias += accel;
    make_strapdown("two_sample")->advance(s, with.apply(dt_s, raw_turn, raw_push));
    return s;
  };
  const auto slope = [&](const Vector9& off, const Vector3d& gyro, const Vector3d& accel, double by) -> Vector9 {
    const NavState up = after(off, gyro, accel), down = after(-off, -gyro, -accel);
    Vector9 out;
    out << so3_log(down.R_EU.conjugate() * up.R_EU), up.p_EU_E - down.p_EU_E, up.v_EU_E - down.v_EU_E;
    return out / (2.0 * by);
  };
  const StepJacobian J(before, in, imu, gravity_gradient_E(before.p_EU_E));
  looks.right(J.dt_s == dt_s);
  const double earth = 7.3e-5 * dt_s;
  // What is left out of theta is nothing; of v and p the square of the turn in the step, and the Earth's cube and its
  // product with the turn; differences leave the square of their angle, and of a place what gravity's gradient, itself
  // a difference, is good to. Places round by an epsilon of the Earth's radius, attitudes and speeds by theirs.
  const auto look = [&](const Vector9& found, const Vector9& expected, double by, double differences, double beside) {
    for (int block = 0; block < 3; ++block) {
      const double size = expected.segment<3>(3 * block).norm();
      const double order = block == 0 ? 0.0 : turn_rad * turn_rad + earth * turn_rad + earth * earth * earth;
      const double rounded = (block == 1 ? 4.0 * 6.4e6 : block == 2 ? 200.0 : 8.0) * kEpsilon / by;
      looks.near((found.segment<3>(3 * block) - expected.segment<3>(3 * block)).norm(), 0.0,
                 size * (order + differences) + rounded + (block == 0 ? 0.0 : beside));
    }
  };
  const double h = dt_s;
  for (int j = 0; j < 9; ++j) {
    const Vector9 unit = Vector9::Unit(j);
    const double by = j < 3 ? 1e-4 : 100.0;
    Vector9 expected;
    expected.head<3>() = J.theta_theta * unit.head<3>();
    expected.tail<3>() = J.v_theta * unit.head<3>() + J.v_p * unit.segment<3>(3) + J.v_v * unit.tail<3>();
    expected.segment<3>(3) = unit.segment<3>(3) + 0.5 * h * (unit.tail<3>() + expected.tail<3>());
    look(slope(by * unit, Vector3d::Zero(), Vector3d::Zero(), by), expected, by,
         j < 3   ? 2e-8
         : j < 6 ? 1e-4
                 : 3e-10,
         0.0);
  }
  for (int j = 0; j < 6; ++j) {
    const Vector3d gyro = j < 3 ? Vector3d(Vector3d::Unit(j)) : Vector3d(Vector3d::Zero()),
                   accel = j < 3 ? Vector3d(Vector3d::Zero()) : Vector3d(Vector3d::Unit(j - 3));
    const double by = j < 3 ? 1e-4 / h : 0.1;
    // Constant over the step: integrals e h, e h^2 / 2, e h^3 / 6.
    Vector9 expected;
    expected.head<3>() = J.theta_gyro * gyro * h;
    expected.tail<3>() = J.v_accel * accel * h + J.v_gyro * gyro * (0.5 * h * h);
    // The step's own place is the trapezoid of speeds.
    expected.segment<3>(3) = 0.5 * h * expected.tail<3>();
    // A turn within the step turns the force by its own square too: of half the force the first order has two thirds of
    // the turn, whatever part of it lies across the axis.
    const double squared = j < 3 ? 2.0 / 3.0 * (turn_rad + earth) * 0.55 * h * in.dv_U.norm() : 0.0;
    look(slope(Vector9::Zero(), by * gyro, by * accel, by), expected, by, j < 3 ? 2e-8 : 2e-9, squared);
  }
  // In axes that stand still.
  const StepJacobian still(before.R_EU, in, imu);
  looks.right(still.v_v == StepJacobian::Matrix::Identity() && still.v_p == StepJacobian::Matrix::Zero() &&
              still.dt_s == dt_s);
  looks.near((still.theta_theta - J.theta_theta).norm() + (still.theta_gyro - J.theta_gyro).norm(), 0.0, 1e-300);
  const double scale = still.v_theta.norm() + still.v_accel.norm() + still.v_gyro.norm();
  looks.near((still.v_theta - J.v_theta).norm() + (still.v_accel - J.v_accel).norm() + (still.v_gyro - J.v_gyro).norm(),
             0.0, 2.0 * earth * scale);
  return looks.figure();
}

/// What stands where nobody says otherwise: the start of a filter, what arrives at it, and the rows of its sets.
StressFigure given_settings() {
  int wrong = 0;
  const auto is = [&](double found, double expected) { wrong += found == expected ? 0 : 1; };
  const FilterConfig c;
  is(c.initial_attitude_sigma_deg_roll_pitch, 0.1), is(c.initial_attitude_sigma_deg_heading, 1.0);
  is(c.initial_position_sigma_m, 0.5), is(c.initial_velocity_sigma_m_s, 0.05);
  const TimelineConfig t;
  is(t.wait_s, 1.0), is(t.held_s, 0.1), is(t.gap_rate_deg_s, 20.0), is(t.gap_force_m_s2, 2.0),
      is(t.frozen_speed_m_s, 0.5), is(t.same_instant_s, 1e-6);
  const TimelineConfig recorded = TimelineConfig::as_recorded();
  is(recorded.wait_s, 0.0), is(recorded.gap_rate_deg_s, 0.0), is(recorded.gap_force_m_s2, 0.0),
      is(recorded.same_instant_s, 0.0);
  is(recorded.frozen_speed_m_s, kInfinity), is(recorded.held_s, 0.1);
  wrong += takes_all(c) && takes_all(configured("acceptance = \"accept_all\"")) &&
                   !takes_all(configured("gate_sigma = 3")) && !takes_all(configured("acceptance = \"huber\"")) &&
                   !takes_all(configured("filter = \"vehicle\""))
               ? 0
               : 1;
  wrong += measures_with(c, "position") && !measures_with(c, "odometer") &&
                   measures_with(configured("filter = \"tight\""), "ranges") &&
                   measures_with(configured("map_aiding = true"), "relative_pose")
               ? 0
               : 1;
  wrong += check_parts(filter_parts(c)).ok() && check_parts(filter_parts(configured("filter = \"tight\""))).ok() &&
                   check_parts(filter_parts(configured("map_aiding = true"))).ok()
               ? 0
               : 1;
  for (const char* keys : {"states = [\"biases\", \"in_run_biases\"]", "states = [\"biases\", \"turn_on_biases\"]",
                           "measurements = [\"ranges\"]", "measurements = [\"relative_pose\"]"})
    wrong += check_parts(filter_parts(configured(keys))).ok() ? 1 : 0;
  wrong += filter_parts(configured("map_aiding = true\nstates = [\"clone\"]")).states.size() == 1 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> state_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "state blocks by their parameters",
           "a sigma of another unit, a density of half the process, a row for a column",
           "each by what its keys and the unit's sheet say, whole states by hand: roundings", "of the bound"});
  rows.add("states/blocks", blocks).add("states/whole_state", whole_state).add("states/lasting_errors", lasting_errors);
  rows.of({StressGroup::kData, "places of satellites among a few states",
           "a satellite that is seen gives way, or the latest one", "by hand: exact", "wrong"});
  rows.add("states/places_of_satellites", slots);
  rows.of({StressGroup::kStiff, "processes within a step, and the loops that move errors",
           "a moment of another order, a panel too few, a row of another triad",
           "closed forms, quadrature of responses, matrices: roundings", "of the bound"});
  rows.add("states/moments", moments).add("states/loops_over_rows", loops);
  rows.of({StressGroup::kGeometry, "the step of errors", "a term of the Earth's turn, of a gain or of half a step",
           "differences of the step itself: its square, and roundings", "of the bound"});
  rows.add("states/step_at_rest", [] { return linearized(1.0, 0.0); }).add("states/step_in_a_bend", [] {
    return linearized(0.02, 0.004);
  });
  rows.of({StressGroup::kData, "settings that nobody gives", "a setting of another unit",
           "as the documentation has them: exact", "wrong"});
  rows.add("states/given_settings", given_settings);
  return rows.take();
}

}  // namespace canyon::fusion
