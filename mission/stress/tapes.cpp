// Tapes of a true path: laid into a mission, made of a file of poses, driven along a route.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/route_tape.h"
#include "canyon/mission/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using stress::Looks;

/// Ground of 400 x 300 m that rises by 0.02 to the east, and a house, if there is one, on y = 0.
PreparedMission on_a_slope(bool house) {
  scene::SceneParts parts;
  parts.name = "slope";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-200, -150, -4}, {200, -150, 4}, {200, 150, 4}, {-200, 150, -4}, mesh.material("asphalt"));
  if (house) {
    mesh.begin_object("house", scene::ObjectKind::kBuilding);
    mesh.box({70, 0, 4}, Eigen::Matrix3d::Identity(), {4, 4, 6}, mesh.material("brick"));
  }
  PreparedMission out;
  out.scene = std::make_shared<const scene::Scene>(std::move(parts));
  out.start = GpsTime::from_week_sow(1590, 1000.0);
  out.nominal_s = 60.0, out.time_limit_s = 120.0;
  return out;
}

/// A path of a hundredth of a second a node, that wherever it is bends aside by `jump_m` once, over one node.
Tape made_tape(const PreparedMission& mission, double seconds, double jump_m, double above_m) {
  Tape tape{.source = "made", .scene_hash = mission.scene->hash(), .traffic = {}, .nodes = {}};
  const int steps = static_cast<int>(std::lround(seconds / 0.01));
  for (int k = 0; k <= steps; ++k) {
    TapeNode node;
    node.motion.t = GpsTime{std::int64_t{10'000'000} * k};
    const double x = -20.0 + 0.05 * k;
    node.motion.X_WB.p = {x, k > steps / 2 ? jump_m : 0.0, 0.02 * x + above_m};
    tape.nodes.push_back(node);
  }
  return tape;
}

/// Each thing that a tape may be refused for, just so and just not so: another scene or its traffic, a tenth of a
/// second that bends by more than 50 m/s^2 let a vehicle, a place beside the terrain, a metre under it, and a second
/// too short. A figure counts.
StressFigure laid_in() {
  StressFigure out;
  const PreparedMission mission = on_a_slope(false);
  MissionConfig config;
  const auto is = [&](const Tape& tape, const MissionConfig& of, const char* why) {
    const Status found = check_tape(tape, "a.tape", of, mission);
    const bool as_said = why == nullptr ? found.ok()
                                        : !found.ok() && found.error().file == "a.tape" &&
                                              found.error().what.find(why) != std::string::npos;
    out.figure += as_said ? 0.0 : 1.0;
  };
  is(made_tape(mission, 10.0, 0.0, 0.0), config, nullptr);
  Tape other = made_tape(mission, 10.0, 0.0, 0.0), of_none = other, busy = other;
  other.scene_hash = "another";
  is(other, config, "in another scene");
  of_none.scene_hash.clear(), of_none.traffic = "anything";
  is(of_none, config, nullptr);
  busy.traffic = "[]";
  is(busy, config, "in other traffic");
  config.time.limit_s = 10.0;
  is(made_tape(mission, 10.0, 0.0, 0.0), config, nullptr),
      is(made_tape(mission, 9.99, 0.0, 0.0), config, "9.99 s long");
  config.time.limit_s = 0.0;
  is(made_tape(mission, 10.0, 0.49, 0.0), config, nullptr),
      is(made_tape(mission, 10.0, 0.51, 0.0), config, "jumps by 0.51 m");
  is(made_tape(mission, 10.0, -0.6, 0.0), config, "jumps by 0.6 m");
  is(made_tape(mission, 10.0, 0.0, -0.99), config, nullptr),
      is(made_tape(mission, 10.0, 0.0, -1.1), config, "1.1 m under");
  is(made_tape(mission, 10.0, 0.0, 300.0), config, nullptr);
  // It comes to x = 200 after 44 s.
  is(made_tape(mission, 43.9, 0.0, 0.0), config, nullptr);
  is(made_tape(mission, 44.2, 0.0, 0.0), config, "leaves the scene at 44.0 s, x 200.1 m, y 0.0 m");
  // A bend of 40 m/s^2 is none of a jump's.
  Tape circle = of_none;
  for (TapeNode& node : circle.nodes) {
    const double a = 2.0 * (node.motion.t - GpsTime{0});
    node.motion.X_WB.p = {10.0 * std::cos(a), 10.0 * std::sin(a), 5.0};
  }
  is(circle, config, nullptr);
  for (TapeNode& node : circle.nodes) node.motion.X_WB.p.head<2>() *= 1.3;
  is(circle, config, "jumps by");
  return out;
}

