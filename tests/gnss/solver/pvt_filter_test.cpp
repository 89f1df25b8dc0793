#include "canyon/gnss/solver/pvt_filter.h"

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/gnss/solver/gauss_newton.h"
#include "canyon/tests/gnss/sensor/synthetic_sky.h"
#include "canyon/tests/gnss/solver/solver_sky.h"

namespace canyon::gnss {
namespace {

struct Measured {
  std::vector<RangeMeasurement> ranges;
  std::vector<RateMeasurement> rates;
};

/// A receiver at p_E with v_E, clock and drift in metres; all systems, the clocks of GLONASS and BeiDou 40 and -15 m
/// off.
class Sky4 {
 public:
  Measured at(GpsTime t, const Eigen::Vector3d& p_E, const Eigen::Vector3d& v_E, double clock_m,
              double drift_m_s) const {
    Measured out;
    const Eigen::Vector3d up = p_E.normalized();
    for (const SatelliteId sv : constellation_->satellites()) {
      const auto s = transmission_to(*constellation_, sv, t, p_E);
      if (!s || (s->p_E() - p_E).normalized().dot(up) < 0.2) continue;
      const double between_m = sv.system == GnssSystem::kGlonass  ? 40.0
                               : sv.system == GnssSystem::kBeidou ? -15.0
                                                                  : 0.0;
      out.ranges.push_back({s->state.p_E, s->range_m + clock_m + between_m, 1.5, sv.system});
      RateMeasurement rate{s->state.p_E, s->state.v_E, 0.0, 0.05};
      rate.rate_m_s = range_rate_m_s(rate, p_E, v_E) + drift_m_s;
      out.rates.push_back(rate);
    }
    return out;
  }

