#pragma once

#include <Eigen/Core>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"

namespace canyon {

/// The scene's own frame W: local east-north-up, metres, tangent at a geodetic origin (ellipsoidal height).
/// W is fixed to the Earth, so velocities are the same vectors in W and E up to the constant rotation R_EW.
class LocalFrame {
 public:
  LocalFrame();
  explicit LocalFrame(const Geodetic& origin);

  const Geodetic& origin() const { return origin_; }
  const Eigen::Matrix3d& R_EW() const { return R_EW_; }
  const Eigen::Vector3d& origin_E() const { return origin_E_; }

  Eigen::Vector3d to_E(const Eigen::Vector3d& p_W) const;
  Eigen::Vector3d to_W(const Eigen::Vector3d& p_E) const;
  Geodetic to_geodetic(const Eigen::Vector3d& p_W) const;
  Eigen::Vector3d from_geodetic(const Geodetic& g) const;
  Pose X_EW() const;

 private:
  Geodetic origin_;
  Eigen::Matrix3d R_EW_;
  Eigen::Vector3d origin_E_;
};

}  // namespace canyon
