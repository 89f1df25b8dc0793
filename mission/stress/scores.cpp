// How a mission is scored: halts, waypoints, facades in sight and ends of a run, against an account kept apart.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/facade.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/scoring/scorer.h"
#include "canyon/mission/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using stress::Looks;

/// Level ground with one house, whose front, 20 m wide and 12 m high, looks south along y = 30, and a wall before a
/// part of it.
std::shared_ptr<const scene::Scene> yard(double wall_to_x_m) {
  scene::SceneParts parts;
  parts.name = "yard";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-200, -200, 0}, {200, -200, 0}, {200, 200, 0}, {-200, 200, 0}, mesh.material("asphalt"));
  const std::uint32_t object = mesh.begin_object("library", scene::ObjectKind::kBuilding);
  mesh.box({0, 36, 6}, Eigen::Matrix3d::Identity(), {10, 6, 6}, mesh.material("brick"));
  if (wall_to_x_m > -10.0) {
    mesh.begin_object("screen", scene::ObjectKind::kWall);
    mesh.quad({-30, 29, 0}, {wall_to_x_m, 29, 0}, {wall_to_x_m, 29, 40}, {-30, 29, 40}, mesh.material("metal"));
  }
  scene::Building house;
  house.name = "library";
  house.object = object;
  house.footprint_W = {{-10, 30}, {10, 30}, {10, 42}, {-10, 42}};
  house.base_m = 0.0, house.height_m = 12.0;
  parts.buildings.push_back(house);
  return std::make_shared<const scene::Scene>(std::move(parts));
}

struct ScoredStage {
  MissionConfig config;
  PreparedMission mission;

  explicit ScoredStage(double wall_to_x_m = -30.0) {
    mission.scene = yard(wall_to_x_m);
    mission.start = GpsTime::from_week_sow(1590, 1000.0);
    mission.nominal_s = 100.0, mission.time_limit_s = 150.0;
    config.autonomy.waypoints = {{"gate", {-40, 0}, ""}, {"library", {0, 10}, "library"}, {"corner", {40, 0}, ""}};
    config.success.stop_s = 2.0, config.success.waypoint_radius_m = 3.0;
    config.success.collision.name = "lines";
  }
  KinematicState at(double t, const Vector2d& p, double yaw = 0.0) const {
    KinematicState out;
    out.t = mission.start + t;
    out.X_WB = {Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Vector3d::UnitZ())), {p.x(), p.y(), 0.0}};
    return out;
  }
};

/// Past three places at a random pace with halts of all lengths near the second and elsewhere: the nearest approach,
/// the longest halt within the radius, what is reached and what comes of it, step by step by an account of its own; and
/// where the autonomy believed itself to be. Sums of 10 ms steps: their roundings, and one step.
StressFigure halts(std::uint64_t seed) {
  Looks looks;
  const ScoredStage stage;
  const scene::SceneAt scene(*stage.mission.scene);
  const RandomStream draws(seed, "stress.scores");
  Scorer scorer(stage.config, stage.mission, scene);
  const SuccessConfig& rule = stage.config.success;
  std::vector<double> closest(3, 1e300);
  std::vector<bool> within(3, false);
  double halt = 0.0, longest = 0.0, t = 0.0, believed_at = -1.0;
  Vector2d p(-60.0, 1.0);
  bool goes_on = true;
  int next = 0;
  for (std::uint64_t leg = 0; leg < 40 && goes_on; ++leg) {
    const double speed = leg % 3 == 2 ? draws.uniform(0.0, 0.099, 0, leg) : draws.uniform(0.11, 9.0, 1, leg);
    const double seconds = leg % 3 == 2 ? draws.uniform(0.3, 3.0, 2, leg) : draws.uniform(0.5, 2.5, 3, leg);
    // Towards the second place, by and by, then on to the third.
    const Vector2d to = leg < 22 ? Vector2d(0, 10) : Vector2d(40, 0);
    const Vector2d v = speed * (to - p).normalized();
    for (int k = 0; k < static_cast<int>(100.0 * seconds) && goes_on; ++k) {
      t += 0.01;
      p += 0.01 * v;
      goes_on = scorer.step(stage.at(t, p, 0.3), speed, true, false);
      for (std::size_t i = 0; i < 3; ++i) {
        const double away = (p - stage.config.autonomy.waypoints[i].p_m).norm();
        closest[i] = std::min(closest[i], away);
        within[i] = within[i] || away <= rule.waypoint_radius_m;
      }
      const bool stands = (p - Vector2d(0, 10)).norm() <= rule.waypoint_radius_m && speed < rule.stopped_speed_m_s;
      halt = stands ? halt + 0.01 : 0.0;
      longest = worse(longest, halt);
      if (leg == 21 && next == 0) next = 1, believed_at = (p - Vector2d(-40, 0)).norm();
      scorer.follow(stage.at(t, p, 0.3), speed, {.speed_m_s = speed, .curvature_1_m = 0.0}, AutonomyState::kDriving,
                    next);
    }
  }
  looks.right(goes_on);
  const auto& found = scorer.waypoints();
  looks.right(found.size() == 3 && !found[0].mission && found[1].mission && found[1].name == "library");
  for (std::size_t i = 0; i < 3; ++i) looks.near(found[i].closest_m, closest[i], 1e-9);
  looks.near(found[1].stopped_s, longest, 1e-6);
  looks.right(found[0].reached == within[0] && found[2].reached == within[2]);
  if (std::abs(longest - rule.stop_s) > 0.011) looks.right(found[1].reached == (longest > rule.stop_s));
  looks.right(found[0].believed && !found[1].believed && !found[2].believed);
  looks.near(found[0].believed_at_m, believed_at, 1e-9);
  scorer.finish(stage.at(t, p), true);
  const Outcome expected =
      !within[0] || longest < rule.stop_s || !within[2] ? Outcome::kMissedWaypoint : Outcome::kSuccess;
  if (std::abs(longest - rule.stop_s) > 0.011) looks.right(scorer.outcome() == expected);
  return looks.figure();
}

