#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/tests/inertial/smooth_path.h"

/// Sensor and filter together over many seeded drives: the covariance the filter states must be the one its errors
/// have.
namespace canyon {
namespace {

using fusion::Band;
using fusion::ConsistencyMean;
using fusion::ErrorStateFilter;
using fusion::FilterConfig;

const GpsTime kStart = GpsTime::from_week_sow(1590, 396000.0);
const LocalFrame kFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
const Eigen::Vector3d kAntenna(-0.3, 0.0, 1.2);
constexpr double kFixSigma_m = 0.4;
constexpr double kFixRate_hz = 2.0;

struct DriveSetup {
  std::string sensor = "high_grade_mems";
  std::string errors = "datasheet";
  double rate_hz = 50.0;
  double seconds = 60.0;
  double last_fix_s = 1e9;  ///< fixes are withheld after this
  FilterConfig filter;
};

struct Outcome {
  double pose_nees = 0.0, velocity_nees = 0.0;  ///< at the end, 6 and 3 degrees of freedom
  double position_error_m = 0.0, position_sigma_m = 0.0;
  ConsistencyMean nis;
};

Eigen::Vector3d fix_error(std::uint64_t seed, std::int64_t epoch) {
  return kFixSigma_m * RandomStream(seed, "test.fix").normal3(static_cast<std::uint64_t>(epoch));
}

/// Truth disturbed by the filter's own initial uncertainty.
void initialize(ErrorStateFilter& filter, const FilterConfig& c, const KinematicState& truth, std::uint64_t seed) {
  const RandomStream stream(seed, "test.initial");
  const Eigen::Vector3d attitude = stream.normal3(0, 0), position = stream.normal3(0, 1),
                        velocity = stream.normal3(0, 2);
  const double tilt = c.initial_attitude_sigma_deg_roll_pitch * kDegree;
  const double heading = c.initial_attitude_sigma_deg_heading * kDegree;
  const Eigen::Vector3d turn_W(tilt * attitude.x(), tilt * attitude.y(), heading * attitude.z());
  Pose start = truth.X_WB;
  start.R = so3_exp(turn_W) * start.R;
  start.p += c.initial_position_sigma_m * position;
  filter.initialize(truth.t, start, truth.v_WB_W + c.initial_velocity_sigma_m_s * velocity);
}

Outcome drive(const DriveSetup& setup, std::uint64_t seed) {
  const testing::SmoothPath path(kStart);
  inertial::ImuConfig imu_config;
  imu_config.sensor = setup.sensor;
  imu_config.errors = setup.errors;
  imu_config.rate_hz = setup.rate_hz;
  auto imu = *inertial::make_imu(imu_config, seed, kFrame);
  ErrorStateFilter filter(setup.filter, imu->noise(), kFrame, imu_config.lever_arm_m, kAntenna);
  initialize(filter, setup.filter, path.at(kStart), seed);

  Outcome out;
  const auto samples = static_cast<std::int64_t>(setup.seconds * setup.rate_hz);
  const auto per_fix = static_cast<std::int64_t>(setup.rate_hz / kFixRate_hz);
  for (std::int64_t k = 0; k < samples; ++k) {
    filter.predict(imu->sample(k, path.nodes(k, setup.rate_hz, 2)));
    if ((k + 1) % per_fix != 0) continue;
    const GpsTime now = filter.nav_state().t;
    if (now - kStart > setup.last_fix_s) continue;
    GnssFix fix;
    fix.t = now;
    fix.status = FixStatus::kDifferential;
    fix.p_A_E = kFrame.to_E(path.at(now).X_WB * kAntenna) + fix_error(seed, k);
    fix.covariance_E = kFixSigma_m * kFixSigma_m * Eigen::Matrix3d::Identity();
    const fusion::UpdateReport report = filter.update(fix);
    out.nis.add(report.nis, report.dimension);
  }
  const NavEstimate estimate = filter.estimate();
  const KinematicState truth = path.at(estimate.t);
  const Vector6d xi = (estimate.X_WB.inverse() * truth.X_WB).log();
  out.pose_nees = fusion::normalized_squared(xi, estimate.pose_covariance);
  out.velocity_nees =
      fusion::normalized_squared(Eigen::Vector3d(truth.v_WB_W - estimate.v_WB_W), estimate.velocity_covariance_W);
  out.position_error_m = (estimate.X_WB.p - truth.X_WB.p).norm();
  out.position_sigma_m = std::sqrt(estimate.pose_covariance.bottomRightCorner<3, 3>().trace());
  return out;
}

struct Ensemble {
  double pose = 0.0, velocity = 0.0, nis = 0.0, position_rms_m = 0.0, position_sigma_rms_m = 0.0;
};

Ensemble ensemble(const DriveSetup& setup, int runs) {
  Ensemble e;
  ConsistencyMean pose, velocity;
  double nis = 0.0;
  for (int run = 0; run < runs; ++run) {
    const Outcome o = drive(setup, static_cast<std::uint64_t>(run) + 1);
    pose.add(o.pose_nees, 6);
    velocity.add(o.velocity_nees, 3);
    nis += o.nis.per_state() / runs;
    e.position_rms_m += o.position_error_m * o.position_error_m / runs;
    e.position_sigma_rms_m += o.position_sigma_m * o.position_sigma_m / runs;
  }
  e.pose = pose.per_state();
  e.velocity = velocity.per_state();
  e.nis = nis;
  e.position_rms_m = std::sqrt(e.position_rms_m);
  e.position_sigma_rms_m = std::sqrt(e.position_sigma_rms_m);
  return e;
}

constexpr double kFalseAlarm = 1e-4;

void expect_in_band(const char* what, double per_state, int dof, std::int64_t count) {
  const Band band = fusion::mean_chi_square_band(dof, count, kFalseAlarm);
  EXPECT_GE(per_state, band.low / dof) << what;
  EXPECT_LE(per_state, band.high / dof) << what;
}

class FilterLoop : public ::testing::TestWithParam<const char*> {};

TEST_P(FilterLoop, CovarianceIsThatOfTheErrors) {
  DriveSetup setup;
  setup.errors = GetParam();
  setup.filter.initial_velocity_sigma_m_s = 0.1;
  const int runs = 60;
  const Ensemble e = ensemble(setup, runs);
  std::printf("%s: NEES per state: pose %.2f, velocity %.2f; NIS %.3f; position RMS %.3f m (stated %.3f)\n", GetParam(),
              e.pose, e.velocity, e.nis, e.position_rms_m, e.position_sigma_rms_m);
  expect_in_band("pose", e.pose, 6, runs);
  expect_in_band("velocity", e.velocity, 3, runs);
  expect_in_band("innovations", e.nis, 3, runs * static_cast<std::int64_t>(setup.seconds * kFixRate_hz));
}

INSTANTIATE_TEST_SUITE_P(Chains, FilterLoop, ::testing::Values("datasheet", "full", "white_only"),
                         [](const auto& param) { return std::string(param.param); });

/// With fixes withheld the estimate drifts, and the covariance says by how much.
TEST(FilterCoasting, DriftsWithoutFixes) {
  DriveSetup aided, coasting;
  coasting.last_fix_s = 30.0;
  const int runs = 60;
  const Ensemble with = ensemble(aided, runs), without = ensemble(coasting, runs);
  std::printf("30 s without fixes: position RMS %.2f m (stated %.2f), with fixes %.3f m\n", without.position_rms_m,
              without.position_sigma_rms_m, with.position_rms_m);
  expect_in_band("pose", without.pose, 6, runs);
  EXPECT_GT(without.position_rms_m, 5.0 * with.position_rms_m);
}

/// The same drives with gain errors the filter is not told of: too confident, which is why it estimates them.
TEST(FilterGains, IgnoredScaleFactorsMakeItTooConfident) {
  DriveSetup setup;
  setup.sensor = "phidget_3_3_3";  // 1 % of scale factor, 10 mrad of misalignment
  setup.filter.initial_attitude_sigma_deg_heading = 0.2;
  setup.filter.states = {"biases"};
  const int runs = 20;
  const Ensemble ignored = ensemble(setup, runs);
  setup.filter.states = {"biases", "gains"};
  const Ensemble estimated = ensemble(setup, runs);
  std::printf("PhidgetSpatial: pose NEES per state %.2f ignoring gains, %.2f estimating them\n", ignored.pose,
              estimated.pose);
  EXPECT_GT(ignored.pose, fusion::mean_chi_square_band(6, runs, kFalseAlarm).high / 6);
  expect_in_band("pose", estimated.pose, 6, runs);
}

}  // namespace
}  // namespace canyon
