#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/output/staged.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon {
namespace {

namespace fs = std::filesystem;
using testing::read;
using testing::TemporaryFolder;
using testing::write;

TEST(StagedDirectory, AppearsUnderItsNameOnlyWhenCommitted) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x");
  auto staged = StagedDirectory::create(path, false);
  ASSERT_TRUE(staged.ok()) << staged.error().str();
  EXPECT_EQ(staged->final_path(), path);
  EXPECT_EQ(staged->staging_path().rfind(folder.file(".x.partial-"), 0), 0U) << staged->staging_path();
  write(fs::path(staged->staging_path()) / "summary.json", "{}");
  EXPECT_FALSE(fs::exists(path));
  ASSERT_TRUE(staged->commit().ok());
  EXPECT_EQ(read(path + "/summary.json"), "{}");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(StagedDirectory, LeavesNothingWhenNotCommitted) {
  const TemporaryFolder folder;
  {
    auto staged = StagedDirectory::create(folder.file("results/deep/x"), false);
    ASSERT_TRUE(staged.ok());
    fs::create_directories(fs::path(staged->staging_path()) / "epochs");
    write(fs::path(staged->staging_path()) / "epochs" / "a.csv", "1");
    EXPECT_EQ(folder.entries(), 1);
  }
  EXPECT_EQ(folder.entries(), 0);
}

TEST(StagedDirectory, ParentsWithOtherContentStay) {
  const TemporaryFolder folder;
  {
    auto staged = StagedDirectory::create(folder.file("results/x"), false);
    ASSERT_TRUE(staged.ok());
    write(folder.path() / "results" / "notes.txt", "kept");
  }
  EXPECT_EQ(read(folder.path() / "results" / "notes.txt"), "kept");
  EXPECT_FALSE(fs::exists(folder.path() / "results" / "x"));
}

TEST(StagedDirectory, MissingParentsAreMadeAndStayAfterCommit) {
  const TemporaryFolder folder;
  auto staged = StagedDirectory::create(folder.file("a/b/x/"), false);  // with a trailing slash
  ASSERT_TRUE(staged.ok());
  ASSERT_TRUE(staged->commit().ok());
  EXPECT_TRUE(fs::is_directory(folder.path() / "a" / "b" / "x"));
}

TEST(StagedDirectory, RelativePathsWork) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  auto staged = StagedDirectory::create("x", false);
  ASSERT_TRUE(staged.ok());
  EXPECT_TRUE(staged->commit().ok());
  fs::current_path(before);
  EXPECT_TRUE(fs::is_directory(folder.path() / "x"));
}

TEST(StagedDirectory, AnExistingDirectoryNeedsForce) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x");
  fs::create_directory(path);
  write(fs::path(path) / "old.txt", "old");
  write(fs::path(path) / ".canyon", "");
  const auto refused = StagedDirectory::create(path, false);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().str(), path + ": output directory exists, expected a new one or --force");
  EXPECT_EQ(refused.error().exit_code, 2);
  EXPECT_EQ(folder.entries(), 1);

  auto forced = StagedDirectory::create(path, true);
  ASSERT_TRUE(forced.ok());
  write(fs::path(forced->staging_path()) / "new.txt", "new");
  EXPECT_EQ(read(path + "/old.txt"), "old");  // until the end
  ASSERT_TRUE(forced->commit().ok());
  EXPECT_FALSE(fs::exists(path + "/old.txt"));
  EXPECT_EQ(read(path + "/new.txt"), "new");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(StagedDirectory, ForceWithoutCommitKeepsTheOldOne) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x");
  fs::create_directory(path);
  write(fs::path(path) / "old.txt", "old");
  write(fs::path(path) / ".canyon", "");
  { ASSERT_TRUE(StagedDirectory::create(path, true).ok()); }
  EXPECT_EQ(read(path + "/old.txt"), "old");
  EXPECT_EQ(folder.entries(), 1);
}

// 2026-11-21: --out ~/Documents --force deleted whatever stood there.
TEST(StagedDirectory, ForceReplacesOnlyWhatWasCommittedOrIsEmpty) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x");
  fs::create_directory(path);
  write(fs::path(path) / "thesis.txt", "years");
  const auto refused = StagedDirectory::create(path, true);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().str(),
            path + ": not a results directory, expected one that canyon wrote, an empty one or a new name");
  EXPECT_EQ(refused.error().exit_code, 2);
  EXPECT_EQ(read(path + "/thesis.txt"), "years");
  EXPECT_EQ(folder.entries(), 1);

  const std::string own = folder.file("own");
  fs::create_directory(own);
  for (const char* text : {"first", "second"}) {  // into an empty one, and over the one just written
    auto staged = StagedDirectory::create(own, true);
    ASSERT_TRUE(staged.ok()) << staged.error().str();
    write(fs::path(staged->staging_path()) / "summary.json", text);
    ASSERT_TRUE(staged->commit().ok());
    EXPECT_EQ(read(own + "/summary.json"), text);
  }
}

