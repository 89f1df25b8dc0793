#include "canyon/core/process/staging_litter.h"

#include <atomic>
#include <csignal>
#include <filesystem>
#include <map>
#include <set>

#include <sys/wait.h>

namespace canyon {
namespace {

namespace fs = std::filesystem;

/// Never destroyed: an interruption may come while the program's other statics already are.
struct Litter {
  std::mutex mutex;
  struct Output {
    std::string absolute;  ///< the process may change its folder
    std::vector<std::string> parents;
  };
  std::map<std::string, Output> outputs;  ///< by the path as given
  std::set<pid_t> processes;
  std::atomic<bool> committed{false};
};
Litter& litter() {
  static Litter& only = *new Litter;
  return only;
}

}  // namespace

void add_litter(const std::string& path, const std::vector<std::string>& created_parents) {
  std::error_code code;
  const fs::path absolute = fs::absolute(path, code);
  const std::lock_guard lock(litter().mutex);
  litter().outputs[path] = {code ? path : absolute.string(), created_parents};
}

void forget_litter(const std::string& path) {
  const std::lock_guard lock(litter().mutex);
  litter().outputs.erase(path);
}

void add_litter_process(int process) {
  litter().processes.insert(process);
}
void forget_litter_process(int process) {
  litter().processes.erase(process);
}

std::unique_lock<std::mutex> hold_litter() {
  return std::unique_lock(litter().mutex);
}

void note_committed() {
  litter().committed = true;
}
bool anything_committed() {
  return litter().committed;
}

void remove_litter_for_good() {
  litter().mutex.lock();  // and never unlocked
  for (const pid_t process : litter().processes) kill(-process, SIGKILL);
  for (const pid_t process : litter().processes) waitpid(process, nullptr, 0);  // another thread may have been first
  for (const auto& [name, output] : litter().outputs) {
    const std::string& path = output.absolute;
    std::error_code ignored;
    // Once it has another name, a thread that still writes finds the folder gone and adds nothing to it.
    const std::string doomed = path + "-interrupted";
    fs::rename(path, doomed, ignored);
    fs::remove_all(ignored ? path : doomed, ignored);
    remove_empty_directories(output.parents);
  }
}

void remove_empty_directories(const std::vector<std::string>& outermost_first) {
  std::error_code ignored;
  for (auto it = outermost_first.rbegin(); it != outermost_first.rend(); ++it) fs::remove(*it, ignored);
}

}  // namespace canyon
