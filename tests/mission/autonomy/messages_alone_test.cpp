// What an autonomy does follows from the messages that it is given, and from no truth.
#include <algorithm>
#include <deque>
#include <limits>
#include <utility>
#include <variant>

#include "canyon/tests/mission/poisoned_truth.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

/// One thing that an autonomy was shown or asked, as it was.
struct Shown {
  LidarScan scan;
  Pose X_WL;
  NavEstimate estimate;
};
struct Asked {
  NavEstimate estimate;
  DriveCommand answer;
};
using Call = std::variant<Shown, Asked, OdometerSample>;

/// Hands everything on, and keeps it.
class Listening final : public Autonomy {
 public:
  Listening(std::unique_ptr<Autonomy> autonomy, std::vector<Call>& calls)
      : autonomy_(std::move(autonomy)), calls_(calls) {}
  void count(const OdometerSample& sample) override {
    calls_.emplace_back(sample);
    autonomy_->count(sample);
  }
  void see(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate) override {
    calls_.emplace_back(Shown{scan, X_WL, estimate});
    autonomy_->see(scan, X_WL, estimate);
  }
  DriveCommand drive(const NavEstimate& estimate) override {
    const DriveCommand answer = autonomy_->drive(estimate);
    calls_.emplace_back(Asked{estimate, answer});
    return answer;
  }
  bool looks() const override { return autonomy_->looks(); }
  std::optional<KeptReturns> keeps() const override { return autonomy_->keeps(); }
  AutonomyState state() const override { return autonomy_->state(); }
  int next_waypoint() const override { return autonomy_->next_waypoint(); }

 private:
  std::unique_ptr<Autonomy> autonomy_;
  std::vector<Call>& calls_;
};

RecordedRun drive_and_listen(const MissionConfig& config, std::vector<Call>& calls, int* poisoned = nullptr) {
  const auto mission = prepare(config, scenes());
  EXPECT_TRUE(mission.ok());
  RecordedRun run;
  RunParts parts;
  parts.recorder = &run;
  parts.autonomy = std::make_unique<Listening>(make_autonomy(config.autonomy, mission->prior, mission->start), calls);
  if (poisoned != nullptr) poison(config, *mission, parts, *poisoned);
  auto record = run_mission(config, *mission, nullptr, std::move(parts));
  EXPECT_TRUE(record.ok()) << (record.ok() ? "" : record.error().str());
  static_cast<RunRecord&>(run) = *std::move(record);
  return run;
}

const char* const kListened = R"(
[time]
limit_s = 20.0
[lidar]
azimuth_steps = 600
[autonomy.self_check]
model = "own_motion"
)";

