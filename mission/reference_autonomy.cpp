#include "mission/reference_autonomy.h"

#include <algorithm>
#include <cmath>

#include "mission/local_grid.h"

namespace canyon::mission {

namespace {

constexpr double kSample = 0.5;         // m, between its checked points
constexpr double kOffsetStep = 0.5;     // m, between candidates
constexpr double kStopTolerance = 0.4;  // m, along the route
constexpr double kPassTolerance = 1.0;  // m, along the route
constexpr double kTurnAround = 1.0;     // 1/m; full lock when the path lies behind
constexpr int kEnoughReturns = 100;     // fewer count as blind

/// The path from arc length s0 on, moving sideways from offset d0 to d1 over `blend` metres.
struct Candidate {
  double s0 = 0, d0 = 0, d1 = 0, blend = 6;

  Eigen::Vector2d at(const Path& route, double s) const {
    const double x = std::clamp((s - s0) / blend, 0.0, 1.0);
    const double d = d0 + (d1 - d0) * x * x * (3.0 - 2.0 * x);
    const Eigen::Vector2d u = route.direction(s);
    return route.at(s) + d * Eigen::Vector2d(-u.y(), u.x());
  }
};

class ReferenceAutonomy final : public Autonomy {
 public:
  ReferenceAutonomy(const AutonomyConfig& config, const PriorKnowledge& prior, GpsTime start)
      : config_(config), prior_(prior), start_(start), grid_(config.grid), last_seen_(start) {}

  void see(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate) override {
    if (static_cast<int>(scan.points.size()) < kEnoughReturns) return;
    last_seen_ = scan.t;
    points_.clear();
    for (const LidarPoint& point : scan.points) points_.emplace_back(point.x, point.y, point.z);
    grid_.add(points_, X_WL, estimate.X_WB, scan.t - start_);
    grid_.update_distances();
    plan(estimate);
  }

  DriveCommand drive(const NavEstimate& estimate) override {
    const Eigen::Vector2d p = estimate.X_WB.p.head<2>();
    s_ = prior_.route.project(p, std::max(0.0, s_ - 2.0), s_ + 5.0);
    const double speed = estimate.v_WB_W.head<2>().norm();

    DriveCommand command;
    command.curvature_1_m = pursue(estimate, speed);
    if (update_waypoints(estimate.t, speed)) return command;  // done or observing: stand still
    if (estimate.t - last_seen_ > config_.blind_after_s) {
      state_ = AutonomyState::kBlind;
      return command;
    }
    command.speed_m_s = allowed_speed();
    state_ = command.speed_m_s > 0.0 ? AutonomyState::kDriving : AutonomyState::kBlocked;
    return command;
  }

  AutonomyState state() const override { return state_; }
  int next_waypoint() const override { return next_; }

 private:
  /// Passes and reaches waypoints; true while the vehicle has to stand.
  bool update_waypoints(GpsTime t, double speed) {
    const auto count = static_cast<int>(config_.waypoints.size());
    while (next_ < count) {
      const auto i = static_cast<std::size_t>(next_);
      const double ahead = prior_.waypoint_s_m[i] - s_;
      const bool last = next_ + 1 == count;
      if (!config_.waypoints[i].is_mission() && !last) {
        if (ahead > kPassTolerance) return false;
      } else {
        // Once it stands and looks it stays, also when a fix moves the estimate back before the stop.
        if (ahead > kStopTolerance && !holding_) return false;
        const double hold = config_.waypoints[i].is_mission() ? config_.hold_s : 0.0;
        state_ = AutonomyState::kObserving;
        if (speed > 0.1 && !holding_) return true;
        if (!holding_) {
          holding_ = true;
          hold_since_ = t;
        }
        if (t - hold_since_ < hold) return true;
        holding_ = false;
      }
      ++next_;
    }
    state_ = AutonomyState::kDone;
    return true;
  }

