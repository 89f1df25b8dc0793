// Whatever the city, the sensors and the autonomy's parts: a run ends in an outcome, and not by any truth.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <future>
#include <set>
#include <string>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/boundaries.h"
#include "canyon/tests/mission/poisoned_truth.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

/// Registration and the planner that searches take their time: by day drives have the usual parts alone.
enum class PartsDrawn { kUsual, kAll };

/// What only some of all drives have: each of them one in ten at least.
const std::set<std::string>& rarer_parts() {
  static const std::set<std::string> parts{"high_aided",      "box",        "kerbs",        "seen_kerbs",
                                           "dynamic_bicycle", "skid_steer", "registration", "hybrid_a_star"};
  return parts;
}

/// Every tenth drive goes on, for what only shows once a vehicle has stood, backed up or lost its way.
double lasts_s(std::uint64_t number) {
  return number % 10 == 5 ? 60.0 : 12.0;
}

/// A short drive through a small city of its own, with sensors, filter, things that move and parts of the autonomy
/// drawn at random, bad ones among them.
class RandomDrive {
 public:
  RandomDrive(std::uint64_t number, PartsDrawn parts) : stream_(number, "tests.random_scenes") {
    const char* fidelities[] = {"low", "high", "paper", "modern", "high_aided"};
    const std::size_t known = parts == PartsDrawn::kAll ? 5 : 4;
    const std::string imu = fidelities[one_of(known)], gnss = fidelities[one_of(known)];
    if (gnss == "high_aided") rarer_.insert(gnss);
    config_ = short_config(gnss, imu);
    config_.time.limit_s = lasts_s(number);
    config_.run.seed = static_cast<std::int64_t>(number);
    draw_scene(number);
    draw_sensors();
    draw_autonomy();
    if (parts == PartsDrawn::kAll) draw_rarer_parts();
    draw_places();
  }
  const MissionConfig& config() const { return config_; }
  const std::set<std::string>& rarer() const { return rarer_; }  ///< those of rarer_parts() that it has

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

  bool rarely(const char* part, double n) {
    if (!once_in(n)) return false;
    rarer_.insert(part);
    return true;
  }

