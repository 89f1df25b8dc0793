#include "canyon/core/process/parallel.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "canyon/core/check.h"
#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/progress.h"

namespace canyon {
namespace {

/// Where our loops run on `count` threads.
struct Pool {
  explicit Pool(int n) : count(n), arena(n), aside(n) {}
  int count;
  tbb::task_arena arena;
  tbb::task_arena aside;  ///< of what is offered to idle threads, with its loops
};

int all_cores() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Where loops of the calling thread run; null: in the pool's.
thread_local tbb::task_arena* own_arena = nullptr;

class InArena {
 public:
  explicit InArena(tbb::task_arena* arena) : before_(own_arena) { own_arena = arena; }
  ~InArena() { own_arena = before_; }
  InArena(const InArena&) = delete;
  InArena& operator=(const InArena&) = delete;

 private:
  tbb::task_arena* before_;
};

/// Lives as long as the process and is never destroyed, nor is any pool: at the exit a worker may still hold what was
/// offered to it, in a pool whose number of threads may have been changed since.
struct Pools {
  std::mutex mutex;
  std::map<int, Pool> by_count;
  Pool* current = nullptr;
  std::optional<tbb::global_control> limit;  ///< also binds what others (Embree) start on oneTBB

  void change_to(int count) {
    limit.reset();  // the old one must go first: the smallest of those alive counts
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
    current = &by_count.try_emplace(count, count).first->second;
  }
};

Pools& pools() {
  static Pools* const forever = new Pools;
  return *forever;
}

Pool& pool() {
  Pools& all = pools();
  const std::lock_guard lock(all.mutex);
  if (all.current == nullptr) all.change_to(all_cores());
  return *all.current;
}

}  // namespace

void set_threads(int threads) {
  CANYON_CHECK(threads >= 0 && threads <= 4096, "threads = ", threads);
  Pools& all = pools();
  const std::lock_guard lock(all.mutex);
  all.change_to(threads == 0 ? all_cores() : threads);
}

int threads() {
  return pool().count;
}

void parallel_for(std::size_t n, std::size_t chunk, const std::function<void(std::size_t, std::size_t)>& body) {
  CANYON_CHECK(chunk > 0, "chunk = ", chunk);
  if (n == 0) return;
  const std::size_t chunks = (n - 1) / chunk + 1;
  CpuAccount* const account = charged_cpu_account();
  tbb::task_arena* const own = own_arena;
  const auto run_chunk = [&](std::size_t i) {
    throw_if_cancelled();
    const ChargeCpu charge(account);
    const InArena in(own);  // loops of the chunk stay in the room of this one
    body(i * chunk, i * chunk + std::min(chunk, n - i * chunk));
  };
  Pool& common = pool();
  if (common.count == 1 || chunks == 1) {
    for (std::size_t i = 0; i < chunks; ++i) run_chunk(i);
    return;
  }
  // Isolated: a thread that waits for a nested loop takes up only that loop's chunks, never an unrelated one's.
  (own != nullptr ? *own : common.arena).execute([&] {
    tbb::this_task_arena::isolate([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, chunks, 1),
          [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) run_chunk(i);
          },
          tbb::simple_partitioner());
    });
  });
}

struct OwnRoom::Room {
  tbb::task_arena arena{threads()};
  tbb::task_arena* before = own_arena;
};

OwnRoom::OwnRoom() : room_(std::make_unique<Room>()) {
  own_arena = &room_->arena;
}

OwnRoom::~OwnRoom() {
  own_arena = room_->before;
}

void offer_to_idle(std::function<void()> work) {
  Pool& common = pool();
  if (common.count == 1) return;
  common.aside.enqueue([&common, work = std::move(work)] {
    const InArena in(&common.aside);
    work();
  });
}

void run_on_one_thread(const std::function<void()>& work) {
  tbb::task_arena(1).execute([&] { tbb::this_task_arena::isolate([&] { work(); }); });
}

}  // namespace canyon
