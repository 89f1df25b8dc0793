// What a filter's integrator can leave out: what that does in a step, in free integration and to a filter's estimate.
#include "canyon/fusion/observers/step_response.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion {
namespace {

const GpsTime kStepStart = GpsTime::from_week_sow(1590, 396000.0);
const LocalFrame kStepFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
const Eigen::Vector3d kStepImu(0.0, 0.0, 0.4), kStepAntenna(-0.3, 0.0, 1.2);

StrapdownOmissions only(const char* effect) {
  return strapdown_omissions_of({{.effect = effect, .verdict = Verdict::kNotNeeded}});
}

/// Rolling and pitching in quadrature, a coning motion, while driving in a circle.
Increments increments(std::int64_t k) {
  const double dt_s = 0.01, t = dt_s * static_cast<double>(k), w = 2.0 * kPi * 1.5;
  return {.dt_s = dt_s,
          .dtheta_U = dt_s * Eigen::Vector3d(0.3 * std::cos(w * t), 0.3 * std::sin(w * t), 0.2),
          .dv_U = dt_s * Eigen::Vector3d(0.8 * std::sin(w * t), 1.6 + 0.5 * std::cos(w * t), 9.8)};
}

StrapdownStep step_of(const NavState& at, const Increments& now, const Increments& before) {
  return {.dt_s = now.dt_s,
          .dt_before_s = before.dt_s,
          .dtheta_U = now.dtheta_U,
          .dv_U = now.dv_U,
          .dtheta_before_U = before.dtheta_U,
          .dv_before_U = before.dv_U,
          .R_EU = at.R_EU.toRotationMatrix(),
          .v_EU_E = at.v_EU_E};
}

NavState moving() {
  return {.t = kStepStart,
          .R_EU = Eigen::Quaterniond(kStepFrame.R_EW()) * so3_exp({0.1, -0.2, 0.7}),
          .p_EU_E = kStepFrame.to_E(kStepImu),
          .v_EU_E = kStepFrame.R_EW() * Eigen::Vector3d(8.0, 3.0, 0.1)};
}

// First order: what remains is the effect once more times what a step turns (0.4 rad/s x 10 ms) and times gravity's
// half a step in Coriolis, below 2 %.
TEST(StrapdownEffects, AreByWhatAStepIsOffWithoutThem) {
  int effects = 0;
  for (const StrapdownRow& row : strapdown_models()) {
    if (row.make.effects == nullptr) continue;
    for (const StrapdownEffect& effect : row.make.effects()) {
      ++effects;
      const auto full = make_strapdown(row.name), less = make_strapdown(row.name);
      less->leave_out(only(effect.name));
      NavState a = moving(), b = moving();
      full->advance(a, increments(6));
      less->advance(b, increments(6));
      b = a;
      const StepMove said = effect.of_step(step_of(a, increments(7), increments(6)));
      full->advance(a, increments(7));
      less->advance(b, increments(7));
      const Eigen::Vector3d theta_U = so3_log(b.R_EU.conjugate() * a.R_EU);
      EXPECT_NEAR((theta_U - said.theta_U).norm(), 0.0, 0.02 * said.theta_U.norm()) << row.name << effect.name;
      EXPECT_NEAR((a.v_EU_E - b.v_EU_E - said.v_E).norm(), 0.0, 0.02 * said.v_E.norm()) << row.name << effect.name;
      EXPECT_NEAR((a.p_EU_E - b.p_EU_E - said.p_E).norm(), 0.0, 0.02 * said.p_E.norm() + 1e-9)
          << row.name << effect.name;
      EXPECT_GT(said.theta_U.norm(), 0.0);
    }
  }
  EXPECT_EQ(effects, 5);
}

// A row that does not say what it can leave out, and one that has no coning, leave nothing out unasked.
TEST(StrapdownEffects, WhatARowHasNotItRefuses) {
  EXPECT_THROW(make_strapdown("three_sample")->leave_out(only(kEarthRate)), ProgramError);
  EXPECT_THROW(make_strapdown("euler")->leave_out(only(kConing)), ProgramError);
  EXPECT_NO_THROW(make_strapdown("three_sample")->leave_out({}));
}

struct Free {
  double apart_rad = 0.0;
  Need need;
};
/// Over ten minutes.
Free integrate_freely(const StrapdownEffect& effect) {
  const auto full = make_strapdown("two_sample"), less = make_strapdown("two_sample");
  less->leave_out(only(effect.name));
  NavState a = moving(), b = moving();
  Increments before;
  double turned_rad = 0.0;
  Free out;
  constexpr std::int64_t kSteps = 60000;
  for (std::int64_t k = 0; k < kSteps; ++k) {
    const Increments now = increments(k);
    turned_rad += effect.of_step(step_of(a, now, before)).theta_U.norm();
    full->advance(a, now);
    less->advance(b, now);
    out.apart_rad = std::max(out.apart_rad, so3_log(a.R_EU.conjugate() * b.R_EU).norm());
    before = now;
  }
  out.need = strapdown_need(effect, turned_rad, 0.01 * kSteps, tactical_noise());
  return out;
}

// The Earth's turning is the same in every step, so that the bound is reached. A coning motion turns the attitude about
// one axis of the body, and so does its bound, but for the axis's own turning.
TEST(StrapdownEffects, TheBoundHoldsInFreeIntegrationAndHalfOfItDoesNot) {
  for (const StrapdownEffect& effect : two_sample_effects()) {
    const Free free = integrate_freely(effect);
    const double bound_rad = free.need.bound * kDegree / 3600.0 * 600.0;
    EXPECT_EQ(free.need.bound_unit, "deg/h");
    EXPECT_LE(free.apart_rad, bound_rad) << effect.name;
    EXPECT_GT(free.apart_rad, 0.5 * bound_rad) << effect.name << ": half the bound would not be one";
  }
  EXPECT_NEAR(integrate_freely(two_sample_effects()[1]).need.bound, 15.041, 1e-3);
}

TEST(StrapdownEffects, TheReasonHasTheNoiseBeside) {
  // ARW 4.4e-5 rad/s/sqrt(Hz) over 100 s: 4.4e-6 rad/s = 0.91 deg/h.
  const Need need = strapdown_need(earth_rate_alone()[0], 7.292115e-3, 100.0, tactical_noise());
  EXPECT_EQ(need.reason, "turns the attitude by 15 deg/h at most, the gyroscopes' noise by 0.91 (1-sigma)");
}

constexpr int kStepCount = 40, kSamplesPerStep = 20;

using Moves = std::function<std::vector<StepMove>(std::int64_t k, const StrapdownStep& step)>;
std::vector<StepMove> as_they_are(std::int64_t, const StrapdownStep& step) {
  return {two_sample_effects()[0].of_step(step), two_sample_effects()[1].of_step(step)};
}

/// What a response says after each fix.
struct Said {
  std::vector<Eigen::Vector3d> moved_E;  // effect by effect
  Eigen::Matrix3d first_by_chance_E;
};

/// Where B is estimated to be after each fix; `response`, if any, is told everything, and that these moves act.
std::vector<Eigen::Vector3d> places(const StrapdownOmissions& leave_out, StepResponse* response, const Moves& moves,
                                    std::vector<Said>* said) {
  const auto truth = make_strapdown("two_sample");
  NavState at = moving();
  ErrorStateFilter filter(FilterConfig(), tactical_noise(), kStepFrame, kStepImu, kStepAntenna);
  const Eigen::Quaterniond R_WE(kStepFrame.R_EW().transpose().eval());
  filter.initialize(kStepStart, {R_WE * at.R_EU, kStepFrame.to_W(at.p_EU_E) - (R_WE * at.R_EU) * kStepImu},
                    R_WE * at.v_EU_E);
  filter.leave_out(leave_out);
  if (response != nullptr) filter.watch(response);
  const RandomStream noise(7, "test.fixes");
  std::vector<Eigen::Vector3d> out;
  Increments before;
  for (std::int64_t k = 0; k < kStepCount * kSamplesPerStep; ++k) {
    const Increments now = increments(k);
    if (response != nullptr) response->expect(moves(k, step_of(filter.nav_state(), now, before)));
    filter.predict({.t = kStepStart + 0.01 * static_cast<double>(k + 1),
                    .dt_s = 0.01,
                    .dtheta_U = now.dtheta_U,
                    .dv_U = now.dv_U});
    truth->advance(at, now);
    before = now;
    if ((k + 1) % kSamplesPerStep != 0) continue;
    GnssFix z;
    z.t = filter.nav_state().t;
    z.status = FixStatus::kDifferential;
    z.p_A_E = at.p_EU_E + at.R_EU * (kStepAntenna - kStepImu) + 0.3 * noise.normal3(static_cast<std::uint64_t>(k));
    z.covariance_E = 0.09 * Eigen::Matrix3d::Identity();
    filter.update(z);
    out.push_back(kStepFrame.R_EW() * filter.estimate().X_WB.p);
    if (said == nullptr) continue;
    const auto J = filter.body_jacobian();
    said->push_back({{}, response->by_chance_E(0, J)});
    const std::size_t effects = moves(0, step_of(at, now, now)).size();
    for (std::size_t i = 0; i < effects; ++i) said->back().moved_E.push_back(response->moved_E(i, J));
  }
  return out;
}

// First order: attitudes that the fixes correct by up to some mrad, of which the gains are made anew; below 3 % of the
// largest so far. The other effect is in the filter both times.
TEST(StepResponse, IsByWhatTheEstimateIsOffWithoutAnEffect) {
  StepResponse response;
  std::vector<Said> said;
  const auto full = places({}, &response, as_they_are, &said);
  for (std::size_t effect = 0; effect < 2; ++effect) {
    const auto without = places(only(two_sample_effects()[effect].name), nullptr, {}, nullptr);
    double largest_m = 0.0;
    for (std::size_t i = 0; i < full.size(); ++i) {
      const Eigen::Vector3d found = full[i] - without[i];
      largest_m = std::max(largest_m, found.norm());
      EXPECT_LE((found - said[i].moved_E[effect]).norm(), 0.03 * largest_m + 1e-9) << effect << " " << i;
    }
    EXPECT_GT(largest_m, 1e-7) << "something is left out";
  }
}

// Coning's moves with signs by lot, twelve at a time in one filter: what they move the estimate by after each fix has
// the covariance that is said. A mean of 240 squares is within 0.37 of itself of its expectation but for one in 1e4
// (three axes count as one); all fixes of a run go with each other.
TEST(StepResponse, ByChanceIsTheCovarianceOfMovesOfEitherSign) {
  constexpr int kRuns = 20, kTogether = 12;
  std::vector<double> square_m2(kStepCount, 0.0), said_m2(kStepCount, 0.0);
  for (int run = 0; run < kRuns; ++run) {
    const RandomStream lot(run + 1, "test.signs");
    const Moves either = [&](std::int64_t k, const StrapdownStep& step) {
      const StepMove move = two_sample_effects()[0].of_step(step);
      std::vector<StepMove> out(kTogether, move);
      for (int i = 0; i < kTogether; ++i) {
        StepMove& one = out[static_cast<std::size_t>(i)];
        const double sign =
            lot.uniform(static_cast<std::uint32_t>(i), static_cast<std::uint64_t>(k)) < 0.5 ? -1.0 : 1.0;
        one.theta_U *= sign, one.p_E *= sign, one.v_E *= sign;
      }
      return out;
    };
    StepResponse response;
    std::vector<Said> said;
    places({}, &response, either, &said);
    for (std::size_t i = 0; i < said.size(); ++i) {
      said_m2[i] = said[i].first_by_chance_E.trace();
      for (const Eigen::Vector3d& moved_E : said[i].moved_E)
        square_m2[i] += moved_E.squaredNorm() / (kRuns * kTogether);
    }
  }
  for (std::size_t i = 0; i < kStepCount; ++i) {
    EXPECT_GT(said_m2[i], 0.0);
    EXPECT_NEAR(square_m2[i], said_m2[i], 0.37 * said_m2[i]) << i;
  }
}

}  // namespace
}  // namespace canyon::fusion
