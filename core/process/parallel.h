#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace canyon {

/// Sets the number of threads for everything (own loops, Embree builds, solvers). 0 = all cores. Call before any work.
void set_threads(int threads);
int threads();

/// body(begin, end) over [0, n) in fixed chunks of `chunk`. Chunk borders do not depend on the number of threads,
/// so a caller that keeps one result slot per chunk and combines them in order gets bit-identical results. CPU time
/// goes to the caller's account (core/process/cpu_time.h), whichever thread works on a chunk.
/// Before each chunk it looks at the cancel flag and throws Cancelled: chunks are to take less than 100 ms.
void parallel_for(std::size_t n, std::size_t chunk, const std::function<void(std::size_t, std::size_t)>& body);

/// While it lives, loops that the calling thread starts have room of their own. A thread that workers of other loops
/// wait for needs it: in the common room it would wait for the places that they hold. Its loops are helped by whoever
/// is idle.
class OwnRoom {
 public:
  OwnRoom();
  ~OwnRoom();
  OwnRoom(const OwnRoom&) = delete;
  OwnRoom& operator=(const OwnRoom&) = delete;

 private:
  struct Room;
  std::unique_ptr<Room> room_;
};

/// Has a thread of the pool do `work` once it is idle, which it may never be; with one thread nobody ever is.
void offer_to_idle(std::function<void()> work);

/// Runs `work` so that whatever it starts on oneTBB stays on the calling thread: for library calls whose result would
/// depend on the number of threads.
void run_on_one_thread(const std::function<void()>& work);

}  // namespace canyon
