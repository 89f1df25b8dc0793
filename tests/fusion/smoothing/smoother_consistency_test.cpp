// Smoothers where the filter's model is exactly true: their covariance is that of their errors, and none is worse than
// the filter.
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "canyon/core/check.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/stress/simulated_drive.h"

namespace canyon::fusion {
namespace {

/// The state at a time from the start, and the truth there.
struct At {
  SmoothedState state;
  NavState truth;
};

At at(const Smoothed& smoothed, const Drive& drive, double t_s) {
  for (const SmoothedState& s : smoothed.states)
    if (std::abs(s.nav.t - drive.start - t_s) < 1e-6)
      return {s, drive.truth[static_cast<std::size_t>(std::lround(t_s / drive.imu.front().dt_s))]};
  CANYON_CHECK(false, "nothing at ", t_s, " s");
  return {};
}

constexpr int kDraws = 100;
constexpr double kInstants[] = {5.0, 15.0, 30.0, 38.0, 55.0};  // without fixes from 20 to 40 s
// Of 100 draws each of which is above its 99 % quantile once in a hundred, more than 6 are in one set of a thousand
// (binomial: 1e-3).
constexpr double kQuantile99 = 21.666;  // chi-square of 9
constexpr int kMostBeyond = 6;

class SmootherConsistency : public ::testing::TestWithParam<const char*> {};

TEST_P(SmootherConsistency, CovarianceIsThatOfTheErrors) {
  constexpr std::size_t kCount = std::size(kInstants);
  ConsistencyMean nees[kCount];
  int beyond[kCount] = {};
  for (int draw = 0; draw < kDraws; ++draw) {
    const Drive drive = simulated_drive(static_cast<std::uint64_t>(draw) + 1, {});
    const Smoothed smoothed = smoothed_by(GetParam(), drive);
    for (std::size_t i = 0; i < kCount; ++i) {
      const At here = at(smoothed, drive, kInstants[i]);
      const double normalized = normalized_squared(error_of(here.truth, here.state.nav), here.state.covariance);
      nees[i].add(normalized, 9);
      beyond[i] += normalized > kQuantile99 ? 1 : 0;
    }
  }
  const Band band = mean_chi_square_band(9, kDraws, 1e-3);
  for (std::size_t i = 0; i < kCount; ++i) {
    std::printf("%s, %g s: NEES per state %.3f, %d of %d above 99 %%\n", GetParam(), kInstants[i], nees[i].per_state(),
                beyond[i], kDraws);
    EXPECT_TRUE(band.contains(9.0 * nees[i].per_state())) << kInstants[i] << " s: " << nees[i].per_state();
    EXPECT_LE(beyond[i], kMostBeyond) << kInstants[i] << " s";
  }
}

INSTANTIATE_TEST_SUITE_P(Rows, SmootherConsistency, ::testing::Values("none", "rts", "batch_graph", "fixed_lag_graph"),
                         [](const auto& param) { return std::string(param.param); });

// Wherever the filter is, and in every direction: the smallest eigenvalue of the difference, with the filter's own
// variances as units, is not negative by more than rounding (some eps of the 33 terms of an element, times the
// condition of what the smoother says beside it).
TEST(RtsSmoother, IsNeverLessCertainThanTheFilter) {
  const Drive drive = simulated_drive(7, {});
  const auto filtered = smoothed_by("none", drive).states, smoothed = smoothed_by("rts", drive).states;
  ASSERT_EQ(filtered.size(), smoothed.size());
  double least = 1.0;
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    ASSERT_EQ(filtered[i].nav.t, smoothed[i].nav.t);
    const Eigen::VectorXd unit = filtered[i].covariance.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd gained =
        unit.asDiagonal() * (filtered[i].covariance - smoothed[i].covariance) * unit.asDiagonal();
    least = std::min(least, Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gained).eigenvalues().minCoeff());
    EXPECT_GT(
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(unit.asDiagonal() * smoothed[i].covariance * unit.asDiagonal())
            .eigenvalues()
            .minCoeff(),
        0.0);
  }
  EXPECT_GT(least, -1e-10);
  // At the end nothing comes later.
  EXPECT_EQ(filtered.back().nav.p_EU_E, smoothed.back().nav.p_EU_E);
  EXPECT_EQ(filtered.back().covariance, smoothed.back().covariance);
}

