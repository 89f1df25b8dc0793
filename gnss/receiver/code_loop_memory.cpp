#include "canyon/gnss/receiver/code_loop_memory.h"

#include <cmath>

#include "canyon/core/check.h"

namespace canyon::gnss {

CodeLoopMemory::CodeLoopMemory(double loop_hz, double interval_s) : share_(-std::expm1(-4.0 * loop_hz * interval_s)) {
  CANYON_CHECK(loop_hz > 0.0 && interval_s > 0.0, "a loop of ", loop_hz, " Hz, epochs ", interval_s, " s apart");
}

double CodeLoopMemory::follow(SatelliteId sv, std::int64_t index, double settled_m) {
  Channel& channel = channels_[sv];
  const bool goes_on = channel.index >= 0 && channel.index + 1 == index;
  channel.error_m = goes_on ? channel.error_m + share_ * (settled_m - channel.error_m) : settled_m;
  channel.index = index;
  return channel.error_m;
}

}  // namespace canyon::gnss
