#include "canyon/fusion/observers/predicted_motion.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/driven_truth.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion {
namespace {

using testing::DrivenTruth;
const Eigen::Vector3d kMotionImu(0.2, -0.1, 0.5);

ErrorStateFilter started(const DrivenTruth& truth, const std::string& keys, const Vector6d& off) {
  ErrorStateFilter filter(configured(keys), tactical_noise(), DrivenTruth::frame(), kMotionImu,
                          Eigen::Vector3d::Zero());
  Pose X = truth.X_WB();
  X.R = so3_exp(off.head<3>()) * X.R;
  filter.initialize(truth.state().t, {X.R, X.p - X.R * kMotionImu + off.tail<3>()}, truth.v_W());
  return filter;
}

// Where the start is, and where it heads, is the same at both ends: 1 km and half a radian of it leave no trace.
TEST(PredictedMotion, DoesNotDependOnPlaceAndHeading) {
  DrivenTruth a(1, 0.5), b(1, 0.5);
  ErrorStateFilter there = started(a, "", Vector6d::Zero());
  ErrorStateFilter elsewhere(configured("initial_position_sigma_m = 1000"), tactical_noise(), DrivenTruth::frame(),
                             kMotionImu, Eigen::Vector3d::Zero());
  const Eigen::Quaterniond turn = so3_exp({0.0, 0.0, 0.5});
  const Pose X = b.X_WB();
  elsewhere.initialize(b.state().t, {turn * X.R, X.p - turn * X.R * kMotionImu + Eigen::Vector3d(700, -700, 0)},
                       turn * b.v_W());
  PredictedMotion first(there), second(elsewhere);
  for (int k = 0; k < 100; ++k) {
    const ImuSample s = a.step();
    first.predict(s);
    second.predict(s);
  }
  const RelativePose one = first.motion(), other = second.motion();
  EXPECT_NEAR(one.source - one.target, 1.0, 1e-9);
  // Earth rate and gravity are others there and for that heading: 15 deg/h and 1 km of 6,400 over 1 s.
  EXPECT_LT((one.X_TS.p - other.X_TS.p).norm(), 2e-3);
  const Eigen::Array<double, 6, 1> sigma = one.covariance.diagonal().cwiseSqrt(),
                                   as_unsure = other.covariance.diagonal().cwiseSqrt();
  EXPECT_LT(((sigma - as_unsure) / sigma).abs().maxCoeff(), 0.01);
}

// The covariance is that of the motion's error: 200 worlds whose errors the filter knows, with wheels and without.
TEST(PredictedMotion, IsAsFarOffAsItSays) {
  constexpr int kRuns = 200;
  for (const bool wheels : {false, true}) {
    ConsistencyMean mean;
    double sigma_m = 0.0;
    for (int run = 0; run < kRuns; ++run) {
      const auto seed = static_cast<std::uint64_t>(run) + 1;
      const RandomStream stream(seed, "test.motion");
      std::uint64_t n = 0;
      const auto draw = [&](double sigma) {
        ++n;
        return Eigen::Vector3d(sigma * stream.normal(0, n), sigma * stream.normal(1, n), sigma * stream.normal(2, n));
      };
      DrivenTruth truth(seed, 0.1 * run);
      const ImuNoise unit = tactical_noise();
      truth.gyro_per_sqrt_hz = unit.gyro.white_per_sqrt_hz;
      truth.accel_per_sqrt_hz = unit.accel.white_per_sqrt_hz;
      truth.bias << draw(std::hypot(unit.gyro.turn_on_bias_sigma, unit.gyro.in_run_bias_sigma)),
          draw(std::hypot(unit.accel.turn_on_bias_sigma, unit.accel.in_run_bias_sigma));
      const std::string keys = wheels ? "states = [\"biases\"]\nmeasurements = [\"odometer\"]\nodometer_tick_m = 1e-6\n"
                                        "odometer_slip_percent = 1\nodometer_wheel_m = [0, 0, 0]\n"
                                        "acceptance = \"accept_all\"\ninitial_velocity_sigma_m_s = 0.2"
                                      : "states = [\"biases\"]\ninitial_velocity_sigma_m_s = 0.2";
      ErrorStateFilter filter(configured(keys), unit, DrivenTruth::frame(), Eigen::Vector3d::Zero(),
                              Eigen::Vector3d::Zero());
      Pose X = truth.X_WB();
      const Pose X_true = X;
      const Eigen::Vector3d tilt = draw(0.1 * kDegree);
      X.R = so3_exp({tilt.x(), tilt.y(), 10.0 * tilt.z()}) * X.R;
      filter.initialize(truth.state().t, X, truth.v_W() + draw(0.2));
      PredictedMotion prediction(filter);
      double sum = 0.0;
      for (int k = 1; k <= 300; ++k) {
        prediction.predict(truth.step());
        sum += (truth.state().R_EU.conjugate() * truth.state().v_EU_E).x();
        if (k % 20 != 0 || !wheels) continue;
        OdometerSample s{.t = truth.state().t, .dt_s = 0.2, .speed_m_s = sum / 20.0};
        s.speed_m_s *= 1.0 + 0.01 * stream.normal(3, ++n);
        sum = 0.0;
        prediction.update(AidingMessage(s));
      }
      const RelativePose motion = prediction.motion();
      const Pose moved = X_true.inverse() * truth.X_WB();
      mean.add(normalized_squared((motion.X_TS.inverse() * moved).log(), motion.covariance), 6);
      sigma_m += std::sqrt(motion.covariance(3, 3)) / kRuns;
    }
    const Band band = mean_chi_square_band(6, kRuns, 1e-3);
    std::printf("3 s of %s: NEES per degree of freedom %.3f, sigma along %.3f m\n", wheels ? "IMU and wheels" : "IMU",
                mean.per_state(), sigma_m);
    EXPECT_TRUE(band.contains(6.0 * mean.per_state())) << mean.per_state();
  }
}

TEST(PredictedMotion, TakesNoFix) {
  DrivenTruth truth(1, 0.5);
  PredictedMotion prediction(started(truth, "", Vector6d::Zero()));
  prediction.predict(truth.step());
  EXPECT_THROW(prediction.update(AidingMessage(truth.fix({0, 0, 0}, 1.0))), ProgramError);
}

}  // namespace
}  // namespace canyon::fusion
