#include "canyon/tests/support/test_data.h"

#include <cstdlib>
#include <filesystem>

namespace canyon::testing {

std::string data_file(const std::string& relative) {
  namespace fs = std::filesystem;
  const char* configured = std::getenv("CANYON_TEST_DATA");
  const fs::path folder =
      configured ? fs::path(configured) : fs::path(CANYON_SOURCE_DIR).parent_path() / "shared" / "data";
  if (!fs::is_directory(folder)) return {};
  const fs::path file = folder / relative;
  if (!fs::exists(file)) {
    ADD_FAILURE() << "the folder of real recordings " << folder << " lacks " << relative;
    return {};
  }
  return file.string();
}

}  // namespace canyon::testing
