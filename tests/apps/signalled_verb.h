#pragma once

#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace canyon::apps::testing {

/// How a verb ended that was told to.
struct SignalledEnd {
  int status = -1;                ///< exit status; -1: it was killed
  bool ended_before = false;      ///< it was done before the signal came
  double cpu_after_signal_s = 0;  ///< of all its threads: unlike wall time the same on a busy machine
};

/// Processor time a process has used so far, s.
inline double cpu_s(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::ostringstream all;
  all << file.rdbuf();
  const std::string text = all.str();
  std::istringstream rest(text.substr(text.rfind(')') + 1));
  std::string word;
  double user = 0.0, system = 0.0;
  for (int field = 3; field <= 15 && rest >> word; ++field) {
    if (field == 14) user = std::stod(word);
    if (field == 15) system = std::stod(word);
  }
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Runs the binary in `folder` and sends it `signal` once it has used `cpu_before_s` of processor time.
inline SignalledEnd signal_verb(const std::string& folder, std::vector<std::string> words, double cpu_before_s,
                                int signal) {
  std::string binary = CANYON_BINARY;
  const pid_t pid = fork();
  if (pid == 0) {
    std::vector<char*> arguments{binary.data()};
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int sink = open("/dev/null", O_WRONLY);
    const int errors = open((folder + "/stderr").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (chdir(folder.c_str()) != 0 || dup2(sink, 1) < 0 || dup2(errors, 2) < 0) _exit(99);
    execv(arguments[0], arguments.data());
    _exit(99);
  }
  SignalledEnd out;
  int status = 0;
  rusage usage{};
  while (cpu_s(pid) < cpu_before_s) {
    if (wait4(pid, &status, WNOHANG, &usage) == pid) {
      out.ended_before = true;
      out.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
      return out;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const double before_s = cpu_s(pid);
  kill(pid, signal);
  wait4(pid, &status, 0, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  out.cpu_after_signal_s = seconds(usage.ru_utime) + seconds(usage.ru_stime) - before_s;
  out.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return out;
}

}  // namespace canyon::apps::testing
