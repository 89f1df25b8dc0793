#include "canyon/fusion/rounding_growth.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/core/units.h"

namespace canyon::fusion {
namespace {

const Geodetic kPlace{45.0 * kDegree, 7.0 * kDegree, 200.0};

NavState start(double heading_deg, double tilt_rad) {
  NavState s = levelled(kPlace, heading_deg * kDegree, {std::sin(tilt_rad), 0.0, std::cos(tilt_rad)});
  s.t = GpsTime::from_week_sow(1590, 1000.0);
  return s;
}

/// At rest, exact increments, an integrator that takes them exactly: what is found is rounding.
std::vector<NavState> resting(const NavState& from, double dt_s, double duration_s) {
  std::vector<ImuSample> samples(static_cast<std::size_t>(duration_s / dt_s));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].t = from.t + dt_s * static_cast<double>(k + 1);
    samples[k].dt_s = dt_s;
    samples[k].dtheta_U = dt_s * (from.R_EU.conjugate() * earth_rate_E());
    samples[k].dv_U = -dt_s * (from.R_EU.conjugate() * gravity_E(from.p_EU_E));
  }
  auto strapdown = make_strapdown("three_sample");
  return dead_reckon(samples, from, *strapdown);
}

std::vector<NavState> truth_of(const std::vector<NavState>& states) {
  std::vector<NavState> out = states;
  for (NavState& s : out) {
    const GpsTime t = s.t;
    s = states.front();
    s.t = t;
  }
  return out;
}

/// Above what rounding does, at two rates, by a factor between one and fifty, 20 min of growth. (With the nose due
/// north rounding happens to cancel.)
TEST(RoundingGrowth, LiesAboveWhatRoundingDoes) {
  for (const double rate_hz : {20.0, 50.0}) {
    const auto states = resting(start(77.0, 0.07), 1.0 / rate_hz, 7200.0);
    RoundingGrowth growth(states.front());
    for (std::size_t k = 1; k < states.size(); ++k) {
      growth.advance(states[k]);
      const double found_m = (states[k].p_EU_E - states.front().p_EU_E).norm();
      ASSERT_LT(found_m, growth.position_m()) << rate_hz << " Hz, after " << states[k].t - states[0].t << " s";
      ASSERT_LT(states[k].v_EU_E.norm(), growth.velocity_m_s()) << rate_hz << " Hz";
    }
    const double found_m = (states.back().p_EU_E - states.front().p_EU_E).norm();
    std::printf("at %g Hz rounding made %.2g m in two hours, bound %.2g m\n", rate_hz, found_m, growth.position_m());
    EXPECT_LT(growth.position_m(), 50.0 * found_m);
  }
}

/// One e-fold each 570 s: k^2 = 2 G M / r^3.
TEST(RoundingGrowth, GrowsAsTheUnstableHeight) {
  NavState s = start(0.0, 0.0);
  RoundingGrowth growth(s);
  const auto after = [&](int seconds) {
    for (int i = 0; i < seconds; ++i) {
      s.t = s.t + 1.0;
      growth.advance(s);
    }
    return growth.position_m();
  };
  const double early_m = after(20000), late_m = after(5700);
  const double r = s.p_EU_E.norm(), k = std::sqrt(2.0 * Wgs84::gm_m3_s2 / (r * r * r));
  EXPECT_NEAR(std::log(late_m / early_m), 5700.0 * k, 1e-3);
  EXPECT_NEAR(1.0 / k, 570.0, 5.0);
}

// 2026-11-22: errors that were grown rounding were told as those of the integrator.
TEST(HeldErrors, EndWhereRoundingMayBeLarger) {
  const auto states = resting(start(0.0, 0.07), 0.1, 4.0 * 3600.0);
  const auto truth = truth_of(states);
  auto errors = navigation_errors(states, truth);
  const HeldErrors held = held_errors(states, errors);
  ASSERT_TRUE(held.until);
  EXPECT_GT(*held.until - states.front().t, 3600.0);
  EXPECT_EQ(errors[held.count - 1].t, *held.until);
  EXPECT_GT(held.rounding_m, 1.0);
  // The same times with an error of 100 km hold all along.
  for (NavError& e : errors) e.position_enu_m.x() += 1e5;
  EXPECT_FALSE(held_errors(states, errors).until);
  EXPECT_EQ(held_errors(states, errors).count, errors.size());
}

}  // namespace
}  // namespace canyon::fusion
