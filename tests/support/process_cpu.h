#pragma once

#include <ctime>

namespace canyon::testing {

/// CPU time of the whole process so far, all threads, s.
inline double process_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace canyon::testing
