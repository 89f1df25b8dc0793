#include <filesystem>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "core/files.h"

namespace canyon {
namespace {

namespace fs = std::filesystem;

Error directory_error(const std::string& path, std::string what, std::string expected, int exit_code = 2) {
  Error error;
  error.file = path;
  error.what = std::move(what);
  error.expected = std::move(expected);
  error.exit_code = exit_code;
  return error;
}

Error not_writable(const std::string& path, const std::error_code& code) {
  return directory_error(path, "not writable (" + code.message() + ")", "a place where a directory can be created");
}

/// The nearest sibling name: renaming stays within one file system.
fs::path sibling(const fs::path& path, const char* role) {
  return path.parent_path() / ("." + path.filename().string() + "." + role + "-" + std::to_string(getpid()));
}

/// Stands in every directory that commit() has put in place; only such a one is ever replaced.
constexpr const char* kMarker = ".canyon";

bool may_be_replaced(const fs::path& directory) {
  std::error_code code;
  return fs::is_empty(directory, code) || fs::is_regular_file(directory / kMarker, code);
}

Error not_ours(const std::string& path) {
  return directory_error(path, "not a results directory", "one that canyon wrote, an empty one or a new name");
}

/// Removes empty directories from the innermost on; one that has got other content meanwhile stays.
void remove_empty(const std::vector<std::string>& outermost_first) {
  std::error_code ignored;
  for (auto it = outermost_first.rbegin(); it != outermost_first.rend(); ++it) fs::remove(*it, ignored);
}

}  // namespace

std::string free_name(const std::string& path) {
  std::string name = path;
  std::error_code code;
  for (int n = 2; fs::exists(fs::symlink_status(name, code)); ++n) name = path + "-" + std::to_string(n);
  return name;
}

StagedDirectory::StagedDirectory(std::string final_path, std::string staging, bool force,
                                 std::vector<std::string> parents)
    : final_(std::move(final_path)),
      staging_(std::move(staging)),
      force_(force),
      created_parents_(std::move(parents)) {}

StagedDirectory::StagedDirectory(StagedDirectory&& other) noexcept
    : final_(std::move(other.final_)),
      staging_(std::exchange(other.staging_, {})),
      force_(other.force_),
      created_parents_(std::exchange(other.created_parents_, {})) {}

StagedDirectory::~StagedDirectory() {
  if (staging_.empty()) return;
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  remove_empty(created_parents_);
}

Result<StagedDirectory> StagedDirectory::create(const std::string& path, bool force) {
  std::error_code code;
  fs::path final_path = fs::path(path).lexically_normal();
  if (!final_path.has_filename()) final_path = final_path.parent_path();  // a trailing slash
  const std::string name = final_path.filename().string();
  if (name.empty() || name == "." || name == "..") {
    return directory_error(path, "not a name for an output directory", "the path of a directory to create");
  }
  const fs::file_status status = fs::symlink_status(final_path, code);
  if (fs::exists(status)) {
    if (!force) return directory_error(path, "output directory exists", "a new one or --force");
    if (!fs::is_directory(status))
      return directory_error(path, "not a directory", "a directory to replace or a new name");
    // Replacing the directory we stand in, or one around it, is never what was meant.
    const std::string here = fs::current_path(code).string() + "/";
    const std::string target = fs::canonical(final_path, code).string() + "/";
    if (code || here.compare(0, target.size(), target) == 0) {
      return directory_error(path, "holds the current directory", "a directory of results to replace");
    }
    if (!may_be_replaced(final_path)) return not_ours(path);
  }

  std::vector<std::string> missing;  // innermost first
  for (fs::path parent = final_path.parent_path(); !parent.empty() && !fs::exists(parent, code);
       parent = parent.parent_path()) {
    missing.push_back(parent.string());
  }
  std::vector<std::string> created;
  for (auto it = missing.rbegin(); it != missing.rend(); ++it) {
    if (!fs::create_directory(*it, code) && code) {
      remove_empty(created);
      return not_writable(path, code);
    }
    created.push_back(*it);
  }
  const fs::path staging = sibling(final_path, "partial");
  fs::remove_all(staging, code);  // left by a process of the same number that was killed
  if (!fs::create_directory(staging, code)) {
    remove_empty(created);
    return not_writable(path, code);
  }
  return StagedDirectory(final_path.string(), staging.string(), force, std::move(created));
}

Status StagedDirectory::commit() {
  CANYON_CHECK(!staging_.empty(), "committed twice: ", final_);
  std::error_code code;
  if (!force_) final_ = free_name(final_);
  const bool replace = fs::exists(fs::symlink_status(final_, code));
  if (replace && !may_be_replaced(final_)) return not_ours(final_);
  CANYON_TRY_STATUS(
      write_text_file(staging_ + "/" + kMarker, "written by canyon; --force may replace this directory\n"));
  const fs::path old = sibling(final_, "replaced");
  if (replace) {
    fs::rename(final_, old, code);
    if (code) return directory_error(final_, "cannot be replaced (" + code.message() + ")", "a writable directory", 1);
  }
  fs::rename(staging_, final_, code);
  if (code) {
    std::error_code ignored;
    if (replace) fs::rename(old, final_, ignored);
    return directory_error(final_, "cannot be put in place (" + code.message() + ")", "a writable directory", 1);
  }
  staging_.clear();
  created_parents_.clear();
  if (replace) fs::remove_all(old, code);
  return Ok{};
}

}  // namespace canyon
