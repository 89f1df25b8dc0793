#pragma once

#include <chrono>
#include <mutex>

namespace canyon {

/// Wall time, less what passed while the process was stopped from outside (SIGSTOP, a batch system that suspends its
/// jobs, a debugger). Nobody looks at the clock then, so what passes between two looks counts as `gap` at most; whoever
/// relies on it sees to it that it is looked at more often. From any thread.
class AwakeTime {
 public:
  using Clock = std::chrono::steady_clock;
  explicit AwakeTime(Clock::duration gap) : gap_(gap) {}

  /// Since the first look.
  Clock::duration look(Clock::time_point now = Clock::now());

 private:
  Clock::duration gap_;
  std::mutex mutex_;
  bool looked_ = false;
  Clock::time_point last_{};
  Clock::duration awake_{0};
};

}  // namespace canyon
