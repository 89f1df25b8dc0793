#include "canyon/mission/route_tape.h"

#include <cmath>
#include <cstdio>

#include "canyon/core/config/text.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/mission/autonomy/route_driver.h"
#include "canyon/mission/motion/motion_source.h"
#include "canyon/mission/scoring/scorer.h"

namespace canyon::mission {

namespace {

std::string place(double t_s, const Eigen::Vector3d& p) {
  char text[96];
  std::snprintf(text, sizeof text, "at %.1f s, x %.1f m, y %.1f m", t_s, p.x(), p.y());
  return text;
}

/// A ground vehicle's path bends by less: beyond 50 m/s^2 over a tenth of a second it has jumped.
constexpr double kSpan_s = 0.1, kMostBend_m = 50.0 * kSpan_s * kSpan_s;

Status check_smooth(const Tape& tape, const std::string& path) {
  const auto& nodes = tape.nodes;
  const double step_s = tape.duration_s() / static_cast<double>(nodes.size() - 1);
  const auto stride = static_cast<std::size_t>(std::max(1.0, std::round(kSpan_s / step_s)));
  for (std::size_t i = stride; i + stride < nodes.size(); ++i) {
    const auto p = [&](std::size_t k) -> const Eigen::Vector3d& { return nodes[k].motion.X_WB.p; };
    const double bend_m = (p(i + stride) - 2.0 * p(i) + p(i - stride)).norm();
    if (bend_m > kMostBend_m)
      return Error{.file = path,
                   .what = "jumps by " + number_text(std::round(100.0 * bend_m) / 100.0) + " m " +
                           place(nodes[i].motion.t - nodes.front().motion.t, p(i)),
                   .expected = "the path of a ground vehicle"};
  }
  return Ok{};
}

Status check_on_terrain(const Tape& tape, const std::string& path, const scene::Scene& scene) {
  constexpr double kMostUnder_m = 1.0;  // a recorded body frame need not lie on the ground, but not in it either
  for (const TapeNode& node : tape.nodes) {
    const Eigen::Vector3d& p = node.motion.X_WB.p;
    const double t_s = node.motion.t - tape.nodes.front().motion.t;
    const auto ground = scene.ground(p.x(), p.y());
    if (!ground)
      return Error{.file = path,
                   .what = "leaves the scene " + place(t_s, p),
                   .expected = "x from " + number_text(scene.extent().min.x()) + " to " +
                               number_text(scene.extent().max.x()) + ", y from " + number_text(scene.extent().min.y()) +
                               " to " + number_text(scene.extent().max.y())};
    if (p.z() < ground->height_m - kMostUnder_m)
      return Error{.file = path,
                   .what = "lies " + number_text(std::round(10.0 * (ground->height_m - p.z())) / 10.0) +
                           " m under the ground " + place(t_s, p),
                   .expected = "heights of the scene's W, where the ground lies at " +
                               number_text(std::round(10.0 * ground->height_m) / 10.0) + " m there"};
  }
  return Ok{};
}

/// The kinematics of B in another frame that is fixed to the Earth.
KinematicState moved(const KinematicState& state, const Pose& X) {
  KinematicState out = state;
  out.X_WB = X * state.X_WB;
  out.v_WB_W = X.R * state.v_WB_W;
  out.a_WB_W = X.R * state.a_WB_W;
  return out;
}

}  // namespace

std::string traffic_text(const MissionConfig& config) {
  MissionConfig copy = config;
  if (copy.scene.moving.empty()) return {};
  return fields_as_json([&copy](FieldVisitor& f) { f.list("moving", copy.scene.moving, ""); });
}

Result<Tape> drive_route(const MissionConfig& config, const PreparedMission& mission) {
  const scene::SceneAt scene(*mission.scene);
  const auto source =
      make_driven_motion(config.vehicle, *mission.scene, static_cast<std::uint64_t>(config.run.seed), mission.start);
  const auto follower = make_route_follower(config.autonomy, mission.prior, mission.start);
  Scorer scorer(config, mission, scene);
  Tape tape{.source = "the route, driven on truth",
            .scene_hash = mission.scene->hash(),
            .traffic = traffic_text(config),
            .nodes = {source->now()}};
  for (bool go_on = true; go_on && follower->state() != AutonomyState::kDone;) {
    throw_if_cancelled();
    const KinematicState& truth = source->now().motion;
    const TapeNode& node = source->advance(follower->drive({.t = truth.t, .X_WB = truth.X_WB, .v_WB_W = truth.v_WB_W}));
    tape.nodes.push_back(node);
    const bool on_purpose = follower->state() != AutonomyState::kDriving;
    go_on = scorer.step(node.motion, node.speed_m_s, source->on_terrain(), on_purpose);
  }
  scorer.finish(source->now().motion, follower->state() == AutonomyState::kDone);
  // A tape that [time] limit_s cuts is as long as was asked for.
  if (const auto& failure = scorer.failure(); failure && failure->kind != Outcome::kStopped)
    return Error{.what = "the route cannot be driven on truth: " + std::string(name(failure->kind)) + " " +
                         place(failure->t_s, failure->p_W) + " (" + failure->detail + ")",
                 .expected = "a route that is free, or --tape or --trajectory",
                 .exit_code = 1};
  for (TapeNode& node : tape.nodes) node.motion.t.ns -= mission.start.ns;
  return tape;
}

Status check_tape(const Tape& tape, const std::string& path, const MissionConfig& config,
                  const PreparedMission& mission) {
  if (!tape.scene_hash.empty() && tape.scene_hash != mission.scene->hash())
    return Error{.file = path,
                 .what = "was recorded in another scene",
                 .expected = "a tape of this mission's scene (" + mission.scene->hash().substr(0, 12) + "…, not " +
                             tape.scene_hash.substr(0, 12) + "…)"};
  if (!tape.scene_hash.empty() && tape.traffic != traffic_text(config))
    return Error{.file = path,
                 .what = "was recorded in other traffic",
                 .expected = "the same [[scene.moving]] as the mission's"};
  if (config.time.limit_s > tape.duration_s())
    return Error{.file = path,
                 .what = "is " + number_text(tape.duration_s()) + " s long",
                 .expected = "at least the " + number_text(config.time.limit_s) + " s of time.limit_s"};
  CANYON_TRY_STATUS(check_smooth(tape, path));
  return check_on_terrain(tape, path, *mission.scene);
}

Result<Tape> tape_from_trajectory(const std::string& path, double rate_hz, const LocalFrame& frame) {
  const Geodetic& origin = frame.origin();
  inertial::MotionConfig config;
  config.path = "recorded";
  config.lat_deg = origin.lat_rad / kDegree;
  config.lon_deg = origin.lon_rad / kDegree;
  config.height_m = origin.h_m;
  config.file = path;
  config.file_rate_hz = rate_hz;
  CANYON_TRY(const inertial::PlacedMotion placed, inertial::make_motion(config, 0));
  // A reference solution in geodetic coordinates has a frame of its own; poses in metres are the scene's already.
  const bool own_frame = (placed.frame.origin_E() - frame.origin_E()).norm() > 1e-3;
  const Pose X = own_frame ? frame.X_EW().inverse() * placed.frame.X_EW() : Pose{};
  Tape tape{.source = path, .scene_hash = {}, .traffic = {}, .nodes = {}};
  const auto steps = static_cast<std::int64_t>(placed.motion->duration_s() * 1e9) / Vehicle::kStep_ns;
  for (std::int64_t k = 0; k <= steps; ++k) {
    TapeNode node;
    node.motion = moved(placed.motion->at(1e-9 * static_cast<double>(k * Vehicle::kStep_ns)), X);
    node.motion.t = GpsTime{k * Vehicle::kStep_ns};
    node.speed_m_s = node.motion.v_WB_W.dot(node.motion.X_WB.R * Eigen::Vector3d::UnitX());
    if (k > 0) {
      const TapeNode& before = tape.nodes.back();
      node.distance_m = before.distance_m + (node.motion.X_WB.p - before.motion.X_WB.p).head<2>().norm();
    }
    tape.nodes.push_back(node);
  }
  if (tape.nodes.size() < 2)
    return Error{.file = path,
                 .what = "covers " + number_text(placed.motion->duration_s()) + " s",
                 .expected = "a longer drive"};
  return tape;
}

}  // namespace canyon::mission
