#include "canyon/mission/scoring/scorer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "canyon/core/units.h"
#include "canyon/mission/autonomy/facade.h"
#include "canyon/mission/scoring/told_failure.h"

namespace canyon::mission {

namespace {

std::string number(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.1f %s", value, unit);
  return text;
}

}  // namespace

Scorer::Scorer(const MissionConfig& config, const PreparedMission& mission, const scene::SceneAt& scene)
    : config_(config.success),
      places_(config.autonomy.waypoints),
      scene_(scene),
      start_(mission.start),
      time_limit_s_(mission.time_limit_s),
      stopped_on_purpose_(config.time.limit_s > 0.0 &&
                          config.time.limit_s < config.success.limit_factor * mission.nominal_s),
      collision_(
          model_row(collision_checks(), config_.collision.name).make(config_.collision.own, config.vehicle, scene)),
      encounters_(config_, config.vehicle, scene),
      departures_(config.vehicle, mission.prior.route, scene),
      last_t_(mission.start) {
  for (const Waypoint& place : places_) {
    waypoints_.push_back({.name = place.name, .mission = place.is_mission()});
    facades_.emplace_back();
    for (const auto& building : scene.scene().buildings())
      if (building.name == place.observe) facades_.back() = facade_points(building, place.p_m);
  }
  halt_s_.assign(places_.size(), 0.0);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    visited_before_.push_back(visited_before(i));
    awaited_.push_back(visited_before_.back() ? 0 : 1);
  }
}

std::optional<std::size_t> Scorer::visited_before(std::size_t i) const {
  bool been_elsewhere = false;
  for (std::size_t j = i; j-- > 0;) {
    const bool same = (places_[i].p_m - places_[j].p_m).norm() < config_.waypoint_radius_m;
    if (same) return been_elsewhere ? std::optional(j) : visited_before_[j];
    been_elsewhere = true;
  }
  return std::nullopt;
}

void Scorer::fail(Outcome kind, const KinematicState& truth, std::string detail) {
  if (failure_) return;
  failure_ = Failure{kind, truth.t - start_, truth.X_WB.p, std::move(detail)};
  // What fails in its first step has been nowhere but here.
  for (std::size_t i = 0; i < waypoints_.size(); ++i)
    waypoints_[i].closest_m = std::min(waypoints_[i].closest_m, (truth.X_WB.p.head<2>() - places_[i].p_m).norm());
}

void Scorer::observe(const Eigen::Vector3d& camera_W, const std::vector<Eigen::Vector3d>& facade_W,
                     WaypointScore& score) const {
  const double share = visible_share(scene_, camera_W, facade_W);
  const bool first = std::isnan(score.facade_range_m);
  if (!first && share <= score.facade_seen_share) return;
  score.facade_seen_share = std::max(score.facade_seen_share, share);
  const Eigen::Vector3d middle = 0.5 * (facade_W.front() + facade_W.back()), sight = camera_W - middle;
  const Eigen::Vector3d along = facade_W[1] - facade_W[0];  // of the grid's lowest row, level
  const Eigen::Vector3d normal = along.cross(Eigen::Vector3d::UnitZ()).normalized();
  const double cosine = std::min(1.0, std::abs(normal.dot(sight)) / sight.norm());
  score.facade_range_m = sight.norm();
  score.facade_obliquity_deg = std::acos(cosine) / kDegree;
  score.facade_px_per_m = config_.camera_px_per_rad * cosine / sight.norm();
}

void Scorer::follow(const KinematicState& truth, double speed_m_s, const DriveCommand& command, AutonomyState state,
                    int next_waypoint) {
  const bool has_seen = first_scan_ && truth.t - *first_scan_ > kFirstPlan_s;
  encounters_.look(truth, speed_m_s, command, has_seen ? state : AutonomyState::kBlind);
  for (std::size_t i = 0; i < waypoints_.size() && static_cast<int>(i) < next_waypoint; ++i) {
    if (waypoints_[i].believed) continue;
    waypoints_[i].believed = true;
    waypoints_[i].believed_at_m = (truth.X_WB.p.head<2>() - places_[i].p_m).norm();
  }
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
    if (awaited_[i] == 0) {
      if (within || !waypoints_[*visited_before_[i]].reached) continue;
      awaited_[i] = 1;
      score.closest_m = distance;  // what comes now is this waypoint's
    }
    if (!score.mission) {
      score.reached = score.reached || within;
      continue;
    }
    if (!within || !standing) {
      halt_s_[i] = 0.0;
      continue;
    }
    if (halt_s_[i] == 0.0 && !facades_[i].empty()) {
      observe(truth.X_WB * Eigen::Vector3d(0, 0, config_.camera_height_m), facades_[i], score);
    }
    halt_s_[i] += dt;
    score.stopped_s = std::max(score.stopped_s, halt_s_[i]);
    if (score.stopped_s >= config_.stop_s) score.reached = true;
  }

  if (!on_terrain) {
    fail(Outcome::kLeftScene, truth, "a wheel left the terrain");
    return false;
  }
  if (const auto object = collision_->touched(truth)) {
    fail(Outcome::kCollision, truth, "hit " + name_with_kind(scene_, *object));
    failure_->seen = sightings_.of(*object, truth.t);
    encounters_.touched(*object, truth.t);
    return false;
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
    if (awaited_[i] == 0) {
      fail(Outcome::kMissedWaypoint, truth, who + ": did not leave the waypoint before it in the same place");
    } else if (!score.reached) {
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
