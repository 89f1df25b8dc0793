#include "canyon/fusion/smoothing/pose_graph/pose_graph.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/LU>

namespace canyon::fusion {
namespace {

class Draws {
 public:
  explicit Draws(unsigned seed) : engine_(seed) {}
  Vector6d xi(double turn_rad, double move_m) {
    std::normal_distribution<double> normal;
    Vector6d out;
    for (int i = 0; i < 6; ++i) out[i] = (i < 3 ? turn_rad : move_m) * normal(engine_);
    return out;
  }
  Matrix6d covariance() {
    Matrix6d A;
    for (int i = 0; i < 6; ++i) A.col(i) = xi(0.02, 0.1);
    return A * A.transpose() + 1e-4 * Matrix6d::Identity();
  }

 private:
  std::mt19937 engine_;
};

Vector6d differenced(const std::function<Vector6d(double)>& f) {
  constexpr double kStep = 1e-5;
  return (8.0 * (f(kStep) - f(-kStep)) - (f(2 * kStep) - f(-2 * kStep))) / (12.0 * kStep);
}

TEST(PoseGraph, RowsHaveTheDerivativesThatDifferencesGive) {
  Draws draws(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Pose X_WS = Pose::exp(draws.xi(1.0, 10.0)), X_WT = Pose::exp(draws.xi(1.0, 10.0));
    PoseGraph::Relative relative{.source = 0,
                                 .target = 1,
                                 .X_TS = X_WT.inverse() * X_WS * Pose::exp(draws.xi(0.1, 0.5)),
                                 .covariance = draws.covariance()};
    const RelativeRows rows = relative_rows(relative, X_WS, X_WT);
    const PoseGraph::Absolute absolute{0, X_WS * Pose::exp(draws.xi(0.1, 0.5)), draws.covariance()};
    const AbsoluteRows by_itself = absolute_rows(absolute, X_WS);
    const auto off = [](double largest) { return 1e-7 * (1.0 + largest); };
    for (int i = 0; i < 6; ++i) {
      const auto moved = [&](const Pose& X, double s) { return X * Pose::exp(s * Vector6d::Unit(i)); };
      const Vector6d source =
          differenced([&](double s) { return relative_rows(relative, moved(X_WS, s), X_WT).residual; });
      const Vector6d target =
          differenced([&](double s) { return relative_rows(relative, X_WS, moved(X_WT, s)).residual; });
      const Vector6d alone = differenced([&](double s) { return absolute_rows(absolute, moved(X_WS, s)).residual; });
      EXPECT_LE((rows.by_source.col(i) - source).norm(), off(source.norm()));
      EXPECT_LE((rows.by_target.col(i) - target).norm(), off(target.norm()));
      EXPECT_LE((by_itself.by_node.col(i) - alone).norm(), off(alone.norm()));
    }
  }
}

/// A square of 4 n poses, 1 m from one to the next, each as far off as its relation to the one before says.
struct Square {
  std::vector<Pose> truth;
  PoseGraph graph;
};

Square square(int n, unsigned seed, double turn_rad = 0.002, double move_m = 0.02) {
  Draws draws(seed);
  Square out;
  Pose at;
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(turn_rad * turn_rad), Eigen::Vector3d::Constant(move_m * move_m);
  for (int k = 0; k < 4 * n; ++k) {
    out.truth.push_back(at);
    Vector6d step = Vector6d::Zero();
    step[3] = 1.0;
    if (k % n == n - 1) step[2] = 0.5 * std::acos(-1.0);
    at = at * Pose::exp(step);
  }
  out.graph.X_WS = {out.truth.front()};
  out.graph.absolute.push_back({0, out.truth.front(), 1e-8 * Matrix6d::Identity()});
  for (std::size_t k = 1; k < out.truth.size(); ++k) {
    const Pose X_TS = out.truth[k - 1].inverse() * out.truth[k] * Pose::exp(draws.xi(turn_rad, move_m));
    out.graph.relative.push_back({.source = k, .target = k - 1, .X_TS = X_TS, .covariance = covariance});
    out.graph.X_WS.push_back(out.graph.X_WS.back() * X_TS);
  }
  return out;
}

double rms_m(const Square& square) {
  double sum = 0.0;
  for (std::size_t k = 0; k < square.truth.size(); ++k)
    sum += (square.graph.X_WS[k].p - square.truth[k].p).squaredNorm();
  return std::sqrt(sum / static_cast<double>(square.truth.size()));
}

PoseGraph::Relative closure(const Square& square, std::size_t source, std::size_t target, const Pose& off = {}) {
  Matrix6d covariance = 1e-6 * Matrix6d::Identity();
  covariance.bottomRightCorner<3, 3>() *= 100.0;
  return {.source = source,
          .target = target,
          .X_TS = square.truth[target].inverse() * square.truth[source] * off,
          .covariance = covariance,
          .switchable = true};
}

TEST(PoseGraph, AChainWithoutLoopsStaysWhereItsRelationsPutIt) {
  Square chain = square(10, 3);
  const auto before = chain.graph.X_WS;
  const auto report = solve(chain.graph, {});
  ASSERT_TRUE(report.ok()) << report.error().str();
  EXPECT_TRUE(report->converged);
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_LE((chain.graph.X_WS[k].p - before[k].p).norm(), 1e-9);
}

// Two chains of n equal steps each lead from one end that is held to the other: with steps of one coordinate alone this
// is least squares on a line, whose variance at step k of N is s^2 k (N - k) / N.
TEST(PoseGraph, WhatTwoEndsHoldHasTheVarianceOfABridge) {
  constexpr int kLegs = 8, kRuns = 400;
  const double sigma_m = 0.01;
  Matrix6d loose = 1e-12 * Matrix6d::Identity();
  loose(3, 3) = sigma_m * sigma_m;
  std::mt19937 engine(4);
  std::normal_distribution<double> normal(0.0, sigma_m);
  std::array<double, kLegs + 1> squares{};
  for (int run = 0; run < kRuns; ++run) {
    PoseGraph graph;
    Pose at;
    for (std::size_t k = 0; k <= kLegs; ++k) {
      graph.X_WS.push_back(at);
      if (k == kLegs) break;
      Vector6d step = Vector6d::Zero();
      step[3] = 1.0 + normal(engine);
      graph.relative.push_back({.source = k + 1, .target = k, .X_TS = Pose::exp(step), .covariance = loose});
      at = at * Pose::exp(step);
    }
    Vector6d whole = Vector6d::Zero();
    whole[3] = kLegs;
    graph.absolute = {{0, Pose{}, 1e-14 * Matrix6d::Identity()},
                      {kLegs, Pose::exp(whole), 1e-14 * Matrix6d::Identity()}};
    ASSERT_TRUE(solve(graph, {}).ok());
    for (std::size_t k = 0; k <= kLegs; ++k)
      squares[k] += std::pow(graph.X_WS[k].p.x() - static_cast<double>(k), 2) / kRuns;
  }
  for (int k = 1; k < kLegs; ++k) {
    const double expected = sigma_m * sigma_m * k * (kLegs - k) / kLegs;
    // A variance over 400 runs: 1-sigma of 7 %.
    EXPECT_NEAR(squares[static_cast<std::size_t>(k)] / expected, 1.0, 4.0 * std::sqrt(2.0 / kRuns)) << k;
  }
}

TEST(PoseGraph, AClosureMendsWhatAChainHasLost) {
  int better = 0;
  for (unsigned seed = 10; seed < 30; ++seed) {
    Square loop = square(10, seed);
    const double before_m = rms_m(loop);
    loop.graph.relative.push_back(closure(loop, 39, 0));
    ASSERT_TRUE(solve(loop.graph, {}).ok());
    EXPECT_GE(loop.graph.relative.back().weight, 0.5);
    better += rms_m(loop) < before_m;
  }
  EXPECT_GE(better, 18);
}

TEST(PoseGraph, AWrongClosureIsSwitchedOffByThoseThatAgree) {
  Vector6d wrong = Vector6d::Zero();
  wrong.tail<3>() << 2.0, -3.0, 0.5;
  wrong[2] = 0.3;
  for (unsigned seed = 40; seed < 50; ++seed) {
    Square loop = square(10, seed), clean = loop;
    for (const auto& [source, target] : {std::pair{39u, 0u}, std::pair{38u, 1u}, std::pair{37u, 2u}}) {
      loop.graph.relative.push_back(closure(loop, source, target));
      clean.graph.relative.push_back(closure(clean, source, target));
    }
    loop.graph.relative.push_back(closure(loop, 36, 3, Pose::exp(wrong)));
    ASSERT_TRUE(solve(loop.graph, {}).ok());
    ASSERT_TRUE(solve(clean.graph, {}).ok());
    EXPECT_LE(loop.graph.relative.back().weight, 0.01);
    for (std::size_t k = 0; k < loop.truth.size(); ++k)
      EXPECT_LE((loop.graph.X_WS[k].p - clean.graph.X_WS[k].p).norm(), 0.01) << k;
  }
}

TEST(PoseGraph, WhatCannotBeSolvedIsTold) {
  Square one = square(2, 5);
  const auto refusal = [](PoseGraph graph) {
    const auto report = solve(graph, {});
    return report.ok() ? std::string() : report.error().str();
  };
  PoseGraph floating = one.graph, beyond = one.graph, singular = one.graph, nowhere = one.graph;
  floating.absolute.clear();
  beyond.relative.back().source = 8;
  singular.relative.back().covariance.setZero();
  nowhere.X_WS[3].p.x() = std::nan("");
  EXPECT_EQ(refusal(floating), "pose graph: no pose is known by itself, so that nothing holds the others");
  EXPECT_EQ(refusal(beyond), "pose graph: poses 6 and 8 of 8");
  EXPECT_EQ(refusal(singular),
            "pose graph: what is known of poses 6 and 7 is not finite, or its covariance not positive definite");
  EXPECT_EQ(refusal(nowhere), "pose graph: pose 3 is not finite");
}

}  // namespace
}  // namespace canyon::fusion
