#include "canyon/core/output/disk.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "canyon/core/process/progress.h"

namespace canyon {
namespace {

namespace fs = std::filesystem;

/// One fsync takes some milliseconds; of more files than these the whole file system's is the shorter way.
constexpr std::size_t kOneByOne = 200;

std::error_code last_error() {
  return {errno, std::generic_category()};
}

/// Special files and some network file systems cannot be synced; that is no loss of ours.
bool is_unsupported(int code) {
  return code == EINVAL || code == ENOTSUP || code == ENOSYS || code == EROFS;
}

struct Descriptor {
  explicit Descriptor(const fs::path& path) : number(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number >= 0) close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number;
};

std::error_code renamed(const std::string& from, const std::string& to, unsigned flags) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags) == 0) return {};
  return last_error();
}

bool cannot(const std::error_code& code) {
  return is_unsupported(code.value()) || code == std::errc::not_supported;
}

}  // namespace

std::error_code sync_file(int descriptor) {
  if (fsync(descriptor) == 0 || is_unsupported(errno)) return {};
  return last_error();
}

std::error_code sync_tree(const std::string& directory) {
  std::error_code code;
  std::vector<fs::path> all{directory};
  for (fs::recursive_directory_iterator it(directory, code), end; !code && it != end; it.increment(code))
    if (it->is_regular_file(code) || it->is_directory(code)) all.push_back(it->path());
  if (code) return code;
  if (all.size() > kOneByOne) {
    throw_if_cancelled();
    const Descriptor top(directory);
    if (top.number < 0) return last_error();
    return syncfs(top.number) == 0 || is_unsupported(errno) ? std::error_code() : last_error();
  }
  for (const fs::path& path : all) {
    throw_if_cancelled();
    const Descriptor file(path);
    if (file.number < 0) return last_error();
    if (const auto failed = sync_file(file.number)) return failed;
  }
  return {};
}

void sync_names_beside(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  const Descriptor open_folder(folder.empty() ? fs::path(".") : folder);
  if (open_folder.number >= 0) (void)sync_file(open_folder.number);  // the content is safe; only its name could be late
}

std::error_code rename_to_new(const std::string& from, const std::string& to) {
  const std::error_code code = renamed(from, to, RENAME_NOREPLACE);
  if (!cannot(code)) return code;
  std::error_code plain;
  if (fs::exists(fs::symlink_status(to, plain))) return std::make_error_code(std::errc::file_exists);
  fs::rename(from, to, plain);
  return plain;
}

std::error_code exchange_names(const std::string& a, const std::string& b) {
  const std::error_code code = renamed(a, b, RENAME_EXCHANGE);
  return cannot(code) ? std::make_error_code(std::errc::not_supported) : code;
}

}  // namespace canyon
