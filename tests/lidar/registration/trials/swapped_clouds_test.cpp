// Clouds of simulated places registered onto one another both ways: T_ab T_ba is no motion, within what both claim.
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/motion/adjoint.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/tests/lidar/registration/trials/tally.h"
#include "canyon/tests/support/setting.h"

namespace canyon::lidar::trials {
namespace {

/// The square of T_ab T_ba over the covariance of both, 6 degrees of freedom; nothing where one of them does not
/// converge. `off`: how far the guess of the way back is off, by a draw of its own.
std::optional<double> there_and_back(const Registration& method, const Trial& trial, const Vector6d& off) {
  const auto a = method.prepare(trial.source), b = method.prepare(trial.target);
  const Registration::Placed onto_a{a, Pose{}}, onto_b{b, Pose{}};
  const auto there = method.align_with_prior(*a, {&onto_b, 1}, trial.prior);
  const auto back =
      method.align_with_prior(*b, {&onto_a, 1}, {trial.truth.inverse() * Pose::exp(-off), trial.prior.covariance});
  for (const auto& result : {there, back})
    if (result.status != RegistrationStatus::kConverged) return std::nullopt;
  // T_ab Exp(-e_b) T_ba Exp(-e_a) with T_ab T_ba = 1: the error of the way back is carried to a's frame.
  const Vector6d round = (back.X_TS * there.X_TS).log();
  const Matrix6d carried = adjoint(back.X_TS);
  const Matrix6d P = there.covariance + carried * back.covariance * carried.transpose();
  return round.dot(P.ldlt().solve(round));
}

// Every place but the facades, which repeat, and every sensor. Along what a place leaves open either result is its own
// guess's, and says so.
TEST(TrialsNightly, SwappedCloudsAgreeInEveryPlace) {
  constexpr int kPairs = 100, kWanted = 97;  // the requirement
  constexpr std::uint64_t kSeed = 7;
  std::vector<const Place*> where;
  for (const Place& place : places())
    if (place.period_m == 0.0) where.push_back(&place);
  RegistrationConfig config;
  config.method.name = canyon::testing::setting("CANYON_TRIALS_METHOD", "gicp");
  const auto method = *make_registration(config);
  int drawn = 0, judged = 0, within = 0;
  for (; judged < kPairs && drawn < 2 * kPairs; ++drawn) {
    const auto number = static_cast<std::size_t>(drawn);
    const Place& place = *where[number % where.size()];
    const Sensor& sensor = sensors()[number / where.size() % sensors().size()];
    Draws draws(kSeed, "trials.swapped", number);
    const auto square =
        there_and_back(*method, make_trial(place, sensor, rings()[0], kSeed, number), draw_guess(draws, rings()[0]));
    if (!square) continue;
    ++judged;
    if (*square < chi_square_threshold(0.01, 6.0)) {
      ++within;
    } else {
      std::printf("%s %s %d: %.1f\n", place.name, sensor.name, drawn, *square);
    }
  }
  std::printf("%d of %d pairs agree within their 99 %% bound; of %d drawn %d did not converge both ways\n", within,
              judged, drawn, drawn - judged);
  EXPECT_EQ(judged, kPairs);
  EXPECT_GE(within, kWanted);
  // Good results refused are 5 % at most, of either way.
  EXPECT_LE(drawn - judged, binomial_most(drawn, 1.0 - 0.95 * 0.95, kAlarm));
}

}  // namespace
}  // namespace canyon::lidar::trials
