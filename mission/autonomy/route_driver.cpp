#include "canyon/mission/autonomy/route_driver.h"

#include <algorithm>
#include <cmath>

namespace canyon::mission {

namespace {

constexpr double kPassTolerance_m = 1.0;  // along the route
constexpr double kTurnAround_1_m = 1.0;   // full lock when the path lies behind

}  // namespace

bool RouteDriver::update(const NavEstimate& estimate) {
  s_ = prior_.route.project(estimate.X_WB.p.head<2>(), std::max(0.0, s_ - 2.0), s_ + 5.0);
  return update_waypoints(estimate.t, estimate.v_WB_W.head<2>().norm());
}

/// Passes and reaches waypoints; true while the vehicle has to stand.
bool RouteDriver::update_waypoints(GpsTime t, double speed_m_s) {
  while (!done()) {
    const auto i = static_cast<std::size_t>(next_);
    const double ahead = prior_.waypoint_s_m[i] - s_;
    const bool last = i + 1 == config_.waypoints.size();
    if (!config_.waypoints[i].is_mission() && !last) {
      if (ahead > kPassTolerance_m) return false;
    } else {
      // Once it stands and looks it stays, also when a fix moves the estimate back before the stop.
      if (ahead > kStopTolerance_m && !holding_) return false;
      const double hold_s = config_.waypoints[i].is_mission() ? config_.hold_s : 0.0;
      if (speed_m_s > 0.1 && !holding_) return true;
      if (!holding_) {
        holding_ = true;
        hold_since_ = t;
      }
      if (t - hold_since_ < hold_s) return true;
      holding_ = false;
    }
    ++next_;
  }
  return true;
}

double RouteDriver::target_s_m(double speed_m_s) const {
  return std::min(s_ + std::clamp(0.8 * speed_m_s, 2.5, 5.0), prior_.route.length_m());
}

double RouteDriver::pursue(const NavEstimate& estimate, const Eigen::Vector2d& target_W) const {
  const double yaw = yaw_pitch_roll(estimate.X_WB.R).yaw_rad;
  const Eigen::Vector2d d = target_W - estimate.X_WB.p.head<2>();
  const double ahead = std::cos(yaw) * d.x() + std::sin(yaw) * d.y(),
               left = -std::sin(yaw) * d.x() + std::cos(yaw) * d.y();
  const double distance2 = ahead * ahead + left * left;
  if (distance2 < 0.25) return 0.0;
  if (ahead < 0.0) return left >= 0.0 ? kTurnAround_1_m : -kTurnAround_1_m;
  return 2.0 * left / distance2;
}

double RouteDriver::braking_to_m_s(double distance_m) const {
  return std::sqrt(2.0 * config_.braking_m_s2 * std::max(0.0, distance_m));
}

double RouteDriver::allowed_speed_m_s() const {
  double v = config_.cruise_m_s;
  for (double x = 0.0; x <= 12.0; x += 1.0) {
    const double curvature = std::abs(prior_.route.curvature(s_ + x));
    if (curvature < 1e-4) continue;
    const double in_corner =
        std::min(std::sqrt(config_.lateral_m_s2 / curvature), prior_.vehicle.max_yaw_rate_rad_s / curvature);
    v = std::min(v, std::sqrt(in_corner * in_corner + 2.0 * config_.braking_m_s2 * std::max(0.0, x - 1.0)));
  }
  for (auto i = static_cast<std::size_t>(next_); i < config_.waypoints.size(); ++i) {
    if (!config_.waypoints[i].is_mission() && i + 1 != config_.waypoints.size()) continue;
    return std::min(v, std::max(0.25, braking_to_m_s(prior_.waypoint_s_m[i] - s_ - 0.2)));  // creeps up to the stop
  }
  return v;
}

namespace {

class RouteFollower final : public Autonomy {
 public:
  RouteFollower(const AutonomyConfig& config, const PriorKnowledge& prior) : driver_(config, prior) {}

  void see(const LidarScan&, const Pose&, const NavEstimate&) override {}
  bool looks() const override { return false; }
  DriveCommand drive(const NavEstimate& estimate) override {
    const bool stands = driver_.update(estimate);
    const double speed = estimate.v_WB_W.head<2>().norm();
    DriveCommand command;
    command.curvature_1_m = driver_.pursue(estimate, driver_.route().at(driver_.target_s_m(speed)));
    if (!stands) command.speed_m_s = driver_.allowed_speed_m_s();
    state_ = driver_.done() ? AutonomyState::kDone : stands ? AutonomyState::kObserving : AutonomyState::kDriving;
    return command;
  }
  AutonomyState state() const override { return state_; }
  int next_waypoint() const override { return driver_.next_waypoint(); }

 private:
  RouteDriver driver_;
  AutonomyState state_ = AutonomyState::kDriving;
};

}  // namespace

std::unique_ptr<Autonomy> make_route_follower(const AutonomyConfig& config, const PriorKnowledge& prior, GpsTime) {
  return std::make_unique<RouteFollower>(config, prior);
}

}  // namespace canyon::mission
