// Autonomies on level ground, driven by their own commands on exact estimates: past posts, before walls, blind.
#include "canyon/mission/autonomy/autonomy.h"

#include <cmath>
#include <string>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;

const GpsTime kBegin = GpsTime::from_week_sow(1600, 0.0);
constexpr double kStep_s = 0.01, kSensor_m = 1.8;

/// A straight street along x of 120 m, with the walls of its houses 8 m to either side, and what stands in it.
struct Street {
  std::vector<Vector2d> posts;  ///< 0.4 m square, 1.5 m high
  double wall_x_m = 1e300;      ///< across the whole street

  LidarScan seen_from(const Vector2d& p, GpsTime t) const {
    LidarScan scan;
    scan.t = t;
    const auto add = [&](double x, double y, double z) {
      if (std::hypot(x - p.x(), y - p.y()) > 30.0) return;
      scan.points.push_back({.x = static_cast<float>(x - p.x()),
                             .y = static_cast<float>(y - p.y()),
                             .z = static_cast<float>(z - kSensor_m)});
    };
    for (double x = -10.0; x <= 130.0; x += 0.5)
      for (double y = -7.5; y <= 7.5; y += 0.5) add(x, y, 0.0);
    for (double z = 0.0; z <= 2.0; z += 0.2) {
      for (double x = -10.0; x <= 130.0; x += 0.25) add(x, 8.0, z), add(x, -8.0, z);
      for (double y = -8.0; wall_x_m < 1e300 && y <= 8.0; y += 0.125) add(wall_x_m, y, z);
      for (const Vector2d& post : posts)
        for (double u = -0.2; u <= 0.21; u += 0.1) {
          add(post.x() - 0.2, post.y() + u, 0.75 * z), add(post.x() + 0.2, post.y() + u, 0.75 * z);
          add(post.x() + u, post.y() - 0.2, 0.75 * z), add(post.x() + u, post.y() + 0.2, 0.75 * z);
        }
    }
    return scan;
  }
};

/// A vehicle that does what it is told within its limits: speed, steering angle and its rate.
struct Car {
  double x = 0.0, y = 0.0, yaw = 0.0, speed = 0.0, steering = 0.0;
  KnownVehicle can{};

  NavEstimate estimate(GpsTime t) const {
    NavEstimate out;
    out.t = t;
    out.X_WB.R = Eigen::Quaterniond(std::cos(0.5 * yaw), 0.0, 0.0, std::sin(0.5 * yaw));
    out.X_WB.p = {x, y, 0.0};
    out.v_WB_W = {speed * std::cos(yaw), speed * std::sin(yaw), 0.0};
    return out;
  }
  void follow(const DriveCommand& command) {
    speed += std::clamp(command.speed_m_s - speed, -can.max_deceleration_m_s2 * kStep_s, 1.5 * kStep_s);
    const double wanted =
        std::clamp(std::atan(can.wheelbase_m * command.curvature_1_m), -can.max_steering_rad, can.max_steering_rad);
    const double most = can.max_steering_rate_rad_s * kStep_s;
    steering += std::clamp(wanted - steering, -most, most);
    yaw += kStep_s * speed * std::tan(steering) / can.wheelbase_m;
    x += kStep_s * speed * std::cos(yaw), y += kStep_s * speed * std::sin(yaw);
  }
  /// From the body's rectangle to a point outside of it; 0 within.
  double distance_m(const Vector2d& p) const {
    const Vector2d d = p - Vector2d(x, y), forward(std::cos(yaw), std::sin(yaw));
    const double along = forward.dot(d), left = forward.x() * d.y() - forward.y() * d.x();
    return std::hypot(along - std::clamp(along, can.rear_m, can.front_m),
                      left - std::clamp(left, -can.half_width_m, can.half_width_m));
  }
};

std::unique_ptr<Autonomy> driver(const std::string& model) {
  AutonomyConfig config;
  config.model.name = model;
  config.waypoints = {{"end", {110.0, 0.0}, ""}};
  PriorKnowledge prior;
  prior.route = Path({{0.0, 0.0}, {120.0, 0.0}}, config.corner_radius_m);
  prior.waypoint_s_m = {110.0};
  return make_autonomy(config, prior, kBegin);
}

/// Where a car ends that is driven for some seconds, and how near its body has come to what stands there.
struct Driven {
  Car car;
  double nearest_m = 1e300, farthest_aside_m = 0.0;
  AutonomyState state{};
};
Driven drive(const std::string& model, const Street& street, double last_s, double last_scan_s = 1e300) {
  const auto autonomy = driver(model);
  Driven out;
  for (int k = 0; k * kStep_s <= last_s; ++k) {
    const GpsTime t = kBegin + kStep_s * k;
    const NavEstimate estimate = out.car.estimate(t);
    const Pose X_WL{estimate.X_WB.R, estimate.X_WB.p + Eigen::Vector3d(0.0, 0.0, kSensor_m)};
    if (k % 10 == 0 && k * kStep_s <= last_scan_s) {
      LidarScan scan = street.seen_from({out.car.x, out.car.y}, t);
      for (LidarPoint& point : scan.points) {
        const Eigen::Vector3d p = X_WL.R.conjugate() * Eigen::Vector3d(point.x, point.y, point.z);
        point.x = static_cast<float>(p.x()), point.y = static_cast<float>(p.y());
      }
      autonomy->see(scan, X_WL, estimate);
    }
    out.car.follow(autonomy->drive(estimate));
    for (const Vector2d& post : street.posts)
      for (const double side : {-0.2, 0.2})
        for (const double end : {-0.2, 0.2})
          out.nearest_m = std::min(out.nearest_m, out.car.distance_m(post + Vector2d(side, end)));
    for (double y = -8.0; street.wall_x_m < 1e300 && y <= 8.0; y += 0.25)
      out.nearest_m = std::min(out.nearest_m, out.car.distance_m({street.wall_x_m, y}));
    out.farthest_aside_m = worse(out.farthest_aside_m, std::abs(out.car.y));
  }
  out.state = autonomy->state();
  return out;
}

