#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress_rows.h"
#include "canyon/fusion/observers/step_response.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/simulated_drive.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;

/// Each number of a sample, not a number, infinite, or (the interval) not above zero; and nothing has changed.
StressFigure not_finite_samples() {
  RestingFilter rest({}, usual_noise(), 100.0);
  rest.predict();
  const NavState before = rest.filter.nav_state();
  const auto P = rest.filter.covariance();
  int passed = 0;
  const auto offer = [&](const ImuSample& s) { passed += stress::not_refused([&] { rest.filter.predict(s); }); };
  for (const double bad : {std::nan(""), stress::kInfinity, -stress::kInfinity}) {
    for (int i = 0; i < 3; ++i) {
      ImuSample s = rest.next_sample();
      s.dtheta_U[i] = bad;
      offer(s);
      s = rest.next_sample();
      s.dv_U[i] = bad;
      offer(s);
    }
    ImuSample s = rest.next_sample();
    s.dt_s = bad;
    offer(s);
  }
  for (const double dt_s : {0.0, -0.01}) {
    ImuSample s = rest.next_sample();
    s.dt_s = dt_s;
    offer(s);
  }
  const NavState& after = rest.filter.nav_state();
  passed += after.t == before.t && after.p_EU_E == before.p_EU_E && rest.filter.covariance() == P ? 0 : 1;
  return {1.0 * passed, 0.0};
}

