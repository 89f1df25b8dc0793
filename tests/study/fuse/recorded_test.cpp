// The filter of `canyon fuse` on runs made by others, beside the figures of a public filter (KF-GINS) on the same
// files.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/study/fuse/run.h"
#include "canyon/tests/study/fuse/recorded_inputs.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::study {
namespace {

using namespace testing;

Fused recorded_run_of(const FuseInputs& inputs, const FuseConfig& config,
                      const std::optional<OutagePlan>& outages = {}) {
  const auto plan = plan_fuse(inputs, config, outages);
  EXPECT_TRUE(plan.ok()) << plan.error().str();
  auto run = fuse(inputs, *plan);
  EXPECT_TRUE(run.ok()) << run.error().str();
  return *std::move(run);
}

void print_score(const char* what, const FuseScore& s) {
  std::printf(
      "%s: 3-D %.4f m, velocity n e u %.1f %.1f %.1f mm/s, roll pitch yaw %.4f %.4f %.4f deg (yaw sigma %.4f), NEES "
      "%.2f\n",
      what, s.rms_3d_m, 1e3 * s.velocity_rms_m_s.y(), 1e3 * s.velocity_rms_m_s.x(), 1e3 * s.velocity_rms_m_s.z(),
      s.attitude_rms_rad.x() / kDegree, s.attitude_rms_rad.y() / kDegree, s.attitude_rms_rad.z() / kDegree,
      s.attitude_sigma_rad.z() / kDegree, s.nees_mean);
}

/// What both filters draw from the same files differs by what they take for known; under 3 % of the error.
constexpr double kSame = 1.03;

struct Published {
  double rms_3d_m, yaw_deg;
  double horizontal_30_m, vertical_30_m, horizontal_60_m, vertical_60_m;
};

/// Windows as in MANIFEST.md: 30 s every 75 s (6) and 60 s every 150 s (3), from 457150 s of the week on.
void expect_outages(const FuseInputs& inputs, const FuseConfig& config, const Published& other) {
  const OutagePlan plans[] = {{30.0, 75.0, 457150.0}, {60.0, 150.0, 457150.0}};
  const std::size_t counts[] = {6, 3};
  const double horizontal[] = {other.horizontal_30_m, other.horizontal_60_m},
               vertical[] = {other.vertical_30_m, other.vertical_60_m};
  for (int i = 0; i < 2; ++i) {
    const OutageScore score = outage_score(recorded_run_of(inputs, config, plans[i]).windows);
    std::printf("  outages of %.0f s: horizontal %.3f m (public %.3f), vertical %.3f m (%.3f)\n", plans[i].length_s,
                score.horizontal_rms_of_max_m, horizontal[i], score.vertical_rms_of_max_m, vertical[i]);
    EXPECT_EQ(score.count, counts[i]);
    EXPECT_LE(score.horizontal_rms_of_max_m, horizontal[i]);
    EXPECT_LE(score.vertical_rms_of_max_m, vertical[i]);
  }
}

class Leador : public ::testing::Test {
 protected:
  void check(const LeadorUnit& unit, const Published& other) {
    CANYON_REAL_DATA(gnss, "inertial/sim_leador_a15/gnss_1hz.csv");
    CANYON_REAL_DATA(truth, "inertial/sim_leador_a15/truth_10hz.csv");
    CANYON_REAL_DATA(imu, std::string("inertial/sim_leador_a15/") + unit.file);
    const FuseInputs inputs = leador_inputs(imu, gnss, truth);
    // The start is the truth itself, exact to the file's digits, and the filter is told so. Told 0.1 degrees of heading
    // it unlearns that: yaw of the A15 is then 0.0055 deg, of a sigma of 0.0073.
    const FuseConfig config = leador_config(unit, 0.01);
    score_ = fuse_score(recorded_run_of(inputs, config).errors);
    print_score(unit.file, score_);
    EXPECT_LE(score_.rms_3d_m, kSame * other.rms_3d_m);
    EXPECT_LE(score_.attitude_rms_rad.z() / kDegree, kSame * other.yaw_deg);
    print_score("  heading known to 0.1 deg", fuse_score(recorded_run_of(inputs, leador_config(unit, 0.1)).errors));
    expect_outages(inputs, config, other);
  }
  FuseScore score_;
};

TEST_F(Leador, TacticalGradeAsThePublicFilter) {
  check(kA15, {0.0141, 0.0047, 0.080, 0.116, 0.288, 0.413});
  if (score_.instants == 0) return;
  const double public_enu_m_s[3] = {1.3e-3, 1.5e-3, 1.9e-3};
  for (int i = 0; i < 3; ++i) EXPECT_LE(score_.velocity_rms_m_s[i], kSame * public_enu_m_s[i]) << i;
}

TEST_F(Leador, IndustrialMemsAsThePublicFilter) {
  check(kAdis16465, {0.0218, 0.063, 1.63, 0.31, 8.85, 1.80});
}

constexpr const char* kNavego = R"(
[fusion]
states = ["turn_on_biases", "in_run_biases"]
measurements = ["position", "velocity"]
fix_velocity_floor_m_s = 0.01
initial_attitude_sigma_deg_roll_pitch = 1.0
initial_position_sigma_m = 5.0
initial_velocity_sigma_m_s = 0.5
[imu]
sensor = "ideal"
arw_deg_per_sqrt_hr = 2.0
gyro_turn_on_bias_deg_per_hr = 10800.0
gyro_in_run_bias_deg_per_hr = 25.2
gyro_in_run_bias_tau_s = 100
vrw_m_s_per_sqrt_hr = 0.2
accel_turn_on_bias_mg = 50
accel_in_run_bias_mg = 0.2
accel_in_run_bias_tau_s = 100
[score]
skip_s = 200
)";

