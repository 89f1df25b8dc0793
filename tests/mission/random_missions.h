#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {

/// What stands in the lane: cars, or whatever may.
enum class Standing { kCars, kAll };

/// All that Standing::kAll draws: what stands there, of which a gap is between two cars side by side, and how a mission
/// is driven.
inline const std::set<std::string>& whatever_stands() {
  static const std::set<std::string> all{"car", "bus", "person", "pole", "gap", "box and high's LIDAR"};
  return all;
}

/// A drive of 100 to 150 m through the built-in city with the true pose: along a street, on over a crossing whichever
/// way its streets lead, and some 50 m further. Things stand in the lane, up to 1.2 m beside its middle. Of even
/// numbers the vehicle starts with one of them before it. Of cars its middle is 4.75 to 12 m ahead of the rear axle,
/// the nearest 0.3 m before the bumper; of whatever may stand there the nearest end is 0.3 to 12 m before the bumper.
/// With those every second mission is scored by the whole body, and driven with the LIDAR of `high`.
class RandomMission {
 public:
  static constexpr double kPoleHalf_m = 0.07;  ///< as the city's own poles (scene/city/poles.cpp)

  explicit RandomMission(std::uint64_t number, const std::string& planner = "offsets",
                         Standing standing = Standing::kCars)
      : stream_(number, standing == Standing::kCars ? "tests.random_missions" : "tests.random_missions.all") {
    config_ = short_config("low", "low",
                           "[run]\ntruth_as_pose = true\n[success]\nlimit_factor = 3.0\n"
                           "[autonomy]\nmodel = \"reference\"\nplanner.model = \"" +
                               planner + "\"");
    config_.run.seed = static_cast<std::int64_t>(number);
    while (!lay(number % 2 == 0, standing)) {
    }
    if (standing == Standing::kCars || number % 4 >= 2) return;
    config_.success.collision.name = "box";
    config_.lidar = short_config("high", "high").lidar;
    drawn_.insert("box and high's LIDAR");
  }
  const MissionConfig& config() const { return config_; }
  const std::vector<Eigen::Vector2d>& poles_W() const { return poles_W_; }
  const std::set<std::string>& drawn() const { return drawn_; }  ///< of whatever_stands()

 private:
  static constexpr double kCrossing_m = 20.0;  // from its middle, kept free of things
  static constexpr double kCar_m = 4.5, kCarWidth_m = 1.8, kBus_m = 12.0, kPerson_m = 0.3;
  /// The body's 1.5 m with the planner's clearance of 0.3 m on either side; the 0.5 m between the ways that `offsets`
  /// tries, a cell of 0.2 m, and 0.1 m for a body that is 2.6 m long and 2 degrees askew.
  static constexpr double kNarrowest_m = 1.5 + 2.0 * 0.3 + 0.5 + 0.2 + 0.1;

  double between(double low, double high) { return stream_.uniform(low, high, 0, draws_++); }
  std::size_t one_of(std::size_t n) { return std::min(n - 1, static_cast<std::size_t>(between(0.0, 1.0) * n)); }

  void stand(const std::string& shape, const Eigen::Vector2d& at, const Eigen::Vector2d& along, double left_m) {
    const Eigen::Vector2d p = at + left_m * Eigen::Vector2d(-along.y(), along.x());
    scene::MovingConfig thing;
    thing.name = shape + " in the lane " + std::to_string(config_.scene.moving.size() + 1);
    thing.shape = shape;
    thing.path_m = {p.x(), p.y(), p.x() + along.x(), p.y() + along.y()};
    thing.start_s = 1e5;
    config_.scene.moving.push_back(thing);
  }

  /// Something with its near end there, on a leg from a. Where its far end is.
  double put(const Eigen::Vector2d& a, const Eigen::Vector2d& along, double near_m, double most_left_m, bool gaps) {
    static const char* const kinds[] = {"car", "bus", "person", "pole", "gap"};
    const std::string kind = kinds[one_of(gaps ? 5 : 4)];
    drawn_.insert(kind);
    if (kind == "gap") {
      // Between cars that are parked at both kerbs, 4 m from the middle, there is no room on either side of the two.
      const double half_m = 0.5 * (between(kNarrowest_m, kNarrowest_m + 0.6) + kCarWidth_m),
                   middle_m = between(-0.4, 0.4);
      for (const double side : {-1.0, 1.0})
        stand("car", a + (near_m + 0.5 * kCar_m) * along, along, middle_m + side * half_m);
      return near_m + kCar_m;
    }
    const double left_m = between(-most_left_m, most_left_m), length_m = kind == "car"      ? kCar_m
                                                                         : kind == "bus"    ? kBus_m
                                                                         : kind == "person" ? kPerson_m
                                                                                            : 2.0 * kPoleHalf_m;
    const Eigen::Vector2d middle = a + (near_m + 0.5 * length_m) * along;
    if (kind == "pole")
      poles_W_.emplace_back(middle + left_m * Eigen::Vector2d(-along.y(), along.x()));
    else
      stand(kind, middle, along, left_m);
    return near_m + length_m;
  }

