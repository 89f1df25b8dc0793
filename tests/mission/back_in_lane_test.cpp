// After it has gone around something the vehicle goes back to its lane.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "canyon/scene/city/site.h"
#include "canyon/tests/mission/random_missions.h"

namespace canyon::mission::testing {
namespace {

constexpr double kAsked_m = 30.0, kCar_m = 4.5;

double rear_m(const VehicleConfig& vehicle) {
  return 0.5 * (vehicle.length_m - vehicle.wheelbase_m);
}

double place_of(const scene::MovingConfig& car, const Path& route) {
  return route.project({car.path_m[0], car.path_m[1]}, 0.0, route.length_m());
}

/// Off its lane: by more than this from the lane's middle.
double allowed_m(const NavRow& row) {
  return 0.5 + (row.estimate.X_WB.p - row.X_WB_true.p).head<2>().norm();
}

/// Drives it to its success, with nothing made that only maps need.
RecordedRun driven_home(const MissionConfig& config, const PreparedMission& prepared) {
  RecordedRun run;
  RunParts parts;
  parts.recorder = &run;
  Omissions unread;
  unread.maps = unread.keyframes = unread.unkept_rays = true;
  parts.omissions = &unread;
  auto record = run_mission(config, prepared, nullptr, std::move(parts));
  EXPECT_TRUE(record.ok()) << (record.ok() ? "" : record.error().str());
  if (!record.ok()) return run;
  static_cast<RunRecord&>(run) = *std::move(record);
  EXPECT_EQ(run.outcome, Outcome::kSuccess) << config.run.seed << " " << (run.failure ? run.failure->detail : "");
  return run;
}

struct WayBack {
  int evasions = 0;
  double longest_m = 0.0;  ///< from the body's being past the thing to its being back
};

/// Along the route from where the rear bumper has passed each car that stands in the lane to where the rear axle truly
/// is within 0.5 m and the estimate's own error of the lane's middle. What it comes to on the way back, sooner than it
/// has to be back, it goes around in one go, and is to be back after the last. A way that the mission's end or the
/// crossing cuts short counts only if it is longer than was asked for.
WayBack way_back(std::uint64_t number, bool truth_as_pose) {
  MissionConfig config = RandomMission(number).config();
  config.run.truth_as_pose = truth_as_pose;
  SceneCache own;
  const auto prepared = prepare(config, own);
  EXPECT_TRUE(prepared.ok());
  const RecordedRun run = driven_home(config, *prepared);
  const Path& route = prepared->prior.route;
  const double behind_m = rear_m(config.vehicle), front_m = config.vehicle.length_m - behind_m;
  /// Where the car's near end stands that is reached first beyond s.
  const auto next_after = [&](double s) {
    double next_s = 1e300;
    for (const scene::MovingConfig& car : config.scene.moving)
      if (const double near_s = place_of(car, route) - 0.5 * kCar_m; near_s > s) next_s = std::min(next_s, near_s);
    return next_s;
  };
  WayBack out;
  for (const scene::MovingConfig& car : config.scene.moving) {
    const double car_s = place_of(car, route), next_s = next_after(car_s);
    bool evaded = false;
    double past_s = -1.0, s = 0.0;
    for (const NavRow& row : run.nav) {
      const Eigen::Vector2d p = row.X_WB_true.p.head<2>();
      s = route.project(p, std::max(0.0, s - 2.0), s + 5.0);
      const double off = std::abs(route.offset(p, s)), allowed = allowed_m(row);
      if (s < car_s + 0.5 * kCar_m + behind_m) {
        evaded = evaded || (s > car_s - 0.5 * kCar_m && off > allowed);
        continue;
      }
      if (!evaded) break;
      if (past_s < 0.0) past_s = s;
      if (s + front_m >= next_s && s - past_s <= kAsked_m) {
        past_s = -1.0;
        break;
      }
      if (off > allowed) continue;
      ++out.evasions;
      out.longest_m = std::max(out.longest_m, s - past_s);
      past_s = -1.0;
      break;
    }
    if (past_s >= 0.0) out.longest_m = std::max(out.longest_m, s - past_s);
  }
  return out;
}

void all_come_back(std::uint64_t from, std::uint64_t to, int fewest) {
  for (const bool truth : {true, false}) {
    int evasions = 0;
    double longest_m = 0.0;
    for (std::uint64_t number = from; number < to; ++number) {
      const WayBack one = way_back(number, truth);
      evasions += one.evasions;
      longest_m = std::max(longest_m, one.longest_m);
      EXPECT_LE(one.longest_m, kAsked_m) << number << (truth ? " on truth" : " on estimates");
    }
    EXPECT_GE(evasions, fewest);
    std::printf("%s: %d evasions, longest way back %.1f m\n", truth ? "truth" : "low", evasions, longest_m);
  }
}

TEST(BackInLane, WithinThirtyMetresOfAnEvasion) {
  all_come_back(2, 4, 2);
}

TEST(BackInLaneNightly, FortyTimesWithinThirtyMetres) {
  all_come_back(1, 41, 40);
}

/// The whole built-in mission, of `high` with nothing built. With `cars` one stands in the lane every 70 to 100 m, up
/// to 1.2 m beside its middle, wherever no waypoint is near and the way back can be 40 m straight on.
MissionConfig whole_mission(const std::string& fidelity, std::int64_t seed, bool cars) {
  const auto file =
      MissionFile::parse("base = \"vicksburg\"\n[registration]\nmethod = \"none\"\n", "whole_mission.toml");
  EXPECT_TRUE(file.ok());
  MissionConfig config = *file->resolve(fidelity);
  config.run.seed = seed;
  config.scene.city.empty = fidelity == "high";
  if (!cars) return config;
  const auto site = scene::planned_site(config.scene);
  const auto prior = plan_route(config.autonomy, site->streets, config.vehicle.start_m);
  EXPECT_TRUE(prior.ok());
  const Path& route = prior->route;
  const auto is_clear = [&](double from_s, double to_s) {
    for (const double waypoint_s : prior->waypoint_s_m)
      if (waypoint_s > from_s && waypoint_s < to_s) return false;
    for (double s = from_s; s < to_s; s += 1.0)
      if (std::abs(route.curvature(s)) > 1e-3) return false;
    return true;
  };
  const RandomStream stream(static_cast<std::uint64_t>(seed), "tests.back_in_lane");
  std::uint64_t draws = 0;
  for (double s = 40.0; s + 40.0 < route.length_m();) {
    if (!is_clear(s - 15.0, s + 0.5 * kCar_m + 40.0)) {
      s += 1.0;
      continue;
    }
    const Eigen::Vector2d u = route.direction(s);
    const Eigen::Vector2d p = route.at(s) + stream.uniform(-1.2, 1.2, 0, draws++) * Eigen::Vector2d(-u.y(), u.x());
    scene::MovingConfig car;
    car.path_m = {p.x(), p.y(), p.x() + u.x(), p.y() + u.y()};
    car.start_s = 1e5;
    config.scene.moving.push_back(car);
    s += stream.uniform(70.0, 100.0, 0, draws++);
  }
  return config;
}

/// A stretch of the way that is driven off the lane, whatever for.
struct OffLane {
  double from_s, to_s, farthest_s;  ///< along the route; farthest_s: where it is farthest beyond what is allowed
};

std::vector<OffLane> off_lane(const Path& route, const std::vector<NavRow>& nav) {
  std::vector<OffLane> out;
  bool off = false;
  double s = 0.0, most_m = 0.0;
  for (const NavRow& row : nav) {
    const Eigen::Vector2d p = row.X_WB_true.p.head<2>();
    s = route.project(p, std::max(0.0, s - 2.0), s + 5.0);
    const double over_m = std::abs(route.offset(p, s)) - allowed_m(row);
    if (off) out.back().to_s = s;
    if (!off && over_m > 0.0) {
      out.push_back({s, s, s});
      most_m = over_m;
    }
    off = over_m > 0.0;
    if (!off || over_m < most_m) continue;
    most_m = over_m;
    out.back().farthest_s = s;
  }
  return out;
}

/// Of a stretch on which cars are passed the way back counts from where the last of them is left behind, unless the one
/// before was left behind for longer than is asked for; of any other, as before what is not there, from where it is
/// farthest off.
WayBack way_back(const OffLane& stretch, const std::vector<double>& cars_s, const VehicleConfig& vehicle) {
  const double behind_m = rear_m(vehicle), front_m = vehicle.length_m - behind_m;
  WayBack out;
  double since_s = stretch.farthest_s;
  for (const double car_s : cars_s) {
    const double reached_s = car_s - 0.5 * kCar_m - front_m, passed_s = car_s + 0.5 * kCar_m + behind_m;
    if (passed_s < stretch.from_s || reached_s > stretch.to_s) continue;
    if (out.evasions > 0 && reached_s - since_s > kAsked_m) break;
    ++out.evasions;
    since_s = passed_s;
  }
  out.longest_m = std::max(0.0, stretch.to_s - since_s);
  return out;
}

// As they are, where nothing stands in the lane and only what is not there could be gone around; and among cars.
TEST(BackInLaneNightly, InWholeMissionsToo) {
  for (const bool cars : {false, true}) {
    for (const char* fidelity : {"low", "high"}) {
      for (std::int64_t seed = 1; seed <= 3; ++seed) {
        const std::string which = std::string(fidelity) + " " + std::to_string(seed) + (cars ? " among cars" : "");
        const MissionConfig config = whole_mission(fidelity, seed, cars);
        SceneCache own;
        const auto prepared = prepare(config, own);
        ASSERT_TRUE(prepared.ok()) << which << ": " << prepared.error().str();
        const Path& route = prepared->prior.route;
        std::vector<double> cars_s;
        for (const scene::MovingConfig& car : config.scene.moving) cars_s.push_back(place_of(car, route));
        const std::vector<OffLane> stretches = off_lane(route, driven_home(config, *prepared).nav);
        WayBack whole;
        for (const OffLane& stretch : stretches) {
          const WayBack one = way_back(stretch, cars_s, config.vehicle);
          EXPECT_LE(one.longest_m, kAsked_m) << which << ", off its lane from " << stretch.from_s << " m on";
          whole.evasions += one.evasions;
          whole.longest_m = std::max(whole.longest_m, one.longest_m);
        }
        std::printf("%s: %zu times off its lane, %d of %zu cars gone around, longest way back %.1f m\n", which.c_str(),
                    stretches.size(), whole.evasions, cars_s.size(), whole.longest_m);
        if (!cars) continue;
        EXPECT_GE(cars_s.size(), 5U) << which;
        EXPECT_GT(whole.evasions, 0) << which;
      }
    }
  }
}

}  // namespace
}  // namespace canyon::mission::testing