/// Of the fixes' positions alone (5, 5, 10 m) the turns of this drive give a yaw of 0.59 deg, of a sigma of 0.70 that
/// does not fall below 0.58 where the biases are known from the start; the file's velocities (0.05 m/s) are what gives
/// better than 0.28.
TEST(Navego, YawAfterALargeTurnOnBias) {
  CANYON_REAL_DATA(gnss, "inertial/navego_synthetic/gnss_5hz.csv");
  CANYON_REAL_DATA(truth, "inertial/navego_synthetic/truth_20hz.csv");
  CANYON_REAL_DATA(imu, "inertial/navego_synthetic/imu_adis16405_200hz.f32");
  const FuseInputs inputs = navego_inputs(imu, gnss, truth);
  FuseConfig config = config_of(kNavego);
  const FuseScore s = fuse_score(recorded_run_of(inputs, config).errors);
  print_score("NaveGo, positions and velocities", s);
  EXPECT_LE(s.attitude_rms_rad.z() / kDegree, 0.28);
  config.fusion.measurements = {"position"};
  const FuseScore alone = fuse_score(recorded_run_of(inputs, config).errors);
  print_score("NaveGo, positions alone", alone);
  EXPECT_LT(alone.rms_3d_m, 1.05 * std::hypot(1.26, 1.33, 1.41));  // the public filter's, well tuned
}

/// Means of (error / sigma)^2 over new draws, all three axes of attitude, position and velocity: within the band that
/// the draws' own spread gives, 99 % for the nine together (Student's quantile of 1 - 0.005 / 9).
void expect_consistent_draws(const FuseInputs& ideal, const FuseConfig& config, int draws, double t) {
  const auto plan = plan_fuse(ideal, config, {});
  ASSERT_TRUE(plan.ok()) << plan.error().str();
  std::vector<double> ratios[9];
  for (int seed = 1; seed <= draws; ++seed) {
    const auto run = fuse(drawn(ideal, *plan, static_cast<std::uint64_t>(seed)), *plan);
    ASSERT_TRUE(run.ok()) << run.error().str();
    const FuseScore s = fuse_score(run->errors);
    const Eigen::Vector3d* rms[] = {&s.attitude_rms_rad, &s.position_rms_m, &s.velocity_rms_m_s};
    const Eigen::Vector3d* sigma[] = {&s.attitude_sigma_rad, &s.position_sigma_m, &s.velocity_sigma_m_s};
    for (int i = 0; i < 9; ++i) ratios[i].push_back(std::pow((*rms[i / 3])[i % 3] / (*sigma[i / 3])[i % 3], 2));
  }
  const char* const names[] = {"roll", "pitch", "yaw", "east", "north", "up", "v east", "v north", "v up"};
  for (int i = 0; i < 9; ++i) {
    const Ratio r = ratio_over(ratios[i], t);
    std::printf("  %-8s (RMS / sigma)^2 %.3f +- %.3f\n", names[i], r.mean, r.half_width);
    EXPECT_LE(std::abs(r.mean - 1.0), r.half_width) << names[i];
  }
}

TEST(FuseDrawsNightly, ErrorsOfFiftyDrawsAreAsLargeAsTheFilterSays) {
  CANYON_REAL_DATA(gnss, "inertial/sim_leador_a15/gnss_1hz.csv");
  CANYON_REAL_DATA(truth, "inertial/sim_leador_a15/truth_10hz.csv");
  CANYON_REAL_DATA(imu, "inertial/sim_leador_a15/imu_ideal_100hz.f64");
  const FuseInputs ideal = leador_inputs(imu, gnss, truth);
  constexpr double kStudent49 = 3.46;
  for (const LeadorUnit* unit : {&kA15, &kAdis16465}) {
    std::printf("%s, 50 draws\n", unit->file);
    expect_consistent_draws(ideal, leador_config(*unit, 0.01), 50, kStudent49);
  }
}

