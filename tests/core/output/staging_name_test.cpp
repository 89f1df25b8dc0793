#include "canyon/core/output/staging_name.h"
#include "canyon/core/output/staged.h"

#include <sys/wait.h>

#include <array>
#include <csignal>
#include <fstream>
#include <set>

#include <unistd.h>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon {
namespace {

namespace fs = std::filesystem;
using canyon::testing::TemporaryFolder;

/// The staging directory that a process had that was killed.
std::string left_by_a_killed_process(const std::string& path, pid_t* number = nullptr) {
  std::array<int, 2> told{};
  EXPECT_EQ(pipe(told.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    auto staged = StagedDirectory::create(path, false);
    const std::string name = staged.ok() ? staged->staging_path() : "";
    (void)!::write(told[1], name.data(), name.size());
    close(told[1]);
    pause();
    _exit(0);
  }
  close(told[1]);
  std::string name;
  for (char c = 0; ::read(told[0], &c, 1) == 1;) name += c;
  close(told[0]);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  if (number != nullptr) *number = child;
  EXPECT_TRUE(fs::is_directory(name)) << name;
  return name;
}

TEST(StagingName, NoTwoAreEqualAndNoneIsTooLong) {
  std::set<std::string> names;
  for (int i = 0; i < 100; ++i) names.insert(staging_name("/a/x", "partial").string());
  EXPECT_EQ(names.size(), 100U);
  const std::string longest(255, 'n');
  EXPECT_LE(staging_name("/a/" + longest, "partial").filename().string().size(), 255U);
  EXPECT_EQ(staging_name("/a/" + longest, "partial").parent_path(), "/a");
}

// 2026-11-22: what a killed run had staged stayed for ever, since every run's output has another name.
TEST(StagingName, WhatAKilledProcessLeftIsTakenAway) {
  const TemporaryFolder folder;
  const std::string left = left_by_a_killed_process(folder.file("x"));
  EXPECT_TRUE(is_stale_staging_name(fs::path(left).filename().string()));
  auto other = StagedFile::create(folder.file("another.csv"), false);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_EQ(folder.entries(), 1);
}

// 2026-11-22: on a shared disk another host's process of the same number lost what it was writing.
TEST(StagingName, OfALivingOrAnotherHostsProcessNothingIsTaken) {
  const TemporaryFolder folder;
  const auto own = StagedDirectory::create(folder.file("x"), false);
  pid_t dead = 0;
  const std::string left = fs::path(left_by_a_killed_process(folder.file("y"), &dead)).filename().string();
  // The same name with another realm: another boot, host or container.
  const std::size_t pid_at = left.rfind("-" + std::to_string(dead) + "-");
  ASSERT_NE(pid_at, std::string::npos);
  std::string foreign = left;
  foreign[pid_at - 1] = foreign[pid_at - 1] == '0' ? '1' : '0';
  EXPECT_FALSE(is_stale_staging_name(foreign));
  // Names that only look alike.
  for (const std::string name : {".x.partial-12345", "x.partial-a-0123456789abcdef-1-1-1", ".x.partial-a-b-1-1-1",
                                 ".x.partial-a-0123456789abcdef-1-1-z", ".partial-", ".x.partial-----"})
    EXPECT_FALSE(is_stale_staging_name(name)) << name;
  fs::create_directory(folder.path() / foreign);
  std::ofstream(folder.path() / ".x.partial-12345") << "the old way";
  remove_stale_stagings(folder.path());
  EXPECT_TRUE(fs::exists(folder.path() / foreign));
  EXPECT_TRUE(fs::exists(own->staging_path()));
  EXPECT_FALSE(fs::exists(folder.path() / left));
  EXPECT_EQ(folder.entries(), 3);
}

TEST(StagingName, ANumberThatAnotherProcessHasNowIsProvenByItsStart) {
  const std::string own = staging_name("x", "partial").filename().string();
  EXPECT_FALSE(is_stale_staging_name(own));
  // Ours but for the start: an earlier process of our number.
  const std::size_t count_at = own.rfind('-'), start_at = own.rfind('-', count_at - 1);
  const std::string earlier = own.substr(0, start_at) + "-1" + own.substr(count_at);
  EXPECT_TRUE(is_stale_staging_name(earlier));
}

TEST(StagingName, TheOnlyCopyOfWhatWasToBeReplacedStays) {
  const TemporaryFolder folder;
  const std::string own = staging_name(folder.file("x"), "replaced").string();
  const std::size_t count_at = own.rfind('-'), start_at = own.rfind('-', count_at - 1);
  const std::string dead = own.substr(0, start_at) + "-1" + own.substr(count_at);
  std::ofstream(dead) << "old";
  remove_stale_stagings(folder.path());
  EXPECT_TRUE(fs::exists(dead));
  std::ofstream(folder.file("x")) << "new";
  remove_stale_stagings(folder.path());
  EXPECT_FALSE(fs::exists(dead));
}

}  // namespace
}  // namespace canyon
