#include "canyon/tests/report/temporary_directory.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "canyon/core/check.h"

namespace canyon::testing {

TemporaryDirectory::TemporaryDirectory() {
  path_ = (std::filesystem::temp_directory_path() / "canyon-report-XXXXXX").string();
  CANYON_CHECK(mkdtemp(path_.data()) != nullptr, "path = ", path_);
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;  // a destructor must not throw
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace canyon::testing
