// The run of canyon fuse on logs of a drive in closed form: order, gaps, starts, bad input.
#include "canyon/study/fuse/run.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/study/fuse/smooth.h"
#include "canyon/tests/study/fuse/recorded_inputs.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using ::testing::AllOf;
using testing::config_of;
using ::testing::Contains;
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

// What is wrong with the fixes is mended and counted by name, and what comes late is taken in its place to the last
// bit.
TEST_F(FuseRunTest, LateRepeatedFrozenAndDamagedFixes) {
  const FuseConfig config = config_of(kConfig);
  const Fused in_time = run_of(drive(), config);
  EXPECT_EQ(in_time.incidents.text(), "");
  FuseInputs late = drive();
  for (const GnssFix& fix : late.fixes) late.fixes_came.push_back(fix.t);
  for (const std::size_t i : {30U, 50U, 70U}) late.fixes_came[i] = late.fixes[i].t + 0.8;
  const Fused run = run_of(late, config);
  EXPECT_EQ(run.replays, 3);
  EXPECT_EQ(run.incidents.text(), "");
  EXPECT_EQ(run.fixes_accepted, in_time.fixes_accepted);
  EXPECT_EQ(last_position(run), last_position(in_time));

  FuseInputs wrong = drive();
  wrong.fixes[40].p_A_E = wrong.fixes[39].p_A_E;                  // frozen
  wrong.fixes[60].covariance_E(1, 1) = -1.0;                      // no covariance
  wrong.fixes.insert(wrong.fixes.begin() + 20, wrong.fixes[20]);  // twice
  const Fused mended = run_of(wrong, config);
  EXPECT_EQ(mended.incidents.count(fusion::Trouble::kFrozen), 1);
  EXPECT_EQ(mended.incidents.count(fusion::Trouble::kNotFinite), 1);
  EXPECT_EQ(mended.incidents.count(fusion::Trouble::kDuplicate), 1);
  EXPECT_EQ(mended.fixes_given, 88U);
  EXPECT_LT(fuse_score(mended.errors).rms_3d_m, 1e-3);
}

// A gap leaves the filter less sure, by 20 degrees a second and 2 m/s^2.
TEST_F(FuseRunTest, AGapLeavesTheFilterLessSure) {
  FuseInputs in = drive();
  in.imu.samples.erase(in.imu.samples.begin() + 2000, in.imu.samples.begin() + 2020);  // 0.4 s
  const Fused run = run_of(in, config_of(kConfig));
  const auto sigma_after = [&](const Fused& of) {
    const auto first =
        std::find_if(of.errors.begin(), of.errors.end(), [&](const FuseError& e) { return e.t - of.start >= 40.41; });
    return first->velocity_sigma_m_s.x();
  };
  EXPECT_EQ(run.incidents.count(fusion::Trouble::kGap), 1);
  // 0.8 m/s before the first fix after it.
  EXPECT_GT(sigma_after(run), 0.7);
  EXPECT_LT(sigma_after(run_of(drive(), config_of(kConfig))), 0.1);
}

// Without a reference innovations and states speak alone; with one the errors do too.
TEST_F(FuseRunTest, TheVerdictSaysWhatDoesNotFit) {
  const auto words = [](const Fused& run) { return fusion::verdict_lines(run.verdict); };
  FuseInputs noisy = drive();
  const RandomStream stream(3, "test.fixes");
  for (std::size_t i = 0; i < noisy.fixes.size(); ++i) noisy.fixes[i].p_A_E += 0.02 * stream.normal3(i);
  const Fused right = run_of(noisy, config_of(kConfig));
  EXPECT_EQ(words(right).front(), "consistent");
  EXPECT_FALSE(right.verdict.axes.empty());
  FuseInputs alone = noisy;
  alone.truth.states.clear();
  alone.truth.has_attitude = alone.truth.has_velocity = false;
  for (GnssFix& fix : alone.fixes) fix.covariance_E /= 25.0;  // five times better than they are
  const Fused wrong = run_of(alone, config_of(kConfig));
  EXPECT_TRUE(wrong.verdict.axes.empty());
  EXPECT_FALSE(wrong.verdict.fixes.has_value());
  EXPECT_THAT(words(wrong), Contains(HasSubstr("position: innovations ")));
  EXPECT_THAT(words(wrong), Contains(HasSubstr(" times too large")));
}

TEST_F(FuseRunTest, SmoothedItIsNearerToTheTruthAndSaysSo) {
  FuseInputs noisy = drive();
  const RandomStream stream(3, "test.fixes");
  for (std::size_t i = 0; i < noisy.fixes.size(); ++i) noisy.fixes[i].p_A_E += 0.02 * stream.normal3(i);
  const FuseConfig config = config_of(std::string(kConfig) + "[score]\nskip_s = 10\n");
  auto plan = plan_fuse(noisy, config, OutagePlan{20.0, 40.0, 20.0});
  ASSERT_TRUE(plan.ok()) << plan.error().str();
  plan->keep_segments = true;
  const auto run = fuse(noisy, *plan);
  ASSERT_TRUE(run.ok());
  const auto smoothed = smooth("rts", config.smoother.own, noisy, *plan, *run);
  ASSERT_TRUE(smoothed.ok()) << smoothed.error().str();
  const FuseScore of_filter = fuse_score(run->errors), of_smoother = fuse_score(smoothed->errors);
  std::printf("filter %.4f m, NEES %.2f; smoothed %.4f m, NEES %.2f; outages %.3f and %.3f m\n", of_filter.rms_3d_m,
              of_filter.nees_mean, of_smoother.rms_3d_m, of_smoother.nees_mean,
              outage_score(run->windows).horizontal_rms_of_max_m,
              outage_score(smoothed->windows).horizontal_rms_of_max_m);
  EXPECT_LT(of_smoother.rms_3d_m, of_filter.rms_3d_m);
  for (int i = 0; i < 3; ++i) EXPECT_LE(of_smoother.position_sigma_m[i], of_filter.position_sigma_m[i]) << i;
  // What smooths nothing is the filter itself: the same samples, divided where it divided them.
  const auto alone = smooth("none", config.smoother.own, noisy, *plan, *run);
  ASSERT_TRUE(alone.ok()) << alone.error().str();
  const auto same = std::find_if(alone->epochs.begin(), alone->epochs.end(),
                                 [&](const FuseEpoch& e) { return e.nav.t == run->epochs.back().nav.t; });
  ASSERT_NE(same, alone->epochs.end());
  EXPECT_EQ(same->nav.p_EU_E, last_position(*run));
}

