#pragma once

#include <cstdint>
#include <utility>

#include "canyon/inertial/errors/imu_block.h"

namespace canyon::inertial {

/// Errors of a whole block, made when a sample of it is first asked for and kept for the others.
class BlockNoise {
 public:
  /// Adds the errors of the block's samples to `out`. `fill(number, errors)` adds those of a whole block to zeros.
  template <class Fill>
  void add_to(const ImuBlock& block, AxisArrays& out, Fill&& fill) {
    if (block.number() != number_) {
      for (auto& axis : errors_) axis.fill(0.0);
      std::forward<Fill>(fill)(block.number(), errors_);
      number_ = block.number();
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double* from = errors_[axis].data() + block.offset();
      for (std::size_t i = 0; i < block.count; ++i) out[axis][i] += from[i];
    }
  }

 private:
  std::int64_t number_ = -1;
  AxisArrays errors_;
};

}  // namespace canyon::inertial
