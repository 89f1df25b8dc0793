#pragma once

#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/imu_block.h"

namespace canyon::inertial {

/// errors += sigma n over a whole block: entity = axis, index = sample.
inline void add_white(const RandomStream& stream, double sigma, std::int64_t number, AxisArrays& errors) {
  std::array<double, kImuBlock> n;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    stream.fill_normal(n, axis, static_cast<std::uint64_t>(number) * kImuBlock);
    for (std::size_t i = 0; i < kImuBlock; ++i) errors[axis][i] += sigma * n[i];
  }
}

}  // namespace canyon::inertial