TEST(FuseDrawsNightly, NavegoInItsBand) {
  CANYON_REAL_DATA(gnss, "inertial/navego_synthetic/gnss_5hz.csv");
  CANYON_REAL_DATA(truth, "inertial/navego_synthetic/truth_20hz.csv");
  const FuseInputs ideal = ideal_navego_inputs(gnss, truth);
  constexpr double kStudent23 = 3.74;
  FuseConfig config = config_of(kNavego);
  std::printf("positions and velocities, 24 draws\n");
  expect_consistent_draws(ideal, config, 24, kStudent23);
  // With positions alone 3 deg/s of bias turn the heading by tens of degrees before a turn shows it, which is more than
  // a filter can be linear about: in some draws it never finds back. Told, not judged.
  config.fusion.measurements = {"position"};
  const auto plan = plan_fuse(ideal, config, {});
  ASSERT_TRUE(plan.ok());
  std::vector<double> yaw_deg;
  for (std::uint64_t seed = 1; seed <= 24; ++seed)
    yaw_deg.push_back(fuse_score(fuse(drawn(ideal, *plan, seed), *plan)->errors).attitude_rms_rad.z() / kDegree);
  std::sort(yaw_deg.begin(), yaw_deg.end());
  std::printf(
      "positions alone, 24 draws: yaw %.2f deg at the least, median %.2f, three quarters below %.2f, most %.2f\n",
      yaw_deg[0], 0.5 * (yaw_deg[11] + yaw_deg[12]), yaw_deg[17], yaw_deg[23]);
}

/// A drive with a low-cost unit in a car whose engine shakes it; the reference is the fixes that were withheld. Windows
/// of 15 s every 40 s and 30 s every 50 s from 100 s on: 11 and 9, as many as the public filter's, whose own windows
/// are not known. The figures of the unit are the public filter's too (MANIFEST.md), not tuned here.
constexpr const char* kRecordedDrive = R"(
[fusion]
states = ["biases", "gains"]
measurements = ["position"]
fix_sigma_floor_m = 0.02
imu_gain_tau_s = 3600.0
[imu]
sensor = "ideal"
turn_deg = [180.0, -6.79, 185.35]
axes = "frd"
clock_offset_s = -0.125
lever_m = [0.0, 0.0, 0.65]
arw_deg_per_sqrt_hr = 0.4
gyro_in_run_bias_deg_per_hr = 60
gyro_in_run_bias_tau_s = 3600
gyro_scale_ppm = 1000
vrw_m_s_per_sqrt_hr = 0.3
accel_in_run_bias_mg = 0.51
accel_in_run_bias_tau_s = 3600
accel_scale_ppm = 1000
[gnss]
lever_m = [0.0, 0.05, 0.65]
[truth]
of = "antenna"
[start]
from = "in_motion"
)";

TEST(DriveMemsPpk, OutagesWithAndWithoutTheConstraint) {
  CANYON_REAL_DATA(gnss, "inertial/drive_mems_ppk/gnss_ppk_4hz.csv");
  CANYON_REAL_DATA(imu, "inertial/drive_mems_ppk/imu_raw_100hz.csv");
  FuseConfig config = config_of(kRecordedDrive);
  const auto inputs = read_fuse_inputs({.imu = imu, .gnss = gnss, .odometer = {}, .truth = gnss, .navigation = {}},
                                       config, [](const std::string&) {});
  ASSERT_TRUE(inputs.ok()) << inputs.error().str();
  const OutagePlan plans[] = {{15.0, 40.0, 100.0}, {30.0, 50.0, 100.0}};
  const std::size_t counts[] = {11, 9};
  const double public_m[] = {13.1, 42.0};
  for (int i = 0; i < 2; ++i) {
    double horizontal_m[2] = {};
    for (const bool constrained : {false, true}) {
      config.fusion.measurements = {"position"};
      if (constrained) config.fusion.measurements.push_back("non_holonomic");
      const OutageScore score = outage_score(recorded_run_of(*inputs, config, plans[i]).windows);
      EXPECT_EQ(score.count, counts[i]);
      horizontal_m[constrained ? 1 : 0] = score.horizontal_rms_of_max_m;
    }
    std::printf("outages of %.0f s: horizontal %.1f m (public, other windows: %.1f), with the constraint %.1f m\n",
                plans[i].length_s, horizontal_m[0], public_m[i], horizontal_m[1]);
    EXPECT_LE(horizontal_m[1], 0.5 * horizontal_m[0]);
  }
}

}  // namespace
}  // namespace canyon::study
