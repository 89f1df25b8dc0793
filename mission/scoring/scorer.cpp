#include "canyon/mission/scoring/scorer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "canyon/mission/autonomy/facade.h"

namespace canyon::mission {

namespace {

constexpr double kCollisionStep = 0.1;  // m of travel between collision checks

std::string number(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.1f %s", value, unit);
  return text;
}

}  // namespace

Scorer::Scorer(const MissionConfig& config, const PreparedMission& mission, const scene::SceneAt& scene)
    : config_(config.success),
      vehicle_(config.vehicle),
      places_(config.autonomy.waypoints),
      scene_(scene),
      start_(mission.start),
      time_limit_s_(mission.time_limit_s),
      stopped_on_purpose_(config.time.limit_s > 0.0 &&
                          config.time.limit_s < config.success.limit_factor * mission.nominal_s),
      last_checked_(Eigen::Vector2d::Constant(1e9)),
      last_t_(mission.start) {
  for (const Waypoint& place : places_) {
    waypoints_.push_back({.name = place.name, .mission = place.is_mission()});
    facades_.emplace_back();
    for (const auto& building : scene.scene().buildings())
      if (building.name == place.observe) facades_.back() = facade_points(building, place.p_m);
  }
  halt_s_.assign(places_.size(), 0.0);
}

void Scorer::fail(Outcome kind, const KinematicState& truth, std::string detail) {
  if (failure_) return;
  failure_ = Failure{kind, truth.t - start_, truth.X_WB.p, std::move(detail)};
}

std::string Scorer::collides(const KinematicState& truth) const {
  // Segments through the body at two heights: outline, and lines along it at most 0.4 m apart, so that no pole fits
  // between.
  const double rear = -0.5 * (vehicle_.length_m - vehicle_.wheelbase_m), front = rear + vehicle_.length_m;
  const double half = 0.5 * vehicle_.width_m;
  const int lines = std::max(2, static_cast<int>(std::ceil(vehicle_.width_m / 0.4)) + 1);
  for (const double z : {0.35 * vehicle_.height_m, 0.8 * vehicle_.height_m}) {
    const auto touched = [&](double x0, double y0, double x1, double y1) -> std::string {
      const Eigen::Vector3d a = truth.X_WB * Eigen::Vector3d(x0, y0, z), b = truth.X_WB * Eigen::Vector3d(x1, y1, z);
      const Eigen::Vector3d d = b - a;
      const scene::Hit hit = scene_.trace({a, d.normalized().cast<float>(), static_cast<float>(d.norm())});
      if (!hit.hit()) return {};
      return scene_.object(scene_.surface(hit.triangle).object).name;
    };
    for (int i = 0; i < lines; ++i) {
      const double y = -half + 2.0 * half * i / (lines - 1);
      if (auto name = touched(rear, y, front, y); !name.empty()) return name;
    }
    for (const double x : {rear, front})
      if (auto name = touched(x, -half, x, half); !name.empty()) return name;
  }
  return {};
}

bool Scorer::step(const KinematicState& truth, double speed_m_s, bool on_terrain, bool observing) {
  const double dt = truth.t - last_t_, t_s = truth.t - start_;
  last_t_ = truth.t;
  const Eigen::Vector2d p = truth.X_WB.p.head<2>();
  const bool standing = std::abs(speed_m_s) < config_.stopped_speed_m_s;

  for (std::size_t i = 0; i < waypoints_.size(); ++i) {
    WaypointScore& score = waypoints_[i];
    const double distance = (p - places_[i].p_m).norm();
    score.closest_m = std::min(score.closest_m, distance);
    const bool within = distance <= config_.waypoint_radius_m;
    if (!score.mission) {
      score.reached = score.reached || within;
      continue;
    }
    if (!within || !standing) {
      halt_s_[i] = 0.0;
      continue;
    }
    if (halt_s_[i] == 0.0 && !facades_[i].empty()) {
      const Eigen::Vector3d camera = truth.X_WB * Eigen::Vector3d(0, 0, config_.camera_height_m);
      score.facade_seen_share = std::max(score.facade_seen_share, visible_share(scene_, camera, facades_[i]));
    }
    halt_s_[i] += dt;
    score.stopped_s = std::max(score.stopped_s, halt_s_[i]);
    if (score.stopped_s >= config_.stop_s) score.reached = true;
  }

  if (!on_terrain) {
    fail(Outcome::kLeftScene, truth, "a wheel left the terrain");
    return false;
  }
  if ((p - last_checked_).norm() >= kCollisionStep) {
    last_checked_ = p;
    if (const std::string object = collides(truth); !object.empty()) {
      fail(Outcome::kCollision, truth, "hit " + object);
      return false;
    }
  }
  standing_s_ = standing && !observing ? standing_s_ + dt : 0.0;
  if (standing_s_ > config_.stuck_after_s) {
    fail(Outcome::kStuck, truth, "stood still for " + number(standing_s_, "s"));
    return false;
  }
  return t_s < time_limit_s_;  // finish() says what that means
}

void Scorer::autonomy_fault(const KinematicState& truth, std::string how) {
  fail(Outcome::kAutonomyFault, truth, std::move(how));
}

void Scorer::lost(const KinematicState& truth, const Eigen::Vector3d& believed_W) {
  const double off_m = (believed_W - truth.X_WB.p).head<2>().norm();
  fail(Outcome::kLost, truth, "it said so, and was " + number(off_m, "m") + " from where it took itself to be");
}

void Scorer::finish(const KinematicState& truth, bool done) {
  if (failure_) return;
  if (!done) {
    const std::string after = number(truth.t - start_, "s");
    if (stopped_on_purpose_) {
      fail(Outcome::kStopped, truth, "by [time] limit_s after " + after);
    } else {
      fail(Outcome::kTimeout, truth, "not finished within " + after);
    }
    return;
  }
  for (std::size_t i = 0; i < waypoints_.size(); ++i) {
    const WaypointScore& score = waypoints_[i];
    const std::string who = score.name.empty() ? "waypoint " + std::to_string(i + 1) : score.name;
    if (!score.reached) {
      fail(Outcome::kMissedWaypoint, truth,
           who + ": came within " + number(score.closest_m, "m") +
               (score.mission ? ", stood there for " + number(score.stopped_s, "s") : ""));
    } else if (score.mission && !facades_[i].empty() && score.facade_seen_share < config_.facade_share) {
      fail(Outcome::kNoLineOfSight, truth,
           who + ": " + number(100.0 * score.facade_seen_share, "% of the facade in sight"));
    }
  }
}

}  // namespace canyon::mission
