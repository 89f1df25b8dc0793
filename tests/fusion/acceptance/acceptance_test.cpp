#include "canyon/fusion/acceptance/acceptance.h"

#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/fusion/filter_config.h"

namespace canyon::fusion {
namespace {

const GpsTime kStart = GpsTime::from_week_sow(1590, 0.0);

std::unique_ptr<Acceptance> made(const char* name, const char* keys = "") {
  FilterConfig config;
  const auto node = ConfigNode::parse(keys, "test");
  EXPECT_TRUE(read_config(&*node, "fusion", config).ok());
  return model_row(acceptance_models(), name).make(config.own);
}

/// Decision on a residual (x, 0, 0) at second t, the noise being 1 and the prediction as good as known.
Decision decide(Acceptance& acceptance, double t_s, double x, double predicted = 1e-12) {
  Measurement::Vector residual = Measurement::Vector::Zero(3);
  residual[0] = x;
  const Measurement::Square R = Measurement::Square::Identity(3, 3),
                            P = predicted * Measurement::Square::Identity(3, 3);
  return acceptance.decide(
      {.t = kStart + t_s, .residual = residual, .R = R, .predicted = P, .nis = x * x / (1.0 + predicted)});
}

TEST(Acceptance, AllIsTakenAsItIs) {
  const auto all = made("accept_all");
  const Decision d = decide(*all, 0.0, 1e9);
  EXPECT_TRUE(d.accepted);
  EXPECT_EQ(d.noise_scale, 1.0);
  EXPECT_TRUE(all->takes_all());
  EXPECT_TRUE(made("gate")->takes_all());  // which is off
  EXPECT_FALSE(made("gate", "gate_sigma = 4")->takes_all());
  for (const char* name : {"huber", "student_t", "innovation_adaptive", "fuzzy_adaptive"})
    EXPECT_FALSE(made(name)->takes_all()) << name;
}

// 2026-11-23: a filter surer than right refused every fix for the rest of the run.
TEST(Acceptance, TheGateHasAWayBack) {
  const auto gate = made("gate", "gate_sigma = 4\ngate_recovery_s = 10");
  for (int t = 0; t < 10; ++t) EXPECT_FALSE(decide(*gate, t, 30.0).accepted) << t;
  const Decision back = decide(*gate, 10.0, 30.0);
  EXPECT_TRUE(back.accepted);
  EXPECT_NEAR(back.loosening, 300.0, 1e-9);          // 30 sigma, of three degrees of freedom
  EXPECT_FALSE(decide(*gate, 11.0, 30.0).accepted);  // and is a gate again
  // One that is taken ends the count.
  for (int t = 12; t < 20; ++t) EXPECT_FALSE(decide(*gate, t, 30.0).accepted);
  EXPECT_TRUE(decide(*gate, 20.0, 1.0).accepted);
  for (int t = 21; t < 31; ++t) EXPECT_FALSE(decide(*gate, t, 30.0).accepted) << t;
  // Two refusals far apart are not ten seconds of nothing else.
  const auto rare = made("gate", "gate_sigma = 4");
  EXPECT_FALSE(decide(*rare, 0.0, 30.0).accepted);
  EXPECT_FALSE(decide(*rare, 100.0, 30.0).accepted);
  // Never, where it is told so.
  const auto never = made("gate", "gate_sigma = 4\ngate_recovery_s = 0");
  for (int t = 0; t < 1000; ++t) EXPECT_FALSE(decide(*never, t, 30.0).accepted);
}

TEST(Acceptance, RobustWeightsAreThoseOfTheirLaws) {
  const auto huber = made("huber", "huber_sigma = 1.345");
  EXPECT_EQ(decide(*huber, 0.0, 1.0).noise_scale, 1.0);
  // d = x / sqrt(3) sigma per degree of freedom: weight k / d.
  EXPECT_NEAR(decide(*huber, 1.0, 10.0).noise_scale, 10.0 / std::sqrt(3.0) / 1.345, 1e-9);
  const auto t = made("student_t", "student_t_dof = 4");
  EXPECT_EQ(decide(*t, 0.0, 1.0).noise_scale, 1.0);
  EXPECT_NEAR(decide(*t, 1.0, 10.0).noise_scale, 104.0 / 7.0, 1e-9);
  // With many degrees of freedom it is the normal law.
  EXPECT_NEAR(decide(*made("student_t", "student_t_dof = 1e6"), 0.0, 10.0).noise_scale, 1.0, 1e-4);
}

// Residuals four times as large as stated: the factor on R tends to 16; 400 of them, of three components, tell it to
// 1 / sqrt(600) of itself, and so does a window of tau = 100 s, of which about 200 s count.
TEST(Acceptance, AdaptiveNoiseIsWhatTheInnovationsSay) {
  const auto adaptive = made("innovation_adaptive", "adaptive_tau_s = 100");
  const RandomStream stream(5, "test.innovations");
  double last = 0.0;
  for (int k = 0; k < 400; ++k) {
    const Measurement::Vector residual = 4.0 * stream.normal3(static_cast<std::uint64_t>(k));
    const Measurement::Square R = Measurement::Square::Identity(3, 3), P = 1e-9 * R;
    last =
        adaptive->decide({.t = kStart + k, .residual = residual, .R = R, .predicted = P, .nis = residual.squaredNorm()})
            .noise_scale;
  }
  EXPECT_NEAR(last, 16.0, 5.0 * 16.0 * std::sqrt(2.0 / (3.0 * 200.0)));
  // What the prediction explains is not the measurement's.
  const auto unsure = made("innovation_adaptive");
  EXPECT_EQ(decide(*unsure, 0.0, 10.0, 100.0).noise_scale, 1.0);
}

/// The first decision on fixes twice a second, beside the filter by place(t) and noisy as they say (1 m per axis), that
/// takes the filter for lost, s; -1 if none does in a minute. Each moves the estimate by moved_m.
double lost_after_s(const char* row, const std::string& keys, const std::function<PlaceBeside(double t_s)>& place,
                    const Eigen::Vector3d& moved_m = Eigen::Vector3d::Zero()) {
  const auto model = made(row, keys.c_str());
  const RandomStream stream(6, "test.lost");
  for (int k = 0; k <= 120; ++k) {
    const double t_s = 0.5 * k;
    PlaceBeside at = place(t_s);
    at.off_m += stream.normal3(static_cast<std::uint64_t>(k));
    const Measurement::Vector residual = at.off_m;
    const Measurement::Square R = Measurement::Square::Identity(3, 3);
    at.nis = residual.squaredNorm() / 1.1;
    const Decision d = model->decide(
        {.t = kStart + t_s, .residual = residual, .R = R, .predicted = 0.1 * R, .nis = at.nis, .place = &at});
    EXPECT_TRUE(d.accepted);
    if (d.loosening > 1.0) return t_s;
    model->moved(moved_m, true);
  }
  return -1.0;
}

/// Of a vehicle at 10 m/s.
PlaceBeside beside_by(const Eigen::Vector3d& off_m) {
  PlaceBeside out;
  out.off_m = off_m;
  out.speed_m_s = 10.0;
  return out;
}

constexpr const char* kWithWayBack[] = {"huber", "student_t", "innovation_adaptive"};
const Eigen::Vector3d kBeside(40.0, -30.0, 5.0);

// 2026-11-25: after an hour of bad fixes the rows that weigh fixes took minutes to believe the good ones.
TEST(Acceptance, FixesThatAreSteadilyBesideItSayThatTheFilterIsLost) {
  const std::string keys = "lost_after_s = 5";
  const auto constant = [](double) { return beside_by(kBeside); };
  for (const char* row : kWithWayBack) {
    // At once, or where chance makes the fixes scatter a few later.
    EXPECT_GE(lost_after_s(row, keys, constant), 5.0) << row;
    EXPECT_LE(lost_after_s(row, keys, constant), 7.0) << row;
    EXPECT_EQ(lost_after_s(row, "lost_after_s = 0", constant), -1.0) << row;
    // Fixes that wander by 2 m/s, which adds 2.9 m (10 m over the root of 12) to their scatter of 1 m: sums of squares
    // of 120 where 40 are allowed.
    EXPECT_EQ(lost_after_s(row, keys, [](double t) { return beside_by((1.0 + t / 25.0) * kBeside); }), -1.0) << row;
    // Their noise alone, and what is beside it by two sigma.
    EXPECT_EQ(lost_after_s(row, keys, [](double) { return beside_by({0.0, 0.0, 0.0}); }), -1.0) << row;
    EXPECT_EQ(lost_after_s(row, keys, [](double) { return beside_by({2.0, 0.0, 0.0}); }), -1.0) << row;
    // Bad until the twentieth second, then steady.
    EXPECT_NEAR(
        lost_after_s(row, keys,
                     [](double t) { return beside_by(t < 20.0 ? Eigen::Vector3d((30.0 - t) * kBeside) : kBeside); }),
        26.0, 1.0)
        << row;
  }
}

// 2026-11-26: a filter that follows fixes by 1 m/s saw them wander, by what it did itself, and one whose velocity had
// been led astray saw them wander by that.
TEST(Acceptance, WhatFixesAreBesideIsCountedAlongTheirOwnMotion) {
  const std::string keys = "lost_after_s = 5";
  const auto followed = [](double t) { return beside_by((1.0 - t / 50.0) * kBeside); };
  const auto led_astray = [](bool measured) {
    return [measured](double t) {
      const Eigen::Vector3d astray(1.0, 0.0, -1.0);  // m/s
      PlaceBeside out = beside_by(kBeside + t * astray);
      out.velocity_measured = measured;
      if (measured) out.leaving_m_s = astray;
      return out;
    };
  };
  for (const char* row : kWithWayBack) {
    EXPECT_EQ(lost_after_s(row, keys, followed), -1.0) << row;
    EXPECT_NEAR(lost_after_s(row, keys, followed, 0.5 / 50.0 * kBeside), 6.0, 1.0) << row;
    EXPECT_NEAR(lost_after_s(row, keys, led_astray(true)), 6.0, 1.0) << row;
    EXPECT_EQ(lost_after_s(row, keys, led_astray(false)), -1.0) << row;
  }
}

TEST(Acceptance, OfAVehicleThatStandsEchoesAreAsSteadyAsTheTruth) {
  for (const char* row : kWithWayBack) {
    const auto standing_until = [](double s) {
      return [s](double t) {
        PlaceBeside out = beside_by(kBeside);
        if (t < s) out.speed_m_s = 0.0;
        return out;
      };
    };
    EXPECT_EQ(lost_after_s(row, "", standing_until(100.0)), -1.0) << row;
    // 20 m later, of which half a second's mean is 5 or, the first, 2.5 m; five fixes at least.
    EXPECT_NEAR(lost_after_s(row, "", standing_until(30.0)), 32.5, 1.0) << row;
  }
}

TEST(Acceptance, FuzzyRulesRaiseTheNoiseWithTheInnovations) {
  const auto quiet = made("fuzzy_adaptive"), loud = made("fuzzy_adaptive", "fuzzy_large = 5");
  double before = 0.0;
  for (int k = 0; k < 50; ++k) {
    EXPECT_LT(decide(*quiet, k, k % 2 == 0 ? 0.5 : -0.5).noise_scale, 1.0 + 1e-9);
    const double scale = decide(*loud, k, 20.0).noise_scale;
    EXPECT_GE(scale, before - 1e-9);
    before = scale;
  }
  EXPECT_NEAR(before, 25.0, 1e-9);  // both are large: the factor of the largest rule
}

}  // namespace
}  // namespace canyon::fusion
