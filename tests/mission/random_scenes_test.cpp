// Whatever the city, the sensors and the autonomy's parts: a run ends in an outcome.
#include <cmath>
#include <string>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/mission/boundaries.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

/// A short drive through a small city of its own, with sensors, filter, things that move and parts of the autonomy
/// drawn at random, bad ones among them.
class RandomDrive {
 public:
  explicit RandomDrive(std::uint64_t number) : stream_(number, "tests.random_scenes") {
    const char* fidelities[] = {"low", "high", "paper", "modern"};
    config_ = short_config(fidelities[one_of(4)], fidelities[one_of(4)], "[time]\nlimit_s = 12.0");
    config_.run.seed = static_cast<std::int64_t>(number);
    draw_scene(number);
    draw_sensors();
    draw_autonomy();
    draw_places();
  }
  const MissionConfig& config() const { return config_; }

 private:
  double between(double low, double high) { return stream_.uniform(low, high, 0, draws_++); }
  std::size_t one_of(std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(between(0.0, 1.0) * static_cast<double>(n)));
  }
  bool once_in(double n) { return between(0.0, n) < 1.0; }

  void draw_scene(std::uint64_t number) {
    scene::CityConfig& scene = config_.scene.city;
    scene.seed = static_cast<std::int64_t>(number);
    scene.extent_m = 300.0;
    scene.block_m = between(60.0, 120.0);
    scene.street_width_m = between(11.0, 16.0);
    scene.slope_percent = between(0.0, 8.0);
    scene.hill_height_m = between(0.0, 10.0);
    scene.lat_deg = between(-70.0, 70.0);
    scene.empty = once_in(6);
    scene.absorbing = once_in(6);
  }

  void draw_sensors() {
    config_.gnss.tracking.multipath_scale = once_in(4) ? 20.0 : 1.0;
    config_.gnss.tracking.thermal_noise_scale = once_in(4) ? 30.0 : 1.0;
    if (once_in(5)) config_.imu.sensor = "mpu6050";
    if (once_in(5)) config_.run.initial_attitude_error_deg = {5.0, 5.0, 60.0};
    if (once_in(5)) config_.run.withhold_fixes_after_s = between(0.0, 12.0);
    if (once_in(8)) config_.run.withhold_scans_after_s = between(0.0, 12.0);
    if (once_in(12)) config_.lidar.blinded = true;
    config_.lidar.azimuth_steps = once_in(4) ? 90 : 450;
    if (once_in(4)) config_.lidar.angle_noise_deg = between(0.0, 3.0);
    if (once_in(4)) config_.lidar.range_noise_m = between(0.0, 2.0);
    if (once_in(6)) config_.lidar.rate_hz = 4.0;
  }

  void draw_autonomy() {
    const char* models[] = {"reference", "reference", "reference", "reference_2012", "route_follower"};
    config_.autonomy.model.name = models[one_of(5)];
    auto tree =
        ConfigNode::parse(std::string("[autonomy.tracker]\nmodel = \"") + (once_in(3) ? "stanley" : "pure_pursuit") +
                              "\"\n[autonomy.self_check]\nmodel = \"" + (once_in(2) ? "own_motion" : "none") +
                              "\"\n[autonomy.recovery]\nmodel = \"" + (once_in(4) ? "wait" : "back_up") + "\"\n",
                          "parts");
    ASSERT_TRUE(tree.ok());
    const auto status = read_config(&*tree, "", config_);
    ASSERT_TRUE(status.ok()) << status.error().str();
  }

  void draw_places() {
    const auto scene = scenes_.get(config_.scene);
    ASSERT_TRUE(scene.ok());
    const scene::StreetGraph& streets = (*scene)->streets();
    ASSERT_FALSE(streets.edges.empty());
    const scene::StreetGraph::Edge& edge = streets.edges[one_of(streets.edges.size())];
    const Eigen::Vector2d a = streets.nodes_W[edge.a], b = streets.nodes_W[edge.b], along = (b - a).normalized();
    config_.vehicle.start_m = a + between(0.1, 0.5) * (b - a);
    config_.vehicle.start_heading_deg = heading_from_yaw(std::atan2(along.y(), along.x())) / kDegree;
    if (once_in(6)) config_.vehicle.start_heading_deg = between(0.0, 360.0);
    config_.autonomy.waypoints.clear();
    for (std::size_t i = 0; i <= one_of(3); ++i)
      config_.autonomy.waypoints.push_back({"", streets.nodes_W[one_of(streets.nodes_W.size())], ""});
    config_.scene.moving.clear();
    for (std::size_t i = 0; i < one_of(4); ++i) {
      scene::MovingConfig thing;
      thing.name = "thing " + std::to_string(i);
      const char* shapes[] = {"car", "bus", "person"};
      thing.shape = shapes[one_of(3)];
      const Eigen::Vector2d p = a + between(-0.2, 1.2) * (b - a), q = p + between(-60.0, 60.0) * along;
      thing.path_m = {p.x(), p.y(), q.x() + 1.0, q.y()};
      thing.speed_m_s = between(0.0, 12.0);
      thing.start_s = once_in(2) ? 1e5 : between(0.0, 10.0);
      config_.scene.moving.push_back(thing);
    }
  }

  RandomStream stream_;
  std::uint64_t draws_ = 0;
  SceneCache scenes_;
  MissionConfig config_;
};