// With one list of states as with another: a turn-on bias that never changes, gains that do, none at all.
TEST(RtsSmoother, TakesAnySetOfStates) {
  for (const char* keys :
       {"states = [\"biases\"]", "states = [\"turn_on_biases\", \"in_run_biases\", \"gains\"]\nimu_gain_tau_s = 100",
        "states = [\"biases\", \"gains\", \"mounting\", \"wheel_scale\", \"fix_error\"]\nfix_error_sigma_m = 0.2\n"
        "fix_error_scale = 0\nfix_error_tau_s = 10"}) {
    const Drive drive = simulated_drive(3, {.keys = keys});
    const Smoothed filtered = smoothed_by("none", drive), smoothed = smoothed_by("rts", drive);
    const auto miss = [&](const Smoothed& s) {
      const At here = at(s, drive, 38.0);
      return error_of(here.truth, here.state.nav).segment<3>(3).norm();
    };
    EXPECT_LT(miss(smoothed), miss(filtered)) << keys;
    EXPECT_LT(at(smoothed, drive, 38.0).state.covariance.trace(), at(filtered, drive, 38.0).state.covariance.trace());
  }
}

/// By how many of the smoother's own sigmas two of them differ.
double difference_in_sigmas(const SmoothedState& a, const SmoothedState& b) {
  return (error_of(a.nav, b.nav).array() / a.covariance.diagonal().array().sqrt()).abs().maxCoeff();
}

/// The largest difference of the two, in sigmas, and of their variances, relative.
struct Apart {
  double sigmas = 0.0, variances = 0.0;
};
Apart rts_and_batch_graph(double noise_scale) {
  const Drive drive = simulated_drive(11, {.noise_scale = noise_scale});
  const Smoothed rts = smoothed_by("rts", drive), graph = smoothed_by("batch_graph", drive);
  Apart out;
  for (double t = 1.0; t <= 60.0; t += 1.0) {
    const SmoothedState a = at(rts, drive, t).state, b = at(graph, drive, t).state;
    out.sigmas = std::max(out.sigmas, difference_in_sigmas(a, b));
    const auto ratio = b.covariance.diagonal().array() / a.covariance.diagonal().array();
    out.variances = std::max(out.variances, (ratio - 1.0).abs().maxCoeff());
  }
  return out;
}

// The same information, weighed alike. What differs is where it is linearized: with errors a tenth as large, a tenth as
// many sigmas, until what the two make of a sample interval is left.
TEST(BatchGraph, AgreesWithRtsButForTheLinearization) {
  const Apart usual = rts_and_batch_graph(1.0), small = rts_and_batch_graph(0.1), smaller = rts_and_batch_graph(0.01);
  std::printf("RTS and batch graph: %.3f, %.4f, %.4f sigmas apart, variances by %.2f, %.2f, %.2f %%\n", usual.sigmas,
              small.sigmas, smaller.sigmas, 100 * usual.variances, 100 * small.variances, 100 * smaller.variances);
  EXPECT_LT(usual.sigmas, 0.5);
  EXPECT_LT(small.sigmas, 0.2 * usual.sigmas);
  EXPECT_LT(small.variances, 0.2 * usual.variances);
}

TEST(FixedLagGraph, WithTheWholeRunInItIsTheBatchGraph) {
  const Drive drive = simulated_drive(11, {});
  const Smoothed batch = smoothed_by("batch_graph", drive),
                 lag = smoothed_by("fixed_lag_graph", drive, "graph_lag_s = 100");
  ASSERT_EQ(batch.states.size(), lag.states.size());
  // The one of a lag ends where a step gains 1e-6 of the cost, which is some 100: sqrt(2e-4) sigma.
  for (std::size_t i = 0; i < batch.states.size(); ++i)
    EXPECT_LT(difference_in_sigmas(batch.states[i], lag.states[i]), 0.02) << i;
}

