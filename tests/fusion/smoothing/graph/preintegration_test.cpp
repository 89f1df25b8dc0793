#include "canyon/fusion/smoothing/graph/preintegration.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/fusion/smoothing/graph/imu_factor.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/simulated_drive.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion {
namespace {

const GpsTime kPreintegrationStart = GpsTime::from_week_sow(1590, 396000.0);

/// Integral from t to t + dt of a + b sin(c t), exactly.
double integral(double a, double b, double c, double t, double dt) {
  return a * dt + b * (std::cos(c * t) - std::cos(c * (t + dt))) / c;
}

/// Increments of a unit that turns and is pushed, its rate and force smooth in time, exactly.
ImuSample moving(double t, double dt) {
  ImuSample s;
  s.t = kPreintegrationStart + (t + dt);
  s.dt_s = dt;
  s.dtheta_U = {integral(0.1, 0.3, 2.0, t, dt), integral(-0.05, 0.2, 3.0, t, dt), integral(0.4, 0.3, 1.0, t, dt)};
  s.dv_U = {integral(0.5, 2.0, 1.5, t, dt), integral(0.3, 1.0, 2.5, t, dt), integral(9.8, 0.5, 4.0, t, dt)};
  return s;
}

std::vector<ImuSample> samples(double seconds, double rate_hz) {
  std::vector<ImuSample> out;
  for (int k = 0; k < std::lround(seconds * rate_hz); ++k) out.push_back(moving(k / rate_hz, 1.0 / rate_hz));
  return out;
}

/// Where the strapdown row leads from the same start.
NavState integrated(const char* row, const NavState& start, double seconds, double rate_hz) {
  NavState s = start;
  const auto strapdown = make_strapdown(row);
  for (const ImuSample& in : samples(seconds, rate_hz))
    strapdown->advance(s, {.dt_s = in.dt_s, .dtheta_U = in.dtheta_U, .dv_U = in.dv_U});
  return s;
}

NavState driving() {
  NavState s = resting_at(48.0, 11.0, 500.0);
  s.t = kPreintegrationStart;
  s.v_EU_E = s.R_EU * Eigen::Vector3d(15.0, 3.0, -1.0);
  return s;
}

struct Stage {
  FilterConfig config = configured("states = [\"biases\", \"gains\"]\nimu_gain_tau_s = 500");
  Preintegrator integrator{config, tactical_noise()};
  GraphLayout layout{integrator.state()};

