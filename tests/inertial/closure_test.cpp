#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "core/rotation.h"
#include "core/units.h"
#include "fusion/strapdown.h"
#include "inertial/true_increments.h"
#include "tests/inertial/smooth_path.h"

/// Generator against strapdown: the increments of a known drive, integrated, must give the drive back.
namespace canyon {
namespace {

using fusion::NavState;

const GpsTime kStart = GpsTime::from_week_sow(1590, 396000.0);
const Eigen::Vector3d kLever(0.2, -0.1, 0.4);

NavState true_state(const LocalFrame& frame, const KinematicState& k) {
  NavState s;
  s.t = k.t;
  s.R_EU = (Eigen::Quaterniond(frame.R_EW()) * k.X_WB.R).normalized();
  s.p_EU_E = frame.to_E(k.X_WB * kLever);
  s.v_EU_E = frame.R_EW() * (k.v_WB_W + k.X_WB.R * k.w_WB_B.cross(kLever));
  return s;
}

struct Drift {
  double position_rms_m = 0.0, attitude_rms_rad = 0.0, velocity_rms_m_s = 0.0;
  double position_max_m = 0.0;
};

/// Free inertial navigation from truth; errors over all seconds.
Drift drive(const char* model, double rate_hz, int seconds) {
  const LocalFrame frame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
  const testing::SmoothPath path(kStart);
  NavState state = true_state(frame, path.at(kStart));
  auto strapdown = fusion::make_strapdown(model);
  Drift d;
  const auto per_second = static_cast<std::int64_t>(rate_hz);
  for (std::int64_t k = 0; k < seconds * per_second; ++k) {
    const ImuSample s = inertial::true_increments(path.nodes(k, rate_hz, 4), frame, kLever);
    strapdown->advance(state, {.dt_s = s.dt_s, .dtheta_U = s.dtheta_U, .dv_U = s.dv_U});
    if ((k + 1) % per_second != 0) continue;
    const NavState truth = true_state(frame, path.at(s.t));
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
  for (int seconds : {60, 600}) {
    const Drift d = drive("two_sample", 200.0, seconds);
    RecordProperty("position_max_m_" + std::to_string(seconds), std::to_string(d.position_max_m));
    std::printf("closure, %d s at 200 Hz: position %.1e m, velocity %.1e m/s, attitude %.1e deg\n", seconds,
                d.position_max_m, d.velocity_rms_m_s, d.attitude_rms_rad / kDegree);
    EXPECT_LT(d.position_max_m, 1e-3) << seconds;
  }
}

TEST(Closure, ThePathIsWithinItsStatedLimits) {
  const testing::SmoothPath path(kStart);
  double speed = 0.0, rate = 0.0;
  for (int i = 0; i < 6000; ++i) {
    const KinematicState k = path.at(kStart + 0.1 * i);
    speed = std::max(speed, k.v_WB_W.norm());
    rate = std::max(rate, k.w_WB_B.norm());
  }
  EXPECT_LE(speed, 15.0);
  EXPECT_LE(rate, 25.0 * kDegree);
}

/// The path's rates are the derivatives of its attitude: a slip there would hide in generator and comparison alike.
TEST(Closure, ThePathsDerivativesAreItsDerivatives) {
  const testing::SmoothPath path(kStart);
  const double h = 1e-3;
  for (double s : {1.0, 7.3, 22.9}) {
    const KinematicState a = path.at(kStart + (s - h)), k = path.at(kStart + s), b = path.at(kStart + (s + h));
    const Eigen::Vector3d w =
        (so3_log(k.X_WB.R.conjugate() * b.X_WB.R) - so3_log(k.X_WB.R.conjugate() * a.X_WB.R)) / (2 * h);
    EXPECT_LT((w - k.w_WB_B).norm(), h * h) << s;  // second order: h^2 / 6 times the third derivative, under 1 1/s^3
    EXPECT_LT(((b.w_WB_B - a.w_WB_B) / (2 * h) - k.alpha_WB_B).norm(), h * h) << s;
    EXPECT_LT(((b.X_WB.p - a.X_WB.p) / (2 * h) - k.v_WB_W).norm(), h * h) << s;
    EXPECT_LT(((b.v_WB_W - a.v_WB_W) / (2 * h) - k.a_WB_W).norm(), h * h) << s;
  }
}

/// The error falls as the interval to the power of the integrator's order, from 50 to 200 Hz. Attitude alone is one
/// order better: coning enters in second order, and what the two-sample correction leaves of it in third.
TEST(Closure, IntegratorsHaveTheirOrder) {
  for (const fusion::StrapdownRow& row : fusion::strapdown_models()) {
    const Drift slow = drive(row.name, 50.0, 20), fast = drive(row.name, 200.0, 20);
    const double order = 0.5 * std::log2(slow.position_rms_m / fast.position_rms_m);
    const double attitude_order = 0.5 * std::log2(slow.attitude_rms_rad / fast.attitude_rms_rad);
    std::printf("%s: position error %.1e m at 50 Hz, %.1e m at 200 Hz, order %.2f; attitude order %.2f\n", row.name,
                slow.position_rms_m, fast.position_rms_m, order, attitude_order);
    EXPECT_NEAR(order, row.order, 0.2) << row.name;
    EXPECT_NEAR(attitude_order, row.order + 1, 0.2) << row.name;
  }
}

}  // namespace
}  // namespace canyon
