#pragma once

#include "canyon/mission/autonomy/autonomy.h"

namespace canyon::mission {

/// So far before a stop it halts, along the route: then it has come.
inline constexpr double kStopTolerance_m = 0.4;

/// Where along its route a vehicle is, at which waypoint it stands, how it steers and how fast the route itself lets it
/// go: what every autonomy that keeps to the planned route shares. Knows nothing of obstacles.
class RouteDriver {
 public:
  RouteDriver(const AutonomyConfig& config, const PriorKnowledge& prior) : config_(config), prior_(prior) {}

  /// Takes in where the vehicle is believed to be. True while it has to stand: it observes, or is done.
  bool update(const NavEstimate& estimate);

  /// Curvature that leads to a point of the plan (pure pursuit), 1/m; full lock where the point lies behind.
  double pursue(const NavEstimate& estimate, const Eigen::Vector2d& target_W) const;
  /// Arc length of the point to steer for.
  double target_s_m(double speed_m_s) const;
  /// Cruise, corners and the next stop.
  double allowed_speed_m_s() const;
  /// Highest speed from which it halts within a distance at the braking of the configuration.
  double braking_to_m_s(double distance_m) const;

  double s_m() const { return s_; }  ///< arc length along the route
  int next_waypoint() const { return next_; }
  bool done() const { return next_ == static_cast<int>(config_.waypoints.size()); }
  const Path& route() const { return prior_.route; }

 private:
  bool update_waypoints(GpsTime t, double speed_m_s);

  AutonomyConfig config_;
  PriorKnowledge prior_;
  double s_ = 0.0;
  int next_ = 0;
  bool holding_ = false;
  GpsTime hold_since_;
};

/// The route on its centre line, whatever stands there: for tapes of the true path, driven on truth.
std::unique_ptr<Autonomy> make_route_follower(const AutonomyConfig& config, const PriorKnowledge& prior, GpsTime start);

}  // namespace canyon::mission
