#include "canyon/tests/report/browser.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "canyon/tests/report/synthetic_results.h"
#include "canyon/tests/report/temporary_directory.h"

namespace canyon::testing {
namespace {

std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string find_chromium() {
  namespace fs = std::filesystem;
  if (const char* chosen = std::getenv("CANYON_CHROMIUM")) return chosen;
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
      const std::string candidate = (fs::path(folder) / name).string();
      if (access(candidate.c_str(), X_OK) == 0) return candidate;
    }
  }
  return {};
}

BrowserVisit visit_page(const std::string& chromium, const std::string& html_file) {
  const TemporaryDirectory folder;
  const std::string dom = folder.file("dom.html"), log = folder.file("log.txt");
  const std::string command =
      "timeout -k 5 120 " + quoted(chromium) +
      " --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking"
      " --disable-component-update --disable-sync --disable-dev-shm-usage --enable-logging=stderr --v=0"
      " --host-resolver-rules='MAP * ~NOTFOUND' --user-data-dir=" +
      quoted(folder.file("profile")) + " --dump-dom " +
      quoted("file://" + std::filesystem::absolute(html_file).string()) + " >" + quoted(dom) + " 2>" + quoted(log);
  BrowserVisit visit;
  const int status = std::system(command.c_str());
  visit.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  visit.dom = load(dom);
  // [pid:tid:date/time:LEVEL:CONSOLE:line] "message", source: ... - older versions write CONSOLE(line).
  std::istringstream lines(load(log));
  for (std::string line; std::getline(lines, line);) {
    if (line.find(":CONSOLE") != std::string::npos) visit.console.push_back(line);
  }
  return visit;
}

}  // namespace canyon::testing