  void draw_rarer_parts() {
    if (rarely("box", 4)) config_.success.collision.name = "box";
    if (rarely("kerbs", 4)) config_.scene.city.kerb_height_m = between(0.05, 0.2);
    if (rarely("dynamic_bicycle", 6)) {
      config_.vehicle.model.name = "dynamic_bicycle";
    } else if (rarely("skid_steer", 6)) {
      config_.vehicle.model.name = "skid_steer";
    }
    if (rarely("registration", 8)) {
      config_.registration.method.name = lidar::RegistrationConfig{}.method.name;
      if (once_in(2)) config_.autonomy.map = MapPose::kRegistered;
    }
    if (config_.autonomy.model.name != "reference") return;  // the only one with these parts
    auto& parts = config_.autonomy.model.own.get<ReferenceParameters>();
    if (rarely("hybrid_a_star", 4)) parts.planner.model.name = "hybrid_a_star";
    if (rarely("seen_kerbs", 4)) parts.lane.model.name = "seen_kerbs";
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
  std::set<std::string> rarer_;
};

/// Drives it into `run`; empty where all is well. With `poisoned` its truth is, and the returns are counted there.
std::string wrong_with(const MissionConfig& config, const PreparedMission& prepared, RecordedRun& run,
                       int* poisoned = nullptr) {
  RunParts parts;
  parts.recorder = &run;
  Omissions unread;
  unread.maps = true;
  unread.keyframes = unread.unkept_rays = !lidar::registers(config.registration);
  parts.omissions = &unread;
  if (poisoned != nullptr) poison(config, prepared, parts, *poisoned);
  try {
    auto record = run_mission(config, prepared, nullptr, std::move(parts));
    if (!record.ok()) return record.error().str();
    if (!record->outcome) return "no outcome";
    if (*record->outcome == Outcome::kAutonomyFault) return "the autonomy: " + record->failure->detail;
    static_cast<RunRecord&>(run) = *std::move(record);
  } catch (const std::exception& thrown) {
    return std::string("thrown: ") + thrown.what();
  }
  for (const NavRow& row : run.nav)
    if (!row.X_WB_true.p.allFinite() || !row.estimate.X_WB.p.allFinite() || !is_finite(row.command))
      return "not finite at " + std::to_string(row.t - run.nav.front().t) + " s";
  return {};
}

/// Empty where the truth that a run was poisoned with changed no bit of it.
std::string poison_shows(const RecordedRun& sound, const RecordedRun& poisoned) {
  if (sound.outcome != poisoned.outcome || sound.nav.size() != poisoned.nav.size()) return "poisoned it ends otherwise";
  for (std::size_t i = 0; i < sound.nav.size(); ++i) {
    const NavRow &a = sound.nav[i], &b = poisoned.nav[i];
    if (a.X_WB_true.p != b.X_WB_true.p || a.estimate.X_WB.p != b.estimate.X_WB.p ||
        a.command.speed_m_s != b.command.speed_m_s || a.command.curvature_1_m != b.command.curvature_1_m)
      return "poisoned it is another after " + std::to_string(a.t - sound.start) + " s";
  }
  return {};
}

/// What many drives have had in them.
struct DrivesMet {
  std::set<std::string> rarer;
  int poisoned_returns = 0;
};

/// Draws until a drive can be, and drives it; of all parts every tenth once more, its truth poisoned. What cannot be, a
/// way that turns back at a waypoint or a unit without figures for the chain that is drawn, is refused with its key.
std::string driven(std::uint64_t number, PartsDrawn parts, DrivesMet& met) {
  for (std::uint64_t draw = 0; draw < 50; ++draw) {
    const RandomDrive drive(number + 100000 * draw, parts);
    SceneCache own;
    const auto prepared = prepare(drive.config(), own);
    if (!prepared.ok()) {
      if (prepared.error().key.empty()) return "refused without a key: " + prepared.error().str();
      continue;
    }
    met.rarer.insert(drive.rarer().begin(), drive.rarer().end());
    RecordedRun sound, poisoned;
    std::string wrong = wrong_with(drive.config(), *prepared, sound);
    if (!wrong.empty() || parts == PartsDrawn::kUsual || number % 10 != 0) return wrong;
    wrong = wrong_with(drive.config(), *prepared, poisoned, &met.poisoned_returns);
    return wrong.empty() ? poison_shows(sound, poisoned) : "poisoned, " + wrong;
  }
  return "none of 50 draws can be driven";
}

/// By the clock, for one number: a minute of driving takes some 17 s on two busy cores, and ten times that under the
/// sanitizers.
constexpr std::chrono::milliseconds kHangs{600'000};

/// What it says, if it comes back in time. If not it is asked to end, as by Ctrl-C. Where nothing looks at that any
/// more either, all that is left of it would go on beside what follows: the process ends.
std::string within(std::chrono::milliseconds limit, std::uint64_t number, const std::function<std::string()>& drive) {
  constexpr std::chrono::seconds kPatience{30};
  std::future<std::string> said = std::async(std::launch::async, drive);
  if (said.wait_for(limit) == std::future_status::ready) return said.get();
  const std::string hangs = "hangs: it has not come back after " + std::to_string(limit.count()) + " ms";
  set_cancel_requested(true);
  if (said.wait_for(kPatience) != std::future_status::ready) {
    std::fprintf(stderr, "drive %s %s, nor when it was asked to end\n", std::to_string(number).c_str(), hangs.c_str());
    std::fflush(nullptr);
    std::_Exit(EXIT_FAILURE);
  }
  set_cancel_requested(false);
  try {
    said.get();
  } catch (const Cancelled&) {
  }
  return hangs;
}

DrivesMet drive_all(std::uint64_t from, std::uint64_t to, PartsDrawn parts) {
  DrivesMet met;
  for (std::uint64_t number = from; number < to; ++number)
    EXPECT_EQ(within(kHangs, number, [&] { return driven(number, parts, met); }), "") << number;
  return met;
}

TEST(RandomScenes, AHandfulEndsInOutcomes) {
  drive_all(1, 9, PartsDrawn::kUsual);
}

TEST(RandomScenes, WhatHangsIsTold) {
  const auto for_ever = []() -> std::string {
    for (;;) throw_if_cancelled();
  };
  EXPECT_EQ(within(std::chrono::milliseconds(50), 7, for_ever), "hangs: it has not come back after 50 ms");
  EXPECT_FALSE(cancel_requested()) << "the next is driven";
  EXPECT_EQ(within(kHangs, 8, [] { return std::string("well"); }), "well");
}

/// A thousand, a hundred each, of which ten for a minute.
class RandomScenesNightly : public ::testing::TestWithParam<int> {};
TEST_P(RandomScenesNightly, AHundredEndInOutcomes) {
  const auto block = static_cast<std::uint64_t>(GetParam());
  const DrivesMet met = drive_all(100 * block + 1, 100 * block + 101, PartsDrawn::kAll);
  // One in ten at least has each: of all ten hundreds one lacks one with a chance of 10 x 8 x 0.9^100 = 0.2 %.
  EXPECT_EQ(met.rarer, rarer_parts());
  EXPECT_GT(met.poisoned_returns, 1000) << "the poison must be there";
}
INSTANTIATE_TEST_SUITE_P(Hundreds, RandomScenesNightly, ::testing::Range(0, 10));

}  // namespace
}  // namespace canyon::mission::testing
