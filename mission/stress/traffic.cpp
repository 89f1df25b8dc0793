#include "canyon/scene/city/traffic.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/mission/stress/subjects.h"
#include "canyon/scene/flat_ground.h"

namespace canyon::mission {
namespace {

scene::Traffic traffic_of(const std::vector<double>& path_m, double speed_m_s, double start_s) {
  scene::MovingConfig config;
  config.path_m = path_m;
  config.speed_m_s = speed_m_s;
  config.start_s = start_s;
  return *scene::Traffic::make({config}, scene::flat_ground());
}

/// It stands until it starts and at its end, however long that is, and in between it is where its speed has brought it,
/// along legs of which some have no length: to a rounding of the time, which counts by the speed. Where it stands, to a
/// rounding of the way, 1e-14 m.
StressFigure ways(double start_s) {
  const double speed = 8.0;
  const auto traffic = traffic_of({0, 0, 0, 0, 40, 0, 40, 0, 40, 30, 40, 30}, speed, start_s);
  stress::Worst worst;
  const auto look = [&](double t_s, double x, double y, bool moves) {
    const auto found = traffic.at(t_s);
    const double rounding_m = 8.0 * stress::kEpsilon * (100.0 + (moves ? speed * std::abs(t_s) : 0.0));
    worst.look((found[0].X_WS.p.head<2>() - Eigen::Vector2d(x, y)).norm(), rounding_m);
    worst.look(found[0].X_WS.R.norm() - 1.0, 8.0 * stress::kEpsilon);
  };
  for (const double before_s : {-1e300, -1.0, 0.0}) look(start_s + before_s, 0.0, 0.0, false);
  look(start_s + 2.5, 20.0, 0.0, true);
  look(start_s + 5.0, 40.0, 0.0, true);
  look(start_s + 6.25, 40.0, 10.0, true);
  look(start_s + 8.75, 40.0, 30.0, true);
  for (const double t_s : {start_s + 100.0, 2147483648.0, 1e12, 1e300}) look(t_s, 40.0, 30.0, false);
  return worst.figure();
}

/// Without speed, or with no leg of any length, it stands for ever, upright and a rotation.
StressFigure standing() {
  stress::Worst worst;
  for (const auto& traffic : {traffic_of({5, 6, 50, 60}, 0.0, 0.0), traffic_of({5, 6, 5, 6}, 100.0, 0.0)})
    for (const double t_s : {0.0, 1.0, 1e9}) {
      const Pose pose = traffic.at(t_s)[0].X_WS;
      worst.look((pose.p.head<2>() - Eigen::Vector2d(5.0, 6.0)).norm(), 1e-12);
      worst.look(((pose.R * Eigen::Vector3d::UnitZ()) - Eigen::Vector3d::UnitZ()).norm(), 8.0 * stress::kEpsilon);
      worst.look(pose.R.norm() - 1.0, 8.0 * stress::kEpsilon);
    }
  return worst.figure();
}

/// Along a leg each step of any length is speed times it, whatever the steps are: a thing's place is a function of
/// time, and no sum of steps. To a rounding of the time, which counts by the speed, at both ends.
StressFigure steps(double step_s) {
  const double speed = 2.0, along_x = 0.8, along_y = 0.6;
  const auto traffic = traffic_of({-100, -75, 100, 75}, speed, 0.0);
  stress::Worst worst;
  for (int k = 0; k < 120; ++k) {
    const double t_s = 2.0 * step_s + 0.7 * k;
    if (t_s + step_s > 120.0) break;
    const Eigen::Vector2d moved = (traffic.at(t_s + step_s)[0].X_WS.p - traffic.at(t_s)[0].X_WS.p).head<2>();
    worst.look((moved - speed * ((t_s + step_s) - t_s) * Eigen::Vector2d(along_x, along_y)).norm(),
               16.0 * stress::kEpsilon * (250.0 + speed * t_s));
  }
  return worst.figure();
}

/// The room that is told to be swept by a thing holds every corner of it at any time, along each leg, of a single point
/// too: within the radius of one of the legs, below its top, and each room is of the leg's two ends. A figure
/// counts corners outside and other ends.
StressFigure swept_rooms() {
  int outside = 0;
  for (const std::vector<double>& way :
       {std::vector<double>{3, 4}, {0, 0, 40, 0, 40, 30}, {5, 6, 5, 6, 5, 6}, {-20, 7, 20, 7}}) {
    const auto traffic = traffic_of(way, 8.0, 1.0);
    const std::vector<scene::SweptRoom> rooms = traffic.swept();
    outside += rooms.size() == std::max<std::size_t>(1, way.size() / 2 - 1) ? 0 : 1;
    for (std::size_t k = 0; k < rooms.size(); ++k) {
      const std::size_t next = std::min(k + 1, way.size() / 2 - 1);
      outside += rooms[k].from_W == Eigen::Vector2d(way[2 * k], way[2 * k + 1]) &&
                         rooms[k].to_W == Eigen::Vector2d(way[2 * next], way[2 * next + 1])
                     ? 0
                     : 1;
    }
    for (double t_s = 0.0; t_s < 12.0; t_s += 0.31) {
      const scene::Instance thing = traffic.at(t_s)[0];
      for (const Eigen::Vector3f& corner : thing.shape->mesh().vertices) {
        const Eigen::Vector3d p = thing.X_WS * corner.cast<double>();
        bool held = false;
        for (const scene::SweptRoom& room : rooms) {
          const Eigen::Vector2d leg = room.to_W - room.from_W, to = p.head<2>() - room.from_W;
          const double along = leg.squaredNorm() > 0.0 ? std::clamp(leg.dot(to) / leg.squaredNorm(), 0.0, 1.0) : 0.0;
          held |= (to - along * leg).norm() <= room.radius_m && p.z() <= room.top_m &&
                  room.around().contains(Eigen::Vector2d(p.head<2>()));
        }
        outside += held ? 0 : 1;
      }
    }
  }
  return {1.0 * outside, 0.0};
}

}  // namespace

std::vector<StressCase> traffic_cases() {
  const StressMechanism way{
      StressGroup::kGeometry, "a moving thing at the ends of its way, and where a leg has no length",
      "it goes on beyond its end, turns to no direction at a repeated point, or is where it was a round ago",
      "where its speed has brought it, to a rounding of the time; a rotation at all times", "of the bound"};
  StressRows rows;
  rows.of(way).add("traffic/from_before_its_start_to_1e300_s", [] { return ways(0.0); });
  rows.of(way).add("traffic/start_after_1e6_s", [] { return ways(1e6); });
  rows.of(way).add("traffic/that_stands", standing);
  rows.of({StressGroup::kStiff, "a moving thing looked at in steps of any length",
           "a place that is a sum of steps drifts, or moves by whole steps alone",
           "speed times the step along a leg, to roundings of the way", "of the bound"});
  for (const auto& [name, step_s] : {std::pair{"traffic/steps_of_10_us", 1e-5},
                                     {"traffic/steps_of_10_ms", 1e-2},
                                     {"traffic/steps_of_1_s", 1.0},
                                     {"traffic/steps_of_40_s", 40.0}})
    rows.add(name, [step_s = step_s] { return steps(step_s); });
  rows.of({StressGroup::kGeometry, "the room that moving things ever take",
           "a leg that is left out, or one after the last", "every corner of theirs within it, at all times",
           "corners"});
  rows.add("traffic/swept_rooms", swept_rooms);
  return rows.take();
}

}  // namespace canyon::mission