/// A halt before a facade that a wall hides in part: the share of 5 x 5 points beside the wall's rim, as plane geometry
/// sees it from the camera; range and angle to its middle, and pixels. A better halt counts, a worse one does not.
StressFigure facade_in_sight(double wall_to_x_m) {
  Looks looks;
  const ScoredStage stage(wall_to_x_m);
  const scene::SceneAt scene(*stage.mission.scene);
  Scorer scorer(stage.config, stage.mission, scene);
  double best = -1.0, t = 0.0, range = 0.0, obliquity = 0.0;
  for (const Vector2d& p : {Vector2d(1.0, 9.0), Vector2d(-2.0, 11.0), Vector2d(2.5, 10.5), Vector2d(0.0, 7.5)}) {
    for (int k = 0; k < 250; ++k) looks.right(scorer.step(stage.at(t += 0.01, p), 0.0, true, true));
    looks.right(scorer.step(stage.at(t += 0.01, p), 5.0, true, true));
    const Vector3d camera(p.x(), p.y(), stage.config.success.camera_height_m);
    int seen = 0;
    const double behind = (30.0 - 0.05 - 29.0) / (30.0 - 0.05 - p.y());
    for (int i = 0; i < 5; ++i) {
      // Five across the wall of 20 m, evenly; where the way crosses the screen's plane.
      const double x = facade_points(stage.mission.scene->buildings()[0], {0, 10})[static_cast<std::size_t>(i)].x();
      const double at = x + (p.x() - x) * behind;
      seen += at > wall_to_x_m ? 5 : 0;
    }
    const double share = seen / 25.0;
    if (share > best) {
      best = share;
      const auto points = facade_points(stage.mission.scene->buildings()[0], {0, 10});
      const Vector3d sight = camera - 0.5 * (points.front() + points.back());
      range = sight.norm();
      obliquity = std::acos(std::abs(sight.y()) / range) / kDegree;
    }
    const WaypointScore& score = scorer.waypoints()[1];
    looks.near(score.facade_seen_share, best, 1e-12);
    looks.near(score.facade_range_m, range, 1e-9), looks.near(score.facade_obliquity_deg, obliquity, 1e-6);
    looks.near(score.facade_px_per_m, stage.config.success.camera_px_per_rad * std::cos(obliquity * kDegree) / range,
               1e-6);
  }
  looks.right(scorer.waypoints()[1].reached);
  // The other places are passed, and it says that it has finished.
  for (const Vector2d& p : {Vector2d(-39.0, 1.0), Vector2d(41.0, 0.0)})
    scorer.step(stage.at(t += 0.01, p), 5.0, true, true);
  scorer.finish(stage.at(t, {41, 0}), true);
  looks.right(scorer.outcome() ==
              (best >= stage.config.success.facade_share ? Outcome::kSuccess : Outcome::kNoLineOfSight));
  return looks.figure();
}

