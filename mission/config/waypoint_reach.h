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
class WaypointReach {
 public:
  /// So far around the radius it is looked at: farther than any thing that moves is long, in which a body could be
  /// without touching it.
  static constexpr double kAround_m = 15.0;

  /// The scene must outlive this.
  WaypointReach(const VehicleConfig& vehicle, double radius_m, const scene::SceneAt& scene);

  /// What the body meets on the route, nearest before the place at s_m and kAround_m before the radius at most, as
  /// SceneAt counts objects. None: the route leads there.
  std::optional<std::uint32_t> met_before(const Path& route, double s_m) const;

  /// False only where no way leads there, from anywhere kAround_m outside of the radius, nor from the vehicle's start
  /// if that is nearer. The body may go sideways, turn on the spot and stand as it likes, and is smaller all around by
  /// what lies between the places and headings that are looked at (a tenth of its shorter side, 7.5 degrees).
  bool comes_near(const Eigen::Vector2d& place_W) const;

 private:
  enum class Stand { kNowhere, kFree, kNear };
  bool is_free(const VehicleConfig& body, const Eigen::Vector2d& rear_axle_W, double yaw_rad,
               std::optional<std::uint32_t>* met = nullptr) const;
  /// How the smaller body can stand about its middle, in the best case.
  Stand stand(const Eigen::Vector2d& middle_W, const Eigen::Vector2d& place_W) const;

  VehicleConfig vehicle_, smaller_;
  double radius_m_, step_m_, near_m_;
  const scene::SceneAt& scene_;
};

}  // namespace canyon::mission
