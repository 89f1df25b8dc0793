#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/inertial/motion/models.h"
#include "canyon/tests/inertial/smooth_motion.h"

/// Generator against strapdown: the increments of a known drive, integrated, must give the drive back.
namespace canyon {
namespace {

using fusion::NavState;
using inertial::PlacedMotion;

const GpsTime kClosureStart = GpsTime::from_week_sow(1590, 396000.0);

NavState true_state(const PlacedMotion& placed, double t_s) {
  const KinematicState k = placed.imu_at(t_s);
  NavState s;
  s.t = placed.start + t_s;
  s.R_EU = (Eigen::Quaterniond(placed.frame.R_EW()) * k.X_WB.R).normalized();
  s.p_EU_E = placed.frame.to_E(k.X_WB.p);
  s.v_EU_E = placed.frame.R_EW() * k.v_WB_W;
  return s;
}

struct Drift {
  double position_rms_m = 0.0, attitude_rms_rad = 0.0, velocity_rms_m_s = 0.0;
  double position_max_m = 0.0;
};

/// Free inertial navigation from truth; errors over all seconds. The integrator has seen the two intervals before the
/// start, as one that runs has.
Drift drive(const char* model, const PlacedMotion& placed, double rate_hz, int seconds) {
  auto strapdown = fusion::make_strapdown(model);
  NavState state;
  Drift d;
  const auto per_second = static_cast<std::int64_t>(rate_hz);
  for (std::int64_t k = -2; k < seconds * per_second; ++k) {
    if (k == -2 || k == 0) state = true_state(placed, static_cast<double>(k) / rate_hz);
    const double to_s = static_cast<double>(k + 1) / rate_hz;
    const ImuSample s = inertial::motion_increments(placed, static_cast<double>(k) / rate_hz, to_s);
    strapdown->advance(state, {.dt_s = s.dt_s, .dtheta_U = s.dtheta_U, .dv_U = s.dv_U});
    if (k < 0 || (k + 1) % per_second != 0) continue;
    const NavState truth = true_state(placed, to_s);
    const double p = (state.p_EU_E - truth.p_EU_E).norm();
    d.position_rms_m += p * p / seconds;
    d.velocity_rms_m_s += (state.v_EU_E - truth.v_EU_E).squaredNorm() / seconds;
    const double a = state.R_EU.angularDistance(truth.R_EU);
    d.attitude_rms_rad += a * a / seconds;
    d.position_max_m = std::max(d.position_max_m, p);
  }
  d.position_rms_m = std::sqrt(d.position_rms_m);
  d.velocity_rms_m_s = std::sqrt(d.velocity_rms_m_s);
  d.attitude_rms_rad = std::sqrt(d.attitude_rms_rad);
  return d;
}

TEST(Closure, OneMillimetreAtTwoHundredHertz) {
  for (const char* model : {"two_sample", "three_sample"}) {
    for (int seconds : {60, 600}) {
      const Drift d = drive(model, testing::smooth_motion(), 200.0, seconds);
      std::printf("closure of %s, %d s at 200 Hz: position %.1e m, velocity %.1e m/s, attitude %.1e deg\n", model,
                  seconds, d.position_max_m, d.velocity_rms_m_s, d.attitude_rms_rad / kDegree);
      EXPECT_LT(d.position_max_m, 1e-3) << model << ", " << seconds;
    }
  }
}

/// At rest for an hour, tilted and turned so that no axis is special. The vertical channel grows as exp(t / 570 s).
TEST(Closure, AtRestForAnHour) {
  inertial::MotionConfig config;
  config.heading_deg = 33.0;
  config.pitch_deg = 11.0;
  config.roll_deg = -23.0;
  const PlacedMotion placed = *inertial::make_motion(config, 1);
  const ImuSample s = inertial::motion_increments(placed, 0.0, 0.01);  // all are alike
  for (const fusion::StrapdownRow& row : fusion::strapdown_models()) {
    auto strapdown = fusion::make_strapdown(row.name);
    NavState state = true_state(placed, 0.0);
    const NavState start = state;
    for (int k = 0; k < 360000; ++k)
      strapdown->advance(state, {.dt_s = s.dt_s, .dtheta_U = s.dtheta_U, .dv_U = s.dv_U});
    const Eigen::Vector3d drift = placed.frame.R_EW().transpose() * (state.p_EU_E - start.p_EU_E);
    std::printf("%s at rest, 1 h at 100 Hz: %.1e m horizontal, %.1e m vertical, %.1e deg\n", row.name,
                drift.head<2>().norm(), drift.z(), state.R_EU.angularDistance(start.R_EU) / kDegree);
    if (row.order > 1) {  // Euler does not turn the force with the Earth within the interval: 1.8 m and 13 m
      EXPECT_LT(drift.head<2>().norm(), 1e-3) << row.name;
      EXPECT_LT(std::abs(drift.z()), 1e-2) << row.name;
    }
    EXPECT_LT(state.R_EU.angularDistance(start.R_EU), 1e-8 * kDegree) << row.name;
  }
}

/// 2000 deg/s at 100 g on an arm at the pole: rate and force are constant in the body but for gravity, which the
/// closed form takes exactly.
TEST(Closure, CentrifugeOfAHundredG) {
  inertial::MotionConfig config;
  config.path = "circle";
  config.lat_deg = 90.0;
  const double rate = 2000.0 * kDegree;
  config.radius_m = 100.0 * kStandardGravity / (rate * rate);
  config.speed_m_s = rate * config.radius_m;
  const PlacedMotion placed = *inertial::make_motion(config, 1);
  for (const char* model : {"constant_rate", "three_sample"}) {
    const Drift d = drive(model, placed, 1000.0, 20);
    std::printf("%s at 2000 deg/s and 100 g, 20 s at 1 kHz: position %.1e m, attitude %.1e deg\n", model,
                d.position_max_m, d.attitude_rms_rad / kDegree);
    EXPECT_LT(d.position_max_m, 1e-3) << model;
    EXPECT_LT(d.attitude_rms_rad, 1e-9) << model;
  }
}

TEST(Closure, ThePathIsWithinItsStatedLimits) {
  const testing::SmoothPath path(kClosureStart);
  double speed = 0.0, rate = 0.0;
  for (int i = 0; i < 6000; ++i) {
    const KinematicState k = path.at(kClosureStart + 0.1 * i);
    speed = std::max(speed, k.v_WB_W.norm());
    rate = std::max(rate, k.w_WB_B.norm());
  }
  EXPECT_LE(speed, 15.0);
  EXPECT_LE(rate, 25.0 * kDegree);
}

/// The path's rates are the derivatives of its attitude: a slip there would hide in generator and comparison alike.
TEST(Closure, ThePathsDerivativesAreItsDerivatives) {
  const testing::SmoothPath path(kClosureStart);
  const double h = 1e-3;
  for (double s : {1.0, 7.3, 22.9}) {
    const KinematicState a = path.at(kClosureStart + (s - h)), k = path.at(kClosureStart + s),
                         b = path.at(kClosureStart + (s + h));
    const Eigen::Vector3d w =
        (so3_log(k.X_WB.R.conjugate() * b.X_WB.R) - so3_log(k.X_WB.R.conjugate() * a.X_WB.R)) / (2 * h);
    EXPECT_LT((w - k.w_WB_B).norm(), h * h) << s;  // second order: h^2 / 6 times the third derivative, under 1 1/s^3
    EXPECT_LT(((b.w_WB_B - a.w_WB_B) / (2 * h) - k.alpha_WB_B).norm(), h * h) << s;
    EXPECT_LT(((b.X_WB.p - a.X_WB.p) / (2 * h) - k.v_WB_W).norm(), h * h) << s;
    EXPECT_LT(((b.v_WB_W - a.v_WB_W) / (2 * h) - k.a_WB_W).norm(), h * h) << s;
  }
}

/// The same drive with the IMU swinging at 2 Hz, by 30 degrees and 20 m/s^2: where the fourth order's error stands
/// clear of rounding (1e-8 m in coordinates of 6e6 m).
PlacedMotion shaken_motion() {
  PlacedMotion placed = testing::smooth_motion();
  inertial::VibrationConfig shake;
  shake.sinusoid = {{.frequency_hz = 2.0, .acceleration_m_s2 = {20.0, 5.0, 0.0}, .angle_deg = {30.0, 0.0, 0.0}},
                    {.frequency_hz = 1.7, .acceleration_m_s2 = {0.0, 20.0, 10.0}, .angle_deg = {0.0, 20.0, 30.0}}};
  placed.motion = *inertial::with_vibration(placed.motion, shake, 0);
  return placed;
}

/// The error falls as the interval to the power of the integrator's order, at every doubling from 50 to 400 Hz.
TEST(Closure, IntegratorsHaveTheirOrder) {
  for (const fusion::StrapdownRow& row : fusion::strapdown_models()) {
    const PlacedMotion placed = row.order < 4 ? testing::smooth_motion() : shaken_motion();
    Drift before;
    for (const double rate_hz : {50.0, 100.0, 200.0, 400.0}) {
      const Drift d = drive(row.name, placed, rate_hz, 20);
      std::printf("%-13s %3.0f Hz: position %.2e m, velocity %.2e m/s, attitude %.2e rad", row.name, rate_hz,
                  d.position_rms_m, d.velocity_rms_m_s, d.attitude_rms_rad);
      if (rate_hz > 50.0) {
        const double position = std::log2(before.position_rms_m / d.position_rms_m);
        const double velocity = std::log2(before.velocity_rms_m_s / d.velocity_rms_m_s);
        const double attitude = std::log2(before.attitude_rms_rad / d.attitude_rms_rad);
        std::printf("; orders %.2f, %.2f, %.2f", position, velocity, attitude);
        EXPECT_NEAR(position, *row.order, 0.2) << row.name << " at " << rate_hz << " Hz";
        EXPECT_NEAR(velocity, row.make.velocity_order, 0.2) << row.name << " at " << rate_hz << " Hz";
        EXPECT_NEAR(attitude, row.make.attitude_order, 0.2) << row.name << " at " << rate_hz << " Hz";
      }
      std::printf("\n");
      before = d;
    }
  }
}

}  // namespace
}  // namespace canyon