 private:
  std::unique_ptr<Constellation> constellation_ = make_broadcast(synthetic_navigation());
};

void add_noise(Measured& m, const RandomStream& noise, std::uint64_t k) {
  for (std::size_t i = 0; i < m.ranges.size(); ++i)
    m.ranges[i].range_m += m.ranges[i].sigma_m * noise.normal(static_cast<std::uint32_t>(i), k, 0);
  for (std::size_t i = 0; i < m.rates.size(); ++i)
    m.rates[i].rate_m_s += m.rates[i].sigma_m_s * noise.normal(static_cast<std::uint32_t>(i), k, 1);
}

// Truth drawn from the filter's own model, noise from its own sigmas: normalised errors of position and velocity are
// chi-square. 60 runs of 30 epochs; the last epoch of each run is taken, so that the samples are independent: mean of
// 6 +- sqrt(12 / 60), 4 sigma. Innovations: 60 x 29 epochs, mean of NIS / degrees 1 within 4 sigma and what the gate
// of 1e-4 takes off, below 0.2 %.
TEST(PvtFilter, ErrorsAndInnovationsAreAsPredicted) {
  const Sky4 sky;
  const PvtFilterParameters p;
  const RandomStream noise(11, "test.pvt"), motion(12, "test.pvt.motion");
  double nees = 0.0, nis = 0.0, degrees = 0.0;
  constexpr int kRuns = 60, kEpochs = 30;
  for (int run = 0; run < kRuns; ++run) {
    PvtFilter filter(p);
    Eigen::Vector3d p_E = kVicksburg, v_E(3.0, -2.0, 1.0);
    double clock_m = 500.0, drift_m_s = 20.0;
    PvtFilter::Estimate estimate;
    for (int k = 0; k < kEpochs; ++k) {
      const auto index = static_cast<std::uint64_t>(run * kEpochs + k);
      if (k > 0) {
        // The exact discrete form of white acceleration over 1 s: covariance q [1/3 1/2; 1/2 1].
        const auto step = [&](std::uint32_t axis, double position_q, double rate_q, double& x, double& rate) {
          const double a = motion.normal(axis, index, 0), b = motion.normal(axis, index, 1);
          x += rate + rate_q * (0.5 * a + b / std::sqrt(12.0)) + position_q * motion.normal(axis, index, 2);
          rate += rate_q * a;
        };
        for (std::uint32_t axis = 0; axis < 3; ++axis) step(axis, 0.0, p.acceleration_m_s2, p_E[axis], v_E[axis]);
        step(3, p.clock_m, p.drift_m_s, clock_m, drift_m_s);
      }
      auto m = sky.at(kSyntheticNoon + static_cast<double>(k), p_E, v_E, clock_m, drift_m_s);
      add_noise(m, noise, index);
      estimate = filter.update(kSyntheticNoon + static_cast<double>(k), m.ranges, m.rates, Eigen::Vector3d::Zero());
      ASSERT_TRUE(estimate.ok) << estimate.reason;
      EXPECT_EQ(estimate.begun_anew, k == 0);
      if (k > 0) {
        nis += estimate.nis;
        degrees += estimate.nis_degrees;
      }
    }
    Eigen::Matrix<double, 6, 1> e;
    e << estimate.p_E - p_E, estimate.v_E - v_E;
    nees += e.dot(estimate.covariance.ldlt().solve(e)) / kRuns;
  }
  EXPECT_NEAR(nees, 6.0, 4.0 * std::sqrt(12.0 / kRuns));
  EXPECT_NEAR(nis / degrees, 1.0, 4.0 * std::sqrt(2.0 / degrees) + 0.002);
}

TEST(PvtFilter, BeatsEpochByEpochLeastSquaresOnASmoothWay) {
  const Sky4 sky;
  PvtFilterParameters p;
  p.acceleration_m_s2 = 0.1;
  PvtFilter filter(p);
  const RandomStream noise(13, "test.pvt");
  const auto solver = make_least_squares({});
  double filtered = 0.0, alone = 0.0;
  for (int k = 0; k < 120; ++k) {
    const GpsTime t = kSyntheticNoon + static_cast<double>(k);
    const Eigen::Vector3d v_E(10.0, 5.0, -2.0), p_E = kVicksburg + k * v_E;
    auto m = sky.at(t, p_E, v_E, 100.0, 0.0);
    add_noise(m, noise, static_cast<std::uint64_t>(k));
    const auto e = filter.update(t, m.ranges, m.rates, kVicksburg);
    if (k < 20) continue;
    filtered += (e.p_E - p_E).squaredNorm();
    alone += (solver->solve(m.ranges, kVicksburg).p_E - p_E).squaredNorm();
  }
  EXPECT_LT(filtered, 0.2 * alone);
}

TEST(PvtFilter, RunsOnWithThreeSatellitesAndThroughNone) {
  const Sky4 sky;
  PvtFilter filter({});
  const Eigen::Vector3d v_E(10.0, 0.0, 0.0);
  for (int k = 0; k < 40; ++k) {
    const GpsTime t = kSyntheticNoon + static_cast<double>(k);
    const Eigen::Vector3d p_E = kVicksburg + k * v_E;
    auto m = sky.at(t, p_E, v_E, 0.0, 0.0);
    if (k >= 20) {
      m.ranges.resize(k < 30 ? 3 : 0);
      m.rates.resize(k < 30 ? 3 : 0);
    }
    const auto e = filter.update(t, m.ranges, m.rates, kVicksburg);
    ASSERT_TRUE(e.ok) << k << ": " << e.reason;
    EXPECT_LT((e.p_E - p_E).norm(), 0.1) << k;
    if (k >= 30) {
      EXPECT_GT(e.covariance.trace(), 1.0 + 0.3 * (k - 30));
    }
  }
  const auto late = filter.update(kSyntheticNoon + 1000.0, {}, {}, kVicksburg);
  EXPECT_FALSE(late.ok);
  EXPECT_EQ(late.reason, "0 satellites, a fix needs 4");
}

TEST(PvtFilter, AMillisecondStepOfTheClockAndAFaultDoNoHarm) {
  const Sky4 sky;
  PvtFilter filter({});
  for (int k = 0; k < 30; ++k) {
    const GpsTime t = kSyntheticNoon + static_cast<double>(k);
    auto m = sky.at(t, kVicksburg, Eigen::Vector3d::Zero(), k < 15 ? 1000.0 : 1000.0 - 299792.458, 0.0);
    m.ranges[2].range_m += k > 5 ? 60.0 : 0.0;
    const auto e = filter.update(t, m.ranges, m.rates, kVicksburg);
    ASSERT_TRUE(e.ok);
    EXPECT_LT((e.p_E - kVicksburg).norm(), 0.05) << k;
    EXPECT_EQ(e.begun_anew, k == 0);
    EXPECT_EQ(e.ranges_used[2], k <= 5);
  }
}

// It was carried elsewhere with the receiver on: all innovations are far outside, no clock explains them.
TEST(PvtFilter, BeginsAnewWhereNothingFits) {
  const Sky4 sky;
  PvtFilter filter({});
  auto m = sky.at(kSyntheticNoon, kVicksburg, Eigen::Vector3d::Zero(), 0.0, 0.0);
  filter.update(kSyntheticNoon, m.ranges, m.rates, kVicksburg);
  m = sky.at(kSyntheticNoon + 1.0, kVicksburg, Eigen::Vector3d::Zero(), 0.0, 0.0);
  filter.update(kSyntheticNoon + 1.0, m.ranges, m.rates, kVicksburg);
  const Eigen::Vector3d there_E = kVicksburg + Eigen::Vector3d(50e3, -30e3, 10e3);
  m = sky.at(kSyntheticNoon + 2.0, there_E, Eigen::Vector3d::Zero(), 0.0, 0.0);
  const auto e = filter.update(kSyntheticNoon + 2.0, m.ranges, m.rates, kVicksburg);
  ASSERT_TRUE(e.ok);
  EXPECT_TRUE(e.begun_anew);
  EXPECT_LT((e.p_E - there_E).norm(), 1e-3);
}

TEST(LineOfSight, IsTheDerivativeOfTheRange) {
  for (const auto& r : ranges_from(kVicksburg, {{10, 70}, {80, 35}, {150, 20}}, 0.0)) {
    const LineOfSight sight = line_of_sight(r.p_E, kVicksburg);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d h = 10.0 * Eigen::Vector3d::Unit(axis);
      const double slope =
          (line_of_sight(r.p_E, kVicksburg + h).range_m - line_of_sight(r.p_E, kVicksburg - h).range_m) / 20.0;
      EXPECT_NEAR(slope, -sight.line[axis], 2e-6);  // the change of the Sagnac turn is left out: w r / c
    }
  }
}

}  // namespace
}  // namespace canyon::gnss
