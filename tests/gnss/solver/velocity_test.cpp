#include "canyon/gnss/solver/velocity.h"

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/tests/gnss/sensor/synthetic_sky.h"
#include "canyon/tests/gnss/solver/solver_sky.h"

namespace canyon::gnss {
namespace {

/// Rates as a receiver measures them, from differences of the whole transmission (tests/gnss/sensor/synthetic_sky.h).
std::vector<RateMeasurement> rates(const Constellation& constellation, GpsTime t, const Eigen::Vector3d& p_E,
                                   const Eigen::Vector3d& v_E, double drift) {
  std::vector<RateMeasurement> out;
  for (const auto& o : SyntheticReceiver{constellation, 5.0, 0.0, drift}.at(t, p_E, v_E).observations) {
    const auto view = transmission_from_pseudorange(constellation, o.sv, t, o.pseudorange_m);
    const double hz = carrier_hz(o.sv.system, o.band, view->state.frequency_channel);
    out.push_back({view->state.p_E, view->state.v_E,
                   pseudorange_rate_m_s(o.doppler_hz, hz) + kSpeedOfLight * view->state.clock_rate, 0.05});
  }
  return out;
}

// The differences are central over 1 s: third derivatives of the range, below 1e-5 m/s^3 (n^3 r = 8e-5 for the orbit
// projected), leave h^2 / 6 of them, 2e-6 m/s at h = 0.5 s.
TEST(Velocity, SyntheticMotionOfAllSystems) {
  const auto constellation = make_broadcast(synthetic_navigation());
  for (const double lat_deg : {-89.9, 0.0, 52.0}) {
    const Eigen::Vector3d p_E = ecef_from_geodetic({lat_deg * kDegree, 179.99 * kDegree, 300.0});
    for (const Eigen::Vector3d& v_E :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(30, -12, 5), Eigen::Vector3d(-250, 100, 80)}) {
      const auto measured = rates(*constellation, kSyntheticNoon + 100.0, p_E, v_E, 3e-8);
      const auto s = solve_velocity(measured, p_E);
      ASSERT_TRUE(s.ok) << s.reason;
      EXPECT_LT((s.v_E - v_E).norm(), 3e-5) << lat_deg;
      // The clock's own rate changes the seconds in which the rates count: 3e-8 of 800 m/s.
      EXPECT_NEAR(s.clock_drift_m_s, 3e-8 * kSpeedOfLight, 5e-5);
    }
  }
}

TEST(Velocity, RangeRateIsTheDerivativeInTheReceiversVelocity) {
  const auto constellation = make_broadcast(synthetic_navigation());
  const auto m = rates(*constellation, kSyntheticNoon, kVicksburg, Eigen::Vector3d::Zero(), 0.0);
  const auto s = solve_velocity(m, kVicksburg);
  ASSERT_TRUE(s.ok);
  for (const auto& r : m)
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = 10.0 * Eigen::Vector3d::Unit(axis);
      const double slope = (range_rate_m_s(r, kVicksburg, step) - range_rate_m_s(r, kVicksburg, -step)) / 20.0;
      const double expected = -(r.p_E - kVicksburg).normalized()[axis];
      EXPECT_NEAR(slope, expected, 3e-5);  // Sagnac turns the line by 6e-6, the stretch is 3e-6
    }
}

// 2000 trials: relative sigma of a variance 3.2 %, 5 sigma.
TEST(Velocity, CovarianceIsTheScatter) {
  const auto constellation = make_broadcast(synthetic_navigation());
  const auto clean = rates(*constellation, kSyntheticNoon, kVicksburg, Eigen::Vector3d::Zero(), 0.0);
  const RandomStream noise(4, "test.velocity");
  constexpr int kN = 2000;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero(), predicted;
  for (int k = 0; k < kN; ++k) {
    auto m = clean;
    for (std::size_t i = 0; i < m.size(); ++i)
      m[i].rate_m_s += m[i].sigma_m_s * noise.normal(static_cast<std::uint32_t>(i), static_cast<std::uint64_t>(k));
    const auto s = solve_velocity(m, kVicksburg);
    scatter += s.v_E * s.v_E.transpose() / kN;
    predicted = s.covariance_E;
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(scatter(i, i), predicted(i, i), 5.0 * std::sqrt(2.0 / kN) * predicted(i, i));
}

TEST(Velocity, OutliersAreLeftOut) {
  const auto constellation = make_broadcast(synthetic_navigation());
  auto m = rates(*constellation, kSyntheticNoon, kVicksburg, Eigen::Vector3d::Zero(), 0.0);
  m[2].rate_m_s += 8.0;
  m[7].rate_m_s -= 3.0;
  const auto s = solve_velocity(m, kVicksburg, {100.0, 5.0});
  ASSERT_TRUE(s.ok);
  EXPECT_FALSE(s.used[2] || s.used[7]);
  EXPECT_LT(s.v_E.norm(), 3e-5);
  EXPECT_NEAR(s.residuals_m_s[2], 8.0, 1e-4);
}

TEST(Velocity, StatusesWordForWord) {
  const auto constellation = make_broadcast(synthetic_navigation());
  auto m = rates(*constellation, kSyntheticNoon, kVicksburg, Eigen::Vector3d::Zero(), 0.0);
  m.resize(3);
  EXPECT_EQ(solve_velocity(m, kVicksburg).reason, "3 Dopplers, a velocity needs 4");
  m.push_back(m[0]);
  const auto s = solve_velocity(m, kVicksburg);
  EXPECT_FALSE(s.ok);
  EXPECT_EQ(s.reason.rfind("satellite geometry is singular: GDOP ", 0), 0u) << s.reason;
}

}  // namespace
}  // namespace canyon::gnss
