#include "canyon/core/files/row_store.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace canyon {

namespace {

Error store_error(const std::string& directory, const char* what) {
  return Error{.file = directory,
               .what = std::string(what) + " (" + std::generic_category().message(errno) + ")",
               .expected = "space for what a run keeps until its end",
               .exit_code = 1};
}

}  // namespace

ByteStore::~ByteStore() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status ByteStore::append(const void* bytes, std::size_t size) {
  if (block_.size() + size > kBlock) CANYON_TRY_STATUS(spill());
  const char* first = static_cast<const char*>(bytes);
  block_.insert(block_.end(), first, first + size);
  return Ok{};
}

Status ByteStore::spill() {
  if (descriptor_ < 0) {
    std::error_code unknown;
    if (directory_.empty()) directory_ = std::filesystem::temp_directory_path(unknown).string();
    std::string name = directory_ + "/.rows-XXXXXX";
    descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor_ < 0) return store_error(directory_, "a temporary file cannot be made");
    ::unlink(name.c_str());
  }
  for (std::size_t done = 0; done < block_.size();) {
    const ssize_t wrote = ::pwrite(descriptor_, &block_[done], block_.size() - done, static_cast<off_t>(in_file_));
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return store_error(directory_, "a temporary file cannot be written");
    done += static_cast<std::size_t>(wrote);
    in_file_ += static_cast<std::size_t>(wrote);
  }
  block_.clear();
  return Ok{};
}

Status ByteStore::read(std::size_t at, std::vector<char>& out) const {
  if (at >= in_file_) {
    out.assign(block_.begin() + static_cast<std::ptrdiff_t>(std::min(at - in_file_, block_.size())), block_.end());
    return Ok{};
  }
  out.resize(std::min(kBlock, in_file_ - at));
  for (std::size_t done = 0; done < out.size();) {
    const ssize_t got = ::pread(descriptor_, &out[done], out.size() - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return store_error(directory_, "a temporary file cannot be read");
    done += static_cast<std::size_t>(got);
  }
  return Ok{};
}

}  // namespace canyon
