#pragma once

#include <fstream>
#include <string>
#include <string_view>

#include "canyon/core/result.h"

namespace canyon {

/// A file that is written piece by piece. What stood there before is replaced at once; for an output that must never
/// look finished half-written, write into a StagedDirectory.
class FileWriter {
 public:
  /// Fails (exit 2) if it cannot be written.
  static Result<FileWriter> create(const std::string& path);
  /// Appends. Fails (exit 1) on a full disk, as close() does; what failed once fails for good.
  Status write(std::string_view bytes);
  Status close();

 private:
  FileWriter(std::string path, std::ofstream out) : path_(std::move(path)), out_(std::move(out)) {}
  std::string path_;
  std::ofstream out_;
};

}  // namespace canyon
