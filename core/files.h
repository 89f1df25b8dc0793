#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace canyon {

Result<std::string> read_text_file(const std::string& path);
/// Like read_text_file, but gzip files are unpacked (zlib), whatever their name.
Result<std::string> read_text_or_gzip_file(const std::string& path);
Status write_text_file(const std::string& path, std::string_view text);

/// SHA-256 of bytes as 64 hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

/// `path`, or `path`-2, -3, ... where nothing of that name exists.
std::string free_name(const std::string& path);

/// A directory that becomes visible under its final name only when complete. Until commit() everything is written under
/// a temporary name beside it; the destructor removes what was not committed.
class StagedDirectory {
 public:
  /// Fails (exit 2) if `path` exists and `force` is false, or if it cannot be written. With `force` an existing one is
  /// replaced if it is empty or was put in place by commit(), which leaves the file `.canyon` in it; no other directory
  /// is ever touched.
  static Result<StagedDirectory> create(const std::string& path, bool force);
  StagedDirectory(StagedDirectory&& other) noexcept;
  StagedDirectory& operator=(StagedDirectory&&) = delete;
  ~StagedDirectory();

  const std::string& staging_path() const { return staging_; }
  /// Where it will be. After commit(), where it is: if without `force` another has taken the name meanwhile, what was
  /// computed is not lost but has the next free_name().
  const std::string& final_path() const { return final_; }
  Status commit();

 private:
  StagedDirectory(std::string final_path, std::string staging, bool force, std::vector<std::string> created_parents);
  std::string final_, staging_;
  bool force_ = false;
  std::vector<std::string> created_parents_;  ///< outermost first; taken away again if nothing is committed
};

}  // namespace canyon