/// An empty street is driven along its middle to its end, which is reached to the stop's tolerance of half a metre.
StressFigure empty_street(const std::string& model) {
  const Driven found = drive(model, {}, 60.0);
  StressFigure out;
  out.figure += std::abs(found.car.x - 110.0) < 0.5 && found.car.speed < 0.05 ? 0.0 : 1.0;
  out.figure += found.farthest_aside_m < 0.05 && found.state == AutonomyState::kDone ? 0.0 : 1.0;
  return out;
}

/// Posts in the middle of the street are passed without touching any, aside by what the body needs, and after 60 s it
/// is at its end; of `reference`, to which the way back always pays, in the middle to half a metre.
StressFigure past_posts(const std::string& model) {
  const Driven found = drive(model, {.posts = {{25.0, 0.0}, {55.0, 0.5}, {80.0, -0.5}}}, 60.0);
  StressFigure out;
  out.figure += found.nearest_m > 0.0 ? 0.0 : 1.0;
  out.figure += found.farthest_aside_m > 0.95 && found.farthest_aside_m < 7.0 ? 0.0 : 1.0;
  out.figure += std::abs(found.car.x - 110.0) < 0.5 ? 0.0 : 1.0;
  out.figure += model != "reference" || std::abs(found.car.y) < 0.5 ? 0.0 : 1.0;
  return out;
}

/// Before a wall across the whole street it stands still and says that it is blocked; between nothing and 10 m before
/// it.
StressFigure wall(const std::string& model) {
  const Driven found = drive(model, {.posts = {}, .wall_x_m = 40.0}, 20.0);
  StressFigure out;
  out.figure += found.nearest_m > 0.0 && found.nearest_m < 10.0 ? 0.0 : 1.0;
  out.figure += found.car.speed < 0.3 && found.state == AutonomyState::kBlocked ? 0.0 : 1.0;
  return out;
}

/// From 5 s on no scan comes: it stops, and says why.
StressFigure blind(const std::string& model) {
  const Driven found = drive(model, {}, 12.0, 5.0);
  StressFigure out;
  out.figure += found.car.speed < 0.05 && found.state == AutonomyState::kBlind && found.car.x > 5.0 ? 0.0 : 1.0;
  return out;
}

/// A metre beside the middle of a free street at speed v, on the way: its point to steer for lies on a curve that is
/// half a metre beside it halfway, 0.8 v ahead, by the symmetry of any blend: curvature 2 (-1/2) / (16 v^2 / 25 + 1/4),
/// to four roundings of 30 m over the square of what is ahead.
StressFigure halfway(double v_m_s) {
  const auto autonomy = driver("reference_2012");
  Car car;
  car.x = 30.0, car.y = 1.0, car.speed = v_m_s;
  const NavEstimate estimate = car.estimate(kBegin);
  // The vehicle is where it is from the start: route and place are looked for within 5 m of the last.
  DriveCommand command;
  for (double x = 0.0; x <= 30.0; x += 2.0) {
    car.x = x;
    autonomy->drive(car.estimate(kBegin));
  }
  const Pose X_WL{Eigen::Quaterniond::Identity(), {30.0, 1.0, kSensor_m}};
  autonomy->see(Street{}.seen_from({30.0, 1.0}, kBegin), X_WL, estimate);
  command = autonomy->drive(estimate);
  const double ahead = 0.8 * v_m_s;
  stress::Worst worst;
  worst.look(command.curvature_1_m + 1.0 / (ahead * ahead + 0.25), 4.0 * stress::kEpsilon * 30.0 / (ahead * ahead));
  worst.look(autonomy->state() == AutonomyState::kDriving ? 0.0 : stress::kInfinity, 1.0);
  return worst.figure();
}

}  // namespace

std::vector<StressCase> autonomy_cases() {
  StressRows rows;
  const StressMechanism street{StressGroup::kGeometry, "an autonomy on a street with posts, a wall, or nothing in it",
                               "a sideways curve of the other hand, an obstacle beside where it is, a stop too late",
                               "no body touches anything; it comes to the end, or halts and says why", "wrong"};
  for (const char* model : {"reference_2012", "reference"}) {
    const std::string of = std::string("autonomy/") + model + "_";
    rows.of(street)
        .add(of + "on_an_empty_street", [model] { return empty_street(model); })
        .add(of + "among_posts", [model] { return past_posts(model); })
        .add(of + "before_a_wall", [model] { return wall(model); })
        .add(of + "blind", [model] { return blind(model); });
  }
  rows.of({StressGroup::kGeometry, "the way back to the middle of the street", "a curve that is a step, or none",
           "half of the way aside in half of the blend, by its symmetry: roundings", "of the bound"});
  for (const double v_m_s : {4.0, 5.0})
    rows.add("autonomy/back_to_the_middle_at_" + stress::text(v_m_s) + "_m_s", [v_m_s] { return halfway(v_m_s); });
  return rows.take();
}

}  // namespace canyon::mission