// Of a bridged gap the smoother knows what the filter knew; a factor graph has no place for it.
TEST_F(FuseRunTest, AGapIsSmoothedByRtsAlone) {
  FuseInputs in = drive();
  in.imu.samples.erase(in.imu.samples.begin() + 2000, in.imu.samples.begin() + 2020);
  const FuseConfig config = config_of(kConfig);
  auto plan = plan_fuse(in, config, {});
  plan->keep_segments = true;
  const auto run = fuse(in, *plan);
  ASSERT_TRUE(run.ok());
  const auto smoothed = smooth("rts", config.smoother.own, in, *plan, *run);
  ASSERT_TRUE(smoothed.ok()) << smoothed.error().str();
  EXPECT_LE(fuse_score(smoothed->errors).rms_3d_m, fuse_score(run->errors).rms_3d_m);
  EXPECT_THAT(
      smooth("batch_graph", config.smoother.own, in, *plan, *run).error().str(),
      AllOf(HasSubstr("imu.csv: samples are missing before "),
            HasSubstr(", which \"batch_graph\" cannot bridge, expected --smoother rts, or an imu.bridge_s below "
                      "the gap")));
}

TEST(FuseSmoother, MistakesWordForWord) {
  const auto error = [](const char* smoother, const char* toml) {
    return check_smoother(smoother, config_of(toml).fusion).error().str();
  };
  EXPECT_EQ(error("rst", ""),
            "--smoother: unknown name \"rst\", expected one of \"none\", \"rts\", \"batch_graph\", "
            "\"fixed_lag_graph\"; nearest is \"rts\"");
  EXPECT_EQ(error("batch_graph", "[fusion]\nmeasurements = [\"position\", \"barometer\"]\n"),
            "--smoother: \"batch_graph\" cannot take the filter's \"barometer\", expected \"rts\", or "
            "fusion.measurements without it");
  EXPECT_TRUE(check_smoother("rts", config_of("[fusion]\nmeasurements = [\"position\", \"barometer\"]\n").fusion).ok());
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
  EXPECT_EQ(error(drive(), "[fusion]\nmeasurements = [\"position\", \"barometer\"]\n"),
            "test.toml:2: fusion.measurements: \"barometer\" without a log of one, expected --results of a run whose "
            "filter measures with it");
  EXPECT_EQ(
      error(drive(), "[fusion]\nmeasurements = [\"relative_pose\"]\nstates = [\"biases\", \"clone\"]\n"),
      "test.toml:2: fusion.measurements: \"relative_pose\", for which canyon fuse has no messages, expected one of "
      "\"position\", \"velocity\", \"non_holonomic\", \"standstill\", \"odometer\", \"heading\", \"barometer\", "
      "\"magnetometer\", \"map_pose\", \"ranges\"");
  EXPECT_EQ(error(drive(), "[fusion]\nmeasurements = [\"relative_pose\"]\nstates = [\"biases\"]\n"),
            "test.toml:2: fusion.measurements: \"relative_pose\" without state \"clone\", expected \"clone\" in "
            "fusion.states");
  EXPECT_EQ(error(drive(), "[fusion]\nstates = [\"biases\", \"turn_on_biases\"]\n"),
            "test.toml:2: fusion.states: \"biases\" already holds what \"turn_on_biases\" and \"in_run_biases\" hold, "
            "expected \"biases\", or the other two");
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
  const std::string unreadable = " cannot be read (No such file or directory), expected a readable file";
  EXPECT_EQ(error("[imu]\nsensor = \"mine/imu.toml\"\n"), "f.toml:2: imu.sensor: \"mine/imu.toml\"" + unreadable);
  EXPECT_EQ(error("[fusion]\nimu = \"mine/imu.toml\"\n"), "f.toml:2: fusion.imu: \"mine/imu.toml\"" + unreadable);
  EXPECT_EQ(error("[gnss]\nsolve = \"solve.toml\"\n"), "f.toml:2: gnss.solve: \"solve.toml\"" + unreadable);
  EXPECT_THAT(error("[start]\nfrom = \"moving\"\n"), HasSubstr("f.toml:2: start.from: unknown name \"moving\""));
  EXPECT_EQ(error("[truth]\norigin_deg_deg_m = [1, 2]\n"),
            "f.toml:2: truth.origin_deg_deg_m: 2 numbers, expected latitude, longitude, height");
}

}  // namespace
}  // namespace canyon::study
