#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/truth.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/motion/vehicle.h"
#include "canyon/mission/scoring/encounters.h"
#include "canyon/mission/scoring/lane_departures.h"
#include "canyon/mission/scoring/outcome.h"
#include "canyon/mission/scoring/sightings.h"
#include "canyon/scene/scene_at.h"

namespace canyon::mission {

/// How a mission failed, when and where.
struct Failure {
  Outcome kind = Outcome::kTimeout;  ///< never kSuccess
  double t_s = 0.0;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  std::string detail;
  std::optional<Sighting> seen{};  ///< of what was hit; none: no scan ever showed it, or nothing was hit
};

/// What truth says of one waypoint.
struct WaypointScore {
  std::string name;
  bool mission = false;
  bool reached = false;  ///< mission waypoint: stood long enough within the radius; else: came within the radius
  double closest_m = 1e300;
  double stopped_s = 0.0;          ///< longest halt within the radius
  double facade_seen_share = 0.0;  ///< best during a halt within the radius
  /// Then: way from the camera to the facade's middle, angle between it and the facade's normal, and how finely the
  /// camera sees the facade along its width.
  double facade_range_m = kNaN, facade_obliquity_deg = kNaN, facade_px_per_m = kNaN;
  bool believed = false;        ///< the autonomy took it for reached
  double believed_at_m = kNaN;  ///< and the vehicle was so far from it
};

/// Scores a mission on truth while it runs. It is a success if the autonomy finished it in time without a failure on
/// the way, having truly reached every waypoint, in whatever order: the mission waypoints with a halt of stop_s within
/// the radius and enough of the facade in sight, the others by passing within the radius. A waypoint that is nearer
/// than the radius to an earlier one, with one elsewhere between the two, wants a visit of its own, after that one's.
/// Out of several failures the first in time counts; of those that only the end shows, that of the first waypoint.
class Scorer {
 public:
  /// So long after its first scan an autonomy may find no way, and is right: before it has seen anything it knows none.
  static constexpr double kFirstPlan_s = 0.5;

  Scorer(const MissionConfig& config, const PreparedMission& mission, const scene::SceneAt& scene);

  /// One true step; `observing` (the autonomy stands on purpose) excuses standing still.
  /// Returns false once the run has to end: collision, stuck, off the terrain, out of time.
  bool step(const KinematicState& truth, double speed_m_s, bool on_terrain, bool observing);
  /// What the autonomy takes for the next waypoint, 0-based, and what it does, at every step.
  void follow(const KinematicState& truth, double speed_m_s, const DriveCommand& command, AutonomyState state,
              int next_waypoint);
  /// Whether it keeps to its lane, at every step (LaneDepartures).
  void follow_lane(const KinematicState& truth, const std::function<Eigen::Vector3d()>& believed_W) {
    departures_.look(truth, believed_W);
  }
  /// What a scan's returns were off.
  void scan(GpsTime t, const std::vector<LidarPointTruth>& returns) {
    if (!first_scan_) first_scan_ = t;
    sightings_.scan(t, returns);
  }
  /// The autonomy itself failed: how is said in the detail.
  void autonomy_fault(const KinematicState& truth, std::string how);
  /// The autonomy says that it is lost, having taken itself to be at `believed_W`.
  void lost(const KinematicState& truth, const Eigen::Vector3d& believed_W);
  /// To be called once at the end: decides what is still open. `done` = the autonomy believes it has finished.
  void finish(const KinematicState& truth, bool done);

  const std::optional<Failure>& failure() const { return failure_; }
  const std::vector<WaypointScore>& waypoints() const { return waypoints_; }
  const Encounters::Numbers& encounters() const { return encounters_.numbers(); }
  int needless_lane_departures() const { return departures_.needless(); }
  bool phantom() const { return encounters_.phantom(); }  ///< as of Encounters, now
  Outcome outcome() const { return failure_ ? failure_->kind : Outcome::kSuccess; }

 private:
  void fail(Outcome kind, const KinematicState& truth, std::string detail);
  /// The last waypoint in the same place, if there is one in another between the two.
  std::optional<std::size_t> visited_before(std::size_t i) const;
  /// How well a facade is seen, if that is better than before.
  void observe(const Eigen::Vector3d& camera_W, const std::vector<Eigen::Vector3d>& facade_W,
               WaypointScore& score) const;

  SuccessConfig config_;
  std::vector<Waypoint> places_;
  const scene::SceneAt& scene_;
  GpsTime start_;
  double time_limit_s_;
  bool stopped_on_purpose_;  ///< it is [time] limit_s, not the mission's own limit, that ends the run
  std::vector<WaypointScore> waypoints_;
  std::vector<std::vector<Eigen::Vector3d>> facades_;
  std::vector<double> halt_s_;
  std::vector<std::optional<std::size_t>> visited_before_;  ///< the waypoint whose visit comes before its own
  std::vector<char> awaited_;  ///< whether the vehicle has been there for the one before it, and left
  std::optional<Failure> failure_;
  std::unique_ptr<CollisionCheck> collision_;
  Encounters encounters_;
  LaneDepartures departures_;
  Sightings sightings_;
  std::optional<GpsTime> first_scan_;
  GpsTime last_t_;
  double standing_s_ = 0.0;
};

}  // namespace canyon::mission
