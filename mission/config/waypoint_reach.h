#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "canyon/mission/autonomy/path.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/scene_at.h"

namespace canyon::mission {

/// Whether the vehicle can come to a place, its rear axle to within a radius of it, past all that stands in a scene.
/// Whatever scores the run, the body is held against the scene by the lines of [success] collision = "lines", which are
/// in the body.
///
/// Places are looked at a tenth of the body's shorter side apart, the nearest first: a way straight in takes as many
/// looks as kAround_m has places, whatever the radius. That there is none is known only after all that can be reached
/// around the radius, which grows with its square, so a search ends after kMostChecks. These are all of a square around
/// a radius of 3 m for a body 0.36 m wide, or around 60 m for one of 1.5 m, if each place is settled by one heading.
class WaypointReach {
 public:
  /// So far around the radius it is looked at: farther than any thing that moves is long, in which a body could be
  /// without touching it.
  static constexpr double kAround_m = 15.0;
  static constexpr std::int64_t kMostChecks = 1'000'000;  ///< of a body against the scene, for one place

  /// The radius, above 0, is that of [success] waypoint_radius_m, up to 100 m. The scene must outlive this.
  WaypointReach(const VehicleConfig& vehicle, double radius_m, const scene::SceneAt& scene,
                std::int64_t most_checks = kMostChecks);

  /// What the body meets on the route, nearest before the place at s_m and kAround_m before the radius at most, as
  /// SceneAt counts objects. None: the route leads there.
  std::optional<std::uint32_t> met_before(const Path& route, double s_m) const;

  /// What is known of a way to a place.
  struct Way {
    bool may_be = true;       ///< false: none leads there
    std::int64_t checks = 0;  ///< of a body against the scene, that it took
  };
  /// None leads there only if the body cannot come there from anywhere kAround_m outside of the radius, nor from the
  /// vehicle's start if that is nearer. The body may go sideways, turn on the spot and stand as it likes; it is smaller
  /// all around by what lies between the places and headings that are looked at (a tenth of its shorter side, 7.5
  /// degrees), and the radius larger by what its axle moves between them. There may be one wherever `most_checks` do
  /// not settle it, and for a body over ten times as long as it is wide, of which too little would be left.
  Way way_to(const Eigen::Vector2d& place_W) const;

 private:
  enum class Stand { kNowhere, kFree, kNear };
  bool is_free(const VehicleConfig& body, const Eigen::Vector2d& rear_axle_W, double yaw_rad,
               std::optional<std::uint32_t>* met = nullptr) const;
  /// How the smaller body can stand about its middle, in the best case; counts its checks.
  Stand stand(const Eigen::Vector2d& middle_W, const Eigen::Vector2d& place_W, std::int64_t& checks) const;

  VehicleConfig vehicle_, smaller_;
  double radius_m_, step_m_, near_m_;
  bool is_judged_ = true;  ///< enough of the body is left
  std::int64_t most_checks_;
  const scene::SceneAt& scene_;
};

}  // namespace canyon::mission
