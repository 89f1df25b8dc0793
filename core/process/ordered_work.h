#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace canyon {

/// Work that is done one piece after another beside the thread that gives it, by whichever thread of the pool is idle.
/// What nobody has taken up when the line is full, or is waited for, the giver does itself; with one thread it does all
/// at once. CPU time goes to the account that the giver had (core/process/cpu_time.h).
class OrderedWork {
 public:
  /// So many pieces may wait.
  explicit OrderedWork(std::size_t most_waiting);
  /// Waits for the piece that is being done; those that wait are dropped.
  ~OrderedWork();
  OrderedWork(const OrderedWork&) = delete;
  OrderedWork& operator=(const OrderedWork&) = delete;

  /// Throws what an earlier piece has thrown, after which all that waited was dropped.
  void add(std::function<void()> piece);
  /// Until all is done. Throws as add() does.
  void wait();

 private:
  struct Line;
  std::shared_ptr<Line> line_;
};

}  // namespace canyon
