// The run of canyon fuse on logs of a drive in closed form: order, gaps, starts, bad input.
#include "canyon/study/fuse/run.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/tests/study/fuse/recorded_inputs.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using testing::config_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Ninety seconds of a figure eight at 50 Hz, a fix a second 2 cm good and off by nothing, truth at 10 Hz.
class FuseRunTest : public ::testing::Test {
 protected:
  static constexpr double kRate_hz = 50.0;
  static constexpr int kSamples = 4500;
  static constexpr const char* kConfig =
      "[imu]\nsensor = \"stim300\"\nlever_m = [0.2, 0.1, 0.5]\n[gnss]\nlever_m = [-0.3, 0.0, 1.2]\n";

  static const FuseInputs& drive() {
    static const FuseInputs inputs = made();
    return inputs;
  }
  static Fused run_of(const FuseInputs& inputs, const FuseConfig& config, const FusePlan* with = nullptr) {
    auto plan = plan_fuse(inputs, config, {});
    EXPECT_TRUE(plan.ok()) << plan.error().str();
    auto run = fuse(inputs, with != nullptr ? *with : *plan);
    EXPECT_TRUE(run.ok()) << run.error().str();
    return *std::move(run);
  }
  static Eigen::Vector3d last_position(const Fused& run) { return run.epochs.back().nav.p_EU_E; }

 private:
  static FuseInputs made() {
    inertial::MotionConfig config;
    config.path = "figure_eight";
    auto motion = *inertial::make_motion(config, 1);
    motion.lever_arm_m = {0.2, 0.1, 0.5};
    const GpsTime start = GpsTime::from_week_sow(2200, 1000.0);
    FuseInputs in;
    in.imu.path = "imu.csv";
    in.gnss_path = "fixes.csv";
    in.truth.path = "truth.csv";
    in.imu.interval_s = 1.0 / kRate_hz;
    in.truth.has_attitude = in.truth.has_velocity = true;
    const Eigen::Matrix3d& R = motion.frame.R_EW();
    for (int k = 0; k <= kSamples; ++k) {
      const double t_s = k / kRate_hz;
      const KinematicState imu = motion.imu_at(t_s), body = motion.motion->at(t_s);
      const GpsTime t = tick(start, k, kRate_hz);
      if (k % 5 == 0)
        in.truth.states.push_back({.t = t,
                                   .R_EU = (Eigen::Quaterniond(R) * imu.X_WB.R).normalized(),
                                   .p_EU_E = motion.frame.to_E(imu.X_WB.p),
                                   .v_EU_E = R * imu.v_WB_W});
      if (k % 50 == 25) {
        GnssFix fix;
        fix.t = t;
        fix.status = FixStatus::kDifferential;
        fix.p_A_E = motion.frame.to_E(body.X_WB * Eigen::Vector3d(-0.3, 0.0, 1.2));
        fix.covariance_E = 4e-4 * Eigen::Matrix3d::Identity();
        in.fixes.push_back(fix);
      }
      if (k == 0) continue;
      ImuSample sample = inertial::motion_increments(motion, (k - 1) / kRate_hz, t_s);
      sample.t = t;
      sample.dt_s = 1.0 / kRate_hz;
      in.imu.samples.push_back(sample);
    }
    return in;
  }
};

TEST_F(FuseRunTest, StaysOnTheTruth) {
  const Fused run = run_of(drive(), config_of(kConfig));
  const FuseScore s = fuse_score(run.errors);
  EXPECT_EQ(run.start_from, "truth");
  EXPECT_EQ(run.samples, static_cast<std::size_t>(kSamples));
  EXPECT_EQ(run.fixes_accepted, 90U);
  EXPECT_EQ(s.instants, 901U);
  // Without noise what is left is the integrator's (50 Hz, two_sample: 30 um in 20 s) and what the filter makes of it.
  EXPECT_LT(s.rms_3d_m, 1e-3);
  EXPECT_EQ(run.gaps_bridged, 0U);
  EXPECT_THAT(run.measurements, ElementsAre("position"));
}

