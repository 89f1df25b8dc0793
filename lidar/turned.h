#pragma once

#include <Eigen/Core>

namespace canyon::lidar {

/// R v in double precision, without the call that g++ makes of Eigen's product in a loop over points.
template <class Vector>
[[gnu::always_inline]] inline Eigen::Vector3d turned(const Eigen::Matrix3d& R, const Vector& v) {
  const double x = v.x(), y = v.y(), z = v.z();
  return {R(0, 0) * x + R(0, 1) * y + R(0, 2) * z, R(1, 0) * x + R(1, 1) * y + R(1, 2) * z,
          R(2, 0) * x + R(2, 1) * y + R(2, 2) * z};
}

}  // namespace canyon::lidar
