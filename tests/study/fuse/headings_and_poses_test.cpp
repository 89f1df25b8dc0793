// Headings of two antennas and poses in a map as measurements of canyon fuse: their logs, and what they are good for.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/study/fuse/run.h"
#include "canyon/study/fuse/smooth.h"
#include "canyon/tests/study/fuse/recorded_inputs.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using testing::config_of;

constexpr double kRate_hz = 50.0, kSeconds = 90.0;

/// A path in closed form, an IMU whose biases and noise are those of a tactical unit, exact fixes twice a second that
/// claim to be 1 m off; unit and antenna at B's origin.
FuseInputs driven(const std::string& path) {
  inertial::MotionConfig config;
  config.path = path;
  auto motion = *inertial::make_motion(config, 1);
  motion.lever_arm_m.setZero();
  const GpsTime start = GpsTime::from_week_sow(2200, 1000.0);
  FuseInputs in;
  in.imu.path = "imu.csv";
  in.gnss_path = "fixes.csv";
  in.truth.path = "truth.csv";
  in.imu.interval_s = 1.0 / kRate_hz;
  in.truth.has_attitude = in.truth.has_velocity = true;
  const RandomStream noise(5, "test.unit");
  const Eigen::Matrix3d& R = motion.frame.R_EW();
  for (int k = 0; k <= static_cast<int>(kRate_hz * kSeconds); ++k) {
    const double t_s = k / kRate_hz;
    const KinematicState body = motion.motion->at(t_s);
    const GpsTime t = tick(start, k, kRate_hz);
    in.truth.states.push_back({.t = t,
                               .R_EU = (Eigen::Quaterniond(R) * body.X_WB.R).normalized(),
                               .p_EU_E = motion.frame.to_E(body.X_WB.p),
                               .v_EU_E = R * body.v_WB_W});
    if (k % 25 == 5) {
      GnssFix fix;
      fix.t = t;
      fix.status = FixStatus::kSingle;
      fix.p_A_E = in.truth.states.back().p_EU_E;
      fix.covariance_E.setIdentity();
      in.fixes.push_back(fix);
    }
    if (k == 0) continue;
    ImuSample sample = inertial::motion_increments(motion, (k - 1) / kRate_hz, t_s);
    sample.t = t;
    sample.dt_s = 1.0 / kRate_hz;
    const auto n = static_cast<std::uint64_t>(k);
    sample.dtheta_U += 5e-6 * Eigen::Vector3d(1.0, -1.0, 1.0) * sample.dt_s + 1e-5 * noise.normal3(n);
    sample.dv_U += 5e-3 * Eigen::Vector3d(1.0, 1.0, -1.0) * sample.dt_s + 1e-4 * noise.normal3(100'000 + n);
    in.imu.samples.push_back(sample);
  }
  return in;
}

/// Two antennas that are 0.3 degrees good, once a second.
void add_headings(FuseInputs& in) {
  const RandomStream noise(6, "test.headings");
  in.heading_path = "heading.csv";
  for (std::size_t k = 50; k < in.truth.states.size(); k += 50) {
    const fusion::NavState& s = in.truth.states[k];
    const Eigen::Matrix3d R_EN = rotation_E_from_enu(geodetic_from_ecef(s.p_EU_E));
    const Eigen::Vector3d nose = R_EN.transpose() * (s.R_EU * Eigen::Vector3d::UnitX());
    in.heading.push_back({.t = s.t,
                          .heading_rad = std::atan2(nose.x(), nose.y()) + 0.3 * kDegree * noise.normal(0, k),
                          .sigma_rad = 0.3 * kDegree});
  }
}

/// Registration against a map, 5 cm and 0.2 degrees good, twice a second.
void add_poses(FuseInputs& in) {
  constexpr double kMoved_m = 0.05, kTurned_rad = 0.2 * kDegree;
  const RandomStream noise(7, "test.poses");
  in.poses_path = "poses.csv";
  for (std::size_t k = 25; k < in.truth.states.size(); k += 25) {
    const fusion::NavState& s = in.truth.states[k];
    StampedMapPose pose{.t = s.t, .X_EB = {}, .covariance = Matrix6d::Identity()};
    pose.X_EB.R = s.R_EU * so3_exp(kTurned_rad * noise.normal3(2 * k));
    pose.X_EB.p = s.p_EU_E + kMoved_m * noise.normal3(2 * k + 1);
    pose.covariance.topLeftCorner<3, 3>() *= kTurned_rad * kTurned_rad;
    pose.covariance.bottomRightCorner<3, 3>() *= kMoved_m * kMoved_m;
    in.poses.push_back(pose);
  }
}

std::string config_text(const std::string& measurements, const std::string& more = "") {
  return "[imu]\nsensor = \"stim300\"\n[fusion]\nmeasurements = [" + measurements + "]\n" + more;
}

struct Ended {
  Fused run;
  double yaw_off_deg, yaw_sigma_deg, off_m;
};
Ended ended(const FuseInputs& in, const std::string& config, double yaw_off_deg = 0.0, double last_fix_s = 1e9) {
  FuseInputs given = in;
  std::erase_if(given.fixes, [&](const GnssFix& fix) { return fix.t - in.begin() > last_fix_s; });
  auto plan = plan_fuse(given, config_of(config), {});
  EXPECT_TRUE(plan.ok()) << plan.error().str();
  plan->X_WB.R = so3_exp(Eigen::Vector3d(0.0, 0.0, yaw_off_deg * kDegree)) * plan->X_WB.R;
  auto run = fuse(given, *plan);
  EXPECT_TRUE(run.ok()) << run.error().str();
  const FuseEpoch& last = run->epochs.back();
  const fusion::NavState& truth = in.truth.states.back();
  return {*run, so3_log(last.nav.R_EU.conjugate() * truth.R_EU).z() / kDegree,
          std::sqrt(last.covariance(2, 2)) / kDegree, (last.nav.p_EU_E - truth.p_EU_E).norm()};
}

TEST(Headings, MakeTheYawObservableAtRest) {
  FuseInputs in = driven("stationary");
  const std::string start = "initial_attitude_sigma_deg_heading = 10.0\n";
  const Ended without = ended(in, config_text("\"position\"", start), 8.0);
  add_headings(in);
  const Ended with = ended(in, config_text("\"position\", \"heading\"", start), 8.0);
  std::printf("yaw at rest, started 8 deg off: %.2f deg (sigma %.2f), with headings %.3f (sigma %.3f)\n",
              without.yaw_off_deg, without.yaw_sigma_deg, with.yaw_off_deg, with.yaw_sigma_deg);
  EXPECT_GT(std::abs(without.yaw_off_deg), 4.0);
  EXPECT_GT(without.yaw_sigma_deg, 5.0);
  // 90 headings of 0.3 degrees are at best 0.032 degrees good; what the gyroscope does meanwhile comes on top.
  EXPECT_LT(with.yaw_sigma_deg, 0.2);
  EXPECT_LT(std::abs(with.yaw_off_deg), 3.3 * with.yaw_sigma_deg);  // false alarm 1e-3
  EXPECT_EQ(with.run.by_measurement.at("heading").count, 90U);
}

TEST(MapPoses, BoundTheErrorWithoutFixes) {
  FuseInputs in = driven("figure_eight");
  const Ended without = ended(in, config_text("\"position\""), 0.0, 10.0);
  add_poses(in);
  const Ended with = ended(in, config_text("\"position\", \"map_pose\""), 0.0, 10.0);
  std::printf("80 s without fixes: %.2f m off, with poses in a map %.3f m\n", without.off_m, with.off_m);
  const double sigma_m = std::sqrt(with.run.epochs.back().covariance.diagonal().segment<3>(3).sum());
  EXPECT_GT(without.off_m, 1.0);
  EXPECT_LT(sigma_m, 0.1);
  EXPECT_LT(with.off_m, 4.1 * sigma_m);  // of three axes together at most; chi-square of 3, false alarm 1e-3
  EXPECT_EQ(with.run.by_measurement.at("map_pose").count, 180U);
}

TEST(MapPoses, AreSmoothedByRtsAndRefusedByGraphs) {
  FuseInputs in = driven("figure_eight");
  add_poses(in);
  add_headings(in);
  const FuseConfig config = config_of(config_text("\"position\", \"map_pose\", \"heading\""));
  auto plan = plan_fuse(in, config, {});
  ASSERT_TRUE(plan.ok()) << plan.error().str();
  plan->keep_segments = true;
  const auto run = fuse(in, *plan);
  ASSERT_TRUE(run.ok()) << run.error().str();
  const auto smoothed = smooth("rts", config.smoother.own, in, *plan, *run);
  ASSERT_TRUE(smoothed.ok()) << smoothed.error().str();
  EXPECT_LT(fuse_score(smoothed->errors).rms_3d_m, fuse_score(run->errors).rms_3d_m);
  EXPECT_EQ(check_smoother("batch_graph", plan->filter).error().str(),
            "--smoother: \"batch_graph\" cannot take the filter's \"heading\", \"map_pose\", expected \"rts\", or "
            "fusion.measurements without it");
}

TEST(HeadingsAndPoses, WithoutAMeasurementOrALogAreRefused) {
  FuseInputs in = driven("figure_eight");
  const auto error = [&](const std::string& measurements) {
    return check_fuse_inputs(in, config_of(config_text(measurements))).error().str();
  };
  EXPECT_EQ(error("\"position\", \"heading\""),
            "test.toml:4: fusion.measurements: \"heading\" without a log of one, expected --heading FILE");
  EXPECT_EQ(error("\"position\", \"map_pose\""),
            "test.toml:4: fusion.measurements: \"map_pose\" without a log of one, expected --poses FILE");
  add_headings(in);
  EXPECT_EQ(error("\"position\""),
            "--heading: heading.csv, but the filter does not measure with \"heading\", expected \"heading\" in "
            "fusion.measurements of --config");
  add_poses(in);
  EXPECT_EQ(error("\"position\", \"heading\""),
            "--poses: poses.csv, but the filter does not measure with \"map_pose\", expected \"map_pose\" in "
            "fusion.measurements of --config");
  EXPECT_TRUE(check_fuse_inputs(in, config_of(config_text("\"heading\", \"map_pose\""))).ok());
  for (StampedMapPose& pose : in.poses) pose.X_EB.p += Eigen::Vector3d(0.0, 5e4, 0.0);
  EXPECT_EQ(error("\"heading\", \"map_pose\""),
            "poses.csv: lie 50 km from the fixes of the same time, expected the frame of fixes.csv (degrees or metres, "
            "their order, poses.origin_deg_deg_m)");
  in.heading.front().t = in.heading.back().t = GpsTime::from_week_sow(2200, 5000.0);
  EXPECT_EQ(error("\"heading\""),
            "heading.csv: covers 5000.000 to 5000.000 s of the week, expected times from 1000.000 to 1090.000 s of the "
            "week, as in imu.csv");
}

class AidingLogs : public ::testing::Test {
 protected:
  std::string written(const std::string& text) const {
    EXPECT_TRUE(write_text_file(folder_.file("log.csv"), text).ok());
    return folder_.file("log.csv");
  }
  /// Without the folder.
  template <class Log>
  std::string mistake(const Result<Log>& log) const {
    if (log.ok()) return "none";
    const std::string text = log.error().str();
    return text.substr(text.find("log.csv"));
  }
  canyon::testing::TemporaryFolder folder_;
};

TEST_F(AidingLogs, HeadingsByTheirColumns) {
  FuseHeadingConfig config;
  config.offset_deg = 90.0;
  config.sigma_deg = 2.0;
  const auto log = read_heading_log(
      written(
          "gps_week,sow,heading_deg,sigma_deg\n2200,1,10,0.5\n2200,2,nan,0.5\n2200,2,20,\n2200,3,30,1\n2200,2.5,0,1\n"),
      config);
  ASSERT_TRUE(log.ok()) << log.error().str();
  ASSERT_EQ(log->samples.size(), 2U);
  EXPECT_TRUE(log->has_week);
  EXPECT_EQ(log->samples[0].t, GpsTime::from_week_sow(2200, 1.0));
  EXPECT_DOUBLE_EQ(log->samples[0].heading_rad, 100.0 * kDegree);
  EXPECT_DOUBLE_EQ(log->samples[0].sigma_rad, 0.5 * kDegree);
  EXPECT_EQ(log->passed_over.not_finite.line, 3);
  EXPECT_EQ(log->passed_over.duplicates.line, 4);
  EXPECT_EQ(log->passed_over.reversed.line, 6);
  EXPECT_EQ(log->passed_over.reversed.after_s, 3.0);
  config.sigma_deg = 0.0;
  const auto of = [&](const char* text) { return mistake(read_heading_log(written(text), config)); };
  EXPECT_EQ(of("t_s,heading_deg\n1,10\n"),
            "log.csv:2: a heading without a sigma, or with one of 0, expected a column sigma_deg, or heading.sigma_deg "
            "in --config");
  EXPECT_EQ(of("t_s,course\n1,10\n"),
            "log.csv:1: no heading among the columns, expected columns t_s (or sow), heading_deg and sigma_deg");
  EXPECT_EQ(of("heading_deg\n1\n"),
            "log.csv:1: no time among the columns, expected columns t_s (or sow), heading_deg and sigma_deg");
  EXPECT_EQ(of("1,10,1\n"),
            "log.csv:1: no header, expected a header, or heading.columns: columns t_s (or sow), heading_deg and "
            "sigma_deg");
  EXPECT_EQ(of("t_s,heading_deg\n"), "log.csv: holds no headings, expected at least one line of numbers");
}

TEST_F(AidingLogs, PosesByTheirColumns) {
  FusePosesConfig config;
  const std::string names =
      "t_s,lat_deg,lon_deg,h_m,sd_n,sd_e,sd_u,roll_deg,pitch_deg,yaw_deg,sd_roll_deg,sd_pitch_deg,";
  const auto log = read_pose_log(written(names + "sd_yaw_deg\n1,45,7,200,0.1,0.2,0.3,1,2,90,0.4,0.5,0.6\n"), config);
  ASSERT_TRUE(log.ok()) << log.error().str();
  const StampedMapPose& pose = log->poses.front();
  const Geodetic at{45.0 * kDegree, 7.0 * kDegree, 200.0};
  // Nanometres: places are some 6.4e6 m from the Earth's centre.
  EXPECT_LT((pose.X_EB.p - ecef_from_geodetic(at)).norm(), 1e-8);
  const Eigen::Matrix3d R = (pose.X_EB.R.conjugate() * Eigen::Quaterniond(rotation_E_from_enu(at))).toRotationMatrix();
  // The nose points east, so that forward, left, up are east, north, up but for the tilt.
  const Eigen::Matrix3d place_enu = R.transpose() * pose.covariance.bottomRightCorner<3, 3>() * R;
  EXPECT_LT((place_enu.diagonal() - Eigen::Vector3d(0.04, 0.01, 0.09)).norm(), 1e-12);
  EXPECT_LT((pose.covariance.diagonal().head<3>().cwiseSqrt() / kDegree - Eigen::Vector3d(0.4, 0.5, 0.6)).norm(),
            1e-12);
  const LocalFrame frame(at);
  const PoseInMap message = pose_in_frame(pose, frame);
  EXPECT_LT(message.X_WB.p.norm(), 1e-8);
  const auto of = [&](const std::string& text) { return mistake(read_pose_log(written(text), config)); };
  EXPECT_EQ(of("t_s,lat_deg,lon_deg,h_m,sd_n,sd_e,sd_u\n1,45,7,200,1,1,1\n"),
            "log.csv:2: a pose without an attitude, expected columns roll_deg,pitch_deg,yaw_deg, or qw,qx,qy,qz");
  EXPECT_EQ(of("t_s,lat_deg,lon_deg,h_m,roll_deg,pitch_deg,yaw_deg\n1,45,7,200,1,1,1\n"),
            "log.csv:2: a place without a sigma, or with one of 0, expected columns sd_n,sd_e,sd_u, or "
            "poses.sigma_enu_m in --config");
  config.sigma_enu_m.setConstant(0.1);
  EXPECT_EQ(of("t_s,lat_deg,lon_deg,h_m,roll_deg,pitch_deg,yaw_deg\n1,45,7,200,1,1,1\n"),
            "log.csv:2: an attitude without a sigma, or with one of 0, expected columns "
            "sd_roll_deg,sd_pitch_deg,sd_yaw_deg, or poses.attitude_sigma_deg in --config");
  EXPECT_EQ(of("1 2 3 4 0 0 0 1\n"),
            "log.csv:1: is in local coordinates, expected poses.origin_deg_deg_m in --config, or lat_deg,lon_deg,h_m");
  config.attitude_sigma_deg.setConstant(0.2);
  config.origin_deg_deg_m = {45.0, 7.0, 200.0};
  const auto local = read_pose_log(written("1 10 20 30 0 0 0 1\n"), config);
  ASSERT_TRUE(local.ok()) << local.error().str();
  EXPECT_LT((frame.to_W(local->poses.front().X_EB.p) - Eigen::Vector3d(10.0, 20.0, 30.0)).norm(), 1e-8);
}

}  // namespace
}  // namespace canyon::study