/// Ends of a run, each by itself, with when and where: standing too long, but not while it observes; a wheel beside the
/// terrain; a house; out of time by the mission's own limit and by the user's; a fault and being lost. The first
/// counts, whatever comes later.
StressFigure ends() {
  Looks looks;
  ScoredStage stage;
  stage.config.success.stuck_after_s = 4.0;
  const scene::SceneAt scene(*stage.mission.scene);
  const auto run = [&](const ScoredStage& of, const auto& act) {
    Scorer scorer(of.config, of.mission, scene);
    act(scorer);
    return std::pair(scorer.outcome(), scorer.failure());
  };
  const auto stands = [&](Scorer& scorer, double from_s, double to_s, bool observing) {
    for (double t = from_s + 0.01; t < to_s + 0.005; t += 0.01)
      if (!scorer.step(stage.at(t, {-60, -50}), 0.05, true, observing)) return t;
    return -1.0;
  };
  double ended = 0.0;
  const auto stuck = run(stage, [&](Scorer& s) { ended = stands(s, 0.0, 10.0, false); });
  looks.right(stuck.first == Outcome::kStuck && ended > 4.0 && ended < 4.03);
  looks.near(stuck.second->t_s, ended, 1e-12),
      looks.near((stuck.second->p_W - Vector3d(-60, -50, 0)).norm(), 0.0, 1e-12);
  const auto excused = run(stage, [&](Scorer& s) {
    looks.right(stands(s, 0.0, 3.0, false) < 0.0 && stands(s, 3.0, 9.0, true) < 0.0);
    ended = stands(s, 9.0, 20.0, false);
  });
  looks.right(excused.first == Outcome::kStuck && ended > 13.0 && ended < 13.03);
  const auto beside = run(stage, [&](Scorer& s) { looks.right(!s.step(stage.at(1.0, {5, 5}), 3.0, false, false)); });
  looks.right(beside.first == Outcome::kLeftScene);
  looks.near(beside.second->t_s, 1.0, 1e-9);
  const auto house = run(stage, [&](Scorer& s) {
    looks.right(s.step(stage.at(1.0, {0, 10}, 1.57), 3.0, true, false));
    looks.right(!s.step(stage.at(2.0, {0, 29}, 1.57), 3.0, true, false));
    s.autonomy_fault(stage.at(3.0, {0, 0}), "late");
  });
  looks.right(house.first == Outcome::kCollision && house.second->detail.find("library") != std::string::npos);
  looks.right(!house.second->seen);
  const auto late = run(stage, [&](Scorer& s) {
    looks.right(s.step(stage.at(149.9, {5, 5}), 3.0, true, false) &&
                !s.step(stage.at(150.0, {5, 5}), 3.0, true, false));
    s.finish(stage.at(150.0, {5, 5}), false);
  });
  looks.right(late.first == Outcome::kTimeout);
  ScoredStage cut = stage;
  cut.config.time.limit_s = 20.0, cut.mission.time_limit_s = 20.0;
  const auto stopped = run(cut, [&](Scorer& s) {
    looks.right(!s.step(stage.at(20.0, {5, 5}), 3.0, true, false));
    s.finish(stage.at(20.0, {5, 5}), false);
  });
  looks.right(stopped.first == Outcome::kStopped);
  const auto fault = run(stage, [&](Scorer& s) {
    s.autonomy_fault(stage.at(7.0, {1, 2}), "threw");
    s.lost(stage.at(8.0, {1, 2}), {4, 6, 50});
  });
  looks.right(fault.first == Outcome::kAutonomyFault && fault.second->detail == "threw");
  const auto lost = run(stage, [&](Scorer& s) { s.lost(stage.at(8.0, {1, 2}), {4, 6, 50}); });
  // 3 and 4 m in the plane: five.
  looks.right(lost.first == Outcome::kLost && lost.second->detail.find("5.0 m") != std::string::npos);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> score_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "halts and waypoints of a drive of any pace",
           "a halt that goes on over a move, a radius for a diameter",
           "an account kept step by step: roundings of sums, and one step", "of the bound"});
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U})
    rows.add("scores/halts_" + std::to_string(seed), [seed] { return halts(seed); });
  rows.of({StressGroup::kGeometry, "a facade that a wall hides in part",
           "a worse halt for a better, an angle to the wall for one to its normal",
           "its points beside the wall's rim, by plane geometry", "of the bound"});
  for (const double to_m : {-30.0, -5.0, 2.0, 9.0})
    rows.add("scores/facade_beside_a_wall_to_" + stress::text(to_m) + "_m", [to_m] { return facade_in_sight(to_m); });
  rows.of({StressGroup::kData, "every end of a run", "a later end for the first, a limit of the other kind",
           "each with when, where and how", "of the bound"});
  rows.add("scores/ends", ends);
  return rows.take();
}

}  // namespace canyon::mission