/// Empty where all is well.
std::string wrong_with(const MissionConfig& config, const PreparedMission& prepared) {
  RecordedRun run;
  RunParts parts;
  parts.recorder = &run;
  Omissions unread;
  unread.maps = unread.keyframes = unread.unkept_rays = true;
  parts.omissions = &unread;
  try {
    const auto record = run_mission(config, prepared, nullptr, std::move(parts));
    if (!record.ok()) return record.error().str();
    if (!record->outcome) return "no outcome";
    if (*record->outcome == Outcome::kAutonomyFault) return "the autonomy: " + record->failure->detail;
  } catch (const std::exception& thrown) {
    return std::string("thrown: ") + thrown.what();
  }
  for (const NavRow& row : run.nav)
    if (!row.X_WB_true.p.allFinite() || !row.estimate.X_WB.p.allFinite() || !is_finite(row.command))
      return "not finite at " + std::to_string(row.t - run.nav.front().t) + " s";
  return {};
}

/// Draws until a drive can be, and drives it. What cannot be, a way that turns back at a waypoint or a unit without
/// figures for the chain that is drawn, is refused with its key.
std::string driven(std::uint64_t number) {
  for (std::uint64_t draw = 0; draw < 50; ++draw) {
    const RandomDrive drive(number + 100000 * draw);
    SceneCache own;
    const auto prepared = prepare(drive.config(), own);
    if (prepared.ok()) return wrong_with(drive.config(), *prepared);
    if (prepared.error().key.empty()) return "refused without a key: " + prepared.error().str();
  }
  return "none of 50 draws can be driven";
}

void drive_all(std::uint64_t from, std::uint64_t to) {
  for (std::uint64_t number = from; number < to; ++number) EXPECT_EQ(driven(number), "") << number;
}

TEST(RandomScenes, AHandfulEndsInOutcomes) {
  drive_all(1, 13);
}

/// A thousand, a hundred each.
class RandomScenesNightly : public ::testing::TestWithParam<int> {};
TEST_P(RandomScenesNightly, AHundredEndInOutcomes) {
  const auto block = static_cast<std::uint64_t>(GetParam());
  drive_all(100 * block + 1, 100 * block + 101);
}
INSTANTIATE_TEST_SUITE_P(Hundreds, RandomScenesNightly, ::testing::Range(0, 10));

}  // namespace
}  // namespace canyon::mission::testing
