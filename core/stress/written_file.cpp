#include "canyon/core/stress/written_file.h"

#include <atomic>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <unistd.h>

#include "canyon/core/process/staging_litter.h"

namespace canyon::stress {

WrittenFile::WrittenFile(std::string_view text, const std::string& ending) {
  static std::atomic<int> count = 0;
  path_ = (std::filesystem::temp_directory_path() /
           ("canyon-stress-" + std::to_string(::getpid()) + "-" + std::to_string(++count) + ending))
              .string();
  add_litter(path_, {});
  std::ofstream(path_, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

WrittenFile::~WrittenFile() {
  std::error_code unknown;
  std::filesystem::remove(path_, unknown);
  forget_litter(path_);
}

}  // namespace canyon::stress
