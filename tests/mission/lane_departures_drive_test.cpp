// What is scored of the lane in a whole drive comes to the figures.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/mission/autonomy/route_driver.h"
#include "canyon/study/results/results.h"
#include "canyon/tests/mission/summary_of.h"

namespace canyon::mission::testing {
namespace {

/// Along the route, and 3 m to its left between 20 and 55 m from the start, whatever stands there.
class GoesAside final : public Autonomy {
 public:
  GoesAside(const AutonomyConfig& config, const PriorKnowledge& prior) : driver_(config, prior) {}

  void see(const LidarScan&, const Pose&, const NavEstimate&) override {}
  bool looks() const override { return false; }
  DriveCommand drive(const NavEstimate& estimate) override {
    driver_.update(estimate);
    const double s = driver_.target_s_m(estimate.v_WB_W.head<2>().norm());
    const Eigen::Vector2d along = driver_.route().direction(s), left(-along.y(), along.x());
    const double aside_m = driver_.s_m() > 20.0 && driver_.s_m() < 55.0 ? 3.0 : 0.0;
    return {.speed_m_s = driver_.allowed_speed_m_s(),
            .curvature_1_m = driver_.pursue(estimate, driver_.route().at(s) + aside_m * left)};
  }
  AutonomyState state() const override { return AutonomyState::kDriving; }
  int next_waypoint() const override { return driver_.next_waypoint(); }

 private:
  RouteDriver driver_;
};

/// 20 s up an empty street.
RecordedRun goes_aside(const std::string& parked) {
  const auto file = MissionFile::parse(
      "base = \"vicksburg\"\n[scene]\nempty = true\n" + parked +
          "[time]\nlimit_s = 20.0\n[registration]\nmethod = \"none\"\n[vehicle]\nstart_m = [213.9, 30.0]\n"
          "start_heading_deg = 0.0\n[[autonomy.waypoint]]\nname = \"north\"\np_m = [213.9, 150.0]\n",
      "aside.toml");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().str());
  const auto config = file->resolve("low");
  EXPECT_TRUE(config.ok()) << (config.ok() ? "" : config.error().str());
  SceneCache own;
  const auto prepared = prepare(*config, own);
  EXPECT_TRUE(prepared.ok()) << (prepared.ok() ? "" : prepared.error().str());
  RecordedRun run;
  RunParts parts;
  parts.recorder = &run;
  parts.autonomy = std::make_unique<GoesAside>(config->autonomy, prepared->prior);
  Omissions unread;
  unread.maps = unread.keyframes = unread.unkept_rays = true;
  parts.omissions = &unread;
  auto record = run_mission(*config, *prepared, nullptr, std::move(parts));
  EXPECT_TRUE(record.ok()) << (record.ok() ? "" : record.error().str());
  static_cast<RunRecord&>(run) = *std::move(record);
  EXPECT_EQ(run.outcome, Outcome::kStopped) << (run.failure ? run.failure->detail : "");
  EXPECT_GT(run.distance_m, 65.0) << "it is back in its lane";
  return run;
}

TEST(LaneDeparturesDrive, ANeedlessOneIsAFigureOfItsRun) {
  const RecordedRun run = goes_aside("");
  EXPECT_EQ(run.needless_lane_departures, 1);
  const auto json = study::run_json(summary_of(run));
  EXPECT_EQ(json["needless_lane_departures_per_km"].get<double>(), 1000.0 / run.distance_m);
  EXPECT_EQ(json["phantoms_per_km"].get<double>(), 0.0) << "it always found a way";
}

TEST(LaneDeparturesDrive, AroundAParkedCarIsNone) {
  const RecordedRun run =
      goes_aside("[[scene.moving]]\nname = \"parked\"\npath_m = [213.9, 72.0, 213.9, 73.0]\nstart_s = 1e5\n");
  EXPECT_EQ(run.needless_lane_departures, 0);
}

}  // namespace
}  // namespace canyon::mission::testing