  void plan(const NavEstimate& estimate) {
    const Eigen::Vector2d p = estimate.X_WB.p.head<2>();
    const double here = prior_.route.offset(p, s_);
    const double speed = estimate.v_WB_W.head<2>().norm();
    const int steps = static_cast<int>(std::floor(config_.max_offset_m / kOffsetStep));
    const PathChoiceConfig& choice = config_.choice;
    double best_cost = 1e300;
    Candidate best = chosen_;
    for (int k = -steps; k <= steps; ++k) {
      const Candidate candidate{s_, here, k * kOffsetStep, std::max(5.0, 1.6 * speed)};
      double free_m = choice.horizon_m, closeness = 0.0;
      for (double x = 0.0; x <= choice.horizon_m; x += kSample) {
        const double distance = grid_.distance_m(candidate.at(prior_.route, s_ + x));
        if (distance < config_.clearance_m) {
          free_m = x;
          break;
        }
        closeness += kSample * std::max(0.0, choice.comfort_clearance_m - distance);
      }
      const double cost = choice.blocked_cost_1_m * (choice.horizon_m - free_m) +
                          choice.closeness_cost_1_m2 * closeness + choice.offset_cost_1_m * std::abs(candidate.d1) +
                          choice.change_cost_1_m * std::abs(candidate.d1 - chosen_.d1);
      if (cost < best_cost) {
        best_cost = cost;
        best = candidate;
        free_m_ = free_m;
        free_from_s_ = s_;
      }
    }
    chosen_ = best;
  }

  double pursue(const NavEstimate& estimate, double speed) const {
    const double lookahead = std::clamp(0.8 * speed, 2.5, 5.0);
    const double s_target = std::min(s_ + lookahead, prior_.route.length_m());
    const Eigen::Vector2d target = chosen_.at(prior_.route, s_target);
    const double yaw = yaw_pitch_roll(estimate.X_WB.R).yaw_rad;
    const Eigen::Vector2d d = target - estimate.X_WB.p.head<2>();
    const double ahead = std::cos(yaw) * d.x() + std::sin(yaw) * d.y(),
                 left = -std::sin(yaw) * d.x() + std::cos(yaw) * d.y();
    const double distance2 = ahead * ahead + left * left;
    if (distance2 < 0.25) return 0.0;
    if (ahead < 0.0) return left >= 0.0 ? kTurnAround : -kTurnAround;
    return 2.0 * left / distance2;
  }

  double allowed_speed() const {
    double v = config_.cruise_m_s;
    const auto braking_to = [&](double distance) {
      return std::sqrt(2.0 * config_.braking_m_s2 * std::max(0.0, distance));
    };
    for (double x = 0.0; x <= 12.0; x += 1.0) {
      const double curvature = std::abs(prior_.route.curvature(s_ + x));
      if (curvature < 1e-4) continue;
      const double in_corner = std::sqrt(config_.lateral_m_s2 / curvature);
      v = std::min(v, std::sqrt(in_corner * in_corner + 2.0 * config_.braking_m_s2 * std::max(0.0, x - 1.0)));
    }
    const double free_m = free_m_ - (s_ - free_from_s_);
    if (free_m_ < config_.choice.horizon_m) {
      const double margin_m = config_.choice.stop_margin_m;
      if (free_m < margin_m + 0.3) return 0.0;
      v = std::min(v, braking_to(free_m - margin_m));
    }
    for (std::size_t i = static_cast<std::size_t>(next_); i < config_.waypoints.size(); ++i) {
      if (!config_.waypoints[i].is_mission() && i + 1 != config_.waypoints.size()) continue;
      v = std::min(v, std::max(0.25, braking_to(prior_.waypoint_s_m[i] - s_ - 0.2)));  // creeps up to the stop
      break;
    }
    return v;
  }

  AutonomyConfig config_;
  PriorKnowledge prior_;
  GpsTime start_;
  LocalGrid grid_;
  std::vector<Eigen::Vector3f> points_;
  GpsTime last_seen_, hold_since_;
  bool holding_ = false;
  double s_ = 0.0;
  Candidate chosen_;
  double free_m_ = 0.0, free_from_s_ = 0.0;
  int next_ = 0;
  AutonomyState state_ = AutonomyState::kBlind;
};

}  // namespace

std::unique_ptr<Autonomy> make_reference_autonomy(const AutonomyConfig& config, const PriorKnowledge& prior,
                                                  GpsTime start) {
  return std::make_unique<ReferenceAutonomy>(config, prior, start);
}

}  // namespace canyon::mission