// Given again to another of its kind, outside of any run, they make it do the same, to the bit.
TEST(Autonomy, DoesTheSameWhenItIsGivenTheSameMessagesWithoutASimulation) {
  const MissionConfig config = short_config("high", "high", kListened);
  std::vector<Call> calls;
  drive_and_listen(config, calls);
  const auto mission = prepare(config, scenes());
  const auto again = make_autonomy(config.autonomy, mission->prior, mission->start);
  int asked = 0, counted = 0, moving = 0;
  for (const Call& call : calls) {
    if (const auto* shown = std::get_if<Shown>(&call)) {
      again->see(shown->scan, shown->X_WL, shown->estimate);
    } else if (const auto* sample = std::get_if<OdometerSample>(&call)) {
      again->count(*sample);
      ++counted;
    } else {
      const Asked& it = std::get<Asked>(call);
      const DriveCommand answer = again->drive(it.estimate);
      ASSERT_EQ(answer.speed_m_s, it.answer.speed_m_s) << asked;
      ASSERT_EQ(answer.curvature_1_m, it.answer.curvature_1_m) << asked;
      ++asked;
      moving += answer.speed_m_s > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(asked, 1500);
  EXPECT_GT(counted, 500);
  EXPECT_GT(moving, 500);
}

// Each message is taken apart into its fields: one that gets another does not compile here until somebody has looked
// that it holds no truth. Beside the messages an autonomy is given poses.
TEST(Autonomy, NoMessageHasAFieldOfTruth) {
  [[maybe_unused]] const auto& [imu_t, imu_dt_s, dtheta_U, dv_U, lost] = ImuSample{};
  [[maybe_unused]] const auto& [odometer_t, odometer_dt_s, ticks, speed_m_s] = OdometerSample{};
  [[maybe_unused]] const auto& [barometer_t, pressure_pa] = BarometerSample{};
  [[maybe_unused]] const auto& [magnetometer_t, field_U_t] = MagnetometerSample{};
  [[maybe_unused]] const auto& [scan_t, period_s, points] = LidarScan{};
  [[maybe_unused]] const auto& [x, y, z, intensity, time_s, ring, return_index] = LidarPoint{};
  [[maybe_unused]] const auto& [fix_t, status, p_A_E, covariance_E, v_A_E, velocity_covariance_E, clock_m, dop,
                                satellites, reason] = GnssFix{};
  [[maybe_unused]] const auto& [estimate_t, X_WB, v_WB_W, gyro_bias_U, accel_bias_U, pose_covariance,
                                velocity_covariance_W] = NavEstimate{};
  EXPECT_EQ(points.size(), 0U);
}

/// Whether two calls are the same to the bit.
bool same_call(const Call& a, const Call& b) {
  const auto same_pose = [](const Pose& p, const Pose& q) { return p.p == q.p && p.R.coeffs() == q.R.coeffs(); };
  const auto same_estimate = [&](const NavEstimate& p, const NavEstimate& q) {
    return p.t == q.t && same_pose(p.X_WB, q.X_WB) && p.v_WB_W == q.v_WB_W && p.pose_covariance == q.pose_covariance;
  };
  if (a.index() != b.index()) return false;
  if (const auto* shown = std::get_if<Shown>(&a)) {
    const Shown& other = std::get<Shown>(b);
    const bool same_points = std::equal(shown->scan.points.begin(), shown->scan.points.end(), other.scan.points.begin(),
                                        other.scan.points.end(), [](const LidarPoint& p, const LidarPoint& q) {
                                          return p.x == q.x && p.y == q.y && p.z == q.z && p.intensity == q.intensity &&
                                                 p.time_s == q.time_s && p.ring == q.ring &&
                                                 p.return_index == q.return_index;
                                        });
    return same_points && same_pose(shown->X_WL, other.X_WL) && same_estimate(shown->estimate, other.estimate);
  }
  if (const auto* asked = std::get_if<Asked>(&a)) {
    const Asked& other = std::get<Asked>(b);
    return same_estimate(asked->estimate, other.estimate) && asked->answer.speed_m_s == other.answer.speed_m_s &&
           asked->answer.curvature_1_m == other.answer.curvature_1_m;
  }
  const OdometerSample &p = std::get<OdometerSample>(a), &q = std::get<OdometerSample>(b);
  return p.t == q.t && p.ticks == q.ticks && p.speed_m_s == q.speed_m_s;
}

void expect_poison_changes_nothing(const MissionConfig& config) {
  std::vector<Call> calls, poisoned_calls;
  int poisoned_returns = 0;
  const RecordedRun sound = drive_and_listen(config, calls);
  const RecordedRun poisoned = drive_and_listen(config, poisoned_calls, &poisoned_returns);
  EXPECT_GT(poisoned_returns, 1000) << "the poison must be there";
  ASSERT_GT(sound.gnss_rows.size(), 15U);
  ASSERT_EQ(sound.gnss_rows.size(), poisoned.gnss_rows.size());
  int poisoned_satellites = 0;
  for (const GnssRow& row : poisoned.gnss_rows)
    for (const auto& satellite : row.truth.satellites) poisoned_satellites += satellite.multipath_m == kPoison_m;
  EXPECT_GT(poisoned_satellites, 50) << "the poison must be there";
  if (config.autonomy.map == MapPose::kRegistered) {
    EXPECT_GT(sound.keyframes.size(), 1U) << "registration must have had its say";
  }
  ASSERT_EQ(sound.nav.size(), poisoned.nav.size());
  for (std::size_t i = 0; i < sound.nav.size(); ++i) {
    ASSERT_EQ(sound.nav[i].X_WB_true.p, poisoned.nav[i].X_WB_true.p) << i;
    ASSERT_EQ(sound.nav[i].estimate.X_WB.p, poisoned.nav[i].estimate.X_WB.p) << i;
    ASSERT_EQ(sound.nav[i].command.curvature_1_m, poisoned.nav[i].command.curvature_1_m) << i;
  }
  ASSERT_EQ(calls.size(), poisoned_calls.size());
  for (std::size_t i = 0; i < calls.size(); ++i) ASSERT_TRUE(same_call(calls[i], poisoned_calls[i])) << i;
}

TEST(Autonomy, PoisonedTruthChangesNothing) {
  expect_poison_changes_nothing(short_config("high", "high", kListened));
}

// A filter that measures with wheels and velocities, and an autonomy whose pose registration has moved.
TEST(Autonomy, PoisonedTruthChangesNothingWithMoreAidsAndARegisteredMap) {
  const MissionConfig config = short_config("high_aided", "high_aided", R"(
[time]
limit_s = 10.0
[lidar]
azimuth_steps = 600
[registration]
method = "gicp"
[autonomy]
map = "registered"
)");
  ASSERT_EQ(config.autonomy.map, MapPose::kRegistered);
  ASSERT_TRUE(fusion::measures_with(config.fusion, "odometer"));
  expect_poison_changes_nothing(config);
}

}  // namespace
}  // namespace canyon::mission::testing