/// A sample again, an old one, one after a gap of one and of many, one of next year.
StressFigure out_of_order_samples() {
  RestingFilter rest({}, usual_noise(), 100.0);
  for (int k = 0; k < 5; ++k) rest.predict();
  int passed = 0;
  for (const std::int64_t k :
       {std::int64_t{4}, std::int64_t{0}, std::int64_t{6}, std::int64_t{105}, std::int64_t{3'153'600'000}})
    passed += stress::not_refused([&] { rest.filter.predict(rest_sample(rest.truth, k, 100.0)); });
  rest.predict();  // the one that is due is taken all the same
  return {1.0 * passed, 0.0};
}

std::vector<ImuSample> log_of(const NavState& truth, int count) {
  std::vector<ImuSample> out;
  for (int k = 0; k < count; ++k) out.push_back(rest_sample(truth, k, 10.0));
  return out;
}

/// Free navigation of a log in which a sample comes twice, or an old one again, or one that is not finite.
StressFigure bad_logs(const char* integrator) {
  const NavState truth = resting_at(45.0, 7.0, 200.0);
  int passed = 0;
  const auto offer = [&](const std::vector<ImuSample>& log) {
    passed += stress::not_refused([&] { dead_reckon(log, truth, *make_strapdown(integrator)); });
  };
  for (const std::size_t from : {std::size_t{4}, std::size_t{3}, std::size_t{0}}) {
    auto log = log_of(truth, 10);
    log.insert(log.begin() + 5, log[from]);
    offer(log);
  }
  for (const double bad : {std::nan(""), stress::kInfinity}) {
    for (int i = 0; i < 3; ++i) {
      auto log = log_of(truth, 10);
      log[5].dtheta_U[i] = bad;
      offer(log);
      log = log_of(truth, 10);
      log[5].dv_U[i] = bad;
      offer(log);
    }
    auto log = log_of(truth, 10);
    log[5].dt_s = bad;
    offer(log);
  }
  for (const double dt_s : {0.0, -0.1}) {
    auto log = log_of(truth, 10);
    log[5].dt_s = dt_s;
    offer(log);
  }
  return {1.0 * passed, 0.0};
}

/// Rest with samples missing, one and a minute of them: the sample after the gap stands for it, and at rest that is the
/// truth. Euler leaves half the Earth's turn within an interval out of the force: g w_e dt / 2 for as long, and twice
/// that to either side in the position's trapezoid; two_sample is right to the square of that turn, and three_sample,
/// whose three nodes integrate (1 - x) times a force of fourth degree exactly, to its fifth power. Each step rounds the
/// place by half a unit of Earth's radius, and may tilt by an epsilon: a third of g n eps t^2 / 2 in the end.
StressFigure gaps(const char* integrator, double gap_s) {
  const NavState truth = resting_at(45.0, 7.0, 200.0);
  auto log = log_of(truth, 600 + static_cast<int>(gap_s * 10.0));
  log.erase(log.begin() + 300, log.begin() + 300 + static_cast<int>(gap_s * 10.0));
  const auto states = dead_reckon(log, truth, *make_strapdown(integrator));
  const double all_s = states.back().t - truth.t, turn = Wgs84::rate_rad_s * (0.1 + gap_s);
  const std::string name = integrator;
  const double order = name == "euler" ? 1.0 : name == "two_sample" ? 2.0 : 5.0;
  const double missed_m_s2 = 9.81 * std::pow(turn, order);
  const double steps = static_cast<double>(log.size());
  const double rounding_m = steps * stress::kEpsilon * (0.5 * truth.p_EU_E.norm() + 9.81 * all_s * all_s / 6.0);
  const double error_m = (states.back().p_EU_E - truth.p_EU_E).norm();
  return {states.size() == log.size() + 1 ? error_m : stress::kInfinity,
          missed_m_s2 * all_s * all_s / 2.0 + rounding_m};
}

ImuSample rounded_to_single(ImuSample sample) {
  sample.dtheta_U = sample.dtheta_U.cast<float>().cast<double>();
  sample.dv_U = sample.dv_U.cast<float>().cast<double>();
  return sample;
}

/// A body that turns about all axes and is pushed to all sides, unaided, by increments as they are and by the same
/// rounded to single precision. Each is off by half a unit u of itself at most: the velocity by u f a second, the
/// attitude by u w, which turns the force f: u (f T^2 / 2 + w f T^3 / 6) after T, and e^(T / 570 s) of the height's.
StressFigure single_precision_unaided(double seconds) {
  const NavState truth = resting_at(45.0, 7.0, 200.0);
  constexpr double kRate_hz = 100.0;
  std::vector<ImuSample> exact, rounded;
  double f = 0.0, w = 0.0;
  for (int k = 0; k < static_cast<int>(seconds * kRate_hz); ++k) {
    const double t = k / kRate_hz;
    ImuSample s = rest_sample(truth, k, kRate_hz);
    s.dtheta_U = s.dt_s * Eigen::Vector3d(0.3 * std::sin(1.1 * t), 0.2 * std::cos(0.7 * t), 0.4 * std::sin(0.3 * t));
    s.dv_U += s.dt_s * Eigen::Vector3d(2.0 * std::sin(0.9 * t), std::cos(1.3 * t), 3.0 * std::sin(5.0 * t));
    f = worse(f, s.dv_U.norm() / s.dt_s);
    w = worse(w, s.dtheta_U.norm() / s.dt_s);
    exact.push_back(s);
    rounded.push_back(rounded_to_single(s));
  }
  const auto end = [&](const std::vector<ImuSample>& log) {
    return dead_reckon(log, truth, *make_strapdown("two_sample")).back().p_EU_E;
  };
  const double T = seconds,
               off_m = stress::kHalfUlp * (f * T * T / 2.0 + w * f * T * T * T / 6.0) * std::exp(T / 570.0);
  return {(end(rounded) - end(exact)).norm() / off_m, 1.0};
}

/// Two filters on one drive with fixes and an outage, of which one has the increments rounded to single precision: the
/// estimates are as far apart as what the rounding does in each step is carried by the filter's own linearization and
/// gains (observers/step_response.h). What remains is of second order, attitudes that the fixes correct by some mrad: 3
/// % of the largest, as in the test of StepResponse. Beside it an epsilon of positions on Earth.
StressFigure single_precision_with_fixes() {
  const Drive drive = simulated_drive(5, {.seconds = 90.0, .rate_hz = 100.0});
  ErrorStateFilter exact(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  exact.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  ErrorStateFilter rounded = exact;
  StepResponse response;
  rounded.watch(&response);
  double largest_m = 0.0, beside_m = 0.0;
  auto fix = drive.fixes.begin();
  for (const ImuSample& sample : drive.imu) {
    const ImuSample single = rounded_to_single(sample);
    StepMove move;
    move.theta_U = single.dtheta_U - sample.dtheta_U;
    move.v_E = rounded.nav_state().R_EU * (single.dv_U - sample.dv_U);
    move.p_E = 0.5 * sample.dt_s * move.v_E;
    response.expect({move});
    exact.predict(sample);
    rounded.predict(single);
    for (; fix != drive.fixes.end() && fix->t - sample.t < 0.5 * sample.dt_s; ++fix) {
      exact.update(*fix);
      rounded.update(*fix);
    }
    const Vector3d apart_E = rounded.nav_state().p_EU_E - exact.nav_state().p_EU_E;
    Eigen::Matrix<double, 3, 9> of_unit = Eigen::Matrix<double, 3, 9>::Zero();
    of_unit.middleCols<3>(3).setIdentity();
    largest_m = worse(largest_m, apart_E.norm());
    beside_m = worse(beside_m, (apart_E - response.moved_E(0, of_unit)).norm());
  }
  return {beside_m, 0.03 * largest_m + 1e-9};
}

}  // namespace

std::vector<StressCase> sample_cases() {
  const auto group = StressGroup::kData;
  const StressMechanism broken{group, "an inertial sample that is not finite",
                               "one increment spoils attitude, and through it everything, for good",
                               "each number in turn is refused, before anything has changed", "let through"};
  const StressMechanism order{group, "inertial samples out of order, twice or missing",
                              "a sample taken twice moves the state twice; over a gap the body stands still",
                              "each is refused, the due one taken", "let through"};
  const StressMechanism logs{group, "a log in which time does not increase",
                             "a sample that comes twice has no time to stand for, and the next one's change of rate is "
                             "divided by it (found by this case, 2026-11-22: no number)",
                             "is refused, and so is what is not finite in it", "let through"};
  const StressMechanism gap{
      group, "a gap in a log at rest", "the integrator looks back over the gap, or the time is lost",
      "rest, to the Earth's turn within the gap, its square or fifth power by the integrator's order, and rounding",
      "m"};
  const StressMechanism single{group, "samples in single precision",
                               "a time or a sum in single precision stands still; rounding that is taken for motion",
                               "no farther off than half a unit of each increment carries it", "of the bound"};
  StressRows rows;
  rows.of(broken).add("sample/not_finite_field_by_field", not_finite_samples);
  rows.of(order).add("sample/out_of_order", out_of_order_samples);
  for (const char* integrator : {"euler", "two_sample", "three_sample"})
    rows.of(logs).add(std::string("sample/bad_logs_by_") + integrator, [=] { return bad_logs(integrator); });
  for (const double seconds : {10.0, 60.0})
    rows.of(single).add("sample/single_precision_unaided_" + stress::text(seconds) + "_s",
                        [=] { return single_precision_unaided(seconds); });
  StressMechanism filtered = single;
  filtered.unit = "m";
  rows.of(filtered).add("sample/single_precision_with_fixes", single_precision_with_fixes);
  for (const char* integrator : {"euler", "two_sample", "three_sample"})
    for (const double gap_s : {0.1, 60.0})
      rows.of(gap).add("sample/gap_of_" + stress::text(gap_s) + "_s_by_" + integrator,
                       [=] { return gaps(integrator, gap_s); });
  return rows.take();
}

}  // namespace canyon::fusion
