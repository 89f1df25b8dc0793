#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/progress.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon {
namespace {

namespace fs = std::filesystem;
using testing::read;
using testing::TemporaryFolder;
using testing::write;

TEST(StagedFile, AppearsOnlyWhenCommitted) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x.csv");
  {
    auto file = StagedFile::create(path, false);
    ASSERT_TRUE(file.ok()) << file.error().str();
    ASSERT_TRUE(file->write("a").ok());
    EXPECT_FALSE(fs::exists(path));
  }
  EXPECT_EQ(folder.entries(), 0);
  auto file = StagedFile::create(path, false);
  ASSERT_TRUE(file->write("a").ok());
  ASSERT_TRUE(file->write(std::string(3 << 20, 'b')).ok());
  ASSERT_TRUE(file->commit().ok());
  EXPECT_EQ(read(path), "a" + std::string(3 << 20, 'b'));
  EXPECT_EQ(folder.entries(), 1);
}

// 2026-11-22: outputs of one file replaced what stood there without being asked.
TEST(StagedFile, AnExistingOneNeedsForceAndKeepsItsRights) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x.csv");
  write(path, "old");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  const auto refused = StagedFile::create(path, false);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().str(), path + ": output file exists, expected a new name or --force");
  EXPECT_EQ(refused.error().exit_code, 2);
  auto forced = StagedFile::create(path, true);
  ASSERT_TRUE(forced->write("new").ok());
  EXPECT_EQ(read(path), "old");
  ASSERT_TRUE(forced->commit().ok());
  EXPECT_EQ(read(path), "new");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(folder.entries(), 1);
}

TEST(StagedFile, AnotherOfItsNameThatAppearsMeanwhileStays) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x.csv");
  auto file = StagedFile::create(path, false);
  ASSERT_TRUE(file->write("ours").ok());
  write(path, "theirs");
  ASSERT_TRUE(file->commit().ok());
  EXPECT_EQ(read(path), "theirs");
  EXPECT_EQ(file->final_path(), folder.file("x-2.csv"));
  EXPECT_EQ(read(folder.file("x-2.csv")), "ours");
}

TEST(StagedFile, ALinksTargetIsReplacedAndNotTheLink) {
  const TemporaryFolder folder;
  write(folder.file("target"), "old");
  fs::create_symlink("target", folder.file("link"));
  auto file = StagedFile::create(folder.file("link"), true);
  ASSERT_TRUE(file->write("new").ok());
  ASSERT_TRUE(file->commit().ok());
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
  EXPECT_EQ(read(folder.file("target")), "new");
}

TEST(StagedFile, DevicesAreWrittenStraightTo) {
  auto nothing = StagedFile::create("/dev/null", false);
  ASSERT_TRUE(nothing.ok()) << nothing.error().str();
  ASSERT_TRUE(nothing->write("x").ok());
  ASSERT_TRUE(nothing->commit().ok());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  auto full = StagedFile::create("/dev/full", false);
  ASSERT_TRUE(full->write("x").ok());  // held back
  const auto failed = full->commit();
  ASSERT_FALSE(failed.ok());
  EXPECT_EQ(failed.error().str(),
            "/dev/full: cannot be written to the end (No space left on device), expected space on the disk");
  EXPECT_EQ(failed.error().exit_code, 1);
}

TEST(StagedFile, MistakesWordForWord) {
  const TemporaryFolder folder;
  const std::string nowhere = folder.file("no/folder.txt");
  EXPECT_EQ(StagedFile::create(nowhere, false).error().str(),
            nowhere + ": cannot be written (No such file or directory), expected a writable place");
  EXPECT_EQ(StagedFile::create(folder.path().string(), true).error().str(),
            folder.path().string() + ": is a directory, expected the path of a file to write");
}

/// Files of this process cannot grow beyond `bytes` for as long as it lives: a full disk, for root too.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FullDisk() {
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &before_), 0);
    std::signal(SIGXFSZ, SIG_DFL);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

// 2026-11-22: on a full disk half a file stood under the final name, and the old one was gone.
TEST(StagedFile, OnAFullDiskTheOldOneStaysWhole) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x.csv");
  write(path, "old");
  {
    auto file = StagedFile::create(path, true);
    ASSERT_TRUE(file.ok());
    const FullDisk full(100'000);
    ASSERT_TRUE(file->write(std::string(200'000, 'x')).ok());  // held back
    const auto failed = file->commit();
    ASSERT_FALSE(failed.ok());
    EXPECT_EQ(failed.error().str(),
              path + ": cannot be written to the end (File too large), expected space on the disk");
    EXPECT_EQ(failed.error().exit_code, 1);
  }
  EXPECT_EQ(read(path), "old");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(OutputSet, AllOrNone) {
  const TemporaryFolder folder;
  write(folder.file("a"), "old a");
  {
    OutputSet outputs(true);
    auto directory = outputs.directory(folder.file("d"));
    auto a = outputs.file(folder.file("a"));
    auto b = outputs.file(folder.file("b"));
    ASSERT_TRUE(directory.ok() && a.ok() && b.ok());
    ASSERT_TRUE((*a)->write("new a").ok());
    ASSERT_TRUE((*b)->write("new b").ok());
    fs::create_directory(folder.file("d"));
    write(folder.file("d/thesis.txt"), "years");  // makes the last of them fail
    const auto failed = outputs.commit();
    ASSERT_FALSE(failed.ok());
    EXPECT_EQ(failed.error().file, folder.file("d"));
  }
  EXPECT_EQ(read(folder.file("a")), "old a");
  EXPECT_FALSE(fs::exists(folder.file("b")));
  EXPECT_EQ(read(folder.file("d/thesis.txt")), "years");
  EXPECT_EQ(folder.entries(), 2);
}

TEST(OutputSet, FilesMayLieInTheDirectoryOfTheSameCommand) {
  const TemporaryFolder folder;
  for (const bool again : {false, true}) {
    OutputSet outputs(again);
    auto directory = outputs.directory(folder.file("d"));
    auto inside = outputs.file(folder.file("d/logs/log.nmea"));
    ASSERT_TRUE(directory.ok() && inside.ok());
    ASSERT_TRUE((*inside)->write("$GPGGA").ok());
    write((*directory)->staging_path() + "/fixes.csv", "t");
    ASSERT_TRUE(outputs.commit().ok());
    EXPECT_EQ(read(folder.file("d/logs/log.nmea")), "$GPGGA");
    EXPECT_EQ(read(folder.file("d/fixes.csv")), "t");
    EXPECT_EQ(folder.entries(), 1);
  }
}

TEST(OutputSet, TwoOutputsOfOneNameAreRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x");
  OutputSet outputs(false);
  ASSERT_TRUE(outputs.file(path).ok());
  EXPECT_EQ(outputs.file(folder.file("./x")).error().what, "named for two outputs");
  EXPECT_EQ(*outputs.file(""), nullptr);
  EXPECT_TRUE(outputs.file("/dev/null").ok());
  EXPECT_TRUE(outputs.file("/dev/null").ok());
}

TEST(OutputSet, AnInterruptionBeforeTheNamesAreGivenLeavesNothing) {
  const TemporaryFolder folder;
  {
    OutputSet outputs(false);
    ASSERT_TRUE(outputs.file(folder.file("x")).ok());
    ASSERT_TRUE(outputs.directory(folder.file("d")).ok());
    set_cancel_requested(true);
    EXPECT_THROW((void)outputs.commit(), Cancelled);
    set_cancel_requested(false);
  }
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace canyon
