#pragma once

#include "canyon/core/config/config.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/lidar/beam/aim.h"

namespace canyon::lidar {

/// Keys of the box.
struct EgoConfig {
  Eigen::Vector3d min_m{0, 0, 0}, max_m{0, 0, 0};  ///< corners in B of what the sensor sees of its own vehicle
};
void visit(FieldVisitor& f, EgoConfig& c);

/// The sensor's own vehicle as a box in B: shots that would meet it report nothing, as drivers of real sensors have
/// them dropped. A box without volume hides nothing.
class EgoMask {
 public:
  EgoMask(const EgoConfig& box, const Pose& X_BL);

  bool any() const { return any_; }
  /// Sets max_m of hidden shots to -1.
  void hide(const AimPacket& aim, scene::RayPacket& rays) const;

 private:
  Eigen::Vector3d min_B_, max_B_;
  Pose X_BL_;
  bool any_;
};

}  // namespace canyon::lidar