/// A file of poses on a straight way, evenly driven, forwards or backwards: a node each hundredth of a second, on the
/// way, with its velocity, the speed along its own axis and the way driven so far. Of nine digits behind the point.
StressFigure of_a_file(double speed_m_s, bool backwards) {
  Looks looks;
  const auto path = std::filesystem::temp_directory_path() / ("canyon-poses-" + std::to_string(::getpid()) + ".tum");
  const double heading = 0.6, t0 = 1000.0;
  const Vector3d begin(30.0, -20.0, 5.0), way(std::cos(heading), std::sin(heading), 0.05);
  const Eigen::Quaterniond R(Eigen::AngleAxisd(heading + (backwards ? kPi : 0.0), Vector3d::UnitZ()));
  {
    std::ofstream file(path);
    for (int k = 0; k <= 63; ++k) {
      const Vector3d p = begin + 0.1 * k * speed_m_s * way;
      char line[256];
      std::snprintf(line, sizeof line, "%.9f %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n", t0 + 0.1 * k, p.x(), p.y(),
                    p.z(), R.x(), R.y(), R.z(), R.w());
      file << line;
    }
  }
  const LocalFrame frame({50.0 * kDegree, 7.0 * kDegree, 100.0});
  const auto tape = tape_from_trajectory(path.string(), 0.0, frame);
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  looks.right(tape.ok());
  if (!tape) return looks.figure();
  looks.right(tape->nodes.size() == 631 && tape->scene_hash.empty() && tape->traffic.empty());
  looks.near(tape->duration_s(), 6.3, 1e-9);
  for (std::size_t k = 0; k < tape->nodes.size(); ++k) {
    const TapeNode& node = tape->nodes[k];
    const double t = 0.01 * static_cast<double>(k);
    looks.right(node.motion.t.ns == static_cast<std::int64_t>(k) * 10'000'000);
    // The spline's slopes are of differences over tenths of a second: ten times the last digit, a hundred times for
    // what bends.
    looks.near((node.motion.X_WB.p - begin - t * speed_m_s * way).norm(), 0.0, 1e-8);
    looks.near((node.motion.v_WB_W - speed_m_s * way).norm(), 0.0, 1e-6);
    looks.near(node.motion.a_WB_W.norm(), 0.0, 1e-4);
    looks.near(node.speed_m_s, (backwards ? -1.0 : 1.0) * speed_m_s * way.head<2>().norm(), 1e-6);
    looks.near(node.distance_m, t * speed_m_s * way.head<2>().norm(), 1e-6);
    looks.near(node.motion.X_WB.R.angularDistance(R), 0.0, 1e-7);
  }
  return looks.figure();
}

/// The route of a mission driven on truth: from rest at its start to a stand at its last place, a node a step, each no
/// faster than the vehicle may, on the terrain, with its own way driven; with a house on it, it says so.
StressFigure along_the_route(bool house) {
  Looks looks;
  PreparedMission mission = on_a_slope(house);
  MissionConfig config;
  config.autonomy.waypoints = {{"half", {30, 0}, ""}, {"end", {100, 0}, ""}};
  config.vehicle.start_m = {-20, 0}, config.vehicle.start_heading_deg = 90.0, config.vehicle.roughness = "none";
  mission.prior.route = Path({{-20, 0}, {100, 0}}, 6.5);
  mission.prior.waypoint_s_m = {50.0, 120.0};
  const auto tape = drive_route(config, mission);
  if (house) {
    looks.right(!tape.ok() && tape.error().exit_code == 1 &&
                tape.error().what.find("cannot be driven on truth") != std::string::npos &&
                tape.error().what.find("house") != std::string::npos);
    return looks.figure();
  }
  looks.right(tape.ok());
  if (!tape) return looks.figure();
  looks.right(tape->scene_hash == mission.scene->hash() && tape->traffic == traffic_text(config) &&
              tape->traffic.empty());
  looks.right(tape->nodes.front().motion.t.ns == 0);
  looks.near((tape->nodes.front().motion.X_WB.p.head<2>() - Vector2d(-20, 0)).norm(), 0.0, 1e-9);
  looks.near(tape->nodes.front().speed_m_s, 0.0, 1e-9);
  const TapeNode& last = tape->nodes.back();
  looks.near((last.motion.X_WB.p.head<2>() - Vector2d(100, 0)).norm(), 0.0, 1.0);
  looks.right(std::abs(last.speed_m_s) < 0.1);
  double driven = 0.0, fastest = 0.0;
  for (std::size_t k = 1; k < tape->nodes.size(); ++k) {
    const TapeNode &a = tape->nodes[k - 1], &b = tape->nodes[k];
    looks.right(b.motion.t.ns - a.motion.t.ns == 10'000'000);
    driven += (b.motion.X_WB.p - a.motion.X_WB.p).norm();
    fastest = worse(fastest, b.speed_m_s);
    looks.right(std::abs(b.speed_m_s - a.speed_m_s) <= 0.01 * config.vehicle.max_deceleration_m_s2 * (1.0 + 1e-9));
    const Vector3d& p = b.motion.X_WB.p;
    looks.near(p.z(), 0.02 * p.x(), 0.05);
    looks.near(p.y(), 0.0, 0.05);
  }
  // A slope of 0.02 lengthens by 2e-4 of the way; roundings of 12,000 steps.
  looks.near(last.distance_m, driven, 3e-4 * 120.0);
  looks.near(last.distance_m, 120.0, 1.0);
  looks.near(fastest, config.autonomy.cruise_m_s, 0.05);
  looks.right(check_tape(*tape, "", config, mission).ok());
  return looks.figure();
}

}  // namespace

std::vector<StressCase> tape_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "a tape laid into a mission", "a limit on the other side, a bend over the wrong stretch",
           "each reason just so and just not so", "wrong"});
  rows.add("tapes/laid_in", laid_in);
  rows.of({StressGroup::kData, "a tape made of poses, or of a route",
           "a step of another length, a way of all three axes, a speed without its sign",
           "a straight way as it is written: its last digits over the spline's steps; the route's own measures",
           "of the bound"});
  for (const double speed : {0.5, 20.0})
    for (const bool backwards : {false, true})
      rows.add("tapes/of_a_file_at_" + stress::text(speed) + (backwards ? "_m_s_backwards" : "_m_s"),
               [=] { return of_a_file(speed, backwards); });
  rows.add("tapes/along_a_route", [] { return along_the_route(false); })
      .add("tapes/along_a_route_with_a_house_on_it", [] { return along_the_route(true); });
  return rows.take();
}

}  // namespace canyon::mission
