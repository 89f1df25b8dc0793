#pragma once

#include <cstdint>
#include <vector>

#include "canyon/core/truth.h"
#include "canyon/mission/autonomy/autonomy.h"
#include "canyon/mission/collision/body_box.h"
#include "canyon/mission/collision/near_triangles.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/scene_at.h"

namespace canyon::mission {

/// How near things came to the true body, and what its driver made of what was truly there. Things are all but the
/// ground. Looked at after every 0.2 m of the way, and every 0.2 s.
class Encounters {
 public:
  static constexpr double kFar_m = 3.0;  ///< what is farther off counts as that far

  /// The scene must outlive this.
  Encounters(const SuccessConfig& config, const VehicleConfig& vehicle, const scene::SceneAt& scene);

  /// At every master step: what the vehicle does, and what is asked of it.
  void look(const KinematicState& truth, double speed_m_s, const DriveCommand& command, AutonomyState state);
  /// An object, as SceneAt counts them, was found touched, wherever look() looked last. The ground is none.
  void touched(std::uint32_t object, GpsTime t);

  struct Numbers {
    double clearance_min_m = kNaN;  ///< 0: touched; NaN: never looked
    /// Times that something was nearer than near_miss_m, without being touched. Of several things that are near within
    /// a second of one another one that is not touched makes it one.
    int near_misses = 0;
    int phantoms = 0;  ///< times that the autonomy found no way with phantom_free_m of its lane truly free
    /// Times that something lay on the arc driven, nearer than the vehicle can stop, and it was not slowed down.
    int missed_obstacles = 0;
  };
  const Numbers& numbers() const { return numbers_; }
  /// Whether what it was last told of is a phantom.
  bool phantom() const { return phantom_now_; }

 private:
  /// Times that something holds: a new one after a second without.
  class Times {
   public:
    bool begins(bool holds, GpsTime t);

   private:
    bool ever_ = false;
    GpsTime last_;
  };
  /// Times that something is near, a new one after a second without: what was in the one that lasts, and whether it was
  /// touched meanwhile.
  class Approaches {
   public:
    /// One of the objects that are near now.
    void add(std::uint32_t object, bool touched, GpsTime t);
    /// How many there were in which something was near and not touched.
    int near_misses() const { return before_ + (is_near_miss() ? 1 : 0); }

   private:
    struct Thing {
      std::uint32_t object;
      bool touched;
    };
    bool is_near_miss() const;
    int before_ = 0;  ///< of those that are over
    std::vector<Thing> things_;
    GpsTime last_;
  };
  bool is_thing(const NearTriangle& triangle) const;
  bool is_driven_over(const NearTriangle& triangle, const OrientedBox& body) const;
  /// To the nearest thing; those that are near are added to approaches_.
  double clearance_m(const Pose& X_WB, GpsTime t);
  /// Whether the body meets a thing on an arc of that length ahead.
  bool meets(const Pose& X_WB, double curvature_1_m, double way_m);

  double near_miss_m_, phantom_free_m_;
  VehicleConfig vehicle_;
  const scene::SceneAt& scene_;
  NearTriangles near_;
  Numbers numbers_;
  Approaches approaches_;
  Times phantom_, missed_;
  bool looked_ = false, phantom_now_ = false;
  GpsTime looked_at_;
  Eigen::Vector2d looked_from_{0, 0};
};

}  // namespace canyon::mission
