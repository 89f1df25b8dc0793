#pragma once

#include "canyon/core/random/random.h"
#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/signal.h"
#include "canyon/lidar/beam/volley.h"
#include "canyon/lidar/receiver/detector.h"

namespace canyon::lidar {

struct CrosstalkConfig {
  double probability = 0.0;  ///< that a shot is answered by another sensor's pulse too
};
void visit(FieldVisitor& f, CrosstalkConfig& c);

/// Pulses of other sensors, taken for echoes: with probability `crosstalk` a shot has one more echo, at any range
/// alike, whose signal is 1 to 10 times the detection threshold of a radiometric detector.
///
/// Stream "lidar.crosstalk", entity = laser, index = firing cycle, n = 0: whether, 1: range, 2: signal.
class Crosstalk {
 public:
  Crosstalk(const LidarConfig& config, std::uint64_t seed);
  void apply(const Volley& volley, Echoes& echoes) const;

 private:
  double probability_, min_m_, max_m_;
  SignalConfig signal_;
  RandomStream stream_;
};

}  // namespace canyon::lidar