// What leaves the graph is not lost: a lag of a second, three nodes, ends as the filter does, which never looks back.
TEST(FixedLagGraph, WithAShortLagEndsAsTheFilterDoes) {
  const Drive drive = simulated_drive(11, {});
  const Smoothed filtered = smoothed_by("none", drive), lag = smoothed_by("fixed_lag_graph", drive, "graph_lag_s = 1");
  EXPECT_LT(difference_in_sigmas(filtered.states.back(), lag.states.back()), 0.2);
  for (int i = 0; i < 9; ++i)
    EXPECT_NEAR(lag.states.back().covariance(i, i) / filtered.states.back().covariance(i, i), 1.0, 0.05);
}

TEST(FactorGraphs, GiveTheSameBitsTwice) {
  const Drive drive = simulated_drive(4, {.outlier_share = 0.2, .outlier_m = 50.0});
  for (const char* row : {"batch_graph", "fixed_lag_graph"}) {
    const Smoothed a = smoothed_by(row, drive, "graph_robustness = \"switchable\""),
                   b = smoothed_by(row, drive, "graph_robustness = \"switchable\"");
    for (std::size_t i = 0; i < a.states.size(); ++i) {
      EXPECT_EQ(a.states[i].nav.p_EU_E, b.states[i].nav.p_EU_E);
      EXPECT_EQ(a.states[i].covariance, b.states[i].covariance);
    }
  }
}

double rms_m(const Smoothed& smoothed, const Drive& drive) {
  double squares = 0.0;
  int count = 0;
  for (double t = 5.0; t <= 60.0; t += 1.0, ++count) {
    const At here = at(smoothed, drive, t);
    squares += (here.truth.p_EU_E - here.state.nav.p_EU_E).squaredNorm();
  }
  return std::sqrt(squares / count);
}

// One fix in five is 50 m off, a hundred sigma. With switches the graph is as good as without outliers, but for the
// fixes that it lacks; without it is lost.
TEST(SwitchableConstraints, SwitchOffWhatIsNotThere) {
  for (const char* row : {"batch_graph", "fixed_lag_graph"}) {
    double clean = 0.0, none = 0.0, huber = 0.0, switched = 0.0;
    int right = 0, all = 0;
    constexpr int kRuns = 10;
    for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
      DriveSetup setup{.outage_from_s = 1e9, .outage_to_s = 1e9};
      clean += rms_m(smoothed_by(row, simulated_drive(seed, setup)), simulated_drive(seed, setup)) / kRuns;
      setup.outlier_share = 0.2;
      setup.outlier_m = 50.0;
      const Drive drive = simulated_drive(seed, setup);
      none += rms_m(smoothed_by(row, drive), drive) / kRuns;
      huber += rms_m(smoothed_by(row, drive, "graph_robustness = \"huber\""), drive) / kRuns;
      const Smoothed s = smoothed_by(row, drive, "graph_robustness = \"switchable\"");
      switched += rms_m(s, drive) / kRuns;
      ASSERT_EQ(s.fixes.size(), drive.fixes.size());
      for (std::size_t i = 0; i < s.fixes.size(); ++i, ++all)
        right += (s.fixes[i].weight < 0.5) == drive.outlier[i] ? 1 : 0;
    }
    std::printf(
        "%s: RMS %.3f m without outliers; with 20 %% 50 m off %.2f m, huber %.2f m, switchable %.3f m (%d of %d fixes "
        "told apart)\n",
        row, clean, none, huber, switched, right, all);
    EXPECT_GT(none, 5.0 * clean);
    // A lag decides with what it has, and what it has decided it cannot take back: one of these ten drives goes wrong.
    if (std::string(row) == "fixed_lag_graph") {
      EXPECT_GE(right, all * 9 / 10);
      continue;
    }
    EXPECT_LT(switched, 1.5 * clean);
    EXPECT_EQ(right, all);
  }
}

}  // namespace
}  // namespace canyon::fusion
