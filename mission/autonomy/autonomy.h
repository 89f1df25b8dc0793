#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/config/config.h"
#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/mission/autonomy/local_grid.h"
#include "canyon/mission/autonomy/path.h"
#include "canyon/scene/city/street_graph.h"

namespace canyon::mission {

/// A place of the mission, known beforehand. A mission waypoint is one with a building to look at.
struct Waypoint {
  std::string name;
  Eigen::Vector2d p_m{kNaN, kNaN};  ///< x, y in W; must be given
  std::string observe;              ///< name of the building of interest; empty = pass through
  bool is_mission() const { return !observe.empty(); }
};
void visit(FieldVisitor& f, Waypoint& w);

/// [autonomy.choice] of a mission file: how the reference autonomy chooses among paths beside the centre line. The one
/// of least cost is driven; it halts where none is free.
struct PathChoiceConfig {
  double horizon_m = 18.0;           ///< how far ahead each is checked
  double stop_margin_m = 3.0;        ///< kept free ahead of the rear axle when halting before an obstacle
  double comfort_clearance_m = 2.0;  ///< closer to an obstacle than this costs
  double blocked_cost_1_m = 4.0;     ///< for every metre of the horizon behind the first obstacle
  double closeness_cost_1_m2 = 1.0;  ///< for every metre driven a metre closer than the comfortable clearance
  double offset_cost_1_m = 0.6;      ///< for every metre beside the centre line
  double change_cost_1_m = 0.8;      ///< for every metre away from the path chosen last
};
void visit(FieldVisitor& f, PathChoiceConfig& c);

/// [autonomy] of a mission file.
struct AutonomyConfig {
  std::string model = "reference";
  std::string map =
      "prior";  ///< pose it works with: the filter's ("prior") or corrected by the last keyframe ("registered")
  double rate_hz = 100.0;  ///< commands per second
  double cruise_m_s = 5.0;
  double lateral_m_s2 = 1.2;  ///< lateral acceleration in corners
  double braking_m_s2 = 1.2;
  double corner_radius_m = 6.5;
  double hold_s = 6.0;         ///< how long it looks at a building
  double max_offset_m = 3.5;   ///< how far it may leave the street's centre line
  double clearance_m = 1.0;    ///< from its axis to an obstacle
  double blind_after_s = 0.5;  ///< stops when no scan with returns came for this long
  LocalGridConfig grid;
  PathChoiceConfig choice;
  std::vector<Waypoint> waypoints;
};
void visit(FieldVisitor& f, AutonomyConfig& c);

enum class AutonomyState { kDriving, kObserving, kBlocked, kBlind, kDone };
const char* name(AutonomyState state);

/// What the vehicle knows before it starts: streets and waypoints, no obstacles.
struct PriorKnowledge {
  Path route;
  std::vector<double> waypoint_s_m;  ///< arc length of each waypoint along the route
};
/// Error (without file and line) if the streets do not connect the waypoints, or if all of them lie at the start.
Result<PriorKnowledge> plan_route(const AutonomyConfig& config, const scene::StreetGraph& streets,
                                  const Eigen::Vector2d& start_m);

/// Drives the vehicle on estimates and scans alone; never sees truth.
class Autonomy {
 public:
  virtual ~Autonomy() = default;
  /// A deskewed scan in L at its stamp, placed by the estimate at that stamp.
  virtual void see(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate) = 0;
  virtual bool looks() const { return true; }  ///< false: nothing it sees changes what it does
  virtual DriveCommand drive(const NavEstimate& estimate) = 0;
  virtual AutonomyState state() const = 0;
  virtual int next_waypoint() const = 0;  ///< 0-based; number of waypoints when done
};

std::unique_ptr<Autonomy> make_autonomy(const AutonomyConfig& config, const PriorKnowledge& prior, GpsTime start);
std::vector<std::string> autonomy_models();

}  // namespace canyon::mission
