#pragma once

#include <functional>

#include <Eigen/Core>

#include "canyon/core/truth.h"
#include "canyon/mission/autonomy/path.h"
#include "canyon/mission/collision/near_triangles.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/scene_at.h"

namespace canyon::mission {

/// How often the true vehicle leaves its lane without need, as for a phantom that it steers around. Its lane is the
/// route, where that truly is, where it is by the estimate that the vehicle drives by, or between the two: what the
/// estimate's error explains is no departure. There is need where a thing, which is all but the ground, stands or moves
/// in the lane, or where the lane turns more sharply than the vehicle can. Kerbs and pavements, which lanes run along,
/// are in it only where the body itself would touch them. Looked at after every 0.2 m of the way.
class LaneDepartures {
 public:
  static constexpr double kBeside_m = 0.5;  ///< farther beside its lane it has left it
  static constexpr double kClear_m = 1.0;   ///< nearer to the body, on its way along the lane, a thing is in it
  static constexpr double kAhead_m = 30.0;  ///< so far ahead a thing is a reason to leave the lane
  static constexpr double kBack_m = 30.0;   ///< and for so long a way after it one not to be back
  static constexpr double kTurn_m = 5.0;    ///< so far ahead a turn is one that the vehicle begins
  static constexpr double kSwing_m =
      15.0;  ///< so long after a turn sharper than the vehicle's own circle it may be beside

  /// `lane`: the route in W, of rear axles; without one nothing is counted. The scene must outlive this.
  LaneDepartures(const VehicleConfig& vehicle, Path lane, const scene::SceneAt& scene);

  /// At every master step; `believed_W`, asked only where it looks, is where the driver takes B to be, finite.
  void look(const KinematicState& truth, const std::function<Eigen::Vector3d()>& believed_W);

  /// Each counts once, however long it lasts, and the next one after it has been back for 5 m. A vehicle that starts
  /// beside its lane, or headed across it, has not left it.
  int needless() const { return needless_; }

 private:
  static constexpr double kEvery_m = 0.2;        // of the way, between looks
  static constexpr double kSearchEvery_m = 2.0;  // of the way beside the lane, between searches of it
  static constexpr double kBodies_m = 1.0;       // between the bodies that are laid along it, which are longer
  static constexpr double kKept_m = 5.0;         // of the way in the lane, before it can be left
  static constexpr double kAlong = 0.7;          // cosine between its heading and that of who is in it
  static constexpr double kMostError_m = 20.0;   // an estimate that is farther off explains everything

  double project(const Eigen::Vector2d& p_W, double near_s_m) const;
  /// Whether nothing stands in the lane ahead, moved by up to so much.
  bool is_free(const Eigen::Vector2d& most_moved_m);
  bool is_free_at(const Eigen::Vector2d& moved_m);
  bool is_kerb(const NearTriangle& triangle) const;
  /// Whether the vehicle can follow the lane over kTurn_m from there.
  bool can_follow(double s_m) const;

  VehicleConfig vehicle_;
  double most_curvature_1_m_;  ///< that the vehicle can steer
  Path lane_;
  const scene::SceneAt& scene_;
  NearTriangles near_;
  bool looked_ = false, may_leave_ = false;
  Eigen::Vector2d looked_from_{0, 0};
  double s_m_ = 0.0, believed_s_m_ = 0.0;  ///< along the lane
  double way_m_ = 0.0, kept_m_ = 0.0;      ///< driven; of that last in the lane
  double search_from_m_ = 0.0, needed_to_m_ = 0.0;
  int needless_ = 0;
};

}  // namespace canyon::mission
