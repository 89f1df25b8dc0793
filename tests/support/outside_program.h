#pragma once

#include <cstdio>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

namespace canyon::testing {

inline bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0;
}

/// A new directory for the files of the running test, removed with all that is in it.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::string name = ::testing::TempDir() + "canyon-XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~ScratchDirectory() {
    if (!path_.empty()) (void)!std::system(("rm -rf '" + path_ + "'").c_str());
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace canyon::testing

/// Skips the running test, by the name of the program, where it is not installed.
#define CANYON_OUTSIDE_PROGRAM(name) \
  if (!::canyon::testing::has_program(name)) GTEST_SKIP() << "program not installed: " << name
