#include "canyon/inertial/errors/markov_process.h"

#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

/// Six standard deviations of a mean of `count` squares of unit normals: false alarm 2e-9.
double six_sigma(double count) {
  return 6.0 * std::sqrt(2.0 / count);
}

constexpr int kProcesses = 300;
constexpr std::int64_t kBlockLooked = 5;  // reached by steps from border to border
constexpr auto kLength = static_cast<std::int64_t>(kImuBlock);

/// Variance of the value, of what a step adds (over the border of two blocks too), and of the mean over an interval,
/// against those of the continuous process at any interval: 1, 1 - e^-2x, and 2 (x - 1 + e^-x) / x^2, x = dt / tau.
StressFigure law(double tau_s, double rate_hz) {
  const double x = 1.0 / (rate_hz * tau_s), phi = std::exp(-x), added = -std::expm1(-2.0 * x);
  const double of_mean = x < 1e-3 ? 1.0 - x / 3.0 : 2.0 * (x + std::expm1(-x)) / (x * x);
  double values = 0.0, steps = 0.0, means = 0.0;
  for (std::uint32_t n = 0; n < kProcesses; ++n) {
    auto process = MarkovProcess::gauss_markov(11, "stress", n, 1.0, tau_s, 1.0 / rate_hz);
    Eigen::Vector3d before = process.at(kBlockLooked * kLength);
    values += before.squaredNorm();
    for (std::int64_t i = 1; i <= kLength; ++i) {
      const Eigen::Vector3d now = process.at(kBlockLooked * kLength + i);
      steps += (now - phi * before).squaredNorm() / added;
      before = now;
    }
    AxisArrays errors{};
    process.add_means(kBlockLooked, errors);
    for (const auto& axis : errors) means += axis[17] * axis[17] + process.within_sigma() * process.within_sigma();
  }
  const double count = 3.0 * kProcesses;
  stress::Worst worst;
  worst.look(values / count - 1.0, six_sigma(count));
  worst.look(steps / (count * kLength) - 1.0, six_sigma(count * kLength));
  worst.look(means / (count * of_mean) - 1.0, six_sigma(count));
  return worst.figure();
}

/// Values asked for backwards and alone are those of the way forwards, to the bit.
StressFigure any_order() {
  auto forwards = MarkovProcess::gauss_markov(7, "stress", 0, 1.0, 30.0, 0.01);
  std::vector<Eigen::Vector3d> all;
  for (std::int64_t k = 0; k < 6 * kLength; ++k) all.push_back(forwards.at(k));
  auto backwards = MarkovProcess::gauss_markov(7, "stress", 0, 1.0, 30.0, 0.01);
  int wrong = 0;
  for (std::int64_t k = 6 * kLength - 1; k >= 0; k -= 37)
    wrong += backwards.at(k) == all[static_cast<std::size_t>(k)] ? 0 : 1;
  wrong += stress::not_refused([&] { return backwards.at(-1); });
  wrong += stress::not_refused([] { MarkovProcess::gauss_markov(7, "stress", 0, 1.0, 0.0, 0.01); });
  wrong += stress::not_refused([] { MarkovProcess::gauss_markov(7, "stress", 0, 1.0, 1.0, std::nan("")); });
  wrong += stress::not_refused([] { MarkovProcess::gauss_markov(7, "stress", 0, -1.0, 1.0, 0.01); });
  return {1.0 * wrong, 0.0};
}

/// Growth of a random walk over a day at 5 kHz: variance t, from independent walks.
StressFigure walk_of_a_day() {
  constexpr double kRate_hz = 5000.0, kDay_s = 86400.0;
  constexpr int kWalks = 20;
  double square = 0.0;
  for (std::uint32_t n = 0; n < kWalks; ++n)
    square += MarkovProcess::random_walk(5, "stress", n, 1.0, 1.0 / kRate_hz)
                  .at(static_cast<std::int64_t>(kDay_s * kRate_hz))
                  .squaredNorm();
  return {std::abs(square / (3.0 * kWalks * kDay_s) - 1.0), six_sigma(3.0 * kWalks)};
}

}  // namespace

std::vector<StressCase> gauss_markov_cases() {
  const std::string expected =
      "variance of the value, of what a step adds and of an interval's mean are the continuous process's, to six "
      "standard "
      "deviations of 900 to 230400 squares (false alarm 2e-9 each)";
  const StressMechanism fast{
      StressGroup::kStiff, "a process far faster than its samples",
      "an explicit step 1 - dt / tau is -10^5 and diverges; a mean taken as the value at an end has too much power",
      expected, "of the bound"};
  const StressMechanism slow{
      StressGroup::kStiff, "a process far slower than its samples",
      "1 - e^-2x cancels to nothing at x = 2e-13, and the process stands still; the bridge is 0 / 0", expected,
      "of the bound"};
  const StressMechanism order{
      StressGroup::kData, "samples of a process out of order",
      "a recursion that goes on from whatever was asked for last",
      "backwards and alone they are the same bits; a negative number, a sigma or time that is none are refused",
      "values"};
  StressMechanism day{StressGroup::kLong, "variance that a recursion loses or gains",
                      "a factor that is off by an epsilon of each of 4.3e8 steps",
                      "variance t after a day at 5 kHz, to six standard "
                      "deviations of 60 squares",
                      ""};
  day.long_running = true;
  StressRows rows;
  for (const double tau_s : {1e-6, 1e-3, 1.0, 1e3, 1e9})
    for (const double rate_hz : {10.0, 5000.0})
      rows.of(rate_hz * tau_s < 1.0 ? fast : slow)
          .add("gauss_markov/tau_" + stress::text(tau_s) + "_s_at_" + stress::text(rate_hz) + "_hz",
               [=] { return law(tau_s, rate_hz); });
  rows.of(order).add("gauss_markov/in_any_order", any_order);
  rows.of(day).add("gauss_markov/random_walk_of_a_day_at_5000_hz", walk_of_a_day);
  return rows.take();
}

}  // namespace canyon::inertial
