#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/config/config.h"
#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"
#include "canyon/core/result.h"
#include "canyon/mission/autonomy/kept_returns.h"
#include "canyon/mission/autonomy/known_vehicle.h"
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

/// The pose that the autonomy works with: the filter's, or that corrected by the last registered keyframe.
enum class MapPose { kPrior, kRegistered };

class Autonomy;
struct AutonomyConfig;
struct PriorKnowledge;
using MakeAutonomy = std::unique_ptr<Autonomy>(const ModelParameters& own, const AutonomyConfig& config,
                                               const PriorKnowledge& prior, GpsTime start);
ModelTable<MakeAutonomy> autonomy_models();

/// [autonomy] of a mission file.
struct AutonomyConfig {
  ModelChoice<autonomy_models> model{"reference"};
  MapPose map = MapPose::kPrior;
  double rate_hz = 100.0;  ///< commands per second
  double cruise_m_s = 5.0;
  double lateral_m_s2 = 1.2;  ///< lateral acceleration in corners
  double braking_m_s2 = 1.2;
  double corner_radius_m = 6.5;
  double hold_s = 6.0;         ///< how long it looks at a building
  double blind_after_s = 0.5;  ///< stops when no scan with returns came for this long
  double call_limit_s = 10.0;  ///< of wall time while the process is awake, for one call
  std::vector<Waypoint> waypoints;
};
void visit(FieldVisitor& f, AutonomyConfig& c);

/// kLost: it no longer believes its estimate and stands, for good.
enum class AutonomyState { kDriving, kObserving, kBlocked, kBlind, kDone, kLost };
const char* name(AutonomyState state);

/// What is known before the start: streets and waypoints, no obstacles, and the vehicle itself.
struct PriorKnowledge {
  Path route;
  std::vector<double> waypoint_s_m{};  ///< arc length of each waypoint along the route
  KnownVehicle vehicle{};
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
  /// What the wheel counted, where the run has an odometer.
  virtual void count(const OdometerSample&) {}
  virtual bool looks() const { return true; }  ///< false: nothing it sees changes what it does
  virtual std::optional<KeptReturns> keeps() const { return std::nullopt; }  ///< none: whatever it is shown
  virtual DriveCommand drive(const NavEstimate& estimate) = 0;
  virtual AutonomyState state() const = 0;
  virtual int next_waypoint() const = 0;  ///< 0-based; number of waypoints when done
};

std::unique_ptr<Autonomy> make_autonomy(const AutonomyConfig& config, const PriorKnowledge& prior, GpsTime start);

}  // namespace canyon::mission
