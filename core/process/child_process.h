#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>

/// A function in a process of its own: whatever becomes of it, the caller goes on and knows what it was.
namespace canyon {

using ProcessId = int;  ///< what the system calls pid_t

struct ChildLimits {
  double cpu_s = 20.0;
  double wall_s = 600.0;                            ///< for one that waits for ever; machines are shared
  std::size_t memory_bytes = std::size_t{2} << 30;  ///< resident
};

/// How a child ended.
struct ChildEnd {
  int exit_status = 0;  ///< -1 if a signal ended it
  int signal = 0;
  double cpu_s = 0.0;
  std::size_t peak_memory_bytes = 0;
  std::string out, err;  ///< what it printed
};

/// Forks a process that works in `folder`, with stdout and stderr in the files `out` and `err`, and whose exit status
/// is what `body` returns; 3 and the exception's text on stderr if one leaves it. Nothing that runs at a program's end
/// runs in it. It is the first of a process group of its own, so that what a terminal sends goes to the caller alone,
/// and ends when the calling thread does, or when the caller is interrupted for good. The calling process must have no
/// other threads, unless all that `body` does is to execute a program.
ProcessId start_child(const std::function<int()>& body, const std::filesystem::path& folder,
                      const std::filesystem::path& out, const std::filesystem::path& err, const ChildLimits& limits);

/// Waits for any child; returns its process and how it ended, without what it printed. Throws Cancelled when the user
/// asks to stop: end_child() those that are left.
std::pair<ProcessId, ChildEnd> wait_for_a_child();
/// Kills it and all that it has started, and waits until it is gone.
void end_child(ProcessId child);

/// What is wrong with that end in any case: a signal, too much time or memory. Empty if nothing is.
std::string breach(const ChildEnd& end, const ChildLimits& limits);

}  // namespace canyon
