#pragma once

#include <string>
#include <string_view>

#include "canyon/core/result.h"

namespace canyon::stress {

/// A file among the temporary ones for as long as the object lives, for readers that take a path.
class WrittenFile {
 public:
  explicit WrittenFile(std::string_view text = {}, const std::string& ending = ".txt");
  ~WrittenFile();
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
