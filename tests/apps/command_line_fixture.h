#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace canyon::apps::testing {

/// Four seconds of driving.
inline constexpr const char* kMission = R"(base = "vicksburg"
[time]
limit_s = 4.0
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[registration]
method = "none"
[autonomy]
[[autonomy.waypoint]]
name = "house"
p_m = [213.9, 150.0]
observe = "building 273"
)";

/// Calls the binary as a user does, in a folder of its own.
class CommandLineTest : public ::testing::Test {
 protected:
  void SetUp() override {
    // A number that comes again would find what a killed process of that number has left.
    std::string name = (std::filesystem::path(::testing::TempDir()) / "canyon-cli-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr) << name;
    folder_ = name;
    write("mission.toml", kMission);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  std::string read(const std::string& name) const {
    std::ostringstream out;
    out << std::ifstream(path(name)).rdbuf();
    return out.str();
  }
  /// Runs canyon in the test's folder; returns the exit status. stdout and stderr go to files of those names.
  int canyon(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() + "' && '" CANYON_BINARY "' " + arguments + " > '" +
                                path("stdout") + "' 2> '" + path("stderr") + "'";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// Names in the folder, but for the test's own files: what a failed call must not have left.
  std::vector<std::string> leftovers() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name != "stdout" && name != "stderr" && entry.path().extension() != ".toml" && name.rfind("given", 0) != 0)
        names.push_back(name);
    }
    return names;
  }
  /// A mistake: one line, exit 2, nothing written.
  void expect_mistake(const std::string& arguments, const std::string& line) const {
    EXPECT_EQ(canyon(arguments), 2) << arguments;
    const std::string message = read("stderr");
    EXPECT_THAT(message, ::testing::HasSubstr(line));
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
    EXPECT_THAT(leftovers(), ::testing::IsEmpty());
  }

  std::filesystem::path folder_;
};

}  // namespace canyon::apps::testing
