#include "canyon/mission/boundaries.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "canyon/core/files/files.h"
#include "canyon/mission/recorder/run_files.h"
#include "canyon/study/results/results.h"
#include "canyon/tests/mission/short_mission.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::mission::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const GpsTime kFirstTick = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string told(const Status& status) {
  if (status.ok()) return "passes";
  EXPECT_EQ(status.error().exit_code, 1);
  return status.error().str();
}

// 2026-11-22: what was not finite passed from part to part until some library ended the process.
TEST(Boundaries, WhatIsNotFiniteIsRefusedWithItsProducersName) {
  const Boundaries boundaries(kFirstTick);
  const std::string could_not = "the computation could not finish: ";

  KinematicState motion;
  motion.t = kFirstTick + 2.5;
  EXPECT_EQ(told(boundaries.check(motion)), "passes");
  motion.X_WB.p.z() = -1e6;
  EXPECT_EQ(told(boundaries.check(motion)), could_not + "the vehicle gave a position of -1e+06 at 2.5 s");
  motion.X_WB.p.z() = 1.0;
  motion.alpha_WB_B.y() = kNaN;
  EXPECT_EQ(told(boundaries.check(motion)), could_not + "the vehicle gave an angular acceleration of nan at 2.5 s");

  ImuSample sample;
  sample.t = kFirstTick + 1.0;
  sample.dt_s = 0.01;
  EXPECT_EQ(told(boundaries.check(sample)), "passes");
  sample.dv_U.x() = kInfinity;
  EXPECT_EQ(told(boundaries.check(sample)), could_not + "the IMU gave a velocity increment of inf at 1 s");

  gnss::GnssOutput gnss;
  gnss.fix.t = kFirstTick + 0.5;
  EXPECT_EQ(told(boundaries.check(gnss)), "passes") << "no fix is no fault";
  gnss.fix.status = FixStatus::kSingle;
  EXPECT_EQ(told(boundaries.check(gnss)), could_not + "the GNSS receiver gave a position of nan at 0.5 s");
  gnss.fix.p_A_E.setConstant(4e6);
  gnss.fix.covariance_E.setIdentity();
  EXPECT_EQ(told(boundaries.check(gnss)), "passes") << "a receiver need not give velocities";
  gnss.fix.v_A_E = Eigen::Vector3d(0, 0, kNaN);
  EXPECT_EQ(told(boundaries.check(gnss)), could_not + "the GNSS receiver gave a velocity of nan at 0.5 s");
  gnss.fix.v_A_E.setZero();
  gnss.epoch.observations.emplace_back();
  EXPECT_EQ(told(boundaries.check(gnss)), "passes") << "not used";
  gnss.epoch.observations[0].used = true;
  EXPECT_EQ(told(boundaries.check(gnss)), could_not + "the GNSS receiver gave a pseudorange of nan at 0.5 s");

  lidar::LidarOutput scan;
  scan.scan.t = kFirstTick + 0.1;
  scan.scan.points.resize(3);
  EXPECT_EQ(told(boundaries.check(scan)), "passes");
  scan.scan.points[2].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(told(boundaries.check(scan)), could_not + "the LIDAR gave a return of nan at 0.1 s");
  scan.scan.points[2].y = 0;
  scan.scan.points[1].intensity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(told(boundaries.check(scan)), could_not + "the LIDAR gave an intensity or a time of inf at 0.1 s");

  NavEstimate estimate;
  estimate.t = kFirstTick + 7.0;
  EXPECT_EQ(told(boundaries.check(estimate)), "passes");
  estimate.pose_covariance(2, 3) = kNaN;
  EXPECT_EQ(told(boundaries.check(estimate)), could_not + "the filter gave a covariance of nan at 7 s");

  Keyframe keyframe;
  keyframe.t = kFirstTick + 3.0;
  EXPECT_EQ(told(boundaries.check(keyframe)), "passes");
  keyframe.X_WL_registered.R.x() = kNaN;
  EXPECT_EQ(told(boundaries.check(keyframe)), could_not + "the registration gave an attitude of nan at 3 s");

  NavRow row;
  row.t = kFirstTick + 9.0;
  EXPECT_EQ(told(boundaries.check(row)), "passes");
  row.true_speed_m_s = kNaN;
  EXPECT_EQ(told(boundaries.check(row)), could_not + "the recorder gave a true speed of nan at 9 s");
  EXPECT_EQ(told(boundaries.check_end(9.0, kInfinity)), could_not + "the recorder gave a distance of inf at 9 s");
}

// 2026-11-22: both values lie in their ranges, and yet the body's spring diverged until the process was aborted.
TEST(Boundaries, AStiffSuspensionIsDriven) {
  const MissionConfig config =
      short_config("low", "low", "[time]\nlimit_s = 3.0\n[vehicle]\nsuspension_hz = 5.0\nsuspension_damping = 2.0");
  EXPECT_EQ(drive(config).outcome, Outcome::kStopped);
}

/// Drives well for a while, then does not.
class FaultyAutonomy final : public Autonomy {
 public:
  explicit FaultyAutonomy(int good_commands) : left_(good_commands) {}
  void see(const LidarScan&, const Pose&, const NavEstimate&) override {}
  DriveCommand drive(const NavEstimate&) override {
    return left_-- > 0 ? DriveCommand{1.0, 0.0} : DriveCommand{kNaN, 0.0};
  }
  AutonomyState state() const override { return AutonomyState::kDriving; }
  int next_waypoint() const override { return 0; }

 private:
  int left_;
};

// 2026-11-22: ended the program. The autonomy is the user's code under test: its fault is the mission's outcome.
TEST(Boundaries, AnAutonomysCommandThatIsNotFiniteIsTheMissionsOutcome) {
  for (const int good_commands : {0, 250}) {
    const MissionConfig config = short_config("low", "low");
    const auto mission = prepare(config, scenes());
    ASSERT_TRUE(mission.ok()) << mission.error().str();
    const canyon::testing::TemporaryFolder folder;
    const std::string directory = folder.path().string();
    const auto files = RunFiles::create(directory, "low", config, *mission, nullptr);
    MemoryRecorder rows;
    Recorders both({files->get(), &rows});
    auto record =
        run_mission(config, *mission, nullptr,
                    {.tape = nullptr, .recorder = &both, .autonomy = std::make_unique<FaultyAutonomy>(good_commands)});
    ASSERT_TRUE(record.ok()) << record.error().str();
    EXPECT_EQ(record->outcome, Outcome::kAutonomyFault);
    ASSERT_TRUE(record->failure);
    EXPECT_EQ(record->failure->detail, "its command was nan m/s, 0.0 1/m");
    EXPECT_NEAR(record->failure->t_s, 0.01 * (good_commands + 1), 1e-9);
    EXPECT_EQ(rows.nav.size(), static_cast<std::size_t>(good_commands / 10));

    study::Results results;
    results.mission = &*mission;
    record->name = record->gnss = record->imu = "low";
    results.summaries.push_back(*study::summarize(*record, study::RunStatistics(record->frame, directory)));
    results.records.push_back(*std::move(record));
    const auto hash = study::write_results(directory, results);
    ASSERT_TRUE(hash.ok()) << hash.error().str();
    EXPECT_THAT(*read_text_file(folder.file("summary.json")), HasSubstr("autonomy_fault"));
  }
}

}  // namespace
}  // namespace canyon::mission::testing
