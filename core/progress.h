#pragma once

#include <atomic>
#include <mutex>
#include <string>

namespace canyon {

/// Progress bar on stderr, drawn only if stderr is a terminal; safe from several threads.
class Progress {
 public:
  Progress(std::string title, double total, bool enabled = true);
  ~Progress();
  void advance(double amount);

 private:
  void draw(double done);
  std::string title_;
  double total_;
  bool enabled_;
  std::atomic<double> done_{0.0};
  std::mutex mutex_;
  int last_permille_ = -1;
};

/// Thrown out of long computations after Ctrl-C; main() turns it into exit status 130.
struct Cancelled {};

/// Installs a SIGINT/SIGTERM handler that only sets a flag.
void install_cancel_handler();
bool cancel_requested();
/// For tests: sets or clears the flag.
void set_cancel_requested(bool requested);
/// Throws Cancelled if the user asked to stop; call at least every 100 ms of work.
void throw_if_cancelled();

}  // namespace canyon
