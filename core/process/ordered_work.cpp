#include "canyon/core/process/ordered_work.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <utility>

#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/parallel.h"

namespace canyon {

struct OrderedWork::Line {
  struct Piece {
    std::function<void()> work;
    CpuAccount* account = nullptr;
  };

  explicit Line(std::size_t most) : most_waiting(most) {}

  const std::size_t most_waiting;
  std::mutex mutex;
  std::condition_variable done;
  std::deque<Piece> waiting;
  bool busy = false;
  std::exception_ptr thrown;

  /// The first that waits; nobody is busy. `lock` is held before and after, not meanwhile.
  void do_first(std::unique_lock<std::mutex>& lock) {
    Piece piece = std::move(waiting.front());
    waiting.pop_front();
    busy = true;
    lock.unlock();
    std::exception_ptr wrong;
    try {
      const ChargeCpu charge(piece.account);
      piece.work();
    } catch (...) {
      wrong = std::current_exception();
    }
    piece = {};  // what it holds is let go before anybody hears that it is done
    lock.lock();
    busy = false;
    if (wrong) {
      thrown = wrong;
      waiting.clear();
    }
    done.notify_all();
  }

  /// Does, or waits for others to do, what there is until at most `left` wait and, if none may, nobody is busy.
  void come_down_to(std::size_t left, std::unique_lock<std::mutex>& lock) {
    while (waiting.size() > left || (left == 0 && busy)) {
      if (busy)
        done.wait(lock);
      else
        do_first(lock);
    }
    tell();
  }

  void tell() {
    if (thrown) std::rethrow_exception(std::exchange(thrown, nullptr));
  }
};

OrderedWork::OrderedWork(std::size_t most_waiting) : line_(std::make_shared<Line>(most_waiting)) {}

OrderedWork::~OrderedWork() {
  std::unique_lock lock(line_->mutex);
  line_->waiting.clear();
  line_->done.wait(lock, [&] { return !line_->busy; });
}

void OrderedWork::add(std::function<void()> piece) {
  const std::shared_ptr<Line> line = line_;
  std::unique_lock lock(line->mutex);
  line->tell();  // before the piece is in the line
  line->waiting.push_back({std::move(piece), charged_cpu_account()});
  line->come_down_to(threads() == 1 ? 0 : line->most_waiting, lock);
  if (line->waiting.empty()) return;
  lock.unlock();
  offer_to_idle([line] {
    std::unique_lock held(line->mutex);
    while (!line->busy && !line->waiting.empty()) line->do_first(held);
  });
}

void OrderedWork::wait() {
  std::unique_lock lock(line_->mutex);
  line_->come_down_to(0, lock);
}

}  // namespace canyon
