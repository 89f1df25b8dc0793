#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

#include "canyon/core/process/staging_litter.h"
#include "canyon/core/result.h"

namespace canyon::stress {

/// A file among the temporary ones for as long as the object lives, for readers that take a path.
class WrittenFile {
 public:
  explicit WrittenFile(std::string_view text = {}, const std::string& ending = ".txt") {
    static int count = 0;
    path_ = (std::filesystem::temp_directory_path() /
             ("canyon-stress-" + std::to_string(::getpid()) + "-" + std::to_string(++count) + ending))
                .string();
    add_litter(path_, {});
    std::ofstream(path_, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
  }
  ~WrittenFile() {
    std::error_code unknown;
    std::filesystem::remove(path_, unknown);
    forget_litter(path_);
  }
  WrittenFile(const WrittenFile&) = delete;
  WrittenFile& operator=(const WrittenFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// 1 where what is read of this text is no mistake, or is told in other words than these, after the file's name:
/// ":LINE: what, expected ...".
template <class Read>
int told_otherwise(std::string_view text, Read&& read, const std::string& words) {
  const WrittenFile file(text);
  const auto found = read(file.path());
  return !found.ok() && found.error().str() == file.path() + words ? 0 : 1;
}

}  // namespace canyon::stress