  /// From a node of the streets to a crossing, and on from there.
  struct Way {
    Eigen::Vector2d a, b, along, then;
    double length_m, start_m;  ///< of the first leg, and of the start along it
  };

  /// False where no street leads on, or what stands there would reach to the crossing.
  bool lay(bool behind_one, Standing standing) {
    config_.scene.moving.clear();
    poles_W_.clear();
    drawn_.clear();
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
    const Way way{a, b, (b - a) / length_m, (c - b).normalized(), length_m, between(8.0, 25.0)};
    config_.vehicle.start_m = a + way.start_m * way.along;
    config_.vehicle.start_heading_deg = heading_from_yaw(std::atan2(way.along.y(), way.along.x())) / kDegree;
    if (standing == Standing::kAll) return lay_whatever(way, behind_one);
    lay_cars(way, behind_one);
    return true;
  }

  void lead(const Way& way, double goal_m) {
    config_.autonomy.waypoints = {{"before the crossing", way.b - kCrossing_m * way.along, ""},
                                  {"goal", way.b + goal_m * way.then, ""}};
  }

  void lay_cars(const Way& way, bool behind_one) {
    lead(way, between(35.0, 60.0));
    double at_m = way.start_m;
    if (behind_one) {
      at_m += between(4.75, 12.0);
      stand("car", way.a + at_m * way.along, way.along, between(-0.8, 0.8));
    }
    at_m += between(22.0, 30.0);
    if (at_m < way.length_m - kCrossing_m) stand("car", way.a + at_m * way.along, way.along, between(-1.2, 1.2));
    stand("car", way.b + between(18.0, 28.0) * way.then, way.then, between(-1.2, 1.2));
  }

  /// What stands before the crossing ends early enough for the vehicle to be near its lane again at the waypoint there.
  bool lay_whatever(const Way& way, bool behind_one) {
    constexpr double kBack_m = 8.0;
    const VehicleConfig& v = config_.vehicle;
    double at_m = way.start_m + v.wheelbase_m + 0.5 * (v.length_m - v.wheelbase_m);  // the bumper
    if (behind_one) {
      const double room_m = between(0.3, 12.0);
      at_m = put(way.a, way.along, at_m + room_m, 0.8, false);
      if (at_m > way.length_m - kCrossing_m - kBack_m) return false;
    }
    at_m += between(17.5, 25.5);
    if (at_m + kBus_m < way.length_m - kCrossing_m - kBack_m) put(way.a, way.along, at_m, 1.2, true);
    const double beyond_m = between(18.0, 26.0);
    const double far_m = put(way.b, way.then, beyond_m, 1.2, true);
    lead(way, far_m + between(5.0, 22.0));
    return true;
  }

  RandomStream stream_;
  std::uint64_t draws_ = 0;
  MissionConfig config_;
  std::vector<Eigen::Vector2d> poles_W_;
  std::set<std::string> drawn_;
};

/// Ready to be driven, its poles in the scene.
inline Result<PreparedMission> prepare_random(const RandomMission& mission) {
  SceneCache own;  // each has other things: the shared one would keep them all
  CANYON_TRY(PreparedMission prepared, prepare(mission.config(), own));
  if (mission.poles_W().empty()) return prepared;
  constexpr double kHalf_m = RandomMission::kPoleHalf_m, kHeight_m = 8.0;
  scene::SceneParts parts = prepared.scene->parts();
  scene::MeshBuilder mesh(parts);
  const std::uint16_t metal = mesh.material("metal");
  for (const Eigen::Vector2d& p : mission.poles_W()) {
    const auto ground = prepared.scene->ground(p.x(), p.y());
    CANYON_CHECK(ground.has_value(), "no ground at ", p.x(), ", ", p.y());
    mesh.begin_object("pole in the lane " + std::to_string(&p - mission.poles_W().data() + 1),
                      scene::ObjectKind::kPole);
    mesh.block(scene::rectangle(p.x() - kHalf_m, p.y() - kHalf_m, p.x() + kHalf_m, p.y() + kHalf_m),
               ground->height_m - 0.3, ground->height_m + kHeight_m, metal, metal);
  }
  prepared.scene = std::make_shared<const scene::Scene>(std::move(parts));
  CANYON_TRY(prepared.traffic, scene::Traffic::make(mission.config().scene.moving, *prepared.scene));
  return prepared;
}

/// How it ended, with the number, for messages.
inline std::string drive_random(const RandomMission& mission) {
  const auto prepared = prepare_random(mission);
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
