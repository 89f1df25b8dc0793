#include "canyon/apps/line/standard_streams.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace canyon::apps {

namespace {

bool had_sigpipe = true;  ///< false where the caller wants to hear of closed pipes by an error

/// A pipe whose reader has gone.
bool is_closed_pipe() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

}  // namespace

void prepare_standard_streams() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(number, F_GETFD) != -1 || errno != EBADF) continue;
    // Opened the wrong way round for standard output: what is printed is lost, and that shall be said.
    const int opened = open("/dev/null", number == STDERR_FILENO ? O_WRONLY : O_RDONLY);
    if (opened >= 0 && opened != number) {
      dup2(opened, number);
      close(opened);
    }
  }
  struct sigaction before = {};
  sigaction(SIGPIPE, nullptr, &before);
  had_sigpipe = before.sa_handler != SIG_IGN;
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

Status finish_standard_output() {
  std::cout.flush();  // --help
  const bool failed_before = std::ferror(stdout) != 0 || !std::cout;
  errno = 0;
  if (std::fflush(stdout) == 0 && !failed_before) return Ok{};
  int code = errno;
  if (code == 0) {
    // It failed while it was printed, and why is forgotten: one more line end fails for the same reason.
    std::clearerr(stdout);
    std::fputc('\n', stdout);
    if (std::fflush(stdout) != 0) code = errno;
  }
  if (had_sigpipe && (code == EPIPE || is_closed_pipe())) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  const std::string why = code == 0 ? "" : " (" + std::generic_category().message(code) + ")";
  return Error{"standard output", 0, "", "cannot be written to the end" + why, "a place that takes it", 1};
}

}  // namespace canyon::apps
