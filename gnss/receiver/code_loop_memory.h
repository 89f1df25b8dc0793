#pragma once

#include <cstdint>
#include <map>

#include "canyon/core/messages.h"

namespace canyon::gnss {

/// What a code loop of first order makes of an error that changes: it follows with a time constant of 1 / (4 B), B
/// being its noise bandwidth. So no range error moves by more in an epoch than 1 - exp(-4 B dt) of what it has still to
/// move. A loop that has just locked on, or that nothing is known of, stands where its discriminator does.
class CodeLoopMemory {
 public:
  /// `loop_hz` > 0, `interval_s` > 0 between epochs.
  CodeLoopMemory(double loop_hz, double interval_s);

  void restart() { channels_.clear(); }
  /// Once per epoch and signal in lock: the error by now, m, where `settled_m` is what it would settle at.
  double follow(SatelliteId sv, std::int64_t index, double settled_m);

 private:
  struct Channel {
    std::int64_t index = -1;
    double error_m = 0.0;
  };
  double share_;  ///< of what is left, in an epoch
  std::map<SatelliteId, Channel> channels_;
};

}  // namespace canyon::gnss
