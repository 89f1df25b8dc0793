#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "canyon/core/process/awake_time.h"

namespace canyon::mission {

/// Watches the calls of an autonomy, which is what is under test: one that throws, or does not return, is a result of
/// its own run and must end no other. The run's thread asks; another looks on, and may take the run over from a call
/// that is over its limit. A call that is taken over from is left where it is: should it ever return, its thread sleeps
/// for the rest of the process, with all that stands on its stack. The limit is of wall time in which the process was
/// not stopped from outside (AwakeTime): no autonomy fails because its batch was suspended.
class CallWatch {
 public:
  explicit CallWatch(double limit_s);

  /// Runs `call`. What was wrong with it, or nothing. Cancelled passes through.
  std::optional<std::string> ask(const std::function<void()>& call);

  /// By the thread that looks on, several times within the limit: true once, if a call is going on for longer than the
  /// limit. From then on what the calling thread worked on is the looker's alone, but for the autonomy itself.
  bool take_over();
  double limit_s() const { return limit_s_; }
  std::string overtime() const;  ///< what is said of such a call

 private:
  using Time = AwakeTime::Clock::duration;
  static constexpr std::uint64_t kTaken = ~std::uint64_t{0};
  bool over(Time since);

  double limit_s_;
  AwakeTime awake_;
  std::atomic<std::uint64_t> turn_{0};  ///< odd while a call is going on, another number for each
  std::atomic<Time::rep> since_{0};     ///< when the last one began
};

}  // namespace canyon::mission
