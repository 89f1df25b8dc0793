#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/imu_block.h"

namespace canyon::inertial {

/// Six independent unit normals off the diagonal, from the stream `name`: entity = row, n = 0, 1 for the columns after
/// it.
inline Eigen::Matrix3d off_diagonal_draws(std::uint64_t seed, const std::string& name) {
  const RandomStream stream(seed, name);
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) {
    for (int j = 0; j < 2; ++j) {
      m(row, (row + 1 + j) % 3) = stream.normal(static_cast<std::uint32_t>(row), 0, static_cast<std::uint32_t>(j));
    }
  }
  return m;
}

/// Plus or minus one on each axis.
inline Eigen::Vector3d sign_draws(std::uint64_t seed, const std::string& name) {
  const RandomStream stream(seed, name);
  Eigen::Vector3d signs;
  for (std::uint32_t axis = 0; axis < 3; ++axis) signs[axis] = stream.uniform(axis, 0) < 0.5 ? -1.0 : 1.0;
  return signs;
}

/// out += m in, sample by sample.
inline void add_product(const Eigen::Matrix3d& m, const AxisArrays& in, std::size_t count, AxisArrays& out) {
  for (int row = 0; row < 3; ++row) {
    const double a = m(row, 0), b = m(row, 1), c = m(row, 2);
    auto& target = out[static_cast<std::size_t>(row)];
    for (std::size_t i = 0; i < count; ++i) target[i] += a * in[0][i] + b * in[1][i] + c * in[2][i];
  }
}

inline void add_constant(const Eigen::Vector3d& v, std::size_t count, AxisArrays& out) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = v[static_cast<Eigen::Index>(axis)];
    for (std::size_t i = 0; i < count; ++i) out[axis][i] += x;
  }
}

}  // namespace canyon::inertial
