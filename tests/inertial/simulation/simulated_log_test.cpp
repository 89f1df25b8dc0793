#include "canyon/inertial/simulation/simulated_log.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/earth/gravity.h"
#include "canyon/core/process/parallel.h"

namespace canyon::inertial {
namespace {

using ::testing::StartsWith;

SimulatedLog log_of(const MotionConfig& motion, const std::string& errors, double rate_hz, std::size_t samples) {
  ImuConfig imu;
  imu.errors = errors;
  imu.rate_hz = rate_hz;
  const auto placed = make_motion(motion, 7);
  const auto chain = make_error_chain(imu, 7);
  EXPECT_TRUE(placed.ok() && chain.ok());
  Progress progress("test", 1.0, false);
  return simulate_log(*placed, imu.rate_hz, samples, **chain, progress);
}

TEST(SimulatedLog, AnIdealUnitAtRestMeasuresTheEarth) {
  const SimulatedLog log = log_of({}, "none", 200.0, 1000);
  ASSERT_EQ(log.measured.size(), 1000u);
  const LogExtremes most = extremes(log);
  EXPECT_EQ(most.speed_m_s, 0.0);
  EXPECT_EQ(most.lost, 0u);
  // Increments are good to 1e-12 each, over 5 ms.
  EXPECT_NEAR(most.rate_rad_s, 7.292115e-5, 2e-10);
  const Geodetic& origin = log.motion.frame.origin();
  EXPECT_NEAR(most.force_m_s2, gravity_E(ecef_from_geodetic(origin)).norm(), 1e-9);
  EXPECT_LE(log.accuracy.dtheta_rad, 1e-12);
  for (std::size_t k = 0; k < log.truth.size(); ++k) EXPECT_EQ(log.measured[k].dv_U, log.truth[k].dv_U);
}

TEST(SimulatedLog, IsTheSameForAnyNumberOfThreads) {
  MotionConfig circle;
  circle.path = "circle";
  set_threads(1);
  const SimulatedLog one = log_of(circle, "datasheet", 100.0, 1500);
  for (const int threads : {2, 8}) {
    set_threads(threads);
    const SimulatedLog more = log_of(circle, "datasheet", 100.0, 1500);
    EXPECT_EQ(rates_csv(more), rates_csv(one));
    EXPECT_EQ(errors_csv(more), errors_csv(one));
  }
  set_threads(0);
}

TEST(SimulatedLog, FilesAgreeWithOneAnother) {
  MotionConfig circle;
  circle.path = "circle";
  SimulatedLog log = log_of(circle, "datasheet", 100.0, 3);
  log.motion.start = GpsTime::from_week_sow(2100, 604799.98);
  log.truth[0].t = log.measured[0].t = log.motion.start + 0.01;
  EXPECT_THAT(rates_csv(log), StartsWith("t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n604799.990000000,"));
  EXPECT_THAT(kf_gins_text(log), StartsWith("604799.990000000 "));
  const NavigationFile truth = truth_file(log);
  ASSERT_EQ(truth.records.size(), 4u);
  EXPECT_EQ(truth.records[0].t, log.motion.start);
  EXPECT_EQ(truth.records[1].t, log.truth[0].t);
  EXPECT_EQ(truth.gravity, "wgs84");
}

TEST(SimulatedLog, RoundingCostsNoSample) {
  // The product of the doubles nearest to 0.29 and 100 is 28.999999999999996, which truncation would make 28.
  static_assert(0.29 * 100.0 < 29.0);
  EXPECT_EQ(whole_samples(0.29, 100.0), 29u);
  EXPECT_EQ(whole_samples(0.7, 10.0), 7u);
  EXPECT_EQ(whole_samples(0.69, 10.0), 6u);
  EXPECT_EQ(whole_samples(0.05, 10.0), 0u);
}

}  // namespace
}  // namespace canyon::inertial
