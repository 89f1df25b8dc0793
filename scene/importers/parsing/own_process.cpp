#include "canyon/scene/importers/parsing/own_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"

namespace canyon::scene {
namespace {

constexpr char kBytes = 'b', kError = 'e';

void write_all(int to, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(to, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno != EINTR) _exit(1);  // nobody reads any more
    if (n > 0) done += static_cast<std::size_t>(n);
  }
}

/// An error as text: its parts, each after its length.
std::string packed(const Error& error) {
  std::string out(1, kError);
  for (const std::string& part : {error.file, std::to_string(error.line), error.what, error.expected})
    out += std::to_string(part.size()) + ":" + part;
  return out;
}

Error unpacked(const std::string& text) {
  std::array<std::string, 4> parts;
  std::size_t at = 1;
  for (std::string& part : parts) {
    const std::size_t colon = text.find(':', at), size = std::stoul(text.substr(at, colon - at));
    part = text.substr(colon + 1, size);
    at = colon + 1 + size;
  }
  return Error{.file = parts[0], .line = std::stoi(parts[1]), .what = parts[2], .expected = parts[3]};
}

[[noreturn]] void run(int to, const std::string& file, const std::function<Result<std::string>()>& work) {
  // Ctrl-C is the parent's to answer, which then ends this process.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);
  for (const int fault : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) std::signal(fault, SIG_DFL);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  if (const int quiet = open("/dev/null", O_WRONLY); quiet >= 0) {
    dup2(quiet, STDOUT_FILENO);
    dup2(quiet, STDERR_FILENO);
  }
  try {
    const Result<std::string> made = work();
    write_all(to, made.ok() ? kBytes + *made : packed(made.error()));
  } catch (const std::exception& error) {
    write_all(to, packed({.file = file, .what = std::string("cannot be read (") + error.what() + ")"}));
  }
  _exit(0);
}

/// Ends the process when it goes out of sight, however that happens.
class Child {
 public:
  Child(pid_t pid, int from) : pid_(pid), from_(from) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    close(from_);
    if (pid_ == 0) return;
    kill(pid_, SIGKILL);
    wait();
  }
  /// All that it writes, until its end.
  std::string read_all() const {
    std::string out;
    std::array<char, 1 << 16> buffer;
    while (true) {
      throw_if_cancelled();
      pollfd ready{from_, POLLIN, 0};
      if (poll(&ready, 1, 50) <= 0) continue;  // 50 ms, or a signal: whether the user asked to stop
      const ssize_t n = read(from_, buffer.data(), buffer.size());
      if (n == 0) return out;
      if (n > 0) out.append(buffer.data(), static_cast<std::size_t>(n));
    }
  }
  int wait() {
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) continue;
    pid_ = 0;
    return status;
  }

 private:
  pid_t pid_;
  int from_;
};

}  // namespace

Result<std::string> in_a_process_of_its_own(const std::string& file, const std::function<Result<std::string>()>& work) {
  int ends[2];
  CANYON_CHECK(pipe2(ends, O_CLOEXEC) == 0, "pipe2: ", std::strerror(errno));
  const pid_t pid = fork();
  CANYON_CHECK(pid >= 0, "fork: ", std::strerror(errno));
  if (pid == 0) {
    close(ends[0]);
    run(ends[1], file, work);
  }
  close(ends[1]);
  Child child(pid, ends[0]);
  std::string answer = child.read_all();
  const int status = child.wait();
  if (WIFSIGNALED(status) || answer.empty()) {
    const std::string how = WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "no answer";
    return Error{.file = file,
                 .what = "cannot be read (the library for such files failed on it: " + how + ")",
                 .expected = "an undamaged file"};
  }
  if (answer.front() == kError) return unpacked(answer);
  return answer.substr(1);
}

}  // namespace canyon::scene
