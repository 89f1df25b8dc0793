#include <filesystem>
#include <system_error>
#include <utility>

#include "canyon/core/files/files.h"
#include "canyon/core/output/disk.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/output/staging_name.h"
#include "canyon/core/process/staging_litter.h"

namespace canyon {
namespace {

namespace fs = std::filesystem;

Error directory_error(const std::string& path, std::string what, std::string expected, int exit_code = 2) {
  return Error{path, 0, "", std::move(what), std::move(expected), exit_code};
}

Error not_writable(const std::string& path, const std::error_code& code) {
  return directory_error(path, "not writable (" + code.message() + ")", "a place where a directory can be created");
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

}  // namespace

std::string free_name(const std::string& path) {
  std::string name = path;
  std::error_code code;
  for (int n = 2; fs::exists(fs::symlink_status(name, code)); ++n) name = path + "-" + std::to_string(n);
  return name;
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
      remove_empty_directories(created);
      return not_writable(path, code);
    }
    created.push_back(fs::absolute(*it, code).string());
  }
  remove_stale_stagings(final_path.parent_path());
  const fs::path staging = staging_name(final_path, "partial");
  if (!fs::create_directory(staging, code)) {
    remove_empty_directories(created);
    return not_writable(path, code);
  }
  return StagedDirectory(final_path.string(), staging.string(), force, std::move(created));
}

Status StagedDirectory::seal() {
  CANYON_CHECK(!staging_path().empty(), "committed twice: ", final_path());
  CANYON_TRY_STATUS(
      write_text_file(staging_path() + "/" + kMarker, "written by canyon; --force may replace this directory\n"));
  if (const auto code = sync_tree(staging_path()))
    return directory_error(final_path(), "cannot be written to the end (" + code.message() + ")", "space on the disk",
                           1);
  return Ok{};
}

Status StagedDirectory::check_replaced() const {
  if (!may_be_replaced(final_path())) return not_ours(final_path());
  return Ok{};
}

std::string StagedDirectory::next_free_name() const {
  return free_name(final_path());
}

}  // namespace canyon