  Eigen::VectorXd nothing() const { return Eigen::VectorXd::Zero(layout.states() - 9); }
  NavState predicted(const NavState& start, double seconds, double rate_hz) {
    const GraphNode first{.nav = start, .walking = layout.walking_of(nothing())};
    const auto all = samples(seconds, rate_hz);
    const ImuFactor factor(layout, integrator.integrate(all, nullptr, nothing()), start.p_EU_E);
    return factor.predict(layout, first, layout.constants_of(nothing())).nav;
  }
};

/// Of position (m), velocity (m/s) and attitude (rad).
Eigen::Vector3d apart(const NavState& a, const NavState& b) {
  const auto e = error_of(a, b);
  return {e.segment<3>(3).norm(), e.tail<3>().norm(), e.head<3>().norm()};
}

// Position to second and the rest to third order in the sample interval, as the strapdown row, against integration of
// fourth order at 4 kHz: half the interval, a quarter and an eighth of the error.
TEST(Preintegration, ConvergesToTheMotion) {
  Stage stage;
  const NavState start = driving(), truth = integrated("three_sample", start, 0.25, 4000.0);
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (const double rate_hz : {20.0, 40.0, 80.0, 160.0}) {
    const Eigen::Vector3d error = apart(truth, stage.predicted(start, 0.25, rate_hz));
    std::printf("%g Hz: %.2e m, %.2e m/s, %.2e rad\n", rate_hz, error[0], error[1], error[2]);
    if (rate_hz > 20.0) {
      EXPECT_GT(last[0] / error[0], 3.2);
      EXPECT_GT(last[1] / error[1], 6.4);
      EXPECT_GT(last[2] / error[2], 6.4);
    }
    last = error;
  }
}

// Beside the strapdown row, which has the same increments, Earth rate and gravity: both take gravity along a path, one
// by the middle of each sample, one by the chord between two nodes, which a bend of a dt^2 / 8 leaves. That is 2.6e-7 a
// dt^3 of velocity, a being below 12 m/s^2 with what turns. The filter's row itself takes Coriolis and gravity to
// second order in a sample, 4e-9 of each in these.
TEST(Preintegration, IsWhereTheStrapdownLeads) {
  Stage stage;
  const NavState start = driving();
  for (const double seconds : {0.25, 0.5, 1.0, 2.0}) {
    const Eigen::Vector3d error =
        apart(integrated("two_sample", start, seconds, 200.0), stage.predicted(start, seconds, 200.0));
    std::printf("%g s: %.2e m, %.2e m/s, %.2e rad\n", seconds, error[0], error[1], error[2]);
    const double dt3 = std::pow(seconds, 3);
    EXPECT_LT(error[1], 2.6e-7 * 12.0 * dt3 + 1e-7 * seconds);
    EXPECT_LT(error[0], 2.6e-7 * 12.0 * dt3 * seconds + 1e-7 * seconds);
    EXPECT_LT(error[2], 1e-14 * 200.0 * seconds);  // rounding: 50 eps a sample
  }
}

// At rest nothing moves: Earth rate, gravity and centrifugal force cancel over any interval.
TEST(Preintegration, RestsWithTheEarth) {
  Stage stage;
  const NavState rest = resting_at(30.0, -80.0, 10.0);
  std::vector<ImuSample> all;
  for (int k = 0; k < 1000; ++k) all.push_back(rest_sample(rest, k, 100.0));
  const ImuFactor factor(stage.layout, stage.integrator.integrate(all, nullptr, stage.nothing()), rest.p_EU_E);
  const GraphNode first{.nav = rest, .walking = stage.layout.walking_of(stage.nothing())};
  const Eigen::Vector3d error = apart(rest, factor.predict(stage.layout, first, {}).nav);
  std::printf("at rest for 10 s: %.2e m, %.2e m/s, %.2e rad\n", error[0], error[1], error[2]);
  // Gravitation turns with the Earth, and is taken as linear in time: w^2 g dt^3 / 12 = 4e-6 m/s, and half of that
  // times dt. A sample's force turns by w dt and is taken to second order in that, which is rounding.
  const double off = std::pow(earth_rate_E().norm(), 2) * 9.8 * 1000.0 / 12.0;
  EXPECT_LT(error[1], 1.1 * off);
  EXPECT_LT(error[0], 1.1 * off * 10.0);
  EXPECT_LT(error[2], 1e-13);
}

// Central differences; relative to the largest derivative of the same kind. Truncation is the square of the step.
TEST(Preintegration, DerivativesByTheValuesAreThoseOfDifferences) {
  Stage stage;
  const auto all = samples(0.5, 100.0);
  const ImuSample before = moving(-0.01, 0.01);
  Eigen::VectorXd values = stage.nothing();
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = 1e-3 * std::sin(static_cast<double>(i) + 1.0);
  const PreintegratedImu here = stage.integrator.integrate(all, &before, values);
  constexpr double kStep = 1e-4;
  Eigen::MatrixXd differences(9, values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    Eigen::VectorXd up = values, down = values;
    up[i] += kStep;
    down[i] -= kStep;
    const PreintegratedImu a = stage.integrator.integrate(all, &before, down),
                           b = stage.integrator.integrate(all, &before, up);
    differences.col(i) << so3_log(here.dR.conjugate() * b.dR) - so3_log(here.dR.conjugate() * a.dR), b.dp - a.dp,
        b.dv - a.dv;
  }
  differences /= 2.0 * kStep;
  for (int part = 0; part < 3; ++part) {
    const Eigen::MatrixXd exact = here.by_values.middleRows<3>(3 * part), numeric = differences.middleRows<3>(3 * part);
    EXPECT_LT((exact - numeric).cwiseAbs().maxCoeff(), 1e-7 * exact.cwiseAbs().maxCoeff()) << part;
  }
}

// Noise put into each sample, and biases that wander meanwhile: the normalized errors of 4000 draws have unit
// covariance, each element to 5 sigma (sqrt(2 / N) on the diagonal, sqrt(1 / N) beside it; false alarm of all 120:
// 7e-5).
TEST(Preintegration, CovarianceIsThatOfTheErrors) {
  ImuNoise noise;
  noise.gyro = {.white_per_sqrt_hz = 1e-3, .in_run_bias_sigma = 5e-3, .in_run_bias_tau_s = 2.0};
  noise.accel = {.white_per_sqrt_hz = 1e-2, .in_run_bias_sigma = 5e-2, .in_run_bias_tau_s = 2.0};
  Preintegrator integrator(configured("states = [\"biases\"]"), noise);
  const auto clean = samples(0.5, 100.0);
  const PreintegratedImu here = integrator.integrate(clean, nullptr, Eigen::VectorXd::Zero(6));
  const Eigen::MatrixXd whiten = whitening(here.covariance);
  constexpr int kDraws = 4000;
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(15, 15);
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    const RandomStream stream(draw + 1, "test.preintegration");
    auto noisy = clean;
    Eigen::Matrix<double, 6, 1> bias = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t k = 0; k < noisy.size(); ++k) {
      const double dt = noisy[k].dt_s, decay = std::exp(-dt / 2.0), drive = std::sqrt(1.0 - decay * decay);
      const Eigen::Matrix<double, 6, 1> was = bias;
      bias.head<3>() = decay * bias.head<3>() + 5e-3 * drive * stream.normal3(k, 0);
      bias.tail<3>() = decay * bias.tail<3>() + 5e-2 * drive * stream.normal3(k, 1);
      noisy[k].dtheta_U += 1e-3 * std::sqrt(dt) * stream.normal3(k, 2) + 0.5 * dt * (was + bias).head<3>();
      noisy[k].dv_U += 1e-2 * std::sqrt(dt) * stream.normal3(k, 3) + 0.5 * dt * (was + bias).tail<3>();
    }
    const PreintegratedImu off = integrator.integrate(noisy, nullptr, Eigen::VectorXd::Zero(6));
    Eigen::VectorXd error(15);
    // Truth minus what was measured, the bias at the end as it came to be.
    error << so3_log(off.dR.conjugate() * here.dR), here.dp - off.dp, here.dv - off.dv, bias;
    const Eigen::VectorXd unit = whiten * error;
    squares += unit * unit.transpose() / kDraws;
  }
  for (int i = 0; i < 15; ++i)
    for (int j = 0; j <= i; ++j)
      EXPECT_NEAR(squares(i, j), i == j ? 1.0 : 0.0, 5.0 * std::sqrt((i == j ? 2.0 : 1.0) / kDraws)) << i << " " << j;
}

}  // namespace
}  // namespace canyon::fusion
