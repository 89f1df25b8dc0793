#include "canyon/fusion/reference_track.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"

namespace canyon::fusion {
namespace {

constexpr double kRate_rad_s = 0.2, kRadius_m = 50.0;
const Eigen::Vector3d kCentre(4.5e6, 5.5e5, 4.49e6);
const GpsTime kStart = GpsTime::from_week_sow(1590, 1000.0);

/// On a circle of 50 m at 10 m/s, turning with it.
NavState circling(double t_s) {
  const double a = kRate_rad_s * t_s;
  NavState s;
  s.t = kStart + t_s;
  s.p_EU_E = kCentre + kRadius_m * Eigen::Vector3d(std::cos(a), std::sin(a), 0.0);
  s.v_EU_E = kRadius_m * kRate_rad_s * Eigen::Vector3d(-std::sin(a), std::cos(a), 0.0);
  s.R_EU = so3_exp({0.3, 0.0, 0.0}) * so3_exp({0.0, 0.0, a});
  return s;
}

std::vector<NavState> circle(double interval_s, int count) {
  std::vector<NavState> out;
  for (int k = 0; k < count; ++k) out.push_back(circling(interval_s * k));
  return out;
}

std::vector<ImuSample> samples(double from_s, double dt_s, int count) {
  std::vector<ImuSample> out;
  for (int k = 1; k <= count; ++k) {
    ImuSample s;
    s.t = kStart + (from_s + dt_s * k);
    s.dt_s = dt_s;
    out.push_back(s);
  }
  return out;
}

TEST(ReferenceTrack, InterpolatesOnTheGroupToItsOrder) {
  const double r = kRate_rad_s;
  for (const double h : {1.0, 0.1}) {
    const auto track = circle(h, 20);
    for (const double share : {0.1, 0.5, 0.9}) {
      const double t = (7.0 + share) * h;
      const auto here = reference_at(track, kStart + t);
      ASSERT_TRUE(here);
      const NavState truth = circling(t);
      EXPECT_EQ(here->t, truth.t);
      // Hermite's cubic: h^4 / 384 times the fourth derivative; eps of 6.4e6 m.
      EXPECT_LT((here->p_EU_E - truth.p_EU_E).norm(), std::pow(h * r, 4) / 384.0 * kRadius_m + 4e-9) << h;
      // Lagrange on six points: at most 5 / 1024 h^6 times the sixth derivative.
      EXPECT_LT((here->v_EU_E - truth.v_EU_E).norm(), 5.0 / 1024.0 * std::pow(h * r, 6) * kRadius_m * r + 1e-13) << h;
      EXPECT_LT(so3_log(here->R_EU.conjugate() * truth.R_EU).norm(), 1e-14) << h;  // an even turn is exact
    }
  }
  const auto track = circle(1.0, 20);
  EXPECT_EQ(reference_at(track, track[5].t)->p_EU_E, track[5].p_EU_E);
  EXPECT_FALSE(reference_at(track, kStart - 0.001));
  EXPECT_FALSE(reference_at(track, kStart + 19.001));
}

TEST(ReferenceTrack, ATrackWithoutVelocityIsInterpolatedByItsPositions) {
  auto track = circle(0.1, 20);
  for (NavState& s : track) s.v_EU_E.setConstant(std::nan(""));
  const auto here = reference_at(track, kStart + 0.85);
  ASSERT_TRUE(here);
  EXPECT_LT((here->p_EU_E - circling(0.85).p_EU_E).norm(), 4e-9);  // a few eps of 6.4e6 m
  EXPECT_FALSE(here->v_EU_E.allFinite());
}

TEST(ReferenceTrack, GapsAreNotBridged) {
  auto track = circle(0.1, 40);
  track.erase(track.begin() + 10, track.begin() + 20);
  EXPECT_FALSE(reference_at(track, kStart + 1.5));
  EXPECT_TRUE(reference_at(track, kStart + 0.85));
}

TEST(ReferenceTrack, TheStartIsTheFirstInstantInCommon) {
  const auto track = circle(0.1, 40);
  // The reference begins within the log, between two samples.
  auto start = first_common_state(track, samples(-1.0034, 0.01, 300));
  ASSERT_TRUE(start);
  EXPECT_EQ(start->t, kStart);
  // The log begins within the reference: there, interpolated.
  start = first_common_state(track, samples(0.1234, 0.01, 300));
  ASSERT_TRUE(start);
  EXPECT_NEAR(start->t - kStart, 0.1234, 2e-9);
  // Hermite's cubic (0.02^4 / 384 of 50 m), stamps rounded to 1 ns twice at 10 m/s, eps of 6.4e6 m.
  EXPECT_LT((start->p_EU_E - circling(0.1234).p_EU_E).norm(), 2.1e-8 + 2e-8 + 4e-9);
  // In a gap: behind it.
  auto broken = track;
  broken.erase(broken.begin() + 10, broken.begin() + 20);
  start = first_common_state(broken, samples(1.55, 0.01, 200));
  ASSERT_TRUE(start);
  EXPECT_EQ(start->t, track[20].t);
  // Stamps within a microsecond are the same instant.
  start = first_common_state(track, samples(0.2 + 4e-7, 0.01, 300));
  ASSERT_TRUE(start);
  EXPECT_NEAR(start->t - kStart, 0.2 + 4e-7, 2e-9);
  EXPECT_EQ(start->p_EU_E, track[2].p_EU_E);
  EXPECT_FALSE(first_common_state(track, samples(5.0, 0.01, 100)));
  EXPECT_FALSE(first_common_state(track, samples(-5.0, 0.01, 100)));
  const auto behind = reference_from(*start, track);
  EXPECT_EQ(behind.front().t, start->t);
  EXPECT_EQ(behind[1].t, track[3].t);
}

}  // namespace
}  // namespace canyon::fusion