TEST(StagedDirectory, AForeignOneThatAppearsMeanwhileIsNotReplacedByForce) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x");
  auto staged = StagedDirectory::create(path, true);
  ASSERT_TRUE(staged.ok());
  fs::create_directory(path);
  write(fs::path(path) / "thesis.txt", "years");
  EXPECT_EQ(staged->commit().error().str(),
            path + ": not a results directory, expected one that canyon wrote, an empty one or a new name");
  EXPECT_EQ(read(path + "/thesis.txt"), "years");
}

TEST(StagedDirectory, ForceReplacesNoFileAndNotTheCurrentDirectory) {
  const TemporaryFolder folder;
  const std::string file = folder.file("plain");
  write(file, "text");
  EXPECT_EQ(StagedDirectory::create(file, true).error().str(),
            file + ": not a directory, expected a directory to replace or a new name");
  EXPECT_EQ(read(file), "text");

  const fs::path before = fs::current_path();
  const std::string inner = folder.file("here/inner");
  fs::create_directories(inner);
  fs::current_path(inner);
  const std::string outer = folder.file("here");
  EXPECT_EQ(StagedDirectory::create(outer, true).error().str(),
            outer + ": holds the current directory, expected a directory of results to replace");
  EXPECT_FALSE(StagedDirectory::create(inner, true).ok());
  EXPECT_TRUE(StagedDirectory::create(folder.file("here/inne"), true).ok());  // a mere prefix of the name
  fs::current_path(before);
  EXPECT_TRUE(fs::exists(inner));
}

TEST(StagedDirectory, BesideOneThatAppearsMeanwhile) {
  const TemporaryFolder folder;
  const std::string path = folder.file("x");
  {
    auto staged = StagedDirectory::create(path, false);
    ASSERT_TRUE(staged.ok());
    fs::create_directory(path);
    fs::create_directory(path + "-2");
    EXPECT_TRUE(staged->commit().ok());
    EXPECT_EQ(staged->final_path(), path + "-3");
  }
  EXPECT_TRUE(fs::is_empty(path));
  EXPECT_TRUE(fs::exists(path + "-3/.canyon"));
  EXPECT_EQ(folder.entries(), 3);
}

TEST(StagedDirectory, AParentThatIsAFileIsNotWritable) {
  const TemporaryFolder folder;
  write(folder.path() / "file", "text");
  const std::string path = folder.file("file/results/x");
  const auto refused = StagedDirectory::create(path, false);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().str(),
            path + ": not writable (Not a directory), expected a place where a directory can be created");
  EXPECT_EQ(refused.error().exit_code, 2);
  EXPECT_EQ(folder.entries(), 1);
}

/// Drops the rights of root, if we have them, for as long as it lives.
class OrdinaryUser {
 public:
  OrdinaryUser() {
    if (geteuid() == 0) changed_ = seteuid(65534) == 0;
  }
  ~OrdinaryUser() { EXPECT_TRUE(!changed_ || seteuid(0) == 0); }
  OrdinaryUser(const OrdinaryUser&) = delete;
  OrdinaryUser& operator=(const OrdinaryUser&) = delete;
  bool changed() const { return changed_; }

 private:
  bool changed_ = false;
};

TEST(StagedDirectory, AFolderWithoutWritePermissionIsRefused) {
  const TemporaryFolder folder;
  const fs::path locked = folder.path() / "locked";
  fs::create_directory(locked);
  fs::permissions(locked,
                  fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
  {
    const OrdinaryUser user;
    if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere and could not become an ordinary user";
    for (const char* name : {"x", "deep/x"}) {
      const std::string path = (locked / name).string();
      const auto refused = StagedDirectory::create(path, false);
      ASSERT_FALSE(refused.ok());
      EXPECT_EQ(refused.error().str(),
                path + ": not writable (Permission denied), expected a place where a directory can be created");
    }
  }
  fs::permissions(locked, fs::perms::owner_all);
  EXPECT_TRUE(fs::is_empty(locked));
}

TEST(StagedDirectory, APathWithoutANameIsRefused) {
  for (const char* path : {"", ".", "..", "/"}) {
    const auto refused = StagedDirectory::create(path, true);
    ASSERT_FALSE(refused.ok()) << path;
    EXPECT_EQ(refused.error().what, "not a name for an output directory") << path;
  }
}

TEST(StagedDirectory, MovingPassesTheDutyToCleanUp) {
  const TemporaryFolder folder;
  {
    auto staged = StagedDirectory::create(folder.file("x"), false);
    ASSERT_TRUE(staged.ok());
    StagedDirectory moved = *std::move(staged);
    EXPECT_TRUE(fs::exists(moved.staging_path()));
    EXPECT_TRUE(moved.commit().ok());
  }
  EXPECT_TRUE(fs::exists(folder.file("x")));
}

}  // namespace
}  // namespace canyon
