#pragma once

#include "canyon/core/random/random.h"
#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/volley.h"
#include "canyon/lidar/lidar_config.h"

namespace canyon::lidar {

/// Pulses of other sensors, taken for echoes: with probability `crosstalk` a shot has one more echo, at any range
/// alike, whose signal is 1 to 10 times the detection threshold of a radiometric detector.
///
/// Stream "lidar.crosstalk", entity = laser, index = firing cycle, n = 0: whether, 1: range, 2: signal.
class Crosstalk {
 public:
  Crosstalk(const LidarConfig& config, std::uint64_t seed) : config_(config), stream_(seed, "lidar.crosstalk") {}
  void apply(const Volley& volley, Echoes& echoes) const;

 private:
  LidarConfig config_;
  RandomStream stream_;
};

}  // namespace canyon::lidar
