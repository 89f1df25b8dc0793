#include "canyon/core/process/awake_time.h"

#include <algorithm>

namespace canyon {

AwakeTime::Clock::duration AwakeTime::look(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (looked_) awake_ += std::clamp(now - last_, Clock::duration::zero(), gap_);  // two threads may come out of order
  looked_ = true;
  last_ = std::max(last_, now);
  return awake_;
}

}  // namespace canyon
