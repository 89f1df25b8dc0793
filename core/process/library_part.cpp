#include "canyon/core/process/library_part.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "embedded/part_folder.inc"

namespace canyon {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> folders() {
  if (const char* named = std::getenv("CANYON_PART_DIR"); named != nullptr && *named != '\0') return {named};
  std::error_code unreadable;
  const fs::path program = fs::read_symlink("/proc/self/exe", unreadable);
  return {program.parent_path().parent_path() / "lib" / "canyon", kInstalledPartFolder};
}

}  // namespace

const void* open_library_part(const std::string& name) {
  const std::string file = "libcanyon_" + name + ".so";
  std::string looked_at;
  for (const fs::path& folder : folders()) {
    const fs::path path = folder / file;
    if (!fs::exists(path)) {
      looked_at += (looked_at.empty() ? "" : ", ") + folder.string();
      continue;
    }
    void* const opened = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (opened == nullptr) throw std::runtime_error(std::string("cannot open ") + dlerror());
    if (const void* part = dlsym(opened, ("canyon_" + name + "_part").c_str())) return part;
    throw std::runtime_error(path.string() + " is of another version of Canyon");
  }
  throw std::runtime_error(file + " is missing; it is looked for in " + looked_at + " (or in CANYON_PART_DIR)");
}

}  // namespace canyon
