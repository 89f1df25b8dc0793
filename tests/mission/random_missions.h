#pragma once

#include <cmath>
#include <string>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {

/// A drive of 100 to 150 m through the built-in city with the true pose: along a street, on over a crossing whichever
/// way its streets lead, and some 50 m further. Cars stand in the lane, up to 1.2 m beside its middle. Of even numbers
/// the vehicle starts with one of them before it: its middle 4.75 to 12 m ahead of the rear axle, the nearest 0.3 m
/// before the bumper.
class RandomMission {
 public:
  explicit RandomMission(std::uint64_t number, const std::string& planner = "offsets")
      : stream_(number, "tests.random_missions") {
    config_ = short_config("low", "low",
                           "[run]\ntruth_as_pose = true\n[success]\nlimit_factor = 3.0\n"
                           "[autonomy]\nmodel = \"reference\"\nplanner.model = \"" +
                               planner + "\"");
    config_.run.seed = static_cast<std::int64_t>(number);
    while (!lay(number % 2 == 0)) {
    }
  }
  const MissionConfig& config() const { return config_; }

 private:
  double between(double low, double high) { return stream_.uniform(low, high, 0, draws_++); }
  std::size_t one_of(std::size_t n) { return std::min(n - 1, static_cast<std::size_t>(between(0.0, 1.0) * n)); }

  void park(const Eigen::Vector2d& at, const Eigen::Vector2d& along, double left_m) {
    const Eigen::Vector2d p = at + left_m * Eigen::Vector2d(-along.y(), along.x());
    scene::MovingConfig car;
    car.name = "car in the lane " + std::to_string(config_.scene.moving.size() + 1);
    car.path_m = {p.x(), p.y(), p.x() + along.x(), p.y() + along.y()};
    car.start_s = 1e5;
    config_.scene.moving.push_back(car);
  }

  /// False where no street leads on.
  bool lay(bool behind_a_car) {
    constexpr double kCrossing_m = 20.0;  // from its middle, kept free of cars
    const scene::StreetGraph& streets = (*scenes().get(config_.scene))->streets();
    const scene::StreetGraph::Edge& edge = streets.edges[one_of(streets.edges.size())];
    const bool back = between(0.0, 1.0) < 0.5;
    const std::uint32_t from = back ? edge.b : edge.a, over = back ? edge.a : edge.b;
    std::vector<std::uint32_t> onward;
    for (const auto& e : streets.edges) {
      if (e.a == over && e.b != from) onward.push_back(e.b);
      if (e.b == over && e.a != from) onward.push_back(e.a);
    }
    const Eigen::Vector2d a = streets.nodes_W[from], b = streets.nodes_W[over];
    const double length_m = (b - a).norm();
    if (onward.empty() || length_m < 60.0) return false;
    const Eigen::Vector2d c = streets.nodes_W[onward[one_of(onward.size())]];
    const Eigen::Vector2d along = (b - a) / length_m, then = (c - b).normalized();

    const double start_m = between(8.0, 25.0);
    config_.vehicle.start_m = a + start_m * along;
    config_.vehicle.start_heading_deg = heading_from_yaw(std::atan2(along.y(), along.x())) / kDegree;
    config_.autonomy.waypoints = {{"before the crossing", b - kCrossing_m * along, ""},
                                  {"goal", b + between(35.0, 60.0) * then, ""}};
    config_.scene.moving.clear();
    double at_m = start_m;
    if (behind_a_car) {
      at_m += between(4.75, 12.0);
      park(a + at_m * along, along, between(-0.8, 0.8));
    }
    at_m += between(22.0, 30.0);
    if (at_m < length_m - kCrossing_m) park(a + at_m * along, along, between(-1.2, 1.2));
    park(b + between(18.0, 28.0) * then, then, between(-1.2, 1.2));
    return true;
  }

  RandomStream stream_;
  std::uint64_t draws_ = 0;
  MissionConfig config_;
};

/// How it ended, with the number, for messages.
inline std::string drive_random(std::uint64_t number, const std::string& planner) {
  const RandomMission mission(number, planner);
  SceneCache own;  // each has other cars: the shared one would keep them all
  const auto prepared = prepare(mission.config(), own);
  if (!prepared.ok()) return prepared.error().str();
  Omissions unread;  // nobody looks at maps
  unread.maps = unread.keyframes = unread.unkept_rays = true;
  RunParts parts;
  parts.omissions = &unread;
  const auto record = run_mission(mission.config(), *prepared, nullptr, std::move(parts));
  if (!record.ok()) return record.error().str();
  if (record->outcome == Outcome::kSuccess) return "success";
  return std::string(name(*record->outcome)) + " after " + std::to_string(record->failure->t_s) +
         " s: " + record->failure->detail;
}

}  // namespace canyon::mission::testing
