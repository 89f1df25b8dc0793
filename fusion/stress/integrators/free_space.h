#pragma once

#include <Eigen/Core>

/// Where bodies are far from everything: what integrators do by themselves.
namespace canyon::fusion {

inline Eigen::Vector3d no_gravity(const Eigen::Vector3d&) {
  return Eigen::Vector3d::Zero();
}

}  // namespace canyon::fusion
