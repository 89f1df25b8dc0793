// What an autonomy does follows from the messages that it is given, and from no truth.
#include <algorithm>
#include <deque>
#include <limits>
#include <utility>
#include <variant>

#include "canyon/gnss/sensor/sensor.h"
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

/// A receiver whose truth is poisoned; what it tells is as it was.
class Poisoned final : public gnss::GnssSensor {
 public:
  explicit Poisoned(std::unique_ptr<gnss::GnssSensor> sensor) : sensor_(std::move(sensor)) {}
  gnss::GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p, const Eigen::Vector3d& v,
                           const scene::SceneAt& scene) override {
    gnss::GnssOutput output = sensor_->measure(index, t, p, v, scene);
    for (GnssObservationTruth& satellite : output.truth.satellites) {
      satellite.multipath_m = 1e5;
      satellite.line_of_sight = !satellite.line_of_sight;
      satellite.reflections = 7;
    }
    std::reverse(output.truth.satellites.begin(), output.truth.satellites.end());
    return output;
  }
  gnss::GnssCounters counters() const override { return sensor_->counters(); }
  bool has_satellites() const override { return sensor_->has_satellites(); }

 private:
  std::unique_ptr<gnss::GnssSensor> sensor_;
};

RecordedRun drive_and_listen(const MissionConfig& config, std::vector<Call>& calls, bool poisoned) {
  const auto mission = prepare(config, scenes());
  EXPECT_TRUE(mission.ok());
  RecordedRun run;
  RunParts parts;
  parts.recorder = &run;
  parts.autonomy = std::make_unique<Listening>(make_autonomy(config.autonomy, mission->prior, mission->start), calls);
  if (poisoned) {
    auto sensor = gnss::make_gnss_sensor(config.gnss, static_cast<std::uint64_t>(config.run.seed), mission->start,
                                         mission->start + mission->time_limit_s, *mission->scene);
    EXPECT_TRUE(sensor.ok());
    parts.receiver = std::make_unique<Poisoned>(*std::move(sensor));
  }
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
  drive_and_listen(config, calls, false);
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

TEST(Autonomy, PoisonedTruthChangesNothing) {
  const MissionConfig config = short_config("high", "high", kListened);
  std::vector<Call> calls, poisoned_calls;
  const RecordedRun sound = drive_and_listen(config, calls, false);
  const RecordedRun poisoned = drive_and_listen(config, poisoned_calls, true);
  ASSERT_GT(sound.gnss_rows.size(), 30U);
  bool differs = false;
  for (std::size_t i = 0; i < sound.gnss_rows.size(); ++i)
    for (const auto& satellite : poisoned.gnss_rows[i].truth.satellites) differs |= satellite.multipath_m == 1e5;
  EXPECT_TRUE(differs) << "the poison must be there";
  ASSERT_EQ(sound.nav.size(), poisoned.nav.size());
  for (std::size_t i = 0; i < sound.nav.size(); ++i) {
    ASSERT_EQ(sound.nav[i].X_WB_true.p, poisoned.nav[i].X_WB_true.p) << i;
    ASSERT_EQ(sound.nav[i].estimate.X_WB.p, poisoned.nav[i].estimate.X_WB.p) << i;
    ASSERT_EQ(sound.nav[i].command.curvature_1_m, poisoned.nav[i].command.curvature_1_m) << i;
  }
  EXPECT_EQ(calls.size(), poisoned_calls.size());
}

}  // namespace
}  // namespace canyon::mission::testing
