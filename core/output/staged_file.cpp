#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "canyon/core/files/files.h"
#include "canyon/core/output/disk.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/output/staging_name.h"

namespace canyon {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBuffer = std::size_t{1} << 20;

Error file_error(const std::string& path, std::string what, std::string expected, int exit_code = 2) {
  return Error{path, 0, "", std::move(what), std::move(expected), exit_code};
}

std::string last_error_text() {
  return std::generic_category().message(errno);
}

/// What a chain of links leads to; the path itself if it is none.
fs::path target_of(fs::path path) {
  std::error_code code;
  for (int hop = 0; hop < 40 && fs::is_symlink(fs::symlink_status(path, code)); ++hop) {
    const fs::path next = fs::read_symlink(path, code);
    if (code) break;
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return path;
}

bool is_standard_output(const struct stat& file) {
  struct stat own = {};
  return fstat(STDOUT_FILENO, &own) == 0 && own.st_dev == file.st_dev && own.st_ino == file.st_ino;
}

}  // namespace

std::string free_file_name(const std::string& path) {
  const fs::path file(path);
  std::string name = path;
  std::error_code code;
  for (int n = 2; fs::exists(fs::symlink_status(name, code)); ++n) {
    fs::path next = file;
    next.replace_filename(file.stem().string() + "-" + std::to_string(n) + file.extension().string());
    name = next.string();
  }
  return name;
}

StagedFile::StagedFile(std::string final_path, std::string staging, bool force, int descriptor)
    : Staged(std::move(final_path), std::move(staging), force, {}), descriptor_(descriptor) {}

StagedFile::StagedFile(StagedFile&& other) noexcept
    : Staged(std::move(other)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      buffer_(std::exchange(other.buffer_, {})) {}

StagedFile::~StagedFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<StagedFile> StagedFile::straight_to(const std::string& path, int descriptor) {
  if (descriptor < 0) return file_error(path, "cannot be written (" + last_error_text() + ")", "a writable place");
  return StagedFile(path, "", false, descriptor);
}

Result<StagedFile> StagedFile::create(const std::string& path, bool force) {
  const fs::path target = target_of(path);
  const std::string name = target.filename().string();
  struct stat old = {};
  const bool exists = stat(path.c_str(), &old) == 0;
  if (name.empty() || name == "." || name == ".." || (exists && S_ISDIR(old.st_mode)))
    return file_error(path, exists ? "is a directory" : "not a name for an output file", "the path of a file to write");
  if (exists && is_standard_output(old)) return straight_to(path, fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3));
  if (exists && !S_ISREG(old.st_mode)) return straight_to(path, open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (exists && !force) return file_error(path, "output file exists", "a new name or --force");
  // Another's file that may not be written is not replaced either, though its folder would allow it.
  if (exists && access(path.c_str(), W_OK) != 0)
    return file_error(path, "cannot be written (" + last_error_text() + ")", "a writable place");

  remove_stale_stagings(target.parent_path());
  const std::string staging = staging_name(target, "partial").string();
  const int descriptor = open(staging.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) return file_error(path, "cannot be written (" + last_error_text() + ")", "a writable place");
  if (exists) (void)fchmod(descriptor, old.st_mode & 07777);
  return StagedFile(target.string(), staging, force, descriptor);
}

Status StagedFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  return buffer_.size() < kBuffer ? Status(Ok{}) : flush();
}

Status StagedFile::flush() {
  CANYON_CHECK(descriptor_ >= 0, "written after its end: ", final_path());
  for (std::size_t done = 0; done < buffer_.size();) {
    const ssize_t n = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      return file_error(final_path(), "cannot be written to the end (" + last_error_text() + ")", "space on the disk",
                        1);
    done += static_cast<std::size_t>(n);
  }
  buffer_.clear();
  return Ok{};
}

Status StagedFile::seal() {
  CANYON_TRY_STATUS(flush());
  std::error_code code;
  if (!staging_path().empty()) code = sync_file(descriptor_);
  if (close(std::exchange(descriptor_, -1)) != 0 && !code) code = {errno, std::generic_category()};
  if (code)
    return file_error(final_path(), "cannot be written to the end (" + code.message() + ")", "space on the disk", 1);
  return Ok{};
}

Status StagedFile::check_replaced() const {
  std::error_code code;
  if (fs::is_directory(fs::symlink_status(final_path(), code)))
    return file_error(final_path(), "is a directory", "the path of a file to write", 1);
  return Ok{};
}

std::string StagedFile::next_free_name() const {
  return free_file_name(final_path());
}

}  // namespace canyon