// A fix between two samples divides the one that holds it: the same place as where the log itself is divided there.
TEST_F(FuseRunTest, AFixWithinASampleDividesIt) {
  FuseInputs shifted = drive();
  for (GnssFix& fix : shifted.fixes) fix.t = fix.t + 0.007;
  // The antenna is where it is 7 ms later: the fixes are wrong by that, and the filter follows both ways alike.
  FuseInputs divided = shifted;
  divided.imu.samples.clear();
  std::size_t next = 0;
  for (ImuSample sample : shifted.imu.samples) {
    if (next < shifted.fixes.size() && shifted.fixes[next].t < sample.t) {
      ImuSample first = sample;
      const double share = (shifted.fixes[next].t - (sample.t + -sample.dt_s)) / sample.dt_s;
      first.t = shifted.fixes[next++].t;
      for (Eigen::Vector3d* v : {&first.dtheta_U, &first.dv_U}) *v *= share;
      first.dt_s *= share;
      sample.dtheta_U -= first.dtheta_U;
      sample.dv_U -= first.dv_U;
      sample.dt_s -= first.dt_s;
      divided.imu.samples.push_back(first);
    }
    divided.imu.samples.push_back(sample);
  }
  const FuseConfig config = config_of(kConfig);
  // The same numbers but for the rounding of shares, over 4500 steps of positions of 6e6 m.
  EXPECT_LT((last_position(run_of(shifted, config)) - last_position(run_of(divided, config))).norm(), 1e-6);
}

TEST_F(FuseRunTest, AGapIsBridgedWithTheLastSample) {
  FuseInputs in = drive();
  in.imu.samples.erase(in.imu.samples.begin() + 2000, in.imu.samples.begin() + 2020);  // 0.4 s
  const Fused run = run_of(in, config_of(kConfig));
  EXPECT_EQ(run.gaps_bridged, 1U);
  EXPECT_EQ(run.restarts, 0U);
  EXPECT_NEAR(run.bridged_s, 0.4, 1e-6);
  // A change of acceleration of at most 1 m/s^3 over 0.4 s leaves 1 cm; fixes take it off again.
  EXPECT_LT(fuse_score(run.errors).rms_3d_m, 0.05);
}

TEST_F(FuseRunTest, AfterALongGapItStartsAnewInMotion) {
  FuseInputs in = drive();
  in.imu.samples.erase(in.imu.samples.begin() + 2000, in.imu.samples.begin() + 2500);  // 10 s
  const Fused run = run_of(in, config_of(kConfig));
  EXPECT_EQ(run.restarts, 1U);
  const FuseError& last = run.errors.back();
  EXPECT_LT(last.position_enu_m.norm(), 0.1);
  EXPECT_LT(std::abs(last.attitude_rad.z()), 4.0 * last.attitude_sigma_rad.z());
}

// In a figure eight of a car the nose follows the course; levelling and course are as good as they say, and the filter
// comes to the truth.
TEST_F(FuseRunTest, AlignsInMotion) {
  const FuseConfig config = config_of(std::string(kConfig) + "[start]\nfrom = \"in_motion\"\n[score]\nskip_s = 30\n");
  const auto plan = plan_fuse(drive(), config, {});
  ASSERT_TRUE(plan.ok()) << plan.error().str();
  EXPECT_GT(plan->start, drive().begin());
  const Fused run = run_of(drive(), config);
  const FuseError& first = run.errors.front();
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(first.attitude_rad[i]), 4.0 * first.attitude_sigma_rad[i]) << i;
    EXPECT_LT(std::abs(first.position_enu_m[i]), 4.0 * first.position_sigma_m[i]) << i;
    EXPECT_LT(std::abs(first.velocity_enu_m_s[i]), 4.0 * first.velocity_sigma_m_s[i]) << i;
  }
  EXPECT_LT(fuse_score(run.errors).rms_3d_m, 0.02);
}

