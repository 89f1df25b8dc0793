#include "canyon/lidar/loops/loop_closures.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"

namespace canyon::lidar {
namespace {

/// A yard of 40 m x 24 m with walls of 8 m and a block in a corner, seen from within: its points are those that a LIDAR
/// at X_WL would have within 30 m, with 1 cm of noise.
std::vector<Eigen::Vector3f> seen_from(const Pose& X_WL, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> across(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<Eigen::Vector3f> out;
  const auto add = [&](const Eigen::Vector3d& p_W) {
    const Eigen::Vector3d p_L = X_WL.inverse() * p_W + Eigen::Vector3d(noise(engine), noise(engine), noise(engine));
    if (p_L.norm() < 30.0) out.push_back(p_L.cast<float>());
  };
  for (int k = 0; k < 4000; ++k) {
    const double a = across(engine), b = across(engine);
    add({40.0 * a - 20.0, 24.0 * b - 12.0, 0.0});
    add({40.0 * a - 20.0, 12.0, 8.0 * b});
    add({40.0 * a - 20.0, -12.0, 8.0 * b});
    add({20.0, 24.0 * a - 12.0, 8.0 * b});
    add({-20.0, 24.0 * a - 12.0, 8.0 * b});
    if (k % 4 == 0) {
      add({8.0, 3.0 * a + 4.0, 3.0 * b});
      add({8.0 + 4.0 * a, 4.0, 3.0 * b});
    }
  }
  return out;
}

/// Two rounds on a circle of 7 m, 20 keyframes each, where the map has drifted by up to 0.8 m and 2 degrees.
struct Rounds {
  std::vector<Pose> truth;
  std::vector<MappedCloud> mapped;
};

Rounds two_rounds(const Registration& registration) {
  Rounds out;
  for (int k = 0; k < 40; ++k) {
    const double turn = 2.0 * kPi * k / 20.0;
    Vector6d at = Vector6d::Zero();
    at[2] = turn + 0.5 * kPi;
    Pose truth = Pose::exp(at);
    truth.p = {7.0 * std::cos(turn), 7.0 * std::sin(turn), 1.8};
    const double drift = k / 39.0;
    Vector6d off;
    off << 0.0, 0.0, 2.0 * kDegree * drift, 0.5 * drift, -0.6 * drift, 0.1 * drift;
    Matrix6d covariance = Matrix6d::Zero();
    covariance.diagonal() << Eigen::Vector3d::Constant(std::pow(0.02 * drift + 1e-3, 2)),
        Eigen::Vector3d::Constant(std::pow(0.5 * drift + 0.01, 2));
    out.truth.push_back(truth);
    out.mapped.push_back(
        {registration.prepare(seen_from(truth, static_cast<unsigned>(k))), truth * Pose::exp(off), covariance});
  }
  return out;
}

TEST(LoopClosures, ASecondRoundFindsTheFirst) {
  const auto registration = make_registration({});
  ASSERT_TRUE(registration.ok());
  const Rounds rounds = two_rounds(**registration);
  ClosureOptions options;
  options.least_way_m = 30.0;
  const auto trials = find_closures(**registration, rounds.mapped, options);
  ASSERT_GE(trials.size(), 8u);
  int closing = 0;
  for (const ClosureTrial& trial : trials) {
    EXPECT_GE(trial.source, trial.target + 10);
    if (!trial.closes) continue;
    ++closing;
    const Pose off = (rounds.truth[trial.target].inverse() * rounds.truth[trial.source]).inverse() * trial.X_TS;
    EXPECT_LE(off.p.norm(), 0.1) << trial.source;
    EXPECT_LE(so3_log(off.R).norm(), 0.3 * kDegree) << trial.source;
  }
  EXPECT_GE(closing, static_cast<int>(trials.size()) - 2);
}

TEST(LoopClosures, TheSameForAnyNumberOfThreads) {
  const auto registration = make_registration({});
  ASSERT_TRUE(registration.ok());
  const Rounds rounds = two_rounds(**registration);
  ClosureOptions options;
  options.least_way_m = 30.0;
  std::vector<std::vector<ClosureTrial>> found;
  for (const int threads : {1, 2, 8}) {
    set_threads(threads);
    found.push_back(find_closures(**registration, rounds.mapped, options));
  }
  set_threads(0);
  for (const auto& other : found) {
    ASSERT_EQ(other.size(), found.front().size());
    for (std::size_t i = 0; i < other.size(); ++i) {
      EXPECT_EQ(other[i].X_TS.matrix(), found.front()[i].X_TS.matrix());
      EXPECT_EQ(other[i].closes, found.front()[i].closes);
    }
  }
}

TEST(LoopClosures, AWayThatNeverComesBackHasNone) {
  const auto registration = make_registration({});
  ASSERT_TRUE(registration.ok());
  const auto cloud = (*registration)->prepare(seen_from({}, 1));
  std::vector<MappedCloud> line;
  for (int k = 0; k < 100; ++k) {
    MappedCloud& one = line.emplace_back(MappedCloud{cloud, {}, 1e-4 * Matrix6d::Identity()});
    one.X_WL.p.x() = 2.0 * k;
  }
  EXPECT_TRUE(find_closures(**registration, line, {}).empty());
  EXPECT_TRUE(find_closures(**registration, {}, {}).empty());
}

}  // namespace
}  // namespace canyon::lidar
