#pragma once

#include "canyon/core/motion/rotation.h"
#include "canyon/lidar/beam/aim.h"

namespace canyon::lidar {

/// The sensor's own vehicle as a box in B: shots that would meet it report nothing, as drivers of real sensors have
/// them dropped. A box without volume hides nothing.
class EgoMask {
 public:
  EgoMask(const Eigen::Vector3d& min_B, const Eigen::Vector3d& max_B, const Pose& X_BL)
      : min_B_(min_B), max_B_(max_B), X_BL_(X_BL), any_(((max_B - min_B).array() > 0).all()) {}

  bool any() const { return any_; }
  /// Sets max_m of hidden shots to -1.
  void hide(const AimPacket& aim, scene::RayPacket& rays) const;

 private:
  Eigen::Vector3d min_B_, max_B_;
  Pose X_BL_;
  bool any_;
};

}  // namespace canyon::lidar