// Nobody says which way it looks: 1-sigma of 180 degrees. A filter alone that starts off by 179 degrees stays there.
TEST_F(FuseRunTest, AnUnknownHeadingDoesNotBreakTheFilter) {
  FuseConfig config = config_of(std::string(kConfig) + "[score]\nskip_s = 60\n");
  config.fusion.initial_attitude_sigma_deg_heading = 180.0;
  for (const double off_deg : {-170.0, -90.0, 20.0, 90.0, 179.0}) {
    auto plan = plan_fuse(drive(), config_of(kConfig), {});
    ASSERT_TRUE(plan.ok());
    plan->filter = config.fusion;
    plan->skip_s = config.score.skip_s;
    plan->X_WB.R = Eigen::Quaterniond(Eigen::AngleAxisd(off_deg * kDegree, Eigen::Vector3d::UnitZ())) * plan->X_WB.R;
    ASSERT_TRUE(settle_heading(drive(), *plan).ok());
    const Fused run = run_of(drive(), config, &*plan);
    const FuseScore s = fuse_score(run.errors);
    std::printf("heading off by %.0f deg: after a minute %.3f m, yaw %.2f deg\n", off_deg, s.rms_3d_m,
                s.attitude_rms_rad.z() / kDegree);
    EXPECT_LT(s.rms_3d_m, 0.1) << off_deg;
    EXPECT_LT(s.attitude_rms_rad.z() / kDegree, 1.0) << off_deg;
  }
}

TEST_F(FuseRunTest, StaticAlignmentFindsLevelAndNorth) {
  FuseInputs in = drive();
  inertial::MotionConfig config;
  config.heading_deg = 73.0;
  config.pitch_deg = 3.0;
  config.roll_deg = -2.0;
  const auto motion = *inertial::make_motion(config, 1);
  in.truth.states.clear();
  for (std::size_t k = 0; k < in.imu.samples.size(); ++k) {
    const GpsTime t = in.imu.samples[k].t;
    in.imu.samples[k] =
        inertial::motion_increments(motion, static_cast<double>(k) / kRate_hz, static_cast<double>(k + 1) / kRate_hz);
    in.imu.samples[k].t = t;
    in.imu.samples[k].dt_s = 1.0 / kRate_hz;
  }
  const KinematicState body = motion.motion->at(0.0);
  for (GnssFix& fix : in.fixes) fix.p_A_E = motion.frame.to_E(body.X_WB * Eigen::Vector3d(-0.3, 0.0, 1.2));
  // Gyroscopes of 0.1 deg/h: the Earth's rate shows north to 0.1 / (15 cos 32) rad.
  const std::string toml =
      "[imu]\nsensor = \"ideal\"\narw_deg_per_sqrt_hr = 0.001\ngyro_in_run_bias_deg_per_hr = 0.1\nvrw_m_s_per_sqrt_hr "
      "= "
      "0.01\naccel_in_run_bias_mg = 0.1\n[gnss]\nlever_m = [-0.3, 0.0, 1.2]\n[start]\nfrom = \"static\"\n";
  const auto good = plan_fuse(in, config_of(toml), {});
  ASSERT_TRUE(good.ok()) << good.error().str();
  EXPECT_NEAR(good->filter.initial_attitude_sigma_deg_heading, 0.1 / (15.04 * std::cos(32.35 * kDegree)) / kDegree,
              0.05);
  // No errors in the samples: what differs is the spline of numbers, 1e-9 of gravity and of the Earth's rate.
  EXPECT_LT(good->X_WB.R.angularDistance(body.X_WB.R), 1e-5);
  EXPECT_LT((good->X_WB.p - Eigen::Vector3d::Zero()).norm(), 1.0);
  const auto poor = plan_fuse(in, config_of("[imu]\nsensor = \"mpu6050\"\n[start]\nfrom = \"static\"\n"), {});
  ASSERT_TRUE(poor.ok());
  EXPECT_DOUBLE_EQ(poor->filter.initial_attitude_sigma_deg_heading, 180.0);
}

