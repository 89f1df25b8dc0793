#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "canyon/core/messages.h"

namespace canyon::inertial {

/// Samples that the links of the error chain work on together. Random processes are made block by block: block j holds
/// the samples [j kImuBlock, (j + 1) kImuBlock).
inline constexpr std::size_t kImuBlock = 256;

using AxisArrays = std::array<std::array<double, kImuBlock>, 3>;

/// Gyroscope or accelerometer, axis by axis: increments (rad or m/s) over each sample's interval.
struct TriadBlock {
  AxisArrays truth;   ///< what acts on the sensing elements
  AxisArrays output;  ///< what the unit gives, so far
};

/// Consecutive samples on their way through the chain; they never straddle the border of a block.
struct ImuBlock {
  std::int64_t first = 0;
  std::size_t count = 0;
  std::array<TriadBlock, 2> triads;  ///< gyroscope, accelerometer
  std::span<ImuSample> samples;      ///< stamps and flags are written here; the increments when all links are done

  std::int64_t number() const { return first / static_cast<std::int64_t>(kImuBlock); }
  std::size_t offset() const { return static_cast<std::size_t>(first) % kImuBlock; }
};

}  // namespace canyon::inertial
