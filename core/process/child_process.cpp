#include "canyon/core/process/child_process.h"

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <thread>
#include <type_traits>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/process/staging_litter.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CANYON_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define CANYON_SANITIZED
#endif
#endif

namespace canyon {

static_assert(std::is_same_v<ProcessId, pid_t>);

namespace {

#ifdef CANYON_SANITIZED
/// The address sanitizer maps terabytes, keeps what was freed, and takes two to three times as long.
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

constexpr double kLargestFile_bytes = 1e9;
constexpr double kGrace_s = 5.0;  ///< between the signal that says which limit it is, and the end in any case

void limit(int resource, double value, double grace = 0.0) {
  const rlimit both{static_cast<rlim_t>(std::ceil(value)), static_cast<rlim_t>(std::ceil(value + grace))};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

double cpu_limit_s(const ChildLimits& limits) {
  return (kSanitized ? 4.0 : 1.0) * limits.cpu_s;
}

void set_limits(const ChildLimits& limits) {
  limit(RLIMIT_CORE, 0.0);
  limit(RLIMIT_FSIZE, kLargestFile_bytes);
  limit(RLIMIT_CPU, cpu_limit_s(limits), kGrace_s);
  // Addresses, not memory in use: a bound that keeps the machine alive. Libraries and stacks come on top.
  if (!kSanitized) limit(RLIMIT_AS, 1.5 * static_cast<double>(limits.memory_bytes) + 1e9);
  const double whole_s = std::floor(limits.wall_s);
  const itimerval once{{0, 0},
                       {static_cast<time_t>(whole_s), static_cast<suseconds_t>(1e6 * (limits.wall_s - whole_s))}};
  setitimer(ITIMER_REAL, &once, nullptr);
}

void redirect(const std::filesystem::path& file, int descriptor) {
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (fd < 0 || dup2(fd, descriptor) < 0) _exit(4);
  close(fd);
}

void forget(pid_t child) {
  const auto lock = hold_litter();
  forget_litter_process(child);
}

int guarded(const std::function<int()>& body) {
  try {
    return body();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "an exception left it: %s\n", error.what());
    return 3;
  }
}

}  // namespace

ProcessId start_child(const std::function<int()>& body, const std::filesystem::path& folder,
                      const std::filesystem::path& out, const std::filesystem::path& err, const ChildLimits& limits) {
  std::fflush(nullptr);
  const pid_t parent = getpid();
  std::unique_lock lock = hold_litter();  // an interruption knows of it from its first moment on
  const pid_t child = fork();
  CANYON_CHECK(child >= 0, "fork: ", std::strerror(errno));
  setpgid(child, child);  // on both sides, as either may be first: Ctrl-C in a terminal is for us alone
  if (child > 0) {
    add_litter_process(child);
    return child;
  }
  lock.unlock();
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(4);
  redirect("/dev/null", STDIN_FILENO);
  redirect(out, STDOUT_FILENO);
  redirect(err, STDERR_FILENO);
  if (chdir(folder.c_str()) != 0) _exit(4);
  set_limits(limits);
  const int status = guarded(body);
  std::fflush(nullptr);
  _exit(status);
}

std::pair<ProcessId, ChildEnd> wait_for_a_child() {
  int status = 0;
  rusage used{};
  pid_t child = 0;
  while ((child = wait4(-1, &status, WNOHANG, &used)) == 0) {
    throw_if_cancelled();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  CANYON_CHECK(child > 0, "wait4: ", std::strerror(errno));
  forget(child);
  ChildEnd end;
  end.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  end.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  end.peak_memory_bytes = static_cast<std::size_t>(used.ru_maxrss) * 1024;
  return {child, end};
}

void end_child(ProcessId child) {
  kill(-child, SIGKILL);
  waitpid(child, nullptr, 0);
  forget(child);
}

std::string breach(const ChildEnd& end, const ChildLimits& limits) {
  char text[120];
  if (end.signal == SIGXCPU || (end.signal == SIGKILL && end.cpu_s >= cpu_limit_s(limits)))
    std::snprintf(text, sizeof text, "ran for more than %.0f s of CPU time", end.cpu_s);
  else if (end.signal == SIGKILL)
    std::snprintf(text, sizeof text, "was killed from outside after %.1f s of CPU time with %.2f GB", end.cpu_s,
                  1e-9 * static_cast<double>(end.peak_memory_bytes));
  else if (end.signal == SIGXFSZ)
    std::snprintf(text, sizeof text, "wrote a file of more than %.0f GB", 1e-9 * kLargestFile_bytes);
  else if (end.signal == SIGALRM)
    std::snprintf(text, sizeof text, "waited for more than %.3g s", limits.wall_s);
  else if (end.signal != 0)
    std::snprintf(text, sizeof text, "signal %d (%s)", end.signal, strsignal(end.signal));
  else if (!kSanitized && end.cpu_s > limits.cpu_s)
    std::snprintf(text, sizeof text, "took %.1f s of CPU time", end.cpu_s);
  else if (!kSanitized && end.peak_memory_bytes > limits.memory_bytes)
    std::snprintf(text, sizeof text, "took %.2f GB", 1e-9 * static_cast<double>(end.peak_memory_bytes));
  else
    return "";
  return text;
}

}  // namespace canyon