TEST_F(FuseRunTest, AStartThatCannotBeFoundIsAnError) {
  FuseInputs in = drive();
  const auto error = [&](const char* toml) { return plan_fuse(in, config_of(toml), {}).error().str(); };
  EXPECT_THAT(error("[start]\nfrom = \"in_motion\"\nin_motion_speed_m_s = 200"),
              HasSubstr("test.toml:3: start.in_motion_speed_m_s: the fixes within the log never move faster than "));
  EXPECT_EQ(
      error("[start]\nfrom = \"static\""),
      "test.toml:2: start.from: the antenna moved during the first static_s seconds, expected a log that begins at "
      "rest, a shorter static_s, or \"in_motion\"");
  in.truth.states.clear();
  EXPECT_EQ(
      error("[start]\nfrom = \"truth\""),
      "test.toml:2: start.from: \"truth\" without one, expected --truth FILE, or an alignment such as \"in_motion\"");
}

TEST_F(FuseRunTest, InputsThatDoNotFitAreErrors) {
  const auto error = [](const FuseInputs& in, const char* toml) {
    return check_fuse_inputs(in, config_of(toml)).error().str();
  };
  ASSERT_TRUE(check_fuse_inputs(drive(), config_of("")).ok());
  FuseInputs late = drive();
  for (GnssFix& fix : late.fixes) fix.t = fix.t + 500.0;
  EXPECT_EQ(
      error(late, ""),
      "fixes.csv: covers 1500.500 to 1589.500 s of the week, expected times from 1000.000 to 1090.000 s of the week, "
      "as in imu.csv");
  EXPECT_EQ(error(drive(), "[fusion]\nmeasurements = [\"position\", \"odometer\"]\n"),
            "test.toml:2: fusion.measurements: \"odometer\" without a log of one, expected --odometer FILE");
  EXPECT_EQ(
      error(drive(), "[fusion]\nmeasurements = [\"position\", \"velocity\"]\n"),
      "test.toml:2: fusion.measurements: \"velocity\", but fixes.csv has no velocity with a sigma, expected columns "
      "vn,ve,vu,sd_vn,sd_ve,sd_vu, or gnss.velocity_sigma_enu_m_s");
  FuseInputs elsewhere = drive();
  for (fusion::NavState& state : elsewhere.truth.states) state.p_EU_E += Eigen::Vector3d(0.0, 5e4, 0.0);
  EXPECT_THAT(error(elsewhere, ""),
              HasSubstr("truth.csv: lies 50 km from the fixes of the same time, expected the frame"));
  FuseInputs upside_down = drive();
  for (ImuSample& sample : upside_down.imu.samples) sample.dv_U = -sample.dv_U;
  EXPECT_EQ(error(upside_down, ""),
            "imu.csv: in the initial attitude the specific force points down, expected imu.axes = \"frd\", or another "
            "imu.turn_deg");
}

TEST(FuseConfig, MistakesWordForWord) {
  const auto error = [](const char* toml) { return parse_fuse_config(toml, "f.toml").error().str(); };
  EXPECT_THAT(error("[fusion]\nstates = [\"bises\"]\n"), HasSubstr("f.toml:2: fusion.states"));
  EXPECT_THAT(error("[fusion]\nstates = [\"bises\"]\n"), HasSubstr("nearest is \"biases\""));
  EXPECT_THAT(error("[imu]\nlever = 3\n"), HasSubstr("f.toml:2: imu.lever: unknown key"));
  EXPECT_THAT(error("[imu]\nsensor = \"adis1646\"\n"), HasSubstr("f.toml:2: imu.sensor: "));
  EXPECT_THAT(error("[start]\nfrom = \"moving\"\n"), HasSubstr("f.toml:2: start.from: unknown name \"moving\""));
  EXPECT_EQ(error("[truth]\norigin_deg_deg_m = [1, 2]\n"),
            "f.toml:2: truth.origin_deg_deg_m: 2 numbers, expected latitude, longitude, height");
}

}  // namespace
}  // namespace canyon::study
