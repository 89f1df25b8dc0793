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

/// On SIGINT or SIGTERM a flag is set that long computations look at. One that has not come to a look after 0.6 s, or
/// at once if the user asks again, is left behind: the staged outputs are removed and the process ends with exit status
/// 130, whatever its threads are waiting for. A third request ends the process without any more ado.
void install_cancel_handler();
/// Everything is done: from here on the signals have their usual effect.
void remove_cancel_handler();
bool cancel_requested();
/// For tests: sets or clears the flag.
void set_cancel_requested(bool requested);
/// Throws Cancelled if the user asked to stop; call at least every 100 ms of work.
void throw_if_cancelled();
/// The line on stderr, once.
void tell_interruption();

}  // namespace canyon
