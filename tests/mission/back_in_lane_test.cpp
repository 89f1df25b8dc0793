// After it has gone around something the vehicle goes back to its lane.
#include <algorithm>
#include <cmath>

#include "canyon/tests/mission/random_missions.h"

namespace canyon::mission::testing {
namespace {

constexpr double kAsked_m = 30.0;

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
  RecordedRun run;
  RunParts parts;
  parts.recorder = &run;
  Omissions unread;
  unread.maps = unread.keyframes = unread.unkept_rays = true;
  parts.omissions = &unread;
  const auto record = run_mission(config, *prepared, nullptr, std::move(parts));
  EXPECT_TRUE(record.ok());
  EXPECT_EQ(record->outcome, Outcome::kSuccess) << number << (record->failure ? record->failure->detail : "");
  const Path& route = prepared->prior.route;
  constexpr double kCar_m = 4.5;
  const double rear_m = 0.5 * (config.vehicle.length_m - config.vehicle.wheelbase_m);
  const double front_m = config.vehicle.length_m - rear_m;
  const auto place_of = [&](const scene::MovingConfig& car) {
    return route.project({car.path_m[0], car.path_m[1]}, 0.0, route.length_m());
  };
  /// Where the car's near end stands that is reached first beyond s.
  const auto next_after = [&](double s) {
    double next_s = 1e300;
    for (const scene::MovingConfig& car : config.scene.moving)
      if (const double near_s = place_of(car) - 0.5 * kCar_m; near_s > s) next_s = std::min(next_s, near_s);
    return next_s;
  };
  WayBack out;
  for (const scene::MovingConfig& car : config.scene.moving) {
    const double car_s = place_of(car), next_s = next_after(car_s);
    bool evaded = false;
    double past_s = -1.0, s = 0.0;
    for (const NavRow& row : run.nav) {
      const Eigen::Vector2d p = row.X_WB_true.p.head<2>();
      s = route.project(p, std::max(0.0, s - 2.0), s + 5.0);
      const double off = std::abs(route.offset(p, s)),
                   allowed = 0.5 + (row.estimate.X_WB.p - row.X_WB_true.p).head<2>().norm();
      if (s < car_s + 0.5 * kCar_m + rear_m) {
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

}  // namespace
}  // namespace canyon::mission::testing
