#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/process/staging_litter.h"

namespace canyon {
namespace {

/// A computation that has not come to a look at the flag by then is left behind: libraries build and solve for seconds,
/// and the reading of a pipe may last for ever.
constexpr int kPatience_ms = 600;
constexpr int kInterrupted = 130;

std::atomic<bool> cancel_flag{false};
std::atomic<int> requests{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "they are set inside a signal handler");

/// Requests go from the signal handler to the watchdog through a pipe.
std::array<int, 2> requests_pipe{-1, -1};

void wake_watchdog() {
  if (write(requests_pipe[1], "!", 1) < 0) return;  // full of requests: it is awake
}

/// The second request does not wait; the third does not even clean up.
extern "C" void on_request(int) {
  cancel_flag.store(true);
  if (requests.fetch_add(1) >= 2) _exit(kInterrupted);
  const int before = errno;
  wake_watchdog();
  errno = before;
}

/// Waits for a request, and then for the computation to end by itself.
class Watchdog {
 public:
  Watchdog() : thread_([this] { watch(); }) {}
  ~Watchdog() {
    over_ = true;
    wake_watchdog();
    thread_.join();
  }
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  /// Whether there was a request within the time; -1: waits for ever.
  static bool is_asked(int within_ms) {
    pollfd waiting{requests_pipe[0], POLLIN, 0};
    while (poll(&waiting, 1, within_ms) < 0 && errno == EINTR) {
    }
    char request = 0;
    return (waiting.revents & POLLIN) != 0 && read(requests_pipe[0], &request, 1) == 1;
  }

  void watch() {
    while (!is_asked(-1)) {
    }
    if (!over_) (void)is_asked(kPatience_ms);
    if (over_) return;
    remove_litter_for_good();
    tell_interruption();
    _exit(kInterrupted);
  }

  std::atomic<bool> over_{false};
  std::thread thread_;
};

Watchdog* watchdog = nullptr;

}  // namespace

void install_cancel_handler() {
  CANYON_CHECK(watchdog == nullptr, "installed twice");
  CANYON_CHECK(pipe2(requests_pipe.data(), O_CLOEXEC | O_NONBLOCK) == 0, "no pipe: errno ", errno);
  requests = 0;
  // The thread takes no signals: they go on to the others.
  sigset_t both, before;
  sigemptyset(&both);
  sigaddset(&both, SIGINT);
  sigaddset(&both, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &both, &before);
  watchdog = new Watchdog;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  struct sigaction action = {};
  action.sa_handler = on_request;
  action.sa_flags = SA_RESTART;  // file reads and writes go on; loops look at the flag
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void remove_cancel_handler() {
  if (watchdog == nullptr) return;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  delete watchdog;
  watchdog = nullptr;
  for (int& end : requests_pipe) close(std::exchange(end, -1));
}

bool cancel_requested() {
  return cancel_flag.load(std::memory_order_relaxed);
}
void set_cancel_requested(bool requested) {
  cancel_flag.store(requested);
}

void throw_if_cancelled() {
  if (cancel_requested()) throw Cancelled{};
}

void tell_interruption() {
  // Who comes second waits until it has been said: it ends the process.
  static std::once_flag told;
  std::call_once(told, [] {
    if (isatty(STDERR_FILENO) == 1) std::fputs("\r\033[K", stderr);  // the progress bar's line
    std::fputs(anything_committed() ? "interrupted: all had been written\n" : "interrupted: nothing was written\n",
               stderr);
  });
}

}  // namespace canyon
